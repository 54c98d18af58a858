//! The fast rasterizer for the host. This rasterizer rejects whole triangles by their distance from the slice, and
//! draws eight pixels at a time.

use super::assemble::SliceTransform;
use super::connected;
use super::lanes::{self, Fragments, Mode};
use super::setup::{Corner, Setup, along, bounds};
use super::{Coverage, SliceRenderer, SliceStats, SliceWork};
use crate::command::{CommandBuffer, Shape};
use crate::image::SliceImage;
use crate::view::SliceView;
use multiversion::multiversion;

/// A fast renderer on one thread, with the same voxels and counts as [`ReferenceRenderer`](super::ReferenceRenderer).
///
/// The loops are compiled once for each vector unit (see [`mod@multiversion`]), all from the same code and with the
/// same results.
#[derive(Clone, Copy, Debug, Default)]
pub struct HostRenderer;

impl SliceRenderer for HostRenderer {
    fn render(&self, work: SliceWork<'_>, view: &SliceView, image: &mut SliceImage) -> SliceStats {
        let transform = SliceTransform::new(view);
        let mut stats = SliceStats::default();
        for pass in 0..view.volume.passes() {
            render_pass(work, view, &transform, pass, image, &mut stats);
        }
        if work.coverage == Coverage::Connected {
            stats.added = connected::draw(work, &transform, image);
        }
        stats
    }
}

impl SliceStats {
    #[inline(always)]
    const fn add(&mut self, fragments: Fragments) {
        self.generated += fragments.generated;
        self.accepted += fragments.accepted;
    }
}

#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn render_pass(
    work: SliceWork<'_>,
    view: &SliceView,
    transform: &SliceTransform,
    pass: u32,
    image: &mut SliceImage,
    stats: &mut SliceStats,
) {
    let size = image.size();
    let test = view.volume.test(pass);
    let clips_first = view.volume.clips_before_fragments();
    let [low, high] = view.reach.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let positions = &work.commands.positions;
    stats.draws += work.bin.primitives().len() as u64;
    // Clusters and triangles away from the slice are rejected before their set-up.
    for cluster in work.bin.clusters() {
        for primitive in cluster.reaching(&transform.rows[2], [low, high]) {
            let primitive = &work.commands.primitives[primitive as usize];
            let mode = Mode { test, combine: primitive.combine, clips_first, hides: view.hides };
            if primitive.shape == Shape::Triangle {
                let [a, b, c] = primitive.vertices;
                let corners = [&positions[a as usize], &positions[b as usize], &positions[c as usize]];
                if is_off_slice(&transform.rows[2], corners, low, high) {
                    continue;
                }
                if let Some(setup) = triangle(transform, corners, primitive.vertices, work.commands, size) {
                    stats.add(lanes::draw(&setup, mode, image));
                }
                continue;
            }
            transform.triangles(work.commands, primitive, &mut |corners| {
                if let Some(setup) = Setup::new(corners, size) {
                    stats.add(lanes::draw(&setup, mode, image));
                }
            });
        }
    }
}

/// Prepares and draws a triangle. The attributes of its corners are read only if a part of the triangle is visible.
#[inline(always)]
fn triangle(
    transform: &SliceTransform,
    [a, b, c]: [&[f64; 3]; 3],
    vertices: [u32; 3],
    commands: &CommandBuffer,
    size: [u32; 2],
) -> Option<Setup> {
    let local = [transform.local(*a), transform.local(*b), transform.local(*c)];
    let places = [transform.place(local[0]), transform.place(local[1]), transform.place(local[2])];
    // Most triangles are invisible and need no further work.
    let bounds = bounds([&places[0], &places[1], &places[2]], size)?;
    let corner = |i: usize, world: &[f64; 3]| {
        let [p, q] = transform.volume.attributes(*world, local[i][0], local[i][2]);
        Corner { place: places[i], p, q, colour: commands.colours[vertices[i] as usize] }
    };
    Setup::within(&[corner(0, a), corner(1, b), corner(2, c)], bounds)
}

/// Returns true if the distances of all corners from the slice are below `low`, or if all are above `high`. The slice
/// shows only distances between `low` and `high`.
#[inline(always)]
fn is_off_slice(row: &[f64; 4], corners: [&[f64; 3]; 3], low: f64, high: f64) -> bool {
    let a = along(row, *corners[0]);
    let b = along(row, *corners[1]);
    let c = along(row, *corners[2]);
    (a.min(b).min(c) > high) | (a.max(b).max(c) < low)
}
