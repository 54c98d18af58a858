#![allow(missing_docs)]
use pxpl5::*;
use std::time::Instant;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let fields: u64 = a[1].parse().unwrap();
    let head: std::sync::Arc<scene::Scene> = scene::builtin("head").unwrap().into();
    for _ in 0..1 {
        for (n, p, t) in [("off", Pixels::Off, 1), ("lazy", Pixels::Lazy, 1), ("all2", Pixels::All, 2)] {
            let e = Experiment::with(
                MachineConfig::small_hmd(),
                std::sync::Arc::new(RenderingControl::stereo()),
                head.clone(),
            )
            .fields(fields)
            .pixels(p)
            .threads(t);
            let cpu0 = cpu();
            let t0 = Instant::now();
            let mut m = e.build().unwrap();
            let b = t0.elapsed();
            let end = m.video().retrace(fields);
            m.run_until(end).unwrap();
            m.finish_pixels();
            let t = t0.elapsed();
            let frames = m.observation().swaps.len() / 2;
            let marks = m
                .observation()
                .marks
                .iter()
                .filter(|m| m.node.0 == 2 && format!("{:?}", m.stage) == "Transform")
                .count();
            println!(
                "{n}: build {b:?} run {:?} cpu {:.1} ms, swaps {frames}, transform marks {marks}; cpu per frame {:.2} ms events {}",
                t - b,
                (cpu() - cpu0) * 1e3,
                (cpu() - cpu0) * 1e3 / frames as f64,
                m.events()
            );
        }
    }
}
fn cpu() -> f64 {
    let s = std::fs::read_to_string("/proc/self/stat").unwrap();
    let f: Vec<&str> = s.rsplit_once(") ").unwrap().1.split(' ').collect();
    let tsched = std::fs::read_to_string("/proc/self/schedstat")
        .ok()
        .and_then(|s| s.split(' ').next().and_then(|x| x.parse::<f64>().ok()))
        .unwrap_or(0.0);
    let _ = tsched;
    (f[11].parse::<f64>().unwrap() + f[12].parse::<f64>().unwrap()) / 100.0
}
