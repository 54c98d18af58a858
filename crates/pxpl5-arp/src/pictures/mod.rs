//! What people look at: unfolded faces, the eye, which memory won, tears, errors, cells from above, updates.

mod colours;
mod faces;
mod plan;
mod views;
mod wires;

pub use faces::cross;
pub use plan::{cells_svg, updates_svg};
pub(crate) use views::without_lens;
pub use views::{Views, difference};
pub use wires::cuts_svg;

use crate::error::ExperimentError;
use crate::figures::{Experiments, gallery, looking_at};
use crate::look::Faces;
use crate::settings::{PolicyKind, Settings};
use crate::simulation::Simulation;
use crate::tears::Tears;
use crate::walk::{at_frames, walk};
use crate::world::{Tint, World};
use address_recalculation::Lens;
use glam::{DQuat, DVec3};
use image::RgbImage;
use priority_rendering::Falloff;
use tracking::motion::Walk;

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

/// Experiment, figures of the paper that it draws anew, and the names of the pictures that show them.
pub const OF_FIGURES: [(&str, &str, &[&str]); 3] = [
    ("E2", "2, 12 and 14", &["faces-0", "faces-1", "faces-2", "faces-3", "faces-whole", "memories"]),
    ("E7", "13 and 15 to 17", &["tears", "unsegmented", "warped", "difference"]),
    ("E10", "5, 6 and 8 to 11", &["cells", "eye-flat", "objects", "cells-seen", "cuts"]),
];

/// All pictures of the torn and the warped walk, at a frame and towards a vertex where much of what lies behind is seen through
/// the tear.
///
/// # Errors
///
/// [`ExperimentError`], where a lens, scene or number is none; those here are.
pub fn all(experiments: &Experiments) -> Result<Vec<Picture>, ExperimentError> {
    let (scene, path) = gallery()?;
    let world = World::new(&scene, experiments.fits[0].cell_m)?;
    let mut torn = Settings::CELLS.with_cells(experiments.fits[0].cell_m);
    // One of the pictures shows what a lens does.
    torn.display.lens = Lens::Radial { k1: 0.32, k2: 0.0 };
    of_walk(world, &path, &torn, 1.0, FRAMES)
}

/// All pictures of a walk at so many m/s. `eye` is seen through the display's lens; what shows it without a lens (`eye-flat` and `cuts`)
/// is left out where the picture is too wide for a plane. The others are flat where that is possible; at the frame and in the direction in which its widest tear would show most of what lies behind,
/// or, where nothing is cut between memories, at its end along the path.
///
/// # Errors
///
/// [`ExperimentError`] for settings that cannot be, or of another cut than the world's.
pub fn of_walk(
    mut world: World,
    path: &Walk,
    settings: &Settings,
    m_per_s: f64,
    frames: u64,
) -> Result<Vec<Picture>, ExperimentError> {
    let eye = at_frames(path, m_per_s, settings.numbers.frame_hz);
    let is_cut = settings.policy == PolicyKind::Cells && settings.is_segmented;
    let mut gaped = Vec::new();
    let last = (frames - 1, ahead(path, m_per_s * (frames - 1) as f64 / settings.numbers.frame_hz));
    let (frame, orientation) = if is_cut {
        let torn = Settings { falloff: Falloff::None, has_cascade: false, ..settings.clone() };
        let background = std::mem::replace(&mut world.background, WHITE);
        let found = gaping(&world, &torn, &eye, frames)?.unwrap_or(last);
        gaped = gaps(&world, &torn, found.0, &eye, found.1)?;
        world.background = background;
        found
    } else {
        last
    };
    let simulation = shown(&world, settings, 0..frame + 1, &eye)?;
    let mut pictures = seen(&simulation, orientation, eye(frame))?;
    let side = settings.numbers.cell_m;
    let screen = settings.display.picture();
    pictures.push(Picture::Drawing("cells".to_owned(), cells_svg(&world, &simulation, path, eye(frame))));
    if Lens::Flat.check(&screen).is_ok() {
        pictures.push(Picture::Drawing("cuts".to_owned(), cuts_svg(&world, side, eye(frame), orientation, &screen)));
    }
    let tally = walk(&world, settings, frame + 60, &eye)?;
    pictures.push(Picture::Drawing("updates".to_owned(), updates_svg(&tally, frame.saturating_sub(60)..frame + 60)));
    pictures.extend(gaped);
    pictures.extend(tinted(world, settings, eye(frame), orientation)?);
    Ok(pictures)
}

/// How far ahead on the path the eyes rest, m: as those of [`Walk`].
const AHEAD_M: f64 = 1.5;

