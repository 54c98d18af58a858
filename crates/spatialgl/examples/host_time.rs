//! Processor time of a volume of 198 distinct slices of the head by one thread, with and without bins and tiles: `cargo
//! run --release -p pxpl5-spatialgl --example host_time`. The benches measure wall-clock time. Processor time is
//! reliable on a busy computer too.

use pxpl5_scene::builtin;
use spatialgl::{
    HostRenderer, Jitter, OneThread, Projection, SliceClip, Strobes, SweptConfig, SweptDisplay, VolumeConfig,
    record_scene, render_volume,
};

/// Returns the nanoseconds that this thread has run (Linux only), or `None` on other systems.
fn processor_ns() -> Option<u64> {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    stat.split_whitespace().next()?.parse().ok()
}

fn main() {
    let wanted = std::env::args().nth(1);
    let commands = record_scene(&builtin("head").expect("built in"), 384.0, true).expect("valid");
    let plain = VolumeConfig { strobes: Strobes::Mirror, ..VolumeConfig::plain() };
    let paper = VolumeConfig { strobes: Strobes::Mirror, ..VolumeConfig::paper() };
    let along = Projection::Orthographic;
    let jittered = Projection::Jittered(Jitter::new(1));
    for (name, projection, config) in [
        ("binned and tiled", along, &paper),
        ("binned and tiled, jittered", jittered, &paper),
        ("plain", along, &plain),
    ]
    .into_iter()
    .filter(|(name, ..)| wanted.as_ref().is_none_or(|wanted| wanted == name))
    {
        let config_of_display = SweptConfig::perspecta(SliceClip::Hyperbolic(0.25), projection);
        let display = SweptDisplay::new(config_of_display).expect("valid");
        let mut times: Vec<u64> = (0..7)
            .filter_map(|_| {
                let begun = processor_ns()?;
                let frame = render_volume(&display, &commands, config, &HostRenderer, &OneThread).expect("valid");
                assert!(frame.stats.fragments_accepted > 0);
                Some(processor_ns()? - begun)
            })
            .collect();
        times.sort_unstable();
        let ms = |at: usize| times.get(at).map_or(f64::NAN, |ns| *ns as f64 / 1e6);
        println!("{name:<28} least {:6.1} ms, median {:6.1} ms", ms(0), ms(times.len() / 2));
    }
}
