use pxpl5::compare::*;
use pxpl5::*;
use std::sync::Arc;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let scene = Arc::new(scene::builtin(&a[1]).unwrap());
    let head =
        Arc::new(Head::new(motion(&a[2]).unwrap(), tracker(&a[3]).unwrap(), predictor(&a[4]).unwrap(), 1).unwrap());
    let fields = a[5].parse().unwrap();
    let t = std::time::Instant::now();
    let c = compare(&MachineConfig::small_hmd(), &scene, &head, fields, a.len() > 6).unwrap();
    println!("total {:.2} s", t.elapsed().as_secs_f64());
    for r in &c.pipelines {
        let b = r.end_to_end;
        println!(
            "{:24} lat {:7.2} tot {:7.2} [{:.1} {:.1} {:.1} {:.1} {:.1} {:.1}] n={} hz {:6.2} missed {} late {} err px mean {:.2} p99 {:.2} centre {:.2} deg {:.3} empty {} behind {} tri {:?} host {:.2} {:?}",
            r.pipeline,
            r.latency_ms,
            b.total_ms,
            b.tracking_ms,
            b.waiting_ms,
            b.sending_ms,
            b.drawing_ms,
            b.showing_ms,
            b.scanning_ms,
            b.pictures,
            r.updates_hz,
            r.missed_retraces,
            r.late_regions,
            r.error.pixels.mean,
            r.error.pixels.p99,
            r.error.centre_px.mean,
            r.error.degrees.mean,
            r.error.empty,
            r.error.behind,
            r.triangles_possible,
            r.host_seconds,
            r.failure
        );
    }
}
