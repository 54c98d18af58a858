//! Pictures of a viewer's walk: unfolded cube faces, views, the memory shown at each pixel, tears (gaps between
//! memories) and errors. Drawings show the cells from above and the updates.

mod faces;
mod plan;
mod views;
mod wires;

pub use faces::cross;
pub use plan::{cells_svg, updates_svg};
pub(crate) use views::without_lens;
pub use views::{MemoryViews, difference};
pub use wires::cuts_svg;

use crate::figures::{Experiments, gallery, looking_at};
use crate::settings::{PolicyKind, WalkSettings};
use crate::simulation::Simulation;
use crate::tears::Tears;
use crate::walk::{at_frames, walk};
use crate::walk_faces::WalkFaces;
use crate::world::{Tint, World};
use address_recalculation::Lens;
use address_recalculation::priority::Falloff;
use glam::{DQuat, DVec3};
use image::RgbImage;
use pxpl5_sim::parameters::SettingError;
use tracking::motion::Walk;

/// A picture, and the name of its file without extension.
#[derive(Clone, Debug)]
pub enum ArpPicture {
    /// Pixels, written as PNG.
    Pixels(String, RgbImage),
    /// A drawing, written as SVG.
    Drawing(String, String),
}

const FRAMES: u64 = 1_800;

/// Name of each experiment, the figures of the papers that the experiment redraws, and the names of the project's
/// pictures.
pub const OF_FIGURES: [(&str, &str, &[&str]); 3] = [
    ("E2", "2, 12 and 14", &["faces-0", "faces-1", "faces-2", "faces-3", "faces-whole", "memories"]),
    ("E7", "13 and 15 to 17", &["tears", "unsegmented", "warped", "difference"]),
    ("E10", "5, 6 and 8 to 11", &["cells", "eye-flat", "objects", "cells-seen", "cuts"]),
];

/// Returns all pictures of the walk with tears (gaps between memories) and of the walk with warping.
///
/// The chosen frame and direction show a tear that uncovers much of the scene behind it.
///
/// # Errors
///
/// Returns a [`SettingError`] if a lens, scene or number is invalid. The built-in lenses, scenes and numbers are valid.
pub fn all(experiments: &Experiments) -> Result<Vec<ArpPicture>, SettingError> {
    let (scene, path) = gallery()?;
    let world = World::new(&scene, experiments.fits[0].cell_m)?;
    let mut torn = WalkSettings::CELLS.with_cells(experiments.fits[0].cell_m);
    // The lens is visible only in the picture `eye`.
    torn.display.lens = Lens::Radial { k1: 0.32, k2: 0.0 };
    of_walk(world, &path, &torn, 1.0, FRAMES)
}

/// Returns all pictures of a walk at a speed of `m_per_s`.
///
/// The picture `eye` is the view through the display's lens. `eye-flat` and `cuts` show the view without a lens, and
/// are omitted if the view is too wide for a plane. All other pictures are drawn without lens distortion, unless the
/// view is too wide for a plane.
///
/// The chosen frame and direction uncover most of the scene behind the widest tear. If no object is cut between two
/// memories, the view is along the path at the end of the walk.
///
/// # Errors
///
/// Returns a [`SettingError`] if settings are invalid, or if the settings have other cells than the world.
pub fn of_walk(
    mut world: World,
    path: &Walk,
    settings: &WalkSettings,
    m_per_s: f64,
    frames: u64,
) -> Result<Vec<ArpPicture>, SettingError> {
    let eye = at_frames(path, m_per_s, settings.numbers.frame_hz);
    // Choose the frame and the direction of view.
    let is_cut = settings.policy == PolicyKind::Cells && settings.is_segmented;
    let mut gaped = Vec::new();
    let last = (frames - 1, ahead(path, m_per_s * (frames - 1) as f64 / settings.numbers.frame_hz));
    let (frame, orientation) = if is_cut {
        let torn = WalkSettings { falloff: Falloff::None, has_cascade: false, ..settings.clone() };
        let background = std::mem::replace(&mut world.background, WHITE);
        let found = best_tear_view(&world, &torn, &eye, frames)?.unwrap_or(last);
        gaped = gaps(&world, &torn, found.0, &eye, found.1)?;
        world.background = background;
        found
    } else {
        last
    };
    // Walk to this frame with the real settings, and draw it.
    let simulation = shown(&world, settings, 0..frame + 1, &eye)?;
    let mut pictures = seen(&simulation, orientation, eye(frame))?;
    let side = settings.numbers.cell_m;
    let screen = settings.display.picture();
    pictures.push(ArpPicture::Drawing("cells".to_owned(), cells_svg(&world, &simulation, path, eye(frame))));
    if Lens::Flat.check(&screen).is_ok() {
        pictures.push(ArpPicture::Drawing("cuts".to_owned(), cuts_svg(&world, side, eye(frame), orientation, &screen)));
    }
    // Draw the updates around this frame.
    let tally = walk(&world, settings, frame + 60, &eye)?;
    pictures.push(ArpPicture::Drawing("updates".to_owned(), updates_svg(&tally, frame.saturating_sub(60)..frame + 60)));
    pictures.extend(gaped);
    pictures.extend(tinted(world, settings, eye(frame), orientation)?);
    Ok(pictures)
}

