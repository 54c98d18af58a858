//! Tests of the i860 code in ring.s, which sends and receives messages, against a reference model.

use super::*;
use crate::processor::CodeVersion;
use pxpl5_sim::SplitMix64;
use pxpl5_wire::{CommandList, CommandRun};
use std::collections::VecDeque;

const NODE_ID: NodeId = NodeId(37);
// Addresses of variables of ring.s that only the tests read.
const WRONG_OF_RECEIVER: u32 = DATA + 24;
const COMPLETE: u32 = DATA + 44;
const START: u32 = WINDOW + 8;

const MAX_WORDS: u32 = pxpl5_wire::MAX_MESSAGE_WORDS;

fn board() -> Processor {
    let mut processor = Processor::new(NODE_ID, 1 << 20, CodeVersion::Compiled, i860::Config::cycle());
    install(&mut processor).expect("it fits");
    processor
}

fn below(numbers: &mut SplitMix64, limit: u32) -> u32 {
    numbers.below(limit.into()) as u32
}

fn words(numbers: &mut SplitMix64, count: u32) -> Vec<Word> {
    (0..count).map(|_| numbers.bits() as Word).collect()
}

fn at(processor: &Processor, address: u32) -> Word {
    processor.word(address).expect("in memory")
}

/// Returns the addresses of the free queue entries, in the order of the linked list.
fn free_entries(processor: &Processor) -> Vec<u32> {
    let mut entry = at(processor, FREE);
    let mut all = Vec::new();
    while entry != 0 && all.len() <= ENTRY_COUNT as usize {
        all.push(entry);
        entry = at(processor, entry);
    }
    all
}

/// Writes a message into receive buffer `slot`, as the ring interface does. Returns false if the processor still owns
/// the buffer.
fn arrive(processor: &mut Processor, slot: u32, source: u32, header: Word, words: &[Word]) -> bool {
    let descriptor = RX + slot % RX_COUNT * DESCRIPTOR_BYTES;
    if at(processor, descriptor) != 0 {
        return false;
    }
    let buffer = BUFFERS + slot % RX_COUNT * BUFFER_BYTES;
    processor.write(buffer, &[Word::from(NODE_ID.0) << 16 | source, header]).expect("in memory");
    processor.write(buffer + 8, words).expect("in memory");
    processor.write(descriptor, &[1]).expect("in memory");
    processor.write(CAUSE, &[1]).expect("in memory");
    true
}

fn call(processor: &mut Processor, entry: &str, registers: &[(usize, Word)]) {
    let registers = [&[(2, STACK)], registers].concat();
    processor.call(&PROGRAM, entry, &registers, BUDGET).expect("it returns");
}

