use pphigs::{FrameView, MemoryPart, Picture, RegionBinning, Shading, Share, TransformCost, TriangleEndsRecorder};
use pxpl5_geometry::Viewport;
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_renderer::Layout;
use pxpl5_sim::Span;

/// The work of TRANSFORM for the whole display list, for one view or for each of two views.
///
/// The result has no bins. A later search finds the primitives in a strip or block.
pub(crate) struct WholeList<'a> {
    pub(crate) share: &'a Share,
    pub(crate) pass: TransformCost,
    pub(crate) views: &'a [FrameView],
    pub(crate) viewport: Viewport,
    pub(crate) layout: Layout,
    /// Part of memory for the result: commands for one view, or corners of triangles for two views.
    pub(crate) part: MemoryPart,
}

impl Work for WholeList<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        self.pass.span(timing) * self.views.len() as u64
    }

    /// Executes i860 code that stores commands with bounding boxes (one view) or the corners of triangles (two views).
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

/// Returns the settings for i860 code that fills no bins. A later search finds the primitives of each region instead.
pub(crate) const fn picture(viewport: Viewport, layout: Layout) -> Picture {
    Picture { viewport, shading: Shading::Gouraud, binning: RegionBinning::All, layout, pixels: false }
}
