//! What meets the regions of a strip or of a batch of blocks, as work of a board: found, interpolated, handed over.

use pphigs::{PrimitiveCounts, Searching};
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_sim::Span;

/// The search for what is drawn, and the interpolation of what meets any of the regions.
pub(crate) struct Finding<'a> {
    /// The regions.
    pub(crate) searching: Searching<'a>,
    /// What is interpolated before it is found; `None` where the display list was transformed for one view.
    pub(crate) interpolated: Option<PrimitiveCounts>,
    /// Time of each of these by the table, ns.
    pub(crate) interpolate_ns: u64,
}

impl Work for Finding<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        let interpolated = self.interpolated.map_or(0, PrimitiveCounts::total);
        self.searching.by_table(timing) + Span::from_ns(self.interpolate_ns * u64::from(interpolated))
    }

    /// Of a dual display list it takes the time of the table.
    fn by_code(&self, timing: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        match self.interpolated {
            Some(_) => Ok(self.by_table(timing)),
            None => self.searching.by_code(timing, processor),
        }
    }
}

#[cfg(test)]
mod tests;