/// Sends messages, interrupts and reads in random order. The program must receive the messages in order of arrival.
#[test]
fn messages_are_received_in_order_and_their_buffers_are_freed() {
    let mut numbers = SplitMix64::new(5);
    let mut processor = board();
    let mut slot = 0;
    let mut pending: Vec<(u32, Word, Vec<Word>)> = Vec::new();
    let mut queue: VecDeque<(u32, Vec<Word>)> = VecDeque::new();
    for _ in 0..4_000 {
        match below(&mut numbers, 5) {
            0 | 1 => {
                let count =
                    if numbers.unit() < 0.6 { 1 + below(&mut numbers, 10) } else { 1 + below(&mut numbers, MAX_WORDS) };
                let message = (below(&mut numbers, 1 << 16), count, words(&mut numbers, count));
                if arrive(&mut processor, slot, message.0, message.1, &message.2) {
                    slot += 1;
                    pending.push(message);
                }
            }
            2 => {
                call(&mut processor, "interrupt", &[]);
                assert_eq!(at(&processor, CAUSE), 0, "acknowledged");
                // Messages without a free queue entry are lost and counted.
                let room = ENTRY_COUNT as usize - queue.len();
                let lost = pending.len() > room;
                queue.extend(pending.drain(..).take(room).map(|(source, _, words)| (source, words)));
                let wrong = at(&processor, WRONG_OF_RECEIVER);
                assert_eq!(wrong, if lost { 3 } else { 0 });
                processor.write(WRONG_OF_RECEIVER, &[0]).expect("in memory");
            }
            _ => {
                call(&mut processor, "take", &[]);
                let [entry, place, count, sender] = [16, 17, 18, 19].map(|number| processor.register(number));
                let Some((source, expected)) = queue.pop_front() else {
                    assert_eq!((entry, place), (0, 0), "nothing is there, and nothing was wrong");
                    continue;
                };
                assert_eq!((sender, count), (source, expected.len() as u32));
                assert_eq!(processor.read(place, expected.len()).expect("in memory"), expected);
                let in_buffer = place >= BUFFERS;
                assert_eq!(in_buffer, expected.len() > 8, "short messages are copied");
                call(&mut processor, "release", &[(16, entry)]);
                if in_buffer {
                    let descriptor = RX + (place - 8 - BUFFERS) / BUFFER_BYTES * DESCRIPTOR_BYTES;
                    assert_eq!((at(&processor, descriptor), at(&processor, WINDOW + 4)), (0, descriptor));
                }
            }
        }
        let held = queue.iter().filter(|(_, words)| words.len() > 8).count() + pending.len();
        let owned = (0..RX_COUNT).filter(|n| at(&processor, RX + n * DESCRIPTOR_BYTES) != 0).count();
        assert_eq!(owned, held, "buffers that are not the interface's");
        let mut free = free_entries(&processor);
        assert_eq!(free.len() + queue.len(), ENTRY_COUNT as usize);
        free.sort_unstable();
        free.dedup();
        assert!(
            free.iter().all(|entry| (entry - ENTRIES).is_multiple_of(ENTRY_BYTES)) && free.len() + queue.len() == 16
        );
    }
    assert!(slot > 500, "{slot} messages arrived");
}

#[test]
fn a_message_is_received_whole_and_its_buffer_is_freed() {
    let mut numbers = SplitMix64::new(11);
    let mut processor = board();
    for n in 0..200 {
        let count = if n % 3 == 0 { MAX_WORDS - n } else { 1 + n % 20 };
        let body = words(&mut numbers, count);
        let source = NodeId(below(&mut numbers, 100) as u16);
        let (span, taken) = deliver(&mut processor, source, count, &body).expect("it returns");
        let taken = taken.expect("it is a message of words");
        assert_eq!((taken.words, taken.sender), (count, source.0.into()));
        assert_eq!(processor.read(taken.place, body.len()).expect("in memory"), body);
        assert!(span > Span::ZERO);
        assert!((0..RX_COUNT).all(|n| at(&processor, RX + n * DESCRIPTOR_BYTES) == 0));
        assert_eq!(free_entries(&processor).len(), 16);
    }
}

#[test]
fn a_message_with_a_wrong_length_or_kind_is_refused_and_the_next_message_is_received() {
    let mut processor = board();
    for (header, wrong) in [
        (0, 1),
        (MAX_WORDS + 1, 1),
        (0xFFFF, 1),
        (1 << 16 | 4, 2),
        (2 << 16 | 4, 2),
        (3 << 16 | 4, 2),
        (0xFFFF_0004, 2),
    ] {
        let (_, refused) = deliver(&mut processor, NodeId(2), header, &[]).expect("it returns");
        assert_eq!(refused, Err(Refusal(wrong)), "header {header:#x}");
        let (_, taken) = deliver(&mut processor, NodeId(2), 3, &[7, 8, 9]).expect("it returns");
        assert_eq!(taken.map(|taken| taken.words), Ok(3), "behind header {header:#x}");
    }
}

