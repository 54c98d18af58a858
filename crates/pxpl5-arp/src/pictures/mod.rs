//! What people look at: unfolded faces, the eye, which memory won, tears, errors, cells from above, updates.

mod faces;
mod plan;
mod views;

pub use faces::cross;
pub use plan::{cells_svg, updates_svg};
pub use views::{Views, difference};

use crate::error::ExperimentError;
use crate::figures::{Experiments, gallery, looking_at};
use crate::look::Faces;
use crate::settings::Settings;
use crate::simulation::Simulation;
use crate::walk::{WalkTally, at_frames, walk};
use crate::world::World;
use address_recalculation::Lens;
use image::RgbImage;
use priority_rendering::Falloff;

/// Colours of memories 0 to 7, told apart by those who see fewer colours too.
pub(crate) const MEMORY_COLOURS: [u32; 8] =
    [0x00D5_5E00, 0x00E6_9F00, 0x0000_9E73, 0x0056_B4E9, 0x0000_72B2, 0x00CC_79A7, 0x00F0_E442, 0x0099_9999];

/// A picture, with the name of its file.
#[derive(Clone, Debug)]
pub enum Picture {
    /// Pixels: name.png.
    Pixels(String, RgbImage),
    /// A drawing: name.svg.
    Drawing(String, String),
}

/// Frames of the walk that is looked at.
const FRAMES: u64 = 1_800;

/// All pictures of the torn and the warped walk, at the frame and towards the vertex of the widest tear.
///
/// # Errors
///
/// [`ExperimentError`], where a lens, scene or number is none; those here are.
pub fn all(experiments: &Experiments) -> Result<Vec<Picture>, ExperimentError> {
    let (scene, path) = gallery()?;
    let mut world = World::new(&scene, experiments.fits[1].2)?;
    let torn = Settings::CELLS.with_cells(experiments.fits[1].2);
    let eye = at_frames(&path, 1.0, 60.0);
    let tally = walk(&world, &torn, FRAMES, &eye)?;
    let (frame, vertex) = widest(&tally);
    let orientation = looking_at(eye(frame), world.vertices[vertex as usize]);
    // A step later, or the memory that has just been drawn would show no error.
    let now = eye(frame);
    let full = shown(&world, &Settings::FULL.with_cells(experiments.fits[1].2), frame..frame + 1, &eye)?;
    let simulation = shown(&world, &torn, 0..frame + 1, &eye)?;
    let faces = Faces::of(&simulation)?;
    let mut pictures: Vec<Picture> = faces
        .memories
        .iter()
        .enumerate()
        .map(|(memory, set)| Picture::Pixels(format!("faces-{memory}"), cross(set, faces.background())))
        .collect();
    pictures
        .push(Picture::Pixels("faces-composite".to_owned(), cross(&Faces::of(&full)?.memories[0], faces.background())));
    let views = Views { faces: &faces, orientation };
    pictures.push(Picture::Pixels("eye-flat".to_owned(), views.seen(Lens::Flat)?));
    pictures.push(Picture::Pixels("eye".to_owned(), views.seen(Lens::Radial { k1: 0.32, k2: 0.0 })?));
    pictures.push(Picture::Pixels("memories".to_owned(), views.memories()?));
    pictures.push(Picture::Pixels("error".to_owned(), views.errors(&simulation, now)?));
    pictures.push(Picture::Drawing("cells".to_owned(), cells_svg(&world, &simulation, &path, now)));
    pictures.push(Picture::Drawing("updates".to_owned(), updates_svg(&tally, frame.saturating_sub(60)..frame + 60)));
    world.background = 0x00FF_FFFF;
    pictures.extend(gaps(&world, &torn, frame, &eye, orientation)?);
    Ok(pictures)
}

/// The same frame torn and warped, cleared to white, and the difference.
fn gaps(
    world: &World,
    torn: &Settings,
    frame: u64,
    eye: &impl Fn(u64) -> glam::DVec3,
    orientation: glam::DQuat,
) -> Result<Vec<Picture>, ExperimentError> {
    let mut both = Vec::new();
    for falloff in [Falloff::None, Falloff::Linear] {
        let settings = Settings { falloff, has_cascade: falloff != Falloff::None, ..torn.clone() };
        let simulation = shown(world, &settings, 0..frame + 1, eye)?;
        let faces = Faces::of(&simulation)?;
        both.push(Views { faces: &faces, orientation }.seen(Lens::Flat)?);
    }
    let names = ["tears", "warped"];
    let mut pictures: Vec<Picture> =
        names.iter().zip(&both).map(|(name, picture)| Picture::Pixels((*name).to_owned(), picture.clone())).collect();
    pictures.push(Picture::Pixels("difference".to_owned(), difference(&both[0], &both[1])));
    Ok(pictures)
}

/// A walk up to a frame.
fn shown<'a>(
    world: &'a World,
    settings: &Settings,
    frames: std::ops::Range<u64>,
    eye: &impl Fn(u64) -> glam::DVec3,
) -> Result<Simulation<'a>, ExperimentError> {
    let mut simulation = Simulation::new(world, settings)?;
    for frame in frames {
        simulation.frame(eye(frame))?;
    }
    Ok(simulation)
}

/// The frame with the widest tear, and its vertex.
fn widest(tally: &WalkTally) -> (u64, u32) {
    let frames =
        (0..).zip(&tally.widest).filter_map(|(frame, widest)| widest.map(|(gap, vertex)| (frame, gap, vertex)));
    let most = frames.max_by(|a, b| a.1.total_cmp(&b.1));
    most.map_or((0, 0), |(frame, _, vertex)| (frame, vertex))
}
