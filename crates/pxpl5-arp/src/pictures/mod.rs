//! What people look at: unfolded faces, the eye, which memory won, tears, errors, cells from above, updates.

mod colours;
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
use crate::tears::Tears;
use crate::walk::{at_frames, walk};
use crate::world::{Tint, World};
use address_recalculation::Lens;
use glam::{DQuat, DVec3};
use image::RgbImage;
use priority_rendering::Falloff;

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

/// All pictures of the torn and the warped walk, at a frame and towards a vertex where much of what lies behind is seen through
/// the tear.
///
/// # Errors
///
/// [`ExperimentError`], where a lens, scene or number is none; those here are.
pub fn all(experiments: &Experiments) -> Result<Vec<Picture>, ExperimentError> {
    let (scene, path) = gallery()?;
    let mut world = World::new(&scene, experiments.fits[1].cell_m)?;
    let torn = Settings::CELLS.with_cells(experiments.fits[1].cell_m);
    let eye = at_frames(&path, 1.0, 60.0);
    let background = world.background;
    world.background = WHITE;
    let (frame, orientation) = gaping(&world, &torn, &eye)?;
    let gaps = gaps(&world, &torn, frame, &eye, orientation)?;
    world.background = background;
    let simulation = shown(&world, &torn, 0..frame + 1, &eye)?;
    let faces = Faces::of(&simulation)?;
    let mut pictures: Vec<Picture> = Vec::new();
    for (memory, set) in faces.memories.iter().enumerate() {
        pictures.push(Picture::Pixels(format!("faces-{memory}"), cross(set, faces.background())));
    }
    let whole = Faces::of(&shown(&world, &Settings::FULL, frame..frame + 1, &eye)?)?;
    pictures.push(Picture::Pixels("faces-whole".to_owned(), cross(&whole.memories[0], faces.background())));
    let views = Views { faces: &faces, orientation };
    pictures.push(Picture::Pixels("eye-flat".to_owned(), views.seen(Lens::Flat)?));
    pictures.push(Picture::Pixels("eye".to_owned(), views.seen(Lens::Radial { k1: 0.32, k2: 0.0 })?));
    pictures.push(Picture::Pixels("memories".to_owned(), views.memories()?));
    pictures.push(Picture::Pixels("error".to_owned(), views.errors(&simulation, eye(frame))?));
    pictures.push(Picture::Drawing("cells".to_owned(), cells_svg(&world, &simulation, &path, eye(frame))));
    let tally = walk(&world, &torn, frame + 60, &eye)?;
    pictures.push(Picture::Drawing("updates".to_owned(), updates_svg(&tally, frame.saturating_sub(60)..frame + 60)));
    pictures.extend(gaps);
    pictures.extend(tinted(world, &torn, eye(frame), orientation)?);
    Ok(pictures)
}

/// The eye's picture with a colour for each object, and with one for each cell.
fn tinted(
    mut world: World,
    settings: &Settings,
    eye: DVec3,
    orientation: DQuat,
) -> Result<Vec<Picture>, ExperimentError> {
    let mut pictures = Vec::new();
    for (tint, name) in [(Tint::Objects, "objects"), (Tint::Cells, "cells-seen")] {
        world.tint = tint;
        let faces = Faces::of(&shown(&world, settings, 0..1, &|_| eye)?)?;
        let seen = Views { faces: &faces, orientation }.seen(Lens::Flat)?;
        pictures.push(Picture::Pixels(name.to_owned(), seen));
    }
    Ok(pictures)
}

/// What tears are seen against.
const WHITE: u32 = 0x00FF_FFFF;

/// Frames that are tried: every so many.
const EVERY: u64 = 29;

/// Of the frames that are tried, each seen towards its widest tear in something upright, the one that shows most white.
fn gaping(world: &World, torn: &Settings, eye: &impl Fn(u64) -> DVec3) -> Result<(u64, DQuat), ExperimentError> {
    let mut simulation = Simulation::new(world, torn)?;
    let mut best = (0, DQuat::IDENTITY, 0);
    for frame in 0..FRAMES {
        let outcome = simulation.frame(eye(frame))?;
        if frame % EVERY != 0 {
            continue;
        }
        let Some(vertex) = widest_upright(world, &simulation) else { continue };
        let orientation = looking_at(outcome.eye, vertex.with_y(outcome.eye.y));
        let faces = Faces::of(&simulation)?;
        let seen = Views { faces: &faces, orientation }.seen(Lens::Flat)?;
        // A pixel of the gap is mixed with its neighbours: nothing else in the gallery is as bright.
        let white = seen.pixels().filter(|pixel| pixel.0.iter().all(|part| *part > 238)).count();
        if white > best.2 {
            best = (frame, orientation, white);
        }
    }
    Ok((best.0, best.1))
}

/// The place of the widest tear of what is not the floor or the ceiling.
fn widest_upright(world: &World, simulation: &Simulation<'_>) -> Option<DVec3> {
    let is_upright =
        |segment: usize| !["floor", "ceiling"].contains(&world.objects[world.segments[segment].object].name.as_str());
    let upright = world.shared.iter().filter(|shared| shared.segments.iter().all(|segment| is_upright(*segment)));
    let upright = World { shared: upright.cloned().collect(), ..world.clone() };
    let (_, vertex) = Tears::of(&upright, simulation.shown()).widest?;
    Some(world.vertices[vertex as usize])
}

/// The same frame torn and warped, cleared to white, and the difference.
fn gaps(
    world: &World,
    torn: &Settings,
    frame: u64,
    eye: &impl Fn(u64) -> DVec3,
    orientation: DQuat,
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

/// A walk through some frames.
fn shown<'a>(
    world: &'a World,
    settings: &Settings,
    frames: std::ops::Range<u64>,
    eye: &impl Fn(u64) -> DVec3,
) -> Result<Simulation<'a>, ExperimentError> {
    let mut simulation = Simulation::new(world, settings)?;
    for frame in frames {
        simulation.frame(eye(frame))?;
    }
    Ok(simulation)
}
