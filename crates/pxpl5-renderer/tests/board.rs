//! Tests of a single renderer board: start times of commands, and messages of regions to the ring. The expected times
//! follow from the rules of the FIFO and the timing table.

use crate::support::{self, Bench, CYCLE, DISPLAY, HOST, NODE, WORD, list, order, run};
use pxpl5_renderer::{CommandKind, RendererStats, RendererTiming};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Body, CommandRun, CopyContent, CopyPath, NodeId, RegionId};

const BEGIN: Time = Time(1_000_000_000);
/// Time of a triangle: 258 clocks of 25 ns.
const TRIANGLE: Span = Span(258 * 25_000);
/// Time to move a region's colours to the backing store: 2,040 clocks of 25 ns (F89's 51 us).
const BLOCK: Span = Span(51_000_000);
/// Time for a copy command of nine words to enter the FIFO.
const COPY_WORDS: Span = Span(9 * 50_000);

#[test]
fn commands_take_the_time_of_their_words_and_then_their_clocks() {
    let mut bench = Bench::new();
    bench.announce(BEGIN, list(&[run(CommandKind::Triangle, 3)], &[]));
    bench.run();
    assert_eq!(bench.accepted(), [(BEGIN + CYCLE, BEGIN + WORD * 90)]);
    assert_eq!(bench.device.busy(), TRIANGLE * 3);
    assert_eq!(bench.device.stats(), RendererStats { commands: 3, words: 90, ..RendererStats::default() });
}

#[test]
fn invalid_words_are_counted_and_take_no_clocks() {
    let mut bench = Bench::new();
    bench.message(BEGIN, 4, Body::Words([1, 2, 3, 4].into()));
    bench.announce(BEGIN, list(&[CommandRun { opcode: 77, words_each: 2, count: 5 }], &[]));
    bench.run();
    let expected = RendererStats { commands: 5, words: 14, regions_copied: 0, illegal_commands: 6 };
    assert_eq!((bench.device.stats(), bench.device.busy()), (expected, Span::ZERO));
    assert_eq!(bench.accepted()[1].1, BEGIN + WORD * 14);
}

#[test]
fn a_region_leaves_in_whole_messages_and_the_last_one_is_acknowledged() {
    // The region has 100 x 100 pixels.
    for (content, words, parts) in [(CopyContent::Colour, 10_000, 10), (CopyContent::ColourAndDepth, 20_000, 20)] {
        let mut bench = Bench::new();
        let order = order(1, CopyPath::FromPixelMemory, content);
        bench.announce(BEGIN, list(&[run(CommandKind::CopyRegion, 1)], &[order]));
        bench.run();
        let sent = bench.sent();
        assert_eq!(sent.len(), parts);
        assert_eq!(sent.iter().map(|sent| sent.message.words).sum::<u32>(), words);
        for (part, sent) in (0..).zip(&sent) {
            let is_last = part + 1 == parts as u32;
            assert_eq!(sent.at, BEGIN + COPY_WORDS + CYCLE);
            assert_eq!((sent.message.source, sent.message.destination), (NODE, DISPLAY));
            assert_eq!((sent.ticket, sent.hold), (is_last, !is_last));
            assert!(is_last || sent.message.words == 1_024);
            let Body::Pixels(pixels) = &sent.message.body else { panic!("{sent:?}") };
            assert_eq!((pixels.part, pixels.parts as usize, pixels.target), (part, parts, order.target));
            assert_eq!(pixels.image.pixels().len(), words as usize);
        }
    }
}

#[test]
fn the_board_that_ordered_a_copy_is_notified_when_the_last_pixel_has_arrived() {
    let mut bench = Bench::new();
    let order = order(1, CopyPath::FromPixelMemory, CopyContent::Colour);
    bench.announce(BEGIN, list(&[run(CommandKind::CopyRegion, 1)], &[order]));
    let sent_at = BEGIN + Span::from_us(600);
    bench.delivered(sent_at);
    bench.run();
    let sent = bench.sent();
    let last = sent.last().expect("a message");
    assert_eq!((last.at, last.message.source, last.message.destination), (sent_at + CYCLE, NODE, HOST));
    assert_eq!((last.message.words, last.ticket, last.hold), (4, false, false));
    let Body::Words(words) = &last.message.body else { panic!("{last:?}") };
    assert_eq!(**words, [0xC0_11_ED, 1, order.target.picture.0 as u32, u32::from(DISPLAY.0)]);
    assert_eq!(bench.device.stats().regions_copied, 1);
}

