//! Runs pipelines with a recording of a head and prints their errors in pixels. The Python version is my_recording.py.
//!
//! `cargo run --release --example my_recording [RECORDING]`

use pxpl5::tracking::motion::Recording;
use pxpl5::{ExperimentFile, Head, Measured};
use std::error::Error;
use std::fmt::Write;
use std::fs::File;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    // The recording is a file in the project's own format or in that of EuRoC or TUM, or a text with samples. A sample
    // has seconds, metres, and a quaternion with the real part first.
    let recording = match std::env::args().nth(1) {
        Some(path) => Recording::read(File::open(path)?)?,
        None => Recording::read(nodding()?.as_bytes())?,
    };
    let recording = Arc::new(recording);
    for pipeline in ["rendering-control", "slats", "jitp-scanline-racing"] {
        for predict in ["none", "kalman"] {
            let settings = format!(
                "pipeline = \"{pipeline}\"\nscene = \"full-screen:4\"\nfields = 120\npixels = \"off\"\n\
                 [head]\nmotion = \"still\"\ntracker = \"fastrak\"\npredict = \"{predict}\"\n"
            );
            let plan = ExperimentFile::parse(&settings, "settings")?.resolve()?;
            let experiment = plan.experiment(plan.load_scene()?);
            // Tracker and predictor stay the same, and the recording replaces the motion.
            let head = experiment.head.as_ref().ok_or("the settings have a head")?;
            let head = Head::clone(head).with_motion(recording.clone());
            let report = experiment.head(head).run()?.report();
            let head = report.head.ok_or("a report without a head")?;
            let error = head.error.pixels;
            let light = head.end_to_end.total_ms;
            println!(
                "{pipeline:22} {predict:7} {light:6.1} ms from head to light, {:6.2} px of error, 99 %: {:.1}",
                error.mean, error.p99
            );
        }
    }
    Ok(())
}

/// Returns four seconds of a head that turns by 20 degrees to both sides, once in two seconds.
fn nodding() -> Result<String, std::fmt::Error> {
    let mut text = "time_s,x,y,z,qw,qx,qy,qz\n".to_owned();
    for sample in 0..=240 {
        let time_s = f64::from(sample) / 60.0;
        let angle = 20f64.to_radians() * (std::f64::consts::PI * time_s).sin();
        writeln!(text, "{time_s},0,0,0,{},0,{},0", (angle / 2.0).cos(), (angle / 2.0).sin())?;
    }
    Ok(text)
}
