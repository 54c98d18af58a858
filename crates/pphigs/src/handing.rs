//! A bin handed over with its token, as work of a board: the messages that its region's commands make, as lists of pieces.
//!
//! The code is kernels/token.s. It walks through the entries that TRANSFORM's code left in the bin; the commands stay where they are.
//! By the timing table each entry takes `token_entry_ns`.

use crate::commands::RegionEnvelope;
use crate::layout::{ENVELOPES, LISTS, LISTS_END, PIECES, TOKEN_CODE, TOKEN_PARAMETERS, bins};
use crate::pass::Pass;
use i860::Program;
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_renderer::CommandKind;
use pxpl5_sim::Span;
use pxpl5_wire::{MAX_MESSAGE_WORDS, RegionId, Word};
use std::sync::{Arc, LazyLock};

/// The bin of a region, handed over in its envelope.
#[derive(Clone, Copy, Debug)]
pub struct Handing<'a> {
    /// The TRANSFORM that filled it.
    pub pass: &'a Pass,
    /// Its bin context, 0 or 1.
    pub context: u8,
    /// Which of the views that share the context, 0 where there is one.
    pub view: u8,
    /// The region.
    pub region: RegionId,
    /// What encloses its primitives.
    pub envelope: RegionEnvelope,
}

/// A message as the code lists it: addresses and lengths in words of its pieces.
pub type MessagePieces = Vec<[Word; 2]>;

/// Bytes of a piece, and of a message in the list of messages.
pub(crate) const PIECE_BYTES: u32 = 8;
pub(crate) const MESSAGE_BYTES: u32 = 16;
/// Pieces that there is room for, besides what encloses a message: two for each of the messages, which hold 20 commands and more.
pub(crate) const MOST_ENTRIES: u32 = (LISTS_END - PIECES) / PIECE_BYTES * 9 / 10;
const _: () = assert!((MOST_ENTRIES / 20 + 2) * MESSAGE_BYTES <= PIECES - LISTS, "room for the messages of so many");

/// Instructions after which the code is taken to be endless: many times what it needs.
pub(crate) const BUDGET: u64 = 10_000;
pub(crate) const BUDGET_OF_ENTRY: u64 = 1_000;

impl Work for Handing<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        Span::from_ns(timing.token_entry_ns) * u64::from(self.pass.counts(self.region).total())
    }

    fn by_code(&self, timing: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        let Some([triangle, sphere]) = self.pass.binned_words(processor.version()) else {
            return Ok(self.by_table(timing));
        };
        let entries = self.pass.counts(self.region).total();
        if entries > MOST_ENTRIES {
            return Err(ProcessorFault::NoRoom {
                gp: processor.node(),
                context: self.context,
                needed_bytes: entries * PIECE_BYTES,
                available_bytes: MOST_ENTRIES * PIECE_BYTES,
            });
        }
        let parameters = [&[triangle, sphere], self.enclosing().as_slice()].concat();
        processor.write(TOKEN_PARAMETERS, &parameters)?;
        let bins = bins(self.context, self.view);
        let registers = [(16, self.region.0.into()), (17, bins), (18, PIECES), (19, LISTS), (20, TOKEN_PARAMETERS)];
        processor.call(&PROGRAM, "token", &registers, BUDGET + BUDGET_OF_ENTRY * u64::from(entries))
    }
}

impl Handing<'_> {
    /// Addresses and words of what begins the region, every other message, and what ends it; words of a message of nothing.
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

    /// The messages that the last call of the code has listed.
    ///
    /// # Errors
    ///
    /// [`ProcessorFault::Unmapped`] on a board that no code has run on.
    pub fn listed(processor: &Processor) -> Result<Vec<MessagePieces>, ProcessorFault> {
        listed(processor, processor.register(16))
    }
}

/// The first messages of the list of messages.
pub(crate) fn listed(processor: &Processor, count: u32) -> Result<Vec<MessagePieces>, ProcessorFault> {
    let message = |number: u32| {
        let bounds = processor.read(LISTS + number * MESSAGE_BYTES, 2)?;
        let [first, end] = [0, 1].map(|at| bounds.get(at).copied().unwrap_or_default());
        let words = processor.read(first, (end.saturating_sub(first) / 4) as usize)?;
        Ok(words.as_chunks::<2>().0.to_vec())
    };
    (0..count).map(message).collect()
}

/// The source of what lists messages: of at most so many words before what ends a region, and of at most so many with that.
pub(crate) fn token_source([most, whole]: [Word; 2]) -> String {
    format!("MOST = {most}\nWHOLE = {whole}\n{}", include_str!("../kernels/token.s"))
}

/// The program of all this.
#[cfg(test)]
pub(crate) fn program() -> Arc<Program> {
    Arc::clone(&PROGRAM)
}

static PROGRAM: LazyLock<Arc<Program>> =
    LazyLock::new(|| match i860::assemble("token", TOKEN_CODE, &token_source([MAX_MESSAGE_WORDS; 2])) {
        Ok(program) => Arc::new(program),
        Err(errors) => unreachable!("it is assembled by the tests: {errors}"),
    });
