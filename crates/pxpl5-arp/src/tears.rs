//! Tears: gaps in the view between memories that were drawn from different positions.

use crate::content::{Content, angle};
use crate::world::World;
use serde::Serialize;

/// Angles of the tears (gaps between memories) at vertices that several memories share, in one frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tears {
    /// Angles of all tears without warping, in radians. A tear's angle lies between the two directions in which two
    /// memories draw a shared vertex.
    pub before: Vec<f64>,
    /// Angles of all tears in the displayed picture, in radians. A tear's angle lies between the two directions in
    /// which two memories draw a shared vertex.
    pub after: Vec<f64>,
    /// Angles by which warping moves the vertices of a memory, in radians. Each vertex has one angle.
    pub stretch: Vec<f64>,
    /// Width in radians of the widest displayed tear, and its vertex as an index into [`World::vertices`].
    pub widest: Option<(f64, u32)>,
}

/// Returns for each segment (part of an object) the index of the memory that shows the segment, or `None`.
fn holders(world: &World, shown: &[Option<Content>]) -> Vec<Option<usize>> {
    let mut holders = vec![None; world.segments.len()];
    for (memory, content) in shown.iter().enumerate() {
        for segment in content.iter().flat_map(|content| &content.segments) {
            holders[*segment] = Some(memory);
        }
    }
    holders
}

impl Tears {
    pub fn of(world: &World, shown: &[Option<Content>]) -> Self {
        let holders = holders(world, shown);
        let mut tears = Self::default();
        // Compare neighbouring memories at each shared vertex.
        for shared in &world.shared {
            let mut memories: Vec<usize> = shared.segments.iter().filter_map(|segment| holders[*segment]).collect();
            memories.sort_unstable();
            memories.dedup();
            let vertex = world.vertices[shared.vertex as usize];
            for pair in memories.windows(2) {
                let [Some(fast), Some(slow)] = [&shown[pair[0]], &shown[pair[1]]] else { continue };
                tears.before.push(angle(vertex - fast.eye, vertex - slow.eye));
                let gap = angle(fast.direction(vertex), slow.direction(vertex));
                tears.after.push(gap);
                if tears.widest.is_none_or(|(widest, _)| gap > widest) {
                    tears.widest = Some((gap, shared.vertex));
                }
            }
        }
        // Measure the displacement of warped vertices.
        for content in shown.iter().flatten().filter(|content| content.warp.is_some()) {
            let vertices =
                content.segments.iter().flat_map(|segment| world.segments[*segment].triangles.iter().flatten());
            let places = vertices.map(|vertex| world.vertices[*vertex as usize]);
            tears.stretch.extend(places.map(|place| angle(place - content.eye, content.direction(place))));
        }
        tears
    }
}

/// Percentiles of angles, in texels (90 degrees divided by the texels of a face's edge).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TearWidths {
    pub p50: f64,
    pub p95: f64,
    pub max: f64,
}

impl TearWidths {
    /// Computes the percentiles of angles in radians. A texel has `texel_deg` degrees. Returns `None` without angles.
    pub fn of(angles: &[f64], texel_deg: f64) -> Option<Self> {
        let mut sorted = angles.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let last = sorted.len().checked_sub(1)?;
        let at = |share: f64| sorted[(share * last as f64).round() as usize].to_degrees() / texel_deg;
        Some(Self { p50: at(0.5), p95: at(0.95), max: at(1.0) })
    }
}
