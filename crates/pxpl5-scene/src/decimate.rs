//! Decimation, which reduces the number of primitives and keeps the shape.
//!
//! The algorithm collapses edges, the cheapest first by the quadric error metric (Garland and Heckbert, SIGGRAPH 97).
//! Each edge collapses onto one of its ends, so every remaining vertex keeps its position, normal and colour. A closed
//! surface stays closed.
//!
//! When no edge can be collapsed, whole connected pieces are removed, the smallest first. When one piece is left, its
//! smallest triangles are removed. Spheres have no edges. Some spheres are removed, spread evenly over the list of
//! spheres.

mod collapse;
mod quadric;
mod surface;

use pxpl5_sim::parameters::SettingError;
use std::fmt;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

use collapse::FirstPass;
use surface::Surface;

use crate::scene::{Scene, SceneParts, Structure};

impl Scene {
    /// Returns this scene, reduced to at most `n` primitives. The result has as many primitives up to `n` as the
    /// surfaces allow. A closed surface has an even number of triangles, so the result can have one primitive less than
    /// an odd `n`. The ratio of spheres to triangles stays the same.
    ///
    /// Structures without primitives are removed together with their edits. The same scene and number give the same
    /// result on every computer.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if `n` is zero or exceeds the number of primitives.
    pub fn decimated(&self, n: usize) -> Result<Self, SettingError> {
        decimated(self, n, |wanted| FirstPass::new(Surface::new(self)).end(wanted))
    }
}

/// Decimation of one scene to several numbers of primitives. Each result equals the result of [`Scene::decimated`].
///
/// Edges collapse in the same order for every number of primitives. Each call therefore stores intermediate surfaces,
/// from which a later call for fewer primitives can start.
pub struct Decimation {
    scene: Arc<Scene>,
    passed: Mutex<Vec<Arc<FirstPass>>>,
}

impl Decimation {
    /// Prepares the decimation of a scene.
    pub const fn new(scene: Arc<Scene>) -> Self {
        Self { scene, passed: Mutex::new(Vec::new()) }
    }

    /// Returns the same scene as [`Scene::decimated`].
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Scene::decimated`].
    pub fn decimated(&self, n: usize) -> Result<Scene, SettingError> {
        decimated(&self.scene, n, |wanted| self.surface(wanted))
    }

    fn surface(&self, wanted: usize) -> Surface {
        let nearest = self.nearest(wanted);
        let mut first = nearest.map_or_else(|| FirstPass::new(Surface::new(&self.scene)), Arc::unwrap_or_clone);
        let above = |n: usize| n + n / PASSED_ABOVE;
        // A bisection continues halfway between two numbers, or below the smaller number.
        for pause in [above(usize::midpoint(wanted, first.left())), above(wanted)] {
            if first.left() > above(pause) {
                first.until(pause, wanted);
                self.store(&first, wanted);
            }
        }
        first.end(wanted)
    }

    /// Returns the stored surface with the fewest triangles from which the decimation to `wanted` triangles can start.
    fn nearest(&self, wanted: usize) -> Option<Arc<FirstPass>> {
        let passed = self.passed.lock().unwrap_or_else(PoisonError::into_inner);
        passed.iter().filter(|passed| passed.serves(wanted)).min_by_key(|passed| passed.left()).cloned()
    }

    /// Stores an intermediate surface of the decimation to `wanted` triangles. A surface that was reached only for this
    /// number does not help with other numbers, so it is not stored.
    fn store(&self, first: &FirstPass, wanted: usize) {
        if !first.serves(wanted) {
            return;
        }
        let mut passed = self.passed.lock().unwrap_or_else(PoisonError::into_inner);
        passed.push(Arc::new(first.clone()));
        // A search continues near the last number.
        passed.sort_by_key(|passed| passed.left().abs_diff(wanted));
        passed.truncate(MAX_PASSED);
    }
}

impl fmt::Debug for Decimation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Decimation").field("scene", &self.scene.name()).finish_non_exhaustive()
    }
}

/// Divisor for the distance between a stored surface and the numbers that start from it: a surface of n + n / 32
/// triangles serves n triangles and slightly more.
const PASSED_ABOVE: usize = 32;

/// Maximum number of stored surfaces. A surface of the scene `head` takes about 12 MB.
const MAX_PASSED: usize = 6;

/// Returns a scene with at most `n` primitives. `reduce` receives a number of triangles, and returns the scene's
/// surface after edges have collapsed to about this number.
fn decimated(scene: &Scene, n: usize, reduce: impl FnOnce(usize) -> Surface) -> Result<Scene, SettingError> {
    let triangles = scene.triangles().len();
    let spheres = scene.spheres().len();
    let all = triangles + spheres;
    if n == 0 || n > all {
        let name = format!("scene {}", scene.name());
        return Err(SettingError::value(&name, format_args!("1 to {all} triangles to keep"), n));
    }
    if n == all {
        return Ok(scene.clone());
    }
    // Rounded to the nearest integer.
    let kept_spheres = (2 * n * spheres + all) / (2 * all);
    let wanted = n - kept_spheres;
    let mut surface = reduce(wanted);
    drop_pieces(&mut surface, wanted);
    drop_triangles(&mut surface, wanted);
    let kept = Kept {
        triangles: surface.triangles,
        spheres: (0..spheres).map(|sphere| is_kept(sphere, spheres, kept_spheres)).collect(),
    };
    Ok(Scene::new(kept.of(scene.clone().into_parts()))?.with_warnings(scene.warnings().to_vec()))
}

/// Returns true if the item `index` is chosen. Of `all` items, `kept` are chosen, spread evenly.
const fn is_kept(index: usize, all: usize, kept: usize) -> bool {
    index * kept / all != (index + 1) * kept / all
}

/// Removes whole connected pieces, the smallest first. The removal ends when `wanted` triangles or a single piece
/// remain.
fn drop_pieces(surface: &mut Surface, wanted: usize) {
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

fn drop_triangles(surface: &mut Surface, wanted: usize) {
    let left: Vec<u32> = surface.all().map(|(triangle, _)| triangle).collect();
    let areas: Vec<f64> = left.iter().map(|&triangle| area(surface, triangle)).collect();
    let excess = surface.left.saturating_sub(wanted);
    smallest_first(&areas).into_iter().take(excess).for_each(|index| remove(surface, left[index]));
}

/// Returns the indices of triangles by increasing area. Areas that agree to a thousandth count as equal. Triangles of
/// equal area are ordered by the reversed bits of their indices, which spreads the first triangles evenly over the
/// surface.
fn smallest_first(areas: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..areas.len()).collect();
    // The key is the exponent and ten bits of the fraction, followed by the bits of the index in reverse order.
    order.sort_by_key(|&index| (areas[index].to_bits() >> 42, index.reverse_bits()));
    order
}

fn area(surface: &Surface, triangle: u32) -> f64 {
    surface.points(triangle).map_or(0.0, |points| surface.normal(points).length() / 2.0)
}

fn remove(surface: &mut Surface, triangle: u32) {
    if let Some(points) = surface.points(triangle) {
        surface.remove(triangle, points);
    }
}

struct Kept {
    triangles: Vec<Option<[u32; 3]>>,
    spheres: Vec<bool>,
}

impl Kept {
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
