//! TRANSFORM of the whole display list as work of a board.

use pphigs::{FrameView, MemoryPart, Picture, RegionBinning, Shading, Share, TransformCost, Transforming};
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
    /// Where the commands of one view are kept.
    pub(crate) part: MemoryPart,
}

impl Work for WholeList<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        self.pass.span(timing) * self.views.len() as u64
    }

    /// The commands of one view are kept with their boxes. Of two the kernels are those of Slats, which sends everything everywhere.
    fn by_code(&self, timing: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        let Self { viewport, layout, part, .. } = *self;
        let picture =
            Picture { viewport, shading: Shading::Gouraud, binning: RegionBinning::All, layout, pixels: false };
        if let [view] = self.views {
            let kept = self.share.transform(view, 0, picture).keep(timing, processor, part)?;
            return Ok(kept.unwrap_or_else(|| self.by_table(timing)));
        }
        (0..).zip(self.views).try_fold(Span::ZERO, |all, (context, view)| {
            let passes = [self.share.transform(view, 0, picture)];
            Ok(all + Transforming { passes: &passes, context, begins: true }.by_code(timing, processor)?)
        })
    }
}