#[test]
fn commands_behind_a_copy_from_pixel_memory_wait_for_its_last_pixel() {
    let mut bench = Bench::new();
    let copy = run(CommandKind::CopyRegion, 1);
    let orders = [1, 2].map(|region| order(region, CopyPath::FromPixelMemory, CopyContent::Colour));
    bench.announce(BEGIN, list(&[copy, run(CommandKind::Triangle, 1), copy], &orders));
    let sent_at = BEGIN + Span::from_us(600);
    bench.run();
    let snapshot = bench.device.snapshot(BEGIN + Span::from_us(100));
    assert_eq!((snapshot.stands_at_copy, snapshot.copying, snapshot.busy), (true, Some(orders[0]), Span::ZERO));
    let target = bench.device.blocked().expect("it waits");
    assert_eq!((target.frame_buffer, target.region), (NodeId(9), RegionId(1)));
    bench.delivered(sent_at);
    bench.run();
    assert_eq!(bench.device.busy(), TRIANGLE);
    assert_eq!(bench.sent().last().expect("sent").at, sent_at + TRIANGLE + CYCLE);
    bench.delivered(sent_at + Span::from_us(600));
    bench.run();
    let snapshot = bench.device.snapshot(sent_at + Span::from_us(600));
    assert_eq!((snapshot.stands_at_copy, snapshot.copying), (false, None));
    assert_eq!(bench.device.blocked(), None);
}

/// Returns the times at which the first pixels of each region were sent.
fn departures(bench: &Bench) -> Vec<Time> {
    let is_first = |sent: &support::Sent| matches!(&sent.message.body, Body::Pixels(pixels) if pixels.part == 0);
    bench.sent().into_iter().filter(is_first).map(|sent| sent.at).collect()
}

#[test]
fn a_region_in_the_backing_store_leaves_during_the_following_commands() {
    for (content, blocks) in [(CopyContent::Colour, 1), (CopyContent::ColourAndDepth, 2)] {
        let mut bench = Bench::new();
        let copy = run(CommandKind::CopyRegion, 1);
        let orders = [1, 2].map(|region| order(region, CopyPath::ThroughBacking, content));
        bench.announce(BEGIN, list(&[copy, run(CommandKind::Triangle, 1), copy], &orders));
        let stored = BEGIN + COPY_WORDS + BLOCK * blocks;
        bench.run_until(Time(stored.0 - 1));
        assert_eq!((bench.device.snapshot(stored).stored_regions, departures(&bench).len()), (1, 0));
        bench.run();
        assert_eq!(bench.device.busy(), TRIANGLE);
        let snapshot = bench.device.snapshot(stored + TRIANGLE + BLOCK * blocks);
        assert_eq!((snapshot.stored_regions, snapshot.copying), (1, Some(orders[0])));
        let sent_at = stored + Span::from_us(900);
        bench.delivered(sent_at);
        bench.run();
        assert_eq!(departures(&bench), [stored + CYCLE, sent_at + CYCLE]);
        assert_eq!(bench.device.snapshot(sent_at).stored_regions, 0);
    }
}

#[test]
fn if_the_backing_store_is_full_the_next_region_waits_for_room() {
    use CopyContent::{Colour, ColourAndDepth};
    // A region occupies one block of the backing store, or two blocks with depths. A region that is being sent can
    // still occupy a block.
    for (places, content, waits) in
        [(1, Colour, true), (2, Colour, false), (3, ColourAndDepth, true), (4, ColourAndDepth, false)]
    {
        let timing = RendererTiming { backing_bits: 32 * places, ..RendererTiming::PAPERS };
        let mut bench = Bench::with(timing);
        let orders = [1, 2].map(|region| order(region, CopyPath::ThroughBacking, content));
        bench.announce(BEGIN, list(&[run(CommandKind::CopyRegion, 2)], &orders));
        let sent_at = BEGIN + Span::from_us(900);
        bench.delivered(sent_at);
        bench.run();
        let block = BLOCK * u64::from(content.words());
        let stored = if waits { sent_at + block } else { sent_at };
        assert_eq!(departures(&bench), [BEGIN + COPY_WORDS + block + CYCLE, stored + CYCLE], "{places} {content:?}");
    }
}

