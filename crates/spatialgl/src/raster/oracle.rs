//! The reference rasterizer. This rasterizer is slow and obvious: it processes one primitive, one pixel and one test at
//! a time.

use super::assemble::SliceTransform;
use super::connected;
use super::setup::{Corner, Setup, channel, weighted};
use super::{Coverage, SliceRenderer, SliceStats, SliceWork};
use crate::command::Combine;
use crate::image::SliceImage;
use crate::slice_volume::SampleTest;
use crate::view::SliceView;

/// The reference model, without optimizations. The reference model defines the voxels that every other renderer must
/// draw.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReferenceRenderer;

impl SliceRenderer for ReferenceRenderer {
    fn render(&self, work: SliceWork<'_>, view: &SliceView, image: &mut SliceImage) -> SliceStats {
        let transform = SliceTransform::new(view);
        let mut stats = SliceStats::default();
        for pass in 0..view.volume.passes() {
            let test = view.volume.test(pass);
            for primitive in work.bin.primitives().iter().map(|i| &work.commands.primitives[*i as usize]) {
                stats.draws += 1;
                transform.triangles(work.commands, primitive, &mut |corners| {
                    draw(corners, test, primitive.combine, view, image, &mut stats);
                });
            }
        }
        // The connecting lines come last, because they fill only pixels on which no fragment was drawn.
        if work.coverage == Coverage::Connected {
            stats.added = connected::draw(work, &transform, image);
        }
        stats
    }
}

fn draw(
    corners: &[Corner; 3],
    test: SampleTest,
    combine: Combine,
    view: &SliceView,
    image: &mut SliceImage,
    stats: &mut SliceStats,
) {
    let Some(setup) = Setup::new(corners, image.size()) else { return };
    let clips_first = view.volume.clips_before_fragments();
    for y in setup.bounds.y[0]..setup.bounds.y[1] {
        for x in setup.bounds.x[0]..setup.bounds.x[1] {
            // Test the pixel centre against edges and planes, then against the slice's volume.
            let Some(weights) = setup.weights(f64::from(x) + 0.5, f64::from(y) + 0.5) else { continue };
            let sum = weights[0] + weights[1] + weights[2];
            let is_accepted = test.accepts(weighted(weights, setup.p), weighted(weights, setup.q), sum);
            stats.generated += u64::from(is_accepted || !clips_first);
            if is_accepted {
                stats.accepted += 1;
                let colour = setup.colour.map(|values| channel(weights, values, 1.0 / sum));
                // Views that hide surfaces also need the depth test.
                let is_seen = !view.hides || image.is_nearest(x, y, weighted(weights, setup.near) / sum);
                if is_seen {
                    image.put(x, y, colour, combine);
                }
            }
        }
    }
}

impl Setup {
    /// Returns the weights of the corners at a sample. Returns `None` if the sample is outside the triangle, or not
    /// between the near and far planes.
    fn weights(&self, x: f64, y: f64) -> Option<[f64; 3]> {
        let weights = self.edges.map(|edge| edge.a * (x - edge.x) + edge.row(y));
        let is_inside = (0..3).all(|i| weights[i] >= self.least[i]);
        let is_between = weighted(weights, self.near) >= 0.0 && weighted(weights, self.far) >= 0.0;
        (is_inside && is_between).then_some(weights)
    }
}