/// Tests chains of all lengths against a reference model of the descriptors, which lie in a circular buffer.
#[test]
fn a_chain_has_a_descriptor_for_each_message_and_frees_the_previous_chain() {
    let mut numbers = SplitMix64::new(23);
    let mut processor = board();
    let mut next = 0;
    let lengths = (0..=TX_COUNT).chain((0..200).map(|n| n * 7 % 60));
    for (ticket, count) in (1000..).zip(lengths) {
        let request = |numbers: &mut SplitMix64| {
            let flags = (below(numbers, 3) << 16) | (below(numbers, 2) * HOLD) | (below(numbers, 2) * 2);
            [below(numbers, 1 << 10), flags, 1 + below(numbers, MAX_WORDS), numbers.bits() as Word]
        };
        let requests: Vec<Request> = (0..count).map(|_| request(&mut numbers)).collect();
        let before = [ISSUED, COMPLETE].map(|address| at(&processor, address));
        let (_, refused) = chain(&mut processor, &requests, ticket).expect("it returns");
        assert_eq!(refused, None);
        if count == 0 {
            assert_eq!([ISSUED, COMPLETE].map(|address| at(&processor, address)), before, "nothing was done");
            continue;
        }
        assert_eq!(at(&processor, START), TX + next * DESCRIPTOR_BYTES);
        assert_eq!(at(&processor, ISSUED), before[0] + 1);
        assert_eq!(at(&processor, TX_ROOM), TX_COUNT - count, "all others are free again");
        for (number, [receiver, flags, words, address]) in (1..).zip(requests) {
            let last = if number == count { 4 } else { 0 };
            let header = [receiver << 16 | Word::from(NODE_ID.0), flags & 0xFFFF_0000 | words];
            let expected = [flags & 0xFFFF | last, header[0], header[1], address];
            let found = processor.read(TX + next * DESCRIPTOR_BYTES, 4).expect("in memory");
            assert_eq!(found, expected, "message {number} of {count}");
            next = (next + 1) % TX_COUNT;
        }
    }
}

#[test]
fn tickets_are_complete_when_a_later_chain_is_built() {
    let mut processor = board();
    for ticket in [7, 8, 9] {
        let before = at(&processor, COMPLETE);
        chain(&mut processor, &[[1, 0, 1, 0]], ticket).expect("it returns");
        assert_eq!(at(&processor, COMPLETE), if ticket == 7 { before } else { ticket - 1 });
    }
}

#[test]
fn a_chain_without_room_or_with_a_wrong_length_is_not_started() {
    let mut processor = board();
    let message = [1, 0, 5, 0];
    for (wrong, at_place) in [(0, 0), (MAX_WORDS + 1, 3), (u32::MAX, 5)] {
        let mut requests = [message; 6];
        requests[at_place][2] = wrong;
        let (_, refused) = chain(&mut processor, &requests, 1).expect("it returns");
        assert_eq!((refused, at(&processor, START), at(&processor, ISSUED)), (Some(at_place), 0, 0));
        assert_eq!(at(&processor, TX_ROOM), TX_COUNT);
    }
    chain(&mut processor, &[message; 200], 2).expect("it returns");
    // The interface has not sent these messages yet.
    processor.write(DONE, &[0]).expect("in memory");
    processor.write(REQUESTS, &[message; 57].concat()).expect("in memory");
    call(&mut processor, "send", &[(16, REQUESTS), (17, 57), (18, 3)]);
    assert_eq!((processor.register(16), at(&processor, ISSUED)), (4, 1), "56 descriptors are free");
    call(&mut processor, "send", &[(16, REQUESTS), (17, 56), (18, 3)]);
    assert_eq!((processor.register(16), at(&processor, ISSUED)), (0, 2));
}

/// Tests a message that is longer than a receive buffer. The interface must stop at the end of the buffer.
#[test]
fn a_buffer_starts_with_the_header_and_ends_at_the_next_buffer() {
    let mut processor = board();
    let [first, second] = [BUFFERS, BUFFERS + BUFFER_BYTES];
    let too_long = vec![9; BUFFER_BYTES as usize];
    processor.receive_message(NodeId(3), &Body::Words(too_long.into())).expect_err("no message has that length");
    assert_eq!(at(&processor, first), Word::from(NODE_ID.0) << 16 | 3);
    assert_eq!([second - 4, second].map(|address| at(&processor, address)), [9, 0]);
}

