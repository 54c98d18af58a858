//! The fast rasteriser of the host: whole triangles rejected by their distance from the slice, eight pixels at a time.

use super::assemble::SliceTransform;
use super::connected;
use super::lanes::{self, Mode};
use super::setup::{Setup, along};
use super::{Coverage, SliceRenderer, SliceStats, SliceWork};
use crate::command::{Primitive, Shape};
use crate::image::SliceImage;
use crate::view::SliceView;
use multiversion::multiversion;

/// Draws what [`OracleRenderer`](super::OracleRenderer) draws, in every voxel and with the same counts, as fast as this
/// computer can with one thread.
///
/// The loops are compiled once for each vector unit (see [`mod@multiversion`]); there is nothing in which they could differ.
#[derive(Clone, Copy, Debug, Default)]
pub struct HostRenderer;

impl SliceRenderer for HostRenderer {
    fn render(&self, work: SliceWork<'_>, view: &SliceView, image: &mut SliceImage) -> SliceStats {
        let transform = SliceTransform::new(view);
        let mut stats = SliceStats::default();
        let distances = distances(&transform, &work.commands.positions);
        for pass in 0..view.volume.passes() {
            render_pass(work, view, &transform, &distances, pass, image, &mut stats);
        }
        if work.coverage == Coverage::Connected {
            stats.added = connected::draw(work, &transform, image);
        }
        stats
    }
}

#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn distances(transform: &SliceTransform, positions: &[[f64; 3]]) -> Vec<f64> {
    positions.iter().map(|position| along(&transform.rows[2], *position)).collect()
}

#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn render_pass(
    work: SliceWork<'_>,
    view: &SliceView,
    transform: &SliceTransform,
    distances: &[f64],
    pass: u32,
    image: &mut SliceImage,
    stats: &mut SliceStats,
) {
    let size = image.size();
    let test = view.volume.test(pass);
    let clips_first = view.volume.clips_before_fragments();
    let [low, high] = view.reach.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    stats.draws += work.bin.len() as u64;
    for i in work.bin {
        let primitive = &work.commands.primitives[*i as usize];
        if is_off_slice(primitive, distances, low, high) {
            continue;
        }
        let mode = Mode { test, combine: primitive.combine, clips_first, hides: view.hides };
        if primitive.shape == Shape::Triangle {
            let world = primitive.vertices.map(|i| work.commands.positions[i as usize]);
            let colour = primitive.vertices.map(|i| work.commands.colours[i as usize]);
            let corners = [0, 1, 2].map(|i| transform.corner(world[i], colour[i]));
            if let Some(setup) = Setup::new(&corners, size) {
                let fragments = lanes::draw(&setup, mode, image);
                stats.generated += fragments.generated;
                stats.accepted += fragments.accepted;
            }
            continue;
        }
        transform.triangles(work.commands, primitive, &mut |corners| {
            if let Some(setup) = Setup::new(corners, size) {
                let fragments = lanes::draw(&setup, mode, image);
                stats.generated += fragments.generated;
                stats.accepted += fragments.accepted;
            }
        });
    }
}

/// Whether all corners lie on one side of all that the slice can show.
#[inline(always)]
fn is_off_slice(primitive: &Primitive, distances: &[f64], low: f64, high: f64) -> bool {
    let [a, b, c] = primitive.vertices.map(|i| distances[i as usize]);
    (a > high && b > high && c > high) || (a < low && b < low && c < low)
}