#[test]
fn a_stored_region_leaves_once_when_a_command_requests_it() {
    let mut bench = Bench::new();
    let kept = order(1, CopyPath::IntoBacking, CopyContent::Colour);
    let asked = order(1, CopyPath::FromBacking, CopyContent::Colour);
    let other = order(2, CopyPath::FromBacking, CopyContent::Colour);
    let copy = run(CommandKind::CopyRegion, 1);
    bench.announce(BEGIN, list(&[copy], &[kept]));
    bench.announce(BEGIN + Span::from_us(400), list(&[copy], &[other]));
    bench.run();
    assert_eq!((departures(&bench).len(), bench.device.stats().illegal_commands), (0, 1));
    let asked_at = BEGIN + Span::from_us(500);
    bench.announce(asked_at, list(&[copy, copy, run(CommandKind::Triangle, 1)], &[asked, asked]));
    bench.run();
    assert_eq!(departures(&bench), [asked_at + COPY_WORDS + CYCLE]);
    assert_eq!((bench.device.stats().illegal_commands, bench.device.busy()), (2, TRIANGLE));
}

#[test]
fn a_copy_command_without_an_order_ends_at_once() {
    let mut bench = Bench::new();
    bench.announce(BEGIN, list(&[run(CommandKind::CopyRegion, 1), run(CommandKind::Triangle, 1)], &[]));
    bench.run();
    assert_eq!((bench.device.stats().illegal_commands, bench.device.busy()), (1, TRIANGLE));
    assert!(bench.sent().is_empty());
}

/// Sends two triangles in one message, or in two messages. The second message is announced before the first has
/// arrived.
#[test]
fn an_observed_fifo_counts_a_word_until_the_command_of_the_word_starts() {
    for messages in [1, 2] {
        let mut bench = Bench::new();
        bench.device.watch_fifo();
        for message in 0..messages {
            let triangles = run(CommandKind::Triangle, 2 / messages);
            bench.announce(BEGIN + Span(message.into()), list(&[triangles], &[]));
        }
        bench.run();
        // The second triangle is complete after 60 words. It starts at the end of the first triangle, which started
        // after 30 words.
        let [first, second, started] = [WORD * 30, WORD * 60, WORD * 30 + TRIANGLE].map(|span| BEGIN + span);
        let words = |at: Time| bench.device.snapshot(at).fifo_words;
        assert_eq!([BEGIN, first, Time(second.0 - 1)].map(words), [Some(0); 3]);
        assert_eq!([second, Time(started.0 - 1)].map(words), [Some(30); 2]);
        assert_eq!(words(started), Some(0));
        assert_eq!(bench.device.snapshot(BEGIN).fifo_depth_words, 1_024);
        let mut changes = bench.device.take_fifo_changes();
        changes.sort_unstable();
        assert_eq!(changes, [(first, -30), (first, 30), (second, 30), (started, -30)]);
        assert!(bench.device.take_fifo_changes().is_empty());
    }
}

#[test]
fn an_unwatched_fifo_has_no_counts() {
    let mut bench = Bench::new();
    bench.announce(BEGIN, list(&[run(CommandKind::Triangle, 2)], &[]));
    bench.run();
    assert_eq!(bench.device.snapshot(BEGIN).fifo_words, None);
    assert!(bench.device.take_fifo_changes().is_empty() && bench.device.array_at(BEGIN).is_none());
}

#[test]
fn a_delivery_without_a_message_starts_no_copy() {
    let mut bench = Bench::new();
    bench.delivered(BEGIN);
    bench.run();
    assert_eq!(bench.device.stats(), RendererStats::default());
    assert!(bench.sent().is_empty() && bench.device.blocked().is_none());
}
