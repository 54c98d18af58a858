//! The message software of a board as i860 code (kernels/ring.s), and the memory that the software shares with the ring
//! interface.
//!
//! ```text
//!   CODE      DATA                REQUESTS     WINDOW, never in a cache
//!   | ring.s  | queue, chains,    | messages   | registers, descriptors | buffers of messages |
//!   |         | frame, stack      | to send    | of messages and chains | that have arrived   |
//! ```
//!
//! The original software is not published. kernels/ring_rules.md states what is assumed about it, and the rules by
//! which this code was written.
//!
//! Before each call, Rust code does the work of the interface's DMA. The simulated inbox holds any number of messages,
//! while receive buffers are few. A message therefore gets its buffer only when the message software begins.
//!
//! Before a chain of messages is built, all earlier chains are marked as sent, because [`crate::Gp::start`] simulates
//! their queue.

use crate::firmware::Fault;
use crate::processor::{Processor, ProcessorFault};
use crate::window::{RING_MEMORY, WINDOW};
use i860::Program;
use pxpl5_sim::Span;
use pxpl5_wire::{Body, Message, NodeId, Word};
use std::sync::{Arc, LazyLock};

const CODE: u32 = RING_MEMORY.start;
const DATA: u32 = 0xF_2000;
const ENTRIES: u32 = DATA + 0x400;
const STACK: u32 = 0xF_3000;
const REQUESTS: u32 = STACK;
const BUFFERS: u32 = WINDOW + 0x3000;

// The sizes of tables, queue and buffers are assumed, because the interface is also assumed (kernels/ring_rules.md,
// last table).

/// Number of buffers for received messages. Each buffer has one descriptor.
const RX_COUNT: u32 = 8;
const RX: u32 = WINDOW + 256;
/// Size of a receive buffer in bytes. It holds a header of two words and the longest message, in whole cache lines.
const BUFFER_BYTES: u32 = 4608;
const TX_COUNT: u32 = 256;
const TX: u32 = WINDOW + 0x1000;
const DESCRIPTOR_BYTES: u32 = 16;
const ENTRY_COUNT: u32 = 16;
const ENTRY_BYTES: u32 = 64;

// Variables of the software in the area DATA, with the same names as in ring.s.
const NODE: u32 = DATA;
const RX_NEXT: u32 = DATA + 4;
const FREE: u32 = DATA + 16;
const TX_NEXT: u32 = DATA + 28;
const TX_ROOM: u32 = DATA + 32;
const ISSUED: u32 = DATA + 36;
const HANDLERS: u32 = DATA + 64;
// Registers of the ring interface.
const CAUSE: u32 = WINDOW;
const DONE: u32 = WINDOW + 12;

/// Number of kinds of messages: words for a program, commands for a renderer, and pixels.
const KINDS: u32 = 3;

/// Flag of a send request: the port of the receiver stays reserved for the next message.
const HOLD: Word = 1;

/// Greatest number of instructions in a call of the message software. A message needs far fewer instructions.
const BUDGET: u64 = 10_000;

impl Processor {
    /// Runs the i860 code that receives a message, and returns its time. The code has four parts: interrupt, dispatch,
    /// queue, and the program's part. The last part takes the message from the queue and releases the message's buffer.
    ///
    /// # Errors
    ///
    /// Returns [`Fault::Protocol`] for a message of commands or pixels, or for an invalid length. Returns
    /// [`Fault::Processor`] if the code does not return.
    pub fn receive_message(&mut self, source: NodeId, body: &Body) -> Result<Span, Fault> {
        let (kind, length, words) = match body {
            Body::Words(words) => (0, words.len() as u32, &words[..]),
            Body::Commands(list) => (1, list.words(), [].as_slice()),
            Body::Pixels(_) => (2, 1, [].as_slice()),
        };
        // Copy only words into the buffer. The software refuses the other kinds because of their header.
        let (span, taken) = deliver(self, source, kind << 16 | length.min(0xFFFF), words)?;
        let what = || match kind {
            0 => format!("of {length} words from node {}", source.0),
            _ => "of commands or pixels at a processor".to_owned(),
        };
        taken.map(|_| span).map_err(|_| Fault::Protocol { node: self.node(), found: what() })
    }

    /// Runs the i860 code that sends a chain of messages, and returns its time. The code writes a header and a
    /// descriptor for each message, and releases the descriptors of earlier chains. The boolean of a message is true if
    /// the receiver's port stays reserved after this message. If the descriptors are not sufficient for all messages,
    /// the remaining messages form one or more separate chains.
    ///
    /// # Errors
    ///
    /// Returns [`Fault::Protocol`] for an invalid length. Returns [`Fault::Processor`] if the code does not return.
    pub fn send_chain<'a>(&mut self, links: impl Iterator<Item = (&'a Message, bool)>) -> Result<Span, Fault> {
        // The address of the words is 0, because this memory does not contain their content.
        let request = |(message, hold): (&Message, bool)| {
            let kind = match message.body {
                Body::Words(_) => 0,
                Body::Commands(_) => 1,
                Body::Pixels(_) => 2,
            };
            [message.destination.0.into(), kind << 16 | if hold { HOLD } else { 0 }, message.words, 0]
        };
        let requests: Vec<Request> = links.map(request).collect();
        let mut span = Span::ZERO;
        for part in requests.chunks(TX_COUNT as usize).chain(requests.is_empty().then_some([].as_slice())) {
            let (took, refused) = chain(self, part, 0)?;
            if let Some(at) = refused {
                let [destination, _, words, _] = part.get(at).copied().unwrap_or_default();
                let found = format!("of {words} words for node {destination}");
                return Err(Fault::Protocol { node: self.node(), found });
            }
            span += took;
        }
        Ok(span)
    }
}

