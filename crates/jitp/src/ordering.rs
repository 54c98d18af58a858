//! An order of the master, as work of its board.

use crate::protocol::DrawingOrder;
use pphigs::{TransformCost, put_together};
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_sim::Span;

/// An order put together. By the table that of a field takes the time of a pass over nothing, any other none besides its message.
pub(crate) struct Ordering<'a>(pub(crate) &'a DrawingOrder);

impl Work for Ordering<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        match self.0 {
            DrawingOrder::Field { .. } => TransformCost::PASS.span(timing),
            _ => Span::ZERO,
        }
    }

    fn by_code(&self, _: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        put_together(processor, &self.0.words(), self.0.head_words())
    }
}
