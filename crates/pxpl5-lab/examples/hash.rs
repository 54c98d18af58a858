fn main() {
    for line in std::io::read_to_string(std::io::stdin()).unwrap().lines() {
        let file =
            line.split(';').try_fold(pxpl5_lab::ExperimentFile::new(), |mut f, a| f.set_text(a, "x").map(|()| f));
        let plan = file.unwrap().resolve().unwrap();
        let out = plan.experiment(plan.load_scene().unwrap()).pixels(pxpl5_run::Pixels::Off).run();
        match out {
            Ok(out) => {
                let r = pxpl5_measure::Report::of(&out);
                println!(
                    "{line} => {} {} {} {} {}",
                    r.trace_hash, r.events, r.latency_fields.statistics.mean, r.missed_retraces, r.updates_hz
                );
            }
            Err(e) => println!("{line} => {e}"),
        }
    }
}
