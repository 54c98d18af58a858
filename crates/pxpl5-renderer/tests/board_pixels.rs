//! Tests of the content of a renderer board's regions. The content follows from the lists that are sent to the region's
//! context before the copy or the read.

use crate::support::{Bench, WORD, list, list_of, order, run};
use pxpl5_renderer::{Clear, Command, CommandKind, Lanes, PixelArray, SelectRegion, TriangleCommand};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Body, CommandList, CopyContent, CopyOrder, CopyPath, CopyTarget, Linear, Word};
use std::sync::Arc;

const BEGIN: Time = Time(1_000_000_000);
const FARTHEST: Word = 0xFF_FFFF;

fn select(context: u8) -> Command {
    Command::SelectRegion(SelectRegion { context, left: 0, top: 0 })
}

const fn clear(colour: Word) -> Command {
    Command::Clear(Clear { colour })
}

fn copy(target: CopyTarget) -> Command {
    Command::CopyRegion(pxpl5_renderer::CopyRegion { target })
}

/// Returns a list that fills a region with one colour and copies it.
fn painted(colour: Word, order: CopyOrder) -> CommandList {
    list_of(&[select(0), clear(colour), copy(order.target)], &[order])
}

fn images(bench: &Bench) -> Vec<Arc<[Word]>> {
    let images = bench.sent().into_iter().filter_map(|sent| match sent.message.body {
        Body::Pixels(pixels) if pixels.part == 0 => Some(pixels.image.pixels()),
        _ => None,
    });
    images.collect()
}

#[test]
fn a_region_is_copied_as_it_was_when_its_copy_was_sent() {
    for saves in [true, false] {
        let mut bench = Bench::new();
        if !saves {
            bench.device.draw_every_region();
        }
        let orders = [1, 2].map(|region| order(region, CopyPath::ThroughBacking, CopyContent::Colour));
        let colours = [0x10_20_30, 0x40_50_60];
        bench.announce(BEGIN, painted(colours[0], orders[0]));
        bench.announce(BEGIN + Span::from_us(1), painted(colours[1], orders[1]));
        bench.delivered(BEGIN + Span::from_us(900));
        bench.run();
        let images = images(&bench);
        // The regions have 100 x 100 and 10 x 100 pixels.
        assert_eq!(images.iter().map(|image| image.len()).collect::<Vec<_>>(), [10_000, 1_000]);
        for (image, colour) in images.iter().zip(colours) {
            assert!(image.iter().all(|pixel| *pixel == colour), "{colour:x}");
        }
    }
}

#[test]
fn copied_depths_follow_the_colours_and_are_far_if_nothing_was_drawn() {
    let mut bench = Bench::new();
    let order = order(1, CopyPath::ThroughBacking, CopyContent::ColourAndDepth);
    bench.announce(BEGIN, painted(0x10_20_30, order));
    bench.run();
    let image = &images(&bench)[0];
    assert_eq!(image.len(), 20_000);
    assert!(image[..10_000].iter().all(|pixel| *pixel == 0x10_20_30));
    assert!(image[10_000..].iter().all(|depth| *depth == FARTHEST));
}

/// The 20 bits of depth in the layout of Slats are the upper bits of a depth of 24 bits. The 24 bits are the upper bits
/// of the depth expression's 32 bits.
#[test]
fn the_copied_depths_are_the_upper_bits_of_24_bit_depths() {
    let inside = Linear::constant(1);
    let depth = Linear::constant(0x1234_5678);
    let triangle = Command::Triangle(TriangleCommand { edges: [inside; 3], depth, colour: [Linear::constant(0); 3] });
    let order = order(1, CopyPath::ThroughBacking, CopyContent::ColourAndDepth);
    let mut bench = Bench::new();
    bench.announce(BEGIN, list_of(&[select(0), clear(0x10_20_30), triangle, copy(order.target)], &[order]));
    bench.run();
    assert!(images(&bench)[0][10_000..].iter().all(|depth| *depth == 0x12_3450));
}

/// A copy must not contain drawing after the copy in the same list, or pixels that are copied to another target.
#[test]
fn commands_behind_a_copy_do_not_change_the_copied_pixels() {
    for saves in [true, false] {
        let mut bench = Bench::new();
        if !saves {
            bench.device.draw_every_region();
        }
        let orders = [1, 0].map(|region| order(region, CopyPath::ThroughBacking, CopyContent::Colour));
        let [first, second] = orders.map(|order| copy(order.target));
        let commands = [select(0), clear(0x10_20_30), first, clear(0x40_50_60), second, clear(0x70_80_90)];
        bench.announce(BEGIN, list_of(&commands, &orders));
        bench.delivered(BEGIN + Span::from_us(900));
        bench.run();
        let colours: Vec<Word> = images(&bench).iter().map(|image| image[0]).collect();
        assert_eq!(colours, [0x10_20_30, 0x40_50_60], "{saves}");
    }
}

#[test]
fn a_region_without_words_is_black() {
    let mut bench = Bench::new();
    let order = order(1, CopyPath::ThroughBacking, CopyContent::ColourAndDepth);
    bench.announce(BEGIN, list(&[run(CommandKind::Clear, 1), run(CommandKind::CopyRegion, 1)], &[order]));
    bench.run();
    assert!(bench.device.pixel_memory().is_none());
    assert_eq!(images(&bench), [vec![0; 20_000].into()]);
}

