//! Prints a table of all clip variants and projections of a scene. `cargo run --release -p pxpl5-spatialgl --example
//! compare_clips -- SCENE`.

use spatialgl::perspecta::PerspectaConfig;
use spatialgl::{
    HostRenderer, Jitter, Projection, SliceClip, Threads, TimeModel, VolumeConfig, brightness_by_radius, connected,
    dead_zone_radius, record_scene, render_volume,
};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = std::env::args().nth(1).unwrap_or_else(|| "mig".to_owned());
    let commands = record_scene(&pxpl5_scene::builtin(&scene)?, 384.0, true)?;
    println!(
        "{scene}: {} primitives; lit voxels a column of radius 0-8, 8-16, 64-72, 256-264 px",
        commands.primitives()
    );
    println!(
        "clip         projection    passes  generated   accepted  tiles %  draws %  connected %  dead px  \
         lit by radius           Hz serial  overlapped"
    );
    for clip in SliceClip::ALL {
        for projection in [Projection::Orthographic, Projection::Jittered(Jitter::new(1))] {
            let display = PerspectaConfig::PAPERS.swept(clip, projection)?;
            let config = VolumeConfig { keeps_colours: true, ..VolumeConfig::paper() };
            let frame = render_volume(&display, &commands, &config, &HostRenderer, &Threads::all())?;
            let stats = &frame.stats;
            let time = TimeModel::GEFORCE_6800.packed(stats, [768, 768], 32);
            let rings = brightness_by_radius(&frame.planes, 8);
            println!(
                "{:<12} {:<12} {:>7} {:>10} {:>10} {:>8.2} {:>8.2} {:>12.1} {:>8} {:>23} {:>10.2} {:>11.2}",
                clip.name(),
                projection.name(),
                stats.passes,
                stats.fragments_generated,
                stats.fragments_accepted,
                stats.tile_occupancy_percent(),
                100.0 * stats.draws as f64 / stats.draws_unbinned as f64,
                connected(&display, &commands, &frame).map_or(0.0, |found| found.percent()),
                dead_zone_radius(&display).unwrap_or(384),
                format!("{:?}", [0, 1, 8, 32].map(|ring| rings[ring] / 16)),
                time.serial_hz(),
                time.overlapped_hz(),
            );
        }
    }
    Ok(())
}
