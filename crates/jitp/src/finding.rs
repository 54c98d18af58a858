//! What meets the regions of a strip or of a batch of blocks, as work of a board: found, interpolated, handed over.

use pphigs::{Interpolating, PrimitiveCounts, Searching};
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_sim::Span;

/// The search for what is drawn, and the interpolation of what meets any of the regions.
pub(crate) struct Finding<'a> {
    /// The regions.
    pub(crate) searching: Searching<'a>,
    /// What comes before; `None` where the display list was transformed for one view.
    pub(crate) interpolating: Option<Interpolating<'a>>,
    /// Primitives that meet any of the regions.
    pub(crate) met: PrimitiveCounts,
    /// Time to interpolate one of them by the table, ns.
    pub(crate) interpolate_ns: u64,
}

impl Work for Finding<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        let interpolated = if self.interpolating.is_some() { self.met.total() } else { 0 };
        self.searching.by_table(timing) + Span::from_ns(self.interpolate_ns * u64::from(interpolated))
    }

    fn by_code(&self, timing: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        let Some(interpolating) = &self.interpolating else { return self.searching.by_code(timing, processor) };
        match interpolating.run_code(timing, processor)? {
            Some(span) => Ok(span + self.searching.by_code(timing, processor)?),
            None => Ok(self.by_table(timing)),
        }
    }
}

#[cfg(test)]
mod tests;
