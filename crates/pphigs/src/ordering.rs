//! CPU work of assembling an order, which is the message of a master to its slaves. The code is kernels/order.s. No
//! paper describes the code; kernels/order_rules.md states its rules.

use crate::layout::{MESSAGE, ORDER_CODE, ORDER_HEAD, ORDER_VIEWS};
use i860::Program;
use pxpl5_gp::{Processor, ProcessorFault};
use pxpl5_sim::Span;
use pxpl5_wire::{MAX_MESSAGE_WORDS, Word};
use std::sync::{Arc, LazyLock};

/// Largest number of instructions, twice what the longest message needs. Code that exceeds the limit counts as an
/// endless loop.
const BUDGET: u64 = 12 * MAX_MESSAGE_WORDS as u64;

const HEAD_WORDS: usize = (ORDER_VIEWS - ORDER_HEAD) as usize / 4;

/// Assembles an order on a board, and returns the simulated time. `head` is the number of words before the views.
///
/// # Errors
///
/// Returns [`ProcessorFault`] if the code does not end, or if the order is longer than a message.
pub fn assemble_order(processor: &mut Processor, order: &[Word], head: usize) -> Result<Span, ProcessorFault> {
    let (head, views) = order.split_at(head.min(order.len()));
    if order.len() > MAX_MESSAGE_WORDS as usize || head.len() > HEAD_WORDS {
        return Err(ProcessorFault::Unmapped { gp: processor.node(), address: MESSAGE, words: order.len() });
    }
    if head.is_empty() {
        return Ok(Span::ZERO);
    }
    processor.write(ORDER_HEAD, head)?;
    processor.write(ORDER_VIEWS, views)?;
    let of_head = [(16, MESSAGE), (17, ORDER_HEAD), (18, head.len() as Word)];
    let of_views = [(19, ORDER_VIEWS), (20, views.len() as Word)];
    processor.call(&PROGRAM, "order", &[of_head.as_slice(), &of_views].concat(), BUDGET)
}

#[cfg(test)]
pub(crate) fn program() -> Arc<Program> {
    Arc::clone(&PROGRAM)
}

static PROGRAM: LazyLock<Arc<Program>> =
    LazyLock::new(|| match i860::assemble("order", ORDER_CODE, include_str!("../kernels/order.s")) {
        Ok(program) => Arc::new(program),
        Err(errors) => unreachable!("it is assembled by the tests: {errors}"),
    });

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_gp::CodeVersion;
    use pxpl5_wire::NodeId;

    #[test]
    fn the_code_of_an_order_writes_exactly_the_words_of_the_order() {
        let mut processor = Processor::new(NodeId(1), 8 << 20, CodeVersion::Compiled, i860::Config::cycle());
        for (words, head) in [(1, 1), (6, 6), (110, 4), (MAX_MESSAGE_WORDS, 6)] {
            let order: Vec<Word> = (0..words).map(|word| 0x1000_0000 + 7 * word).collect();
            processor.write(MESSAGE, &vec![0; order.len() + 1]).expect("in memory");
            let span = assemble_order(&mut processor, &order, head).expect("it returns");
            // Each word takes six instructions. The last instruction is a branch, which takes two more clocks if the
            // branch is taken.
            assert!(span >= Processor::CLOCK * (6 * u64::from(words)), "{span:?} for {words} words");
            assert_eq!(processor.read(MESSAGE, order.len()).expect("in memory"), order);
            assert_eq!(processor.read(MESSAGE + 4 * words, 1).expect("in memory"), [0], "{words} words and no more");
        }
        assert!(assemble_order(&mut processor, &[0; MAX_MESSAGE_WORDS as usize + 1], 4).is_err());
    }
}