/// A send request of four words: receiver, kind and flags, length in words, and address.
type Request = [Word; 4];

/// A received message, as the message software passes it to a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Taken {
    place: u32,
    words: u32,
    sender: u32,
}

/// The error number (defined in ring.s) with which the message software refuses a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Refusal(Word);

/// Puts a message into the next receive buffer, like the ring interface, and runs the code that receives it. `header`
/// contains the kind and length of the message.
fn deliver(
    processor: &mut Processor,
    source: NodeId,
    header: Word,
    words: &[Word],
) -> Result<(Span, Result<Taken, Refusal>), ProcessorFault> {
    // Write the message and its descriptor as the interface's DMA would.
    install(processor)?;
    let descriptor = processor.word(RX_NEXT)?;
    let buffer = processor.word(descriptor + 4)?;
    let room = (BUFFER_BYTES / 4 - 2) as usize;
    let receiver = Word::from(processor.node().0);
    processor.write(buffer, &[receiver << 16 | Word::from(source.0), header])?;
    processor.write(buffer + 8, &words[..words.len().min(room)])?;
    processor.write(descriptor, &[1])?;
    processor.write(CAUSE, &[1])?;
    // Registers 16 to 19 hold the results of `receive`.
    let span = processor.call(&PROGRAM, "receive", &[(2, STACK)], BUDGET)?;
    let [entry, place, words, sender] = [16, 17, 18, 19].map(|number| processor.register(number));
    Ok((span, if entry == 0 { Err(Refusal(place)) } else { Ok(Taken { place, words, sender }) }))
}

/// Runs the code that builds and starts a chain of messages, and returns its time. If the code refuses a message, also
/// returns the index of the first refused message.
fn chain(
    processor: &mut Processor,
    requests: &[Request],
    ticket: Word,
) -> Result<(Span, Option<usize>), ProcessorFault> {
    install(processor)?;
    processor.write(REQUESTS, requests.as_flattened())?;
    // All earlier chains are already sent.
    let sent = processor.word(ISSUED)?;
    processor.write(DONE, &[sent])?;
    let count = requests.len() as Word;
    let registers = [(2, STACK), (16, REQUESTS), (17, count), (18, ticket)];
    let span = processor.call(&PROGRAM, "send", &registers, BUDGET + BUDGET * u64::from(count))?;
    Ok((span, (processor.register(16) != 0).then(|| processor.register(17) as usize)))
}

/// Writes the initial queues, descriptors and table of handlers to memory. Does nothing if memory already contains
/// them.
fn install(processor: &mut Processor) -> Result<(), ProcessorFault> {
    if processor.word(RX_NEXT)? != 0 {
        return Ok(());
    }
    // Only messages of words have a handler. The software refuses all other kinds.
    let handler = |label: &str| PROGRAM.symbol(label).unwrap_or_default();
    let handlers = [handler("queue"), handler("nohandler"), handler("nohandler")];
    const { assert!(KINDS == 3, "a handler for each kind") };
    // Every receive descriptor points to its buffer, and belongs to the interface.
    for number in 0..RX_COUNT {
        let buffer = BUFFERS + number * BUFFER_BYTES;
        processor.write(RX + number * DESCRIPTOR_BYTES, &[0, buffer])?;
    }
    // The free queue entries form a linked list.
    for number in 0..ENTRY_COUNT {
        let next = if number + 1 < ENTRY_COUNT { ENTRIES + (number + 1) * ENTRY_BYTES } else { 0 };
        processor.write(ENTRIES + number * ENTRY_BYTES, &[next])?;
    }
    processor.write(HANDLERS, &handlers)?;
    processor.write(FREE, &[ENTRIES])?;
    processor.write(TX_NEXT, &[TX, TX_COUNT])?;
    processor.write(NODE, &[processor.node().0.into(), RX])
}

static PROGRAM: LazyLock<Arc<Program>> = LazyLock::new(|| {
    let constants = format!("DATA = {DATA}\nWINDOW = {WINDOW}\nRX_COUNT = {RX_COUNT}\nTX_COUNT = {TX_COUNT}\n");
    match i860::assemble("ring", CODE, &[constants.as_str(), include_str!("../kernels/ring.s")].concat()) {
        Ok(program) => Arc::new(program),
        Err(errors) => unreachable!("it is assembled by the tests: {errors}"),
    }
});

const _: () = assert!(TX_ROOM == TX_NEXT + 4 && RX_NEXT == NODE + 4, "written together");
const _: () = assert!(TX + TX_COUNT * DESCRIPTOR_BYTES <= BUFFERS && ENTRIES + ENTRY_COUNT * ENTRY_BYTES < STACK);
const _: () =
    assert!(REQUESTS + TX_COUNT * DESCRIPTOR_BYTES <= WINDOW && BUFFERS + RX_COUNT * BUFFER_BYTES <= RING_MEMORY.end);

#[cfg(test)]
mod tests;
