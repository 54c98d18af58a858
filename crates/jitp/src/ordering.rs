use crate::protocol::DrawingOrder;
use pphigs::{TransformCost, assemble_order};
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_sim::Span;

/// The work of assembling a message with an order.
///
/// In the timing table, the order for a field takes the time of an empty TRANSFORM. Other orders take no additional
/// time.
pub(crate) struct OrderAssemblyWork<'a>(pub(crate) &'a DrawingOrder);

impl Work for OrderAssemblyWork<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        match self.0 {
            DrawingOrder::Field { .. } => TransformCost::PASS.span(timing),
            _ => Span::ZERO,
        }
    }

    fn by_code(&self, _: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        assemble_order(processor, &self.0.words(), self.0.head_words())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::{MASTER, view};
    use pxpl5_gp::CodeVersion;
    use pxpl5_sim::Time;
    use pxpl5_wire::PeriodNumber;

    /// Tests the time in which i860 code assembles an order. Each word takes six instructions (kernels/order.s of
    /// pphigs), and each instruction takes at least a clock of 25 ns. Cache misses add a few clocks per word.
    #[test]
    fn the_code_of_an_order_takes_at_least_six_clocks_a_word() {
        let views = |n: u64| (0..n).map(view).collect();
        for order in [
            DrawingOrder::Field { field: PeriodNumber(3), views: views(1) },
            DrawingOrder::Field { field: PeriodNumber(3), views: views(2) },
            DrawingOrder::Strip { field: PeriodNumber(3), strip: 7, deadline: Time(9), view: None },
        ] {
            let mut processor = Processor::new(MASTER, 8 << 20, CodeVersion::Scheduled, i860::Config::cycle());
            let span = OrderAssemblyWork(&order).by_code(&GpTiming::PAPERS, &mut processor).expect("it returns");
            let least = Span::from_ns(25 * 6 * order.words().len() as u64);
            assert!(span > least && span < least * 4, "{span} for {least}: {order:?}");
        }
    }
}