fn commands(words_each: u32) -> CommandList {
    let runs = vec![CommandRun { opcode: 1, words_each, count: 1 }];
    CommandList { runs, context: 0, copies: Vec::new(), content: None }
}

#[test]
fn a_chain_has_kind_and_receiver_flag_of_each_message() {
    let mut processor = board();
    let to = |node, words, body| Message { source: NODE_ID, destination: NodeId(node), words, body };
    let chain = [
        (to(4, 1, Body::Words([7].into())), true),
        (to(5, 20, Body::Commands(commands(20))), true),
        (to(6, 3, Body::Commands(commands(3))), false),
    ];
    processor.send_chain(chain.iter().map(|(message, hold)| (message, *hold))).expect("it returns");
    // Message kinds are 0 for words and 1 for commands. The last message of a chain has flag 4.
    for (number, (flags, node, kind, words)) in (0..).zip([(HOLD, 4, 0, 1), (HOLD, 5, 1, 20), (4, 6, 1, 3)]) {
        let header = [node << 16 | Word::from(NODE_ID.0), kind << 16 | words];
        let found = processor.read(TX + number * DESCRIPTOR_BYTES, 3).expect("in memory");
        assert_eq!(found, [flags, header[0], header[1]], "message {number}");
    }
}

#[test]
fn a_message_of_commands_stops_the_board_with_its_fault() {
    let mut processor = board();
    let error = processor.receive_message(NodeId(3), &Body::Commands(commands(20))).expect_err("no handler");
    assert_eq!(error.to_string(), "node 37: unexpected message of commands or pixels at a processor");
    let long: Body = Body::Words(vec![0; 1025].into());
    let error = processor.receive_message(NodeId(3), &long).expect_err("too long");
    assert_eq!(error.to_string(), "node 37: unexpected message of 1025 words from node 3");
    let message = Message { source: NODE_ID, destination: NodeId(4), words: 0, body: Body::Words([].into()) };
    let error = processor.send_chain([(&message, false)].into_iter()).expect_err("no words");
    assert_eq!(error.to_string(), "node 37: unexpected message of 0 words for node 4");
}

#[test]
fn a_memory_without_room_is_a_fault_with_the_place() {
    let mut small = Processor::new(NodeId(2), 1 << 16, CodeVersion::Compiled, i860::Config::cycle());
    let error = small.receive_message(NodeId(3), &Body::Words([1].into())).expect_err("no memory there");
    assert_eq!(error.to_string(), "graphics processor at node 2: no memory for 1 words at 0x000f2004");
}

/// Tests that a call leaves the interrupt enable bit of the register psr as it was.
#[test]
fn interrupts_are_masked_only_inside_the_ring_code() {
    let setting = i860::assemble("psr", 0x1000, "set: st.c r16, psr\n bri r1\n nop").expect("it assembles");
    let setting = Arc::new(setting);
    for psr in [0, 0x10] {
        let mut processor = board();
        processor.call(&setting, "set", &[(16, psr)], 10).expect("it returns");
        chain(&mut processor, &[[1, 0, 1, 0]], 1).expect("it returns");
        assert_eq!(processor.state().psr & 0x10, psr);
        deliver(&mut processor, NodeId(1), 1, &[1]).expect("it returns").1.expect("a message");
        assert_eq!(processor.state().psr & 0x10, psr);
        chain(&mut processor, &[[1, 0, 0, 0]], 1).expect("it returns").1.expect("refused");
        assert_eq!(processor.state().psr & 0x10, psr);
    }
}

#[test]
fn code_and_data_are_adjacent_in_memory() {
    assert!(PROGRAM.base == CODE && CODE + PROGRAM.bytes.len() as u32 <= DATA, "{} bytes", PROGRAM.bytes.len());
    // An interrupt saves at most all registers of both register files, at FRAME.
    const { assert!(DATA + 384 + 2 * 32 * 4 <= ENTRIES) };
}
