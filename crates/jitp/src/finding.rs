use pphigs::{PrimitiveCounts, StripInterpolation, WindowSearchWork};
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_sim::Span;

/// The work of interpolating primitives, finding the primitives in some regions, and listing the messages that draw
/// these primitives.
pub(crate) struct StripSearchWork<'a> {
    pub(crate) searching: WindowSearchWork<'a>,
    /// The interpolation, or `None` if the display list was transformed for only one view.
    pub(crate) interpolating: Option<StripInterpolation<'a>>,
    pub(crate) met: PrimitiveCounts,
    pub(crate) interpolate_ns: u64,
}

impl Work for StripSearchWork<'_> {
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
