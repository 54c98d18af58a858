//! Decimation, which reduces the number of primitives of a scene and keeps the scene's shape.
//!
//! The algorithm collapses edges, the cheapest first by the quadric error metric (Garland and Heckbert, SIGGRAPH 97).
//! Each edge collapses onto one of its ends, so every remaining vertex keeps its position, normal and colour. A closed
//! surface stays closed.
//!
//! When no edge can be collapsed, whole connected pieces are removed, the smallest first. When one piece is left, its
//! smallest triangles are removed. Spheres have no edges. Some of them are removed, evenly over their order.

mod collapse;
mod quadric;
mod surface;

use std::ops::Range;

use collapse::{Decimator, Rules};
use surface::Surface;

use crate::error::SceneError;
use crate::scene::{Scene, SceneParts, Structure};

impl Scene {
    /// Returns a decimated copy of the scene with `n` primitives, or with fewer if the surfaces of the scene do not
    /// allow exactly `n`. A closed surface has an even number of triangles, so the result can have one primitive less
    /// than an odd `n`. The ratio of spheres to triangles stays the same.
    ///
    /// Structures without primitives are removed together with their edits. The same scene and number give the same
    /// result on every host.
    ///
    /// # Errors
    ///
    /// Returns [`SceneError::Kept`] if `n` is zero or exceeds the number of primitives.
    pub fn decimated(&self, n: usize) -> Result<Self, SceneError> {
        let triangles = self.triangles().len();
        let spheres = self.spheres().len();
        let all = triangles + spheres;
        if n == 0 || n > all {
            return Err(SceneError::Kept { scene: self.name().to_owned(), expected: all, found: n });
        }
        if n == all {
            return Ok(self.clone());
        }
        // Spheres keep their share of the primitives, rounded to the nearest integer.
        let kept_spheres = (2 * n * spheres + all) / (2 * all);
        let kept = Kept {
            triangles: triangles_kept(self, n - kept_spheres),
            spheres: (0..spheres).map(|sphere| is_kept(sphere, spheres, kept_spheres)).collect(),
        };
        Ok(Self::new(kept.of(self.clone().into_parts()))?.with_warnings(self.warnings().to_vec()))
    }
}

/// Returns true if the item with this index is kept, when `kept` of `all` items are kept. The kept items are spread
/// evenly.
const fn is_kept(index: usize, all: usize, kept: usize) -> bool {
    index * kept / all != (index + 1) * kept / all
}

/// Returns the vertices of each remaining triangle, or `None` for a removed triangle. At most `wanted` triangles
/// remain.
fn triangles_kept(scene: &Scene, wanted: usize) -> Vec<Option<[u32; 3]>> {
    let mut surface = Surface::new(scene);
    // Later passes have weaker rules. From the second pass on, too few triangles may remain. In the third pass,
    // triangles may also fold over.
    let mut collapsing = Decimator::new(&mut surface);
    let passes = [(false, false), (false, true), (true, true)];
    for (may_flip_triangles, may_overshoot) in passes {
        collapsing.until(wanted, Rules { may_flip_triangles, may_overshoot });
    }
    drop_pieces(&mut surface, wanted);
    drop_triangles(&mut surface, wanted);
    surface.triangles
}

/// Removes whole connected pieces, the smallest first, until at most `wanted` triangles or a single piece remain.
fn drop_pieces(surface: &mut Surface<'_>, wanted: usize) {
    if surface.left <= wanted {
        return;
    }
    let pieces = surface.pieces();
    let areas: Vec<f64> = pieces.iter().map(|piece| piece.iter().map(|&t| area(surface, t)).sum()).collect();
    let order = smallest_first(&areas);
    // The largest piece always stays.
    for index in order.into_iter().take(pieces.len() - 1) {
        if surface.left <= wanted {
            return;
        }
        pieces[index].iter().for_each(|&triangle| remove(surface, triangle));
    }
}

/// Removes the smallest triangles until `wanted` remain. This is the last resort, after all other passes.
fn drop_triangles(surface: &mut Surface<'_>, wanted: usize) {
    let left: Vec<u32> = surface.all().map(|(triangle, _)| triangle).collect();
    let areas: Vec<f64> = left.iter().map(|&triangle| area(surface, triangle)).collect();
    let excess = surface.left.saturating_sub(wanted);
    smallest_first(&areas).into_iter().take(excess).for_each(|index| remove(surface, left[index]));
}

/// Returns the indices of triangles by increasing area. Areas that agree to a thousandth count as equal. Triangles of
/// equal area are in an order that spreads evenly over the surface.
fn smallest_first(areas: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..areas.len()).collect();
    // The key is the exponent and ten bits of the fraction, followed by the bits of the index in reverse order.
    order.sort_by_key(|&index| (areas[index].to_bits() >> 42, index.reverse_bits()));
    order
}

fn area(surface: &Surface<'_>, triangle: u32) -> f64 {
    surface.points(triangle).map_or(0.0, |points| surface.normal(points).length() / 2.0)
}

fn remove(surface: &mut Surface<'_>, triangle: u32) {
    if let Some(points) = surface.points(triangle) {
        surface.remove(triangle, points);
    }
}

/// The triangles and spheres that remain after decimation.
struct Kept {
    triangles: Vec<Option<[u32; 3]>>,
    spheres: Vec<bool>,
}

impl Kept {
    /// Returns the parts of the scene that remain, without unused vertices and empty structures.
    fn of(self, mut parts: SceneParts) -> SceneParts {
        // Count how many items remain before each index: these are the new indices.
        let mut used = vec![false; parts.vertices.len()];
        self.triangles.iter().flatten().flatten().for_each(|&corner| used[corner as usize] = true);
        let present: Vec<bool> = self.triangles.iter().map(Option::is_some).collect();
        let vertices = counts_before(&used);
        let triangles = counts_before(&present);
        let spheres = counts_before(&self.spheres);
        // Renumber the ranges of the structures.
        for structure in &mut parts.structures {
            structure.vertices = moved(&structure.vertices, &vertices);
            structure.triangles = moved(&structure.triangles, &triangles);
            structure.spheres = moved(&structure.spheres, &spheres);
        }
        parts.structures.retain(|s: &Structure| !s.triangles.is_empty() || !s.spheres.is_empty());
        // Renumber the corners, and keep only what remains.
        let corner = |corner: u32| vertices[corner as usize] as u32;
        parts.triangles = self.triangles.iter().flatten().map(|corners| corners.map(corner)).collect();
        parts.vertices = only(&parts.vertices, &used);
        parts.spheres = only(&parts.spheres, &self.spheres);
        parts
    }
}

/// Returns the number of kept items before each index. The last element is the total.
fn counts_before(kept: &[bool]) -> Vec<usize> {
    let mut count = 0;
    let mut counts = vec![0];
    counts.extend(kept.iter().map(|&is_kept| {
        count += usize::from(is_kept);
        count
    }));
    counts
}

fn moved(range: &Range<usize>, counts: &[usize]) -> Range<usize> {
    counts[range.start]..counts[range.end]
}

fn only<T: Copy>(items: &[T], kept: &[bool]) -> Vec<T> {
    items.iter().zip(kept).filter(|(_, is_kept)| **is_kept).map(|(item, _)| *item).collect()
}
