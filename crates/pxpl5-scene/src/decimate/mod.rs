//! Fewer primitives for the same shape.
//!
//! Edges are collapsed, the cheapest first by the quadric error metric (Garland and Heckbert, SIGGRAPH 97), each onto one of its
//! ends, so that every vertex that is left has the place, normal and colour that it had. A surface that was closed stays
//! closed. Where nothing can be collapsed any more, whole pieces go, the smallest first; where one piece is left, its smallest
//! triangles. Of spheres, which have no edges, some are left out, evenly over their order.

mod collapse;
mod quadric;
mod surface;

use std::ops::Range;

use collapse::{Collapsing, Rules};
use surface::Surface;

use crate::error::SceneError;
use crate::scene::{Scene, SceneParts, Structure};

impl Scene {
    /// The same scene with at most `n` primitives, and as many as its surfaces allow: a closed surface has an even number of
    /// triangles, so of an odd number one may be missing. Spheres and triangles are kept in the proportion that they have.
    ///
    /// Structures that hold nothing any more are left out, and so are their edits. The same scene and number give the same result
    /// on every host.
    ///
    /// # Errors
    ///
    /// [`SceneError::Kept`] when `n` is zero or more than there are.
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
        // Rounded to the nearest.
        let kept_spheres = (2 * n * spheres + all) / (2 * all);
        let kept = Kept {
            triangles: triangles_kept(self, n - kept_spheres),
            spheres: (0..spheres).map(|sphere| is_kept(sphere, spheres, kept_spheres)).collect(),
        };
        Ok(Self::new(kept.of(self.clone().into_parts()))?.with_warnings(self.warnings().to_vec()))
    }
}

/// Whether an item is among so many that are spread evenly over all.
const fn is_kept(index: usize, all: usize, kept: usize) -> bool {
    index * kept / all != (index + 1) * kept / all
}

/// The corners of the triangles that are left, at most `wanted`; nothing where one is gone.
fn triangles_kept(scene: &Scene, wanted: usize) -> Vec<Option<[u32; 3]>> {
    let mut surface = Surface::new(scene);
    let mut collapsing = Collapsing::new(&mut surface);
    let passes = [(false, false), (false, true), (true, true)];
    for (may_fold, may_overshoot) in passes {
        collapsing.until(wanted, Rules { may_fold, may_overshoot });
    }
    drop_pieces(&mut surface, wanted);
    drop_triangles(&mut surface, wanted);
    surface.triangles
}

/// Leaves out whole pieces, the smallest first, as long as there are others.
fn drop_pieces(surface: &mut Surface<'_>, wanted: usize) {
    if surface.left <= wanted {
        return;
    }
    let pieces = surface.pieces();
    let areas: Vec<f64> = pieces.iter().map(|piece| piece.iter().map(|&t| area(surface, t)).sum()).collect();
    let order = smallest_first(&areas);
    for index in order.into_iter().take(pieces.len() - 1) {
        if surface.left <= wanted {
            return;
        }
        pieces[index].iter().for_each(|&triangle| remove(surface, triangle));
    }
}

/// Leaves out the smallest triangles: only where no edge can be collapsed and one piece is left.
fn drop_triangles(surface: &mut Surface<'_>, wanted: usize) {
    let left: Vec<u32> = surface.all().map(|(triangle, _)| triangle).collect();
    let areas: Vec<f64> = left.iter().map(|&triangle| area(surface, triangle)).collect();
    let excess = surface.left.saturating_sub(wanted);
    smallest_first(&areas).into_iter().take(excess).for_each(|index| remove(surface, left[index]));
}

/// Indices by size; equal sizes, to a thousandth, in an order that takes from everywhere alike.
fn smallest_first(areas: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..areas.len()).collect();
    // The exponent and ten bits of the fraction; then the bits of the index from behind.
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

/// Which primitives are left.
struct Kept {
    triangles: Vec<Option<[u32; 3]>>,
    spheres: Vec<bool>,
}

impl Kept {
    /// The parts of a scene without what is gone: primitives, vertices that none uses, structures without any.
    fn of(self, mut parts: SceneParts) -> SceneParts {
        let mut used = vec![false; parts.vertices.len()];
        self.triangles.iter().flatten().flatten().for_each(|&corner| used[corner as usize] = true);
        let present: Vec<bool> = self.triangles.iter().map(Option::is_some).collect();
        let vertices = counts_before(&used);
        let triangles = counts_before(&present);
        let spheres = counts_before(&self.spheres);
        for structure in &mut parts.structures {
            structure.vertices = moved(&structure.vertices, &vertices);
            structure.triangles = moved(&structure.triangles, &triangles);
            structure.spheres = moved(&structure.spheres, &spheres);
        }
        parts.structures.retain(|s: &Structure| !s.triangles.is_empty() || !s.spheres.is_empty());
        let corner = |corner: u32| vertices[corner as usize] as u32;
        parts.triangles = self.triangles.iter().flatten().map(|corners| corners.map(corner)).collect();
        parts.vertices = only(&parts.vertices, &used);
        parts.spheres = only(&parts.spheres, &self.spheres);
        parts
    }
}

/// How many are kept before each item, and in all.
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