/// Returns the colour of the selected context at a pixel.
fn colour(array: &Lanes) -> Word {
    array.read_colour(1, 1)[0]
}

#[test]
fn pixel_memory_has_everything_drawn_since_the_last_clear() {
    let mut bench = Bench::new();
    bench.announce(BEGIN, list_of(&[select(0)], &[]));
    bench.run();
    assert!(bench.device.pixel_memory().is_none());
    for (us, colour_sent) in [(100, 0x10_20_30), (200, 0x40_50_60)] {
        let at = BEGIN + Span::from_us(us);
        bench.announce(at, list_of(&[select(0), clear(colour_sent)], &[]));
        bench.run();
        assert_eq!(bench.device.pixel_memory().as_ref().map(colour), Some(colour_sent));
    }
}

/// A command has its effect from its start on. A select has two words, and a clear has five words. The earlier picture
/// is visible until the clear starts. The second clear starts after five selects of six clocks.
#[test]
fn a_snapshot_of_the_array_shows_all_commands_that_have_started() {
    let mut bench = Bench::new();
    bench.device.watch_fifo();
    let second = BEGIN + Span::from_us(100);
    bench.announce(BEGIN, list_of(&[select(0), clear(0x10_20_30)], &[]));
    bench.announce(second, list_of(&[[select(0); 5].as_slice(), &[clear(0x40_50_60)]].concat(), &[]));
    let seen = |bench: &Bench, at: Time| bench.device.array_at(at).as_ref().map(colour);
    bench.run_until(BEGIN);
    assert_eq!(seen(&bench, Time((BEGIN + WORD * 2).0 - 1)), None);
    assert_eq!(seen(&bench, Time((BEGIN + WORD * 7).0 - 1)), Some(0));
    assert_eq!(seen(&bench, BEGIN + WORD * 7), Some(0x10_20_30));
    bench.run();
    let clears = second + WORD * 2 + Span::from_ns(5 * 6 * 25);
    assert_eq!(seen(&bench, second + WORD * 2), Some(0x10_20_30));
    assert_eq!(seen(&bench, Time(clears.0 - 1)), Some(0x10_20_30));
    assert_eq!(seen(&bench, clears), Some(0x40_50_60));
    let third = second + Span::from_us(100);
    bench.announce(third, list_of(&[clear(0x70_80_90)], &[]));
    bench.run();
    assert_eq!(seen(&bench, Time((third + WORD * 5).0 - 1)), Some(0x40_50_60));
    assert_eq!(seen(&bench, third + WORD * 5), Some(0x70_80_90));
}

/// Arrays are reused for other regions, so an array can hold old content.
#[test]
fn a_region_that_was_never_cleared_is_black() {
    let mut bench = Bench::new();
    let orders = [1, 2].map(|region| order(region, CopyPath::ThroughBacking, CopyContent::Colour));
    bench.announce(BEGIN, painted(0x10_20_30, orders[0]));
    let other = CopyOrder { context: 1, ..orders[1] };
    let list = list_of(&[select(0), Command::WaitBacking, copy(other.target)], &[other]);
    bench.announce(BEGIN + Span::from_us(1), CommandList { context: 1, ..list });
    bench.delivered(BEGIN + Span::from_us(900));
    bench.run();
    let images = images(&bench);
    assert!(images[0].iter().all(|pixel| *pixel == 0x10_20_30) && images[1].iter().all(|pixel| *pixel == 0));
}

/// The board has eight contexts, so context 9 is the same as context 1.
#[test]
fn commands_for_another_context_do_not_change_the_copied_pixels() {
    for (sent, copied) in [(1, 1), (1, 9), (9, 1)] {
        let mut bench = Bench::new();
        let order = CopyOrder { context: copied, ..order(1, CopyPath::ThroughBacking, CopyContent::Colour) };
        let first = CommandList { context: sent, ..list_of(&[select(0), clear(0x10_20_30)], &[]) };
        bench.announce(BEGIN, first);
        bench.announce(BEGIN + Span::from_us(10), list_of(&[select(0), clear(0x40_50_60)], &[]));
        bench.announce(BEGIN + Span::from_us(20), list(&[run(CommandKind::CopyRegion, 1)], &[order]));
        bench.run();
        assert!(images(&bench)[0].iter().all(|pixel| *pixel == 0x10_20_30), "{sent} {copied}");
    }
}

#[test]
fn a_clear_hides_no_pixels_of_another_context() {
    let mut bench = Bench::new();
    bench.device.watch_fifo();
    for (us, context, colour_sent) in [(0, 1, 0x10_20_30), (100, 0, 0x40_50_60)] {
        let list = list_of(&[select(context), clear(colour_sent)], &[]);
        bench.announce(BEGIN + Span::from_us(us), CommandList { context, ..list });
    }
    let again = list_of(&[select(1), Command::WaitBacking], &[]);
    bench.announce(BEGIN + Span::from_us(200), CommandList { context: 1, ..again });
    bench.run();
    let seen = |us: u64| bench.device.array_at(BEGIN + Span::from_us(us)).as_ref().map(colour);
    assert_eq!([seen(199), seen(300)], [Some(0x40_50_60), Some(0x10_20_30)]);
}