/// A head that looks where its path leads, so many metres from the path's beginning.
pub(crate) fn ahead(path: &Walk, way_m: f64) -> DQuat {
    looking_at(path.place(way_m), path.place(way_m + AHEAD_M))
}

/// The faces of all memories and of one that has it all, the eye with and without a lens, which memory won, what is wrong.
fn seen(simulation: &Simulation<'_>, orientation: DQuat, eye: DVec3) -> Result<Vec<Picture>, ExperimentError> {
    let faces = Faces::of(simulation)?;
    let mut pictures: Vec<Picture> = Vec::new();
    for (memory, set) in faces.memories.iter().enumerate() {
        pictures.push(Picture::Pixels(format!("faces-{memory}"), cross(set, faces.background())));
    }
    let whole = Settings { display: simulation.settings().display.clone(), ..Settings::FULL }.with_memories(1);
    let whole = Faces::of(&shown(simulation.world(), &whole, 0..1, &|_| eye)?)?;
    pictures.push(Picture::Pixels("faces-whole".to_owned(), cross(&whole.memories[0], faces.background())));
    let display = &simulation.settings().display;
    let views = Views { faces: &faces, orientation, lens: without_lens(display) };
    if views.lens == Lens::Flat {
        pictures.push(Picture::Pixels("eye-flat".to_owned(), views.seen()?));
    }
    let through = Views { lens: display.lens.clone(), ..views.clone() };
    pictures.push(Picture::Pixels("eye".to_owned(), through.seen()?));
    pictures.push(Picture::Pixels("memories".to_owned(), views.memories()?));
    pictures.push(Picture::Pixels("error".to_owned(), views.errors(simulation, eye)?));
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
        let seen = Views { faces: &faces, orientation, lens: without_lens(&settings.display) }.seen()?;
        pictures.push(Picture::Pixels(name.to_owned(), seen));
    }
    Ok(pictures)
}

/// What tears are seen against.
const WHITE: u32 = 0x00FF_FFFF;

/// Frames that are tried at most, and the least number from one to the next.
const TRIED: u64 = 63;
const EVERY: u64 = 29;

/// Of the frames that are tried, each seen towards its widest tear in something upright, the one that shows most white; `None` where
/// nothing gapes.
fn gaping(
    world: &World,
    torn: &Settings,
    eye: &impl Fn(u64) -> DVec3,
    frames: u64,
) -> Result<Option<(u64, DQuat)>, ExperimentError> {
    let mut simulation = Simulation::new(world, torn)?;
    let mut best = (0, DQuat::IDENTITY, 0);
    for frame in 0..frames {
        let outcome = simulation.frame(eye(frame))?;
        if frame % EVERY.max(frames / TRIED) != 0 {
            continue;
        }
        let Some(vertex) = widest_upright(world, &simulation) else { continue };
        let orientation = looking_at(outcome.eye, vertex.with_y(outcome.eye.y));
        let faces = Faces::of(&simulation)?;
        let seen = Views { faces: &faces, orientation, lens: without_lens(&torn.display) }.seen()?;
        // A pixel of the gap is mixed with its neighbours: nothing else in the gallery is as bright.
        let white = seen.pixels().filter(|pixel| pixel.0.iter().all(|part| *part > 238)).count();
        if white > best.2 {
            best = (frame, orientation, white);
        }
    }
    Ok((best.2 > 0).then_some((best.0, best.1)))
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

/// The same frame torn, warped and without cuts, cleared to white, and the difference of the first two.
fn gaps(
    world: &World,
    torn: &Settings,
    frame: u64,
    eye: &impl Fn(u64) -> DVec3,
    orientation: DQuat,
) -> Result<Vec<Picture>, ExperimentError> {
    let mut both = Vec::new();
    for (falloff, is_segmented) in [(Falloff::None, true), (Falloff::Linear, true), (Falloff::None, false)] {
        let settings = Settings { falloff, has_cascade: falloff != Falloff::None, is_segmented, ..torn.clone() };
        let simulation = shown(world, &settings, 0..frame + 1, eye)?;
        let faces = Faces::of(&simulation)?;
        both.push(Views { faces: &faces, orientation, lens: without_lens(&torn.display) }.seen()?);
    }
    let mut pictures = vec![Picture::Pixels("difference".to_owned(), difference(&both[0], &both[1]))];
    let names = ["tears", "warped", "unsegmented"].map(str::to_owned);
    pictures.extend(names.into_iter().zip(both).map(|(name, picture)| Picture::Pixels(name, picture)));
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
