//! CPU work of a TRANSFORM of the whole display list.

use pphigs::{FrameView, MemoryPart, Picture, RegionBinning, Shading, Share, TransformCost, TriangleEndsRecorder};
use pxpl5_geometry::Viewport;
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_renderer::Layout;
use pxpl5_sim::Span;

/// Work of a pass over all primitives, for one view or for each of two views.
///
/// The pass makes the commands of all primitives and fills no bins. A later search finds the primitives in a strip or
/// block.
pub(crate) struct WholeList<'a> {
    /// The whole display list.
    pub(crate) share: &'a Share,
    /// Work of one pass, for the timing table.
    pub(crate) pass: TransformCost,
    /// One view, or two views for the start and the end of a field.
    pub(crate) views: &'a [FrameView],
    /// Lines of the field or frame that the views show.
    pub(crate) viewport: Viewport,
    /// Layout of pixel memory, for which the commands are encoded.
    pub(crate) layout: Layout,
    /// Part of memory for the result: commands for one view, or positions of triangles for two views.
    pub(crate) part: MemoryPart,
}

impl Work for WholeList<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        self.pass.span(timing) * self.views.len() as u64
    }

    /// Runs the i860 code of the pass. For one view, the code stores commands with their bounding boxes. For two views,
    /// the code stores the positions of triangles in both views.
    fn by_code(&self, timing: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        let Self { share, part, .. } = *self;
        let picture = picture(self.viewport, self.layout);
        let kept = match self.views {
            [from, to] => {
                TriangleEndsRecorder { share, views: [from, to], picture, part }.run_code(timing, processor)?
            }
            views => views
                .iter()
                .try_fold(None, |_, view| self.share.transform(view, 0, picture).keep(timing, processor, part))?,
        };
        Ok(kept.unwrap_or_else(|| self.by_table(timing)))
    }

    fn vertex_transforms(&self) -> u64 {
        self.share.counts().vertices() * self.views.len() as u64
    }
}

/// Returns the picture parameters that select the kernels. The kernels fill no bins, because a later search finds the
/// primitives in the regions.
pub(crate) const fn picture(viewport: Viewport, layout: Layout) -> Picture {
    Picture { viewport, shading: Shading::Gouraud, binning: RegionBinning::All, layout, pixels: false }
}
