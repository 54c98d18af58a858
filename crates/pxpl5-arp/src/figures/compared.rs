//! Comparisons of pictures that must be bit-identical.

use crate::settings::{SourceKind, WalkSettings};
use crate::simulation::Simulation;
use crate::walk_faces::WalkFaces;
use crate::world::World;
use address_recalculation::{CubeFace, FaceSet, TexelAddress};
use glam::{DQuat, DVec3};
use pxpl5_sim::parameters::SettingError;

const TEXELS: u32 = 128;

fn small(settings: &WalkSettings) -> WalkSettings {
    let mut settings = settings.clone();
    settings.display.timing.face_texels = u64::from(TEXELS);
    settings
}

/// Counts the texels in which the combined picture of all memories differs from the picture of a single memory.
///
/// All memories are drawn at once from one position. The single memory draws the same parts of objects (segments), in
/// the order of the memories.
pub(super) fn composite_differs(world: &World, settings: &WalkSettings, eye: DVec3) -> Result<u64, SettingError> {
    let settings = small(settings);
    // Draw all memories from one position.
    let mut simulation = Simulation::new(world, &settings)?;
    simulation.frame(eye)?;
    let faces = WalkFaces::of(&simulation)?;
    // Draw the same segments in the same order into one memory.
    let in_order: Vec<usize> = simulation.shown.iter().flatten().flat_map(|content| content.segments.clone()).collect();
    let mut one = FaceSet::new(TEXELS, settings.display.format());
    settings.view()?.draw(eye, world.triangles(&in_order, |vertex| vertex), &mut one);
    let all = CubeFace::ALL
        .into_iter()
        .flat_map(|face| (0..TEXELS * TEXELS).map(move |k| TexelAddress { face, column: k % TEXELS, row: k / TEXELS }));
    let composed = |texel| {
        let shown = faces.memories.iter().filter_map(|memory| memory.texel(texel));
        shown.min_by_key(|(_, depth)| *depth)
    };
    Ok(all.filter(|texel| composed(*texel) != one.texel(*texel)).count() as u64)
}

/// Number of simulated frames. In this time, even the very slow renderer draws all memories once.
const FRAMES: u64 = 200;
/// Triangles that the very slow (stalled) renderer draws per second.
const STALLED_TRIANGLES_PER_S: f64 = 700.0;

/// Counts the pixels that differ between the pictures of an ideal renderer and of a very slow renderer, while a head at
/// a fixed position rotates.
pub(super) fn turned_differ(world: &World, settings: &WalkSettings, eye: DVec3) -> Result<u64, SettingError> {
    // Simulate both renderers with the eye at rest until the slow one has drawn all memories.
    let ideal = small(settings);
    let source = SourceKind::Timed { triangles_per_s: STALLED_TRIANGLES_PER_S };
    let stalled = WalkSettings { source, ..ideal.clone() };
    let mut seen = Vec::new();
    for settings in [ideal, stalled] {
        let mut simulation = Simulation::new(world, &settings)?;
        for _ in 0..FRAMES {
            simulation.frame(eye)?;
        }
        seen.push(WalkFaces::of(&simulation)?);
    }
    // Rotate the head and compare the pictures.
    let mut differ = 0;
    for degrees in [12.0_f64, 90.0, 180.0] {
        let turned = DQuat::from_rotation_y(degrees.to_radians());
        let [first, second] = [seen[0].seen(turned)?.0, seen[1].seen(turned)?.0];
        differ += first.pixels().zip(second.pixels()).filter(|(a, b)| a != b).count() as u64;
    }
    Ok(differ)
}
