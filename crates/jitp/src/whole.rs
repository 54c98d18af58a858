//! TRANSFORM of the whole display list as work of a board.

use pphigs::{FrameView, Picture, RegionBinning, Shading, Share, TransformCost, Transforming};
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
}

impl Work for WholeList<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        self.pass.span(timing) * self.views.len() as u64
    }

    /// The kernels are those of Slats, which sends everything everywhere.
    fn by_code(&self, timing: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        let Self { viewport, layout, .. } = *self;
        let picture =
            Picture { viewport, shading: Shading::Gouraud, binning: RegionBinning::All, layout, pixels: false };
        (0..).zip(self.views).try_fold(Span::ZERO, |all, (context, view)| {
            let passes = [self.share.transform(view, 0, picture)];
            Ok(all + Transforming { passes: &passes, context, begins: true }.by_code(timing, processor)?)
        })
    }
}
