//! TRANSFORM of the whole display list as work of a board.

use pphigs::{FrameView, MemoryPart, Picture, RegionBinning, Shading, Share, TransformCost, TriangleEndsRecorder};
use pxpl5_geometry::Viewport;
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_renderer::Layout;
use pxpl5_sim::Span;

/// Work of a pass over all primitives for each of one or two views.
///
/// The pass makes the commands of all primitives without bins. The primitives of a strip or block are searched later.
pub(crate) struct WholeList<'a> {
    /// The whole display list.
    pub(crate) share: &'a Share,
    /// Cost of a pass by the timing table.
    pub(crate) pass: TransformCost,
    /// One view, or the views of start and end.
    pub(crate) views: &'a [FrameView],
    /// Field or frame that the views show.
    pub(crate) viewport: Viewport,
    /// Layout of pixel memory for which commands are encoded.
    pub(crate) layout: Layout,
    /// Part of memory that receives the commands of one view, or the triangles' positions in two views.
    pub(crate) part: MemoryPart,
}

impl Work for WholeList<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        self.pass.span(timing) * self.views.len() as u64
    }

    /// Runs the code. For one view it keeps commands with their boxes, for two views the positions of triangles in
    /// both.
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

/// Returns the picture that selects the kernels: one without bins, since regions are searched later.
pub(crate) const fn picture(viewport: Viewport, layout: Layout) -> Picture {
    Picture { viewport, shading: Shading::Gouraud, binning: RegionBinning::All, layout, pixels: false }
}
