//! temporary
use pxpl5_gp::{CodeVersion, GpTiming, Stage};
use pxpl5_lab::code_times::{CodeUse, code_times};
use pxpl5_lab::limit::LimitQuery;
use pxpl5_machine::MachineConfig;
use pxpl5_measure::Measured;
use pxpl5_run::{Experiment, Level, Pixels, Slats, SlatsLighting, TestScene};
use pxpl5_scene::builtin;

use std::io::Write;

fn limit(config: MachineConfig, slats: Slats, scene: TestScene, level: Level) -> u32 {
    let mut query = LimitQuery::of_papers(config, slats).expect("known");
    query.criterion.scene = scene;
    query.level = level;
    query.search().expect("it runs").triangles
}
fn say(text: String) {
    println!("{text}");
    std::io::stdout().flush().unwrap();
}

#[test]
fn a_measure() {
    let preset = |name: &str| MachineConfig::preset(name).unwrap();
    for (name, slats) in [
        ("slats", Slats::whole()),
        ("slats", Slats::split()),
        ("slats-1995", Slats::split()),
        ("slats", Slats::backup()),
    ] {
        say(format!(
            "transaction full-screen {name} {:?}: {}",
            slats.copy,
            limit(preset(name), slats, TestScene::FullScreen, Level::Transaction)
        ));
    }
    for lighting in [SlatsLighting::Precomputed, SlatsLighting::OnGp] {
        for (name, slats) in [
            ("slats", Slats::whole()),
            ("slats", Slats::split()),
            ("slats-optimised", Slats::whole()),
            ("slats-optimised", Slats::split()),
        ] {
            let slats = Slats { lighting, ..slats };
            say(format!(
                "cycle typical {name} {:?} {lighting:?}: {}",
                slats.copy,
                limit(preset(name), slats, TestScene::Typical, Level::Cycle)
            ));
        }
    }
    for (version, of) in [
        (CodeVersion::Compiled, CodeUse::Slats),
        (CodeVersion::Compiled, CodeUse::SlatsLit),
        (CodeVersion::Scheduled, CodeUse::Slats),
        (CodeVersion::Scheduled, CodeUse::SlatsLit),
    ] {
        let t = code_times(version, of).unwrap();
        say(format!("{version:?} {of:?} {t:?}"));
        let r = |ns: f64| ns.round() as u64;
        let gp = GpTiming {
            message_ns: r(t.message_ns),
            triangle_ns: r(t.triangle_ns),
            sphere_ns: r(t.sphere_ns),
            guard_ns: r(t.guard_ns),
            bin_entry_ns: 0,
            edit_ns: r(t.edit_ns),
            pass_ns: r(t.pass_ns),
            structure_ns: r(t.structure_ns),
            sphere_view_ns: r(t.sphere_view_ns),
            ..preset("slats").gp
        };
        for slats in [Slats::whole(), Slats::split()] {
            say(format!(
                "times of code typical {version:?} {of:?} {:?}: {}",
                slats.copy,
                limit(MachineConfig { gp, ..preset("slats") }, slats, TestScene::Typical, Level::Transaction)
            ));
        }
    }
    for renderers in [5, 10, 15, 20] {
        let config = MachineConfig { n_renderers: renderers, ..preset("slats-optimised") };
        let l = limit(config.clone(), Slats::split(), TestScene::FullScreen, Level::Transaction);
        let l4 = limit(
            {
                let mut c = config.clone();
                c.ring.source_channels = 4;
                c
            },
            Slats::split(),
            TestScene::FullScreen,
            Level::Transaction,
        );
        let o = Experiment::new(config, Slats::split(), builtin("full-screen:180").unwrap())
            .fields(16)
            .pixels(Pixels::Off)
            .run()
            .unwrap();
        let m = o.record().ring().timing().occupancy(1_024);
        let stages: Vec<_> = o
            .observation()
            .stages(m)
            .into_iter()
            .filter(|s| s.picture.0 == 10)
            .map(|s| (s.stage, s.surface, s.begin.0 as f64 * 1e-9, s.end.map(|e| e.0 as f64 * 1e-9)))
            .collect();
        let _ = Stage::Transform;
        say(format!("optimised split {renderers} renderers: {l}; four channels {l4}; {stages:?}"));
    }
}

#[test]
fn b_backup() {
    for scene in
        ["full-screen:60", "full-screen:147", "full-screen:160", "full-screen:200", "typical:200", "full-screen:400"]
    {
        for slats in [Slats::backup(), Slats::split()] {
            let o = Experiment::new(MachineConfig::preset("slats").unwrap(), slats, builtin(scene).unwrap())
                .fields(40)
                .pixels(Pixels::Off)
                .run();
            let o = match o {
                Ok(o) => o,
                Err(e) => {
                    say(format!("{scene} {:?}: {e}", slats.copy));
                    continue;
                }
            };
            let r = o.report();
            let shown: Vec<_> = o
                .pictures()
                .iter()
                .map(|p| (p.picture.0, o.record().display().period_at(p.shown_at).0, p.end))
                .collect();
            say(format!(
                "{scene} {:?}: due {:?} late {} lines {:?}\n   {shown:?}",
                slats.copy, r.due, r.late_regions, r.display_counters
            ));
        }
    }
}