/// Distance along the path from the eye to the point at which the eye looks, in metres. The distance is the same as in
/// [`Walk`].
const AHEAD_M: f64 = 1.5;

/// Returns the orientation of a head that looks along the path. The head is `way_m` metres from the start of the path.
pub(crate) fn ahead(path: &Walk, way_m: f64) -> DQuat {
    looking_at(path.place(way_m), path.place(way_m + AHEAD_M))
}

/// Returns pictures of one frame: cube faces, views, the memory shown at each pixel, and errors.
///
/// The faces include the faces of a reference memory, which holds the whole scene. Views are drawn with and without the
/// lens.
fn seen(simulation: &Simulation<'_>, orientation: DQuat, eye: DVec3) -> Result<Vec<ArpPicture>, SettingError> {
    let faces = WalkFaces::of(simulation)?;
    let mut pictures: Vec<ArpPicture> = Vec::new();
    // Unfolded faces of each memory.
    for (memory, set) in faces.memories.iter().enumerate() {
        pictures.push(ArpPicture::Pixels(format!("faces-{memory}"), cross(set, faces.background)));
    }
    // Faces of a reference memory with the whole scene.
    let whole = WalkSettings { display: simulation.settings.display.clone(), ..WalkSettings::FULL }.with_memories(1);
    let whole = WalkFaces::of(&shown(simulation.world, &whole, 0..1, &|_| eye)?)?;
    pictures.push(ArpPicture::Pixels("faces-whole".to_owned(), cross(&whole.memories[0], faces.background)));
    // Views without a lens, then through the display's lens.
    let display = &simulation.settings.display;
    let views = MemoryViews { faces: &faces, orientation, lens: without_lens(display) };
    if views.lens == Lens::Flat {
        pictures.push(ArpPicture::Pixels("eye-flat".to_owned(), views.seen()?));
    }
    let through = MemoryViews { lens: display.lens.clone(), ..views.clone() };
    pictures.push(ArpPicture::Pixels("eye".to_owned(), through.seen()?));
    pictures.push(ArpPicture::Pixels("memories".to_owned(), views.memories()?));
    pictures.push(ArpPicture::Pixels("error".to_owned(), views.errors(simulation, eye)?));
    Ok(pictures)
}

/// Returns two views: one with a colour per object, and one with a colour per cell.
fn tinted(
    mut world: World,
    settings: &WalkSettings,
    eye: DVec3,
    orientation: DQuat,
) -> Result<Vec<ArpPicture>, SettingError> {
    let mut pictures = Vec::new();
    for (tint, name) in [(Tint::Objects, "objects"), (Tint::Cells, "cells-seen")] {
        world.tint = tint;
        let faces = WalkFaces::of(&shown(&world, settings, 0..1, &|_| eye)?)?;
        let seen = MemoryViews { faces: &faces, orientation, lens: without_lens(&settings.display) }.seen()?;
        pictures.push(ArpPicture::Pixels(name.to_owned(), seen));
    }
    Ok(pictures)
}

/// Background colour that is visible through tears (gaps between memories).
const WHITE: u32 = 0x00FF_FFFF;

