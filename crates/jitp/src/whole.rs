//! TRANSFORM of the whole display list as work of a board.

use pphigs::{FrameView, KeepingEnds, MemoryPart, Picture, RegionBinning, Shading, Share, TransformCost};
use pxpl5_geometry::Viewport;
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_renderer::Layout;
use pxpl5_sim::Span;

/// A pass over all primitives for each of some views: commands of all of them, since which strip or block they touch is found for that
/// strip or block alone.
pub(crate) struct WholeList<'a> {
    /// All primitives.
    pub(crate) share: &'a Share,
    /// A pass by the table.
    pub(crate) pass: TransformCost,
    /// The views, one or two.
    pub(crate) views: &'a [FrameView],
    /// The field or the frame that they are of.
    pub(crate) viewport: Viewport,
    /// Division of pixel memory that the commands are encoded for.
    pub(crate) layout: Layout,
    /// Where the commands of one view are kept, or the places of triangles in two.
    pub(crate) part: MemoryPart,
}

impl Work for WholeList<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        self.pass.span(timing) * self.views.len() as u64
    }

    /// The commands of one view are kept with their boxes; of two, the places of triangles in both.
    fn by_code(&self, timing: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        let Self { share, part, .. } = *self;
        let picture = picture(self.viewport, self.layout);
        let kept = match self.views {
            [from, to] => KeepingEnds { share, views: [from, to], picture, part }.run_code(timing, processor)?,
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

/// The picture whose kernels these are: that of a pipeline that sends everything everywhere, since what is sent where is found later.
pub(crate) const fn picture(viewport: Viewport, layout: Layout) -> Picture {
    Picture { viewport, shading: Shading::Gouraud, binning: RegionBinning::All, layout, pixels: false }
}
