//! Writes pictures of a volume: the six clip variants side by side, a sheet of all slices, a slice before and after
//! halftoning. `cargo run --release -p pxpl5-spatialgl --example draw_volume -- SCENE FOLDER`.

use image::{GenericImage, Rgb, RgbImage, imageops};
use spatialgl::perspecta::{Camera, PerspectaConfig, ViewOptions, view_planes};
use spatialgl::{
    CommandBuffer, HostRenderer, Jitter, Projection, SliceClip, Threads, VolumeConfig, VolumeFrame, record_scene,
    render_volume,
};
use std::error::Error;
use std::path::PathBuf;

const SIDE: u32 = 384;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let scene = arguments.next().unwrap_or_else(|| "head".to_owned());
    let folder = PathBuf::from(arguments.next().unwrap_or_else(|| ".".to_owned()));
    let commands = record_scene(&pxpl5_scene::builtin(&scene)?, 384.0, true)?;
    variants(&commands)?.save(folder.join(format!("{scene}-variants.png")))?;
    let frame = volume(&commands, SliceClip::Hyperbolic(0.25), Projection::Jittered(Jitter::new(1)))?;
    sheet(&frame)?.save(folder.join(format!("{scene}-sheet.png")))?;
    slice(&frame, 50)?.save(folder.join(format!("{scene}-slice-50.png")))?;
    Ok(())
}

fn volume(commands: &CommandBuffer, clip: SliceClip, projection: Projection) -> Result<VolumeFrame, Box<dyn Error>> {
    let display = PerspectaConfig::PAPERS.swept(clip, projection)?;
    let config = VolumeConfig { keeps_colours: true, ..VolumeConfig::paper() };
    Ok(render_volume(&display, commands, &config, &HostRenderer, &Threads::all())?)
}

/// Draws one row for each clip: orthographic and jittered, from the side and from above, all with one exposure.
fn variants(commands: &CommandBuffer) -> Result<RgbImage, Box<dyn Error>> {
    let mut all = RgbImage::new(4 * SIDE, 6 * SIDE);
    let reference = volume(commands, SliceClip::ShaderPlanes, Projection::Jittered(Jitter::new(1)))?;
    for (column, elevation) in [(0, 25.0), (2, 80.0)] {
        let camera = Camera::around(384.0, 40.0, elevation, SIDE);
        let see = |frame: &VolumeFrame| view_planes(&frame.planes, &camera, ViewOptions::default(), &Threads::all());
        let exposure = see(&reference)?.exposure(0.97);
        for (row, clip) in (0..).zip(SliceClip::ALL) {
            for (beside, projection) in [(0, Projection::Orthographic), (1, Projection::Jittered(Jitter::new(1)))] {
                let picture = see(&volume(commands, clip, projection)?)?.picture(exposure);
                all.copy_from(&picture, (column + beside) * SIDE, row * SIDE)?;
            }
        }
    }
    Ok(all)
}

/// Draws all slices as thumbnails, 22 in a row.
fn sheet(frame: &VolumeFrame) -> Result<RgbImage, Box<dyn Error>> {
    let mut all = RgbImage::new(22 * 64, frame.planes.slices().div_ceil(22) * 64);
    for k in 0..frame.planes.slices() {
        let thumbnail = imageops::thumbnail(&halftoned(frame, k), 62, 62);
        all.copy_from(&thumbnail, k % 22 * 64 + 1, k / 22 * 64 + 1)?;
    }
    Ok(all)
}

fn slice(frame: &VolumeFrame, k: u32) -> Result<RgbImage, Box<dyn Error>> {
    let [width, height] = frame.planes.size();
    let mut both = RgbImage::new(2 * width, height);
    for sample in frame.colours.as_ref().map_or(&[][..], |colours| &colours[k as usize]) {
        both.put_pixel(sample.pixel % width, sample.pixel / width, Rgb(sample.colour));
    }
    both.copy_from(&halftoned(frame, k), width, 0)?;
    Ok(both)
}

fn halftoned(frame: &VolumeFrame, k: u32) -> RgbImage {
    let [width, height] = frame.planes.size();
    RgbImage::from_fn(width, height, |x, y| {
        let bits = frame.planes.pixel(k, x, y);
        Rgb([0, 1, 2].map(|channel| 255 * (bits >> channel & 1)))
    })
}