/// Approximate limit of the number of frames that are examined for the best view of a tear (gap between two memories).
const TRIED: u64 = 63;
/// Smallest distance, in frames, between two frames that are examined for the best view of a tear. In a long walk, the
/// distance is larger, so that only about `TRIED` frames are examined.
const EVERY: u64 = 29;

/// Returns the frame and orientation at which a tear (gap between two memories) shows the largest number of background
/// pixels.
///
/// The view in each tried frame is towards the widest tear in an upright surface. Returns `None` if there is no tear.
fn best_tear_view(
    world: &World,
    torn: &WalkSettings,
    eye: &impl Fn(u64) -> DVec3,
    frames: u64,
) -> Result<Option<(u64, DQuat)>, SettingError> {
    let mut simulation = Simulation::new(world, torn)?;
    let mut best = (0, DQuat::IDENTITY, 0);
    for frame in 0..frames {
        let outcome = simulation.frame(eye(frame))?;
        // Evaluate only some frames, because drawing is slow.
        if frame % EVERY.max(frames / TRIED) != 0 {
            continue;
        }
        // Look horizontally towards the widest tear.
        let Some(vertex) = widest_upright(world, &simulation) else { continue };
        let orientation = looking_at(outcome.eye, vertex.with_y(outcome.eye.y));
        let faces = WalkFaces::of(&simulation)?;
        let seen = MemoryViews { faces: &faces, orientation, lens: without_lens(&torn.display) }.seen()?;
        // Antialiasing mixes the pixels of a gap with their neighbours. Nothing else in the gallery is as bright.
        let white = seen.pixels().filter(|pixel| pixel.0.iter().all(|part| *part > 238)).count();
        if white > best.2 {
            best = (frame, orientation, white);
        }
    }
    Ok((best.2 > 0).then_some((best.0, best.1)))
}

/// Returns the position of the widest tear (gap between two memories), except tears in the floor and the ceiling.
fn widest_upright(world: &World, simulation: &Simulation<'_>) -> Option<DVec3> {
    let is_upright =
        |segment: usize| !["floor", "ceiling"].contains(&world.objects[world.segments[segment].object].name.as_str());
    let upright = world.shared.iter().filter(|shared| shared.segments.iter().all(|segment| is_upright(*segment)));
    let upright = World { shared: upright.cloned().collect(), ..world.clone() };
    let (_, vertex) = Tears::of(&upright, &simulation.shown).widest?;
    Some(world.vertices[vertex as usize])
}

/// Returns views of one frame against a white background: with tears (gaps between memories), warped, and without cuts.
/// A last picture is the difference of the first two pictures.
fn gaps(
    world: &World,
    torn: &WalkSettings,
    frame: u64,
    eye: &impl Fn(u64) -> DVec3,
    orientation: DQuat,
) -> Result<Vec<ArpPicture>, SettingError> {
    let mut both = Vec::new();
    // Draw the frame with tears, with warped segments, and with uncut objects.
    for (falloff, is_segmented) in [(Falloff::None, true), (Falloff::Linear, true), (Falloff::None, false)] {
        let settings = WalkSettings { falloff, has_cascade: falloff != Falloff::None, is_segmented, ..torn.clone() };
        let simulation = shown(world, &settings, 0..frame + 1, eye)?;
        let faces = WalkFaces::of(&simulation)?;
        both.push(MemoryViews { faces: &faces, orientation, lens: without_lens(&torn.display) }.seen()?);
    }
    let mut pictures = vec![ArpPicture::Pixels("difference".to_owned(), difference(&both[0], &both[1]))];
    let names = ["tears", "warped", "unsegmented"].map(str::to_owned);
    pictures.extend(names.into_iter().zip(both).map(|(name, picture)| ArpPicture::Pixels(name, picture)));
    Ok(pictures)
}

/// Simulates a walk over a range of frames. Returns the simulation after the last of these frames.
fn shown<'a>(
    world: &'a World,
    settings: &WalkSettings,
    frames: std::ops::Range<u64>,
    eye: &impl Fn(u64) -> DVec3,
) -> Result<Simulation<'a>, SettingError> {
    let mut simulation = Simulation::new(world, settings)?;
    for frame in frames {
        simulation.frame(eye(frame))?;
    }
    Ok(simulation)
}
