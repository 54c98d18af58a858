//! Work of a graphics processor that sends a region's bin. The code lists the pieces of memory that contain the
//! commands of each message, and the ring interface then sends these pieces.
//!
//! The code is kernels/token.s. This code reads the bins that the code of TRANSFORM has filled, and does not move the
//! commands. In the timing table, each bin entry takes `token_entry_ns`.

use crate::commands::RegionEnvelope;
use crate::layout::{ENVELOPES, LISTS, LISTS_END, PIECES, TOKEN_CODE, TOKEN_PARAMETERS, bins};
use crate::pass::Pass;
use i860::Program;
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_renderer::CommandKind;
use pxpl5_sim::Span;
use pxpl5_wire::{MAX_MESSAGE_WORDS, RegionId, Word};
use std::sync::{Arc, LazyLock};

/// Work of sending the bin of one region, with the commands before and after its primitives.
#[derive(Clone, Copy, Debug)]
pub struct BinHandoffWork<'a> {
    /// Result of TRANSFORM with the bin.
    pub pass: &'a Pass,
    /// Set of bins, 0 or 1. A board has two sets.
    pub context: u8,
    /// Index of the view among the views in the same set of bins, usually 0.
    pub view: u8,
    /// Region whose bin is sent.
    pub region: RegionId,
    /// Commands before and after the region's primitives.
    pub envelope: RegionEnvelope,
}

/// The pieces of memory of one message: address and length in words of each piece.
pub type MessagePieces = Vec<[Word; 2]>;

pub(crate) const PIECE_BYTES: u32 = 8;
pub(crate) const MESSAGE_BYTES: u32 = 16;
/// Largest number of bin entries of a region for which the list of pieces has room. A message has at least 20 commands,
/// and two more pieces for its first and its last commands.
pub(crate) const MAX_ENTRIES: u32 = (LISTS_END - PIECES) / PIECE_BYTES * 9 / 10;
const _: () = assert!((MAX_ENTRIES / 20 + 2) * MESSAGE_BYTES <= PIECES - LISTS, "room for the messages of so many");

/// Largest number of instructions, much more than the code needs. Code that exceeds the limit counts as an endless
/// loop.
pub(crate) const BUDGET: u64 = 10_000;
pub(crate) const BUDGET_OF_ENTRY: u64 = 1_000;

impl Work for BinHandoffWork<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        Span::from_ns(timing.token_entry_ns) * u64::from(self.pass.counts(self.region).total())
    }

    fn by_code(&self, timing: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        // The code can send only bins that code has filled.
        let Some([triangle, sphere]) = self.pass.binned_words(processor.version()) else {
            return Ok(self.by_table(timing));
        };
        let entries = self.pass.counts(self.region).total();
        if entries > MAX_ENTRIES {
            return Err(ProcessorFault::NoRoom {
                gp: processor.node(),
                context: self.context,
                needed_bytes: entries * PIECE_BYTES,
                available_bytes: MAX_ENTRIES * PIECE_BYTES,
            });
        }
        // The parameters contain the lengths of the commands and the envelope, from which the code divides the bin into
        // messages.
        let parameters = [&[triangle, sphere], self.enclosing().as_slice()].concat();
        processor.write(TOKEN_PARAMETERS, &parameters)?;
        let bins = bins(self.context, self.view);
        let registers = [(16, self.region.0.into()), (17, bins), (18, PIECES), (19, LISTS), (20, TOKEN_PARAMETERS)];
        processor.call(&PROGRAM, "token", &registers, BUDGET + BUDGET_OF_ENTRY * u64::from(entries))
    }
}

impl BinHandoffWork<'_> {
    /// Returns the parameters for the commands before and after a region's primitives.
    ///
    /// Six parameters are address and length of three sequences of commands. The sequences belong to the start of the
    /// region, to the start of each message except the first, and to the end of the region. The seventh parameter is
    /// the number of words of a message without primitives and without the end of the region.
    fn enclosing(&self) -> [Word; 7] {
        let words = |kind: CommandKind, is_there: bool| kind.words() * u32::from(is_there);
        let contexts = self.pass.picture().layout.plan().contexts > 1;
        let again = words(CommandKind::SelectRegion, contexts);
        let begin = words(CommandKind::SelectRegion, contexts || self.envelope.begin)
            + words(CommandKind::Clear, self.envelope.begin);
        let shades = self.envelope.shade && self.pass.shades_at_pixels();
        let end = words(CommandKind::Shade, shades) + words(CommandKind::CopyRegion, self.envelope.copy.is_some());
        let nothing = words(CommandKind::SelectRegion, contexts || self.envelope.begin);
        let [at_begin, at_again, at_end] = [0, 1, 2].map(|n| ENVELOPES + n * 0x40);
        [at_begin, begin, at_again, again, at_end, end, nothing]
    }

    /// Returns the messages that the last execution of the i860 code has listed.
    ///
    /// # Errors
    ///
    /// Returns [`ProcessorFault::Unmapped`] on a board that has not run the code.
    pub fn listed(processor: &Processor) -> Result<Vec<MessagePieces>, ProcessorFault> {
        listed(processor, processor.register(16))
    }
}

pub(crate) fn listed(processor: &Processor, count: u32) -> Result<Vec<MessagePieces>, ProcessorFault> {
    let message = |number: u32| {
        let bounds = processor.read(LISTS + number * MESSAGE_BYTES, 2)?;
        let [first, end] = [0, 1].map(|at| bounds.get(at).copied().unwrap_or_default());
        let words = processor.read(first, (end.saturating_sub(first) / 4) as usize)?;
        Ok(words.as_chunks::<2>().0.to_vec())
    };
    (0..count).map(message).collect()
}

/// Returns the source of the code that divides a bin into messages.
///
/// A message has at most `most` words without the commands that end a region, and at most `whole` with them.
pub(crate) fn token_source([most, whole]: [Word; 2]) -> String {
    format!("MOST = {most}\nWHOLE = {whole}\n{}", include_str!("../kernels/token.s"))
}

#[cfg(test)]
pub(crate) fn program() -> Arc<Program> {
    Arc::clone(&PROGRAM)
}

static PROGRAM: LazyLock<Arc<Program>> =
    LazyLock::new(|| match i860::assemble("token", TOKEN_CODE, &token_source([MAX_MESSAGE_WORDS; 2])) {
        Ok(program) => Arc::new(program),
        Err(errors) => unreachable!("it is assembled by the tests: {errors}"),
    });
