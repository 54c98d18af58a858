//! Both pixel arrays agree in every bit. `PXPL5_FUZZ_SECONDS` sets how long the random part runs.

use pxpl5_renderer::conformance::{self, Mismatch, Random};
use pxpl5_renderer::{BitSerial, Clear, Command, CopyRegion, Lanes, Layout, PixelArray, SelectRegion, Vectors};
use pxpl5_wire::{CopyTarget, FieldParity, Lines, NodeId, RegionGrid, RegionId};
use std::time::{Duration, Instant};

/// Rounds of each layout without the variable.
const ROUNDS: u64 = 20;

fn layouts() -> [Layout; 3] {
    [Layout::rendering_control_phong(), Layout::slats(), Layout::slats_quarters()]
}

fn check(result: Result<(), Mismatch>) {
    if let Err(mismatch) = result {
        panic!("{mismatch}");
    }
}

#[test]
fn every_instruction_agrees_with_corner_operands() {
    let layout = Layout::slats();
    check(conformance::instructions(&mut BitSerial::new(&layout), &mut Lanes::new(&layout)));
}

#[test]
fn commands_agree_on_every_vector_unit() {
    for vectors in Vectors::available() {
        for layout in layouts() {
            let mut definition = BitSerial::with_vectors(&layout, Vectors::Portable);
            let mut subject = Lanes::with_vectors(&layout, vectors);
            check(conformance::commands(&layout, &mut definition, &mut subject));
        }
    }
}

#[test]
fn bit_planes_agree_on_every_vector_unit() {
    let layout = Layout::rendering_control_phong();
    for vectors in Vectors::available() {
        let mut definition = BitSerial::with_vectors(&layout, Vectors::Portable);
        let mut subject = BitSerial::with_vectors(&layout, vectors);
        check(conformance::commands(&layout, &mut definition, &mut subject));
    }
}

#[test]
fn random_lists_agree() {
    let seconds = std::env::var("PXPL5_FUZZ_SECONDS").ok();
    let limit = seconds.map(|text| Duration::from_secs(text.parse().expect("a number of seconds")));
    let start = Instant::now();
    let more = |round: u64| limit.map_or(round < ROUNDS, |limit| start.elapsed() < limit);
    let layouts = layouts();
    let mut arrays = layouts.map(|layout| (BitSerial::new(&layout), Lanes::new(&layout)));
    let mut round = 0;
    while more(round) {
        for (layout, (definition, subject)) in layouts.iter().zip(&mut arrays) {
            check(conformance::random_round(layout, 1000 + round, definition, subject));
        }
        round += 1;
    }
}

#[test]
fn constants_of_a_command_agree_whatever_they_are() {
    for layout in layouts() {
        let (mut a, mut b) = (BitSerial::new(&layout), Lanes::new(&layout));
        let mut words = Vec::new();
        Command::Clear(Clear { colour: 0x12_3456 }).encode(&layout, &mut words).unwrap();
        // The depth that a clear always sets to the far plane, with one bit flipped on the way.
        words[4] ^= 1 << 13;
        check(conformance::agree(&mut a, &mut b, &words, &"a clear to a nearer depth"));
    }
}

#[test]
fn both_arrays_send_the_same_pixels_of_a_context_to_a_frame_buffer() {
    let layout = Layout::slats();
    let (mut a, mut b) = (BitSerial::new(&layout), Lanes::new(&layout));
    conformance::scramble(&mut Random::new(3), &mut a, &mut b);
    let target = CopyTarget {
        frame_buffer: NodeId(9),
        buffer: 1,
        lines: Lines::Field(FieldParity::Odd),
        grid: RegionGrid::FIELD,
        region: RegionId(9),
        picture: 77,
    };
    let mut words = Vec::new();
    let select = SelectRegion { context: 2, left: 512, top: 120 };
    Command::SelectRegion(select).encode(&layout, &mut words).unwrap();
    Command::CopyRegion(CopyRegion { target }).encode(&layout, &mut words).unwrap();
    check(conformance::agree(&mut a, &mut b, &words, &"copy"));
    let outputs = b.execute(&words).unwrap().outputs;
    assert_eq!((outputs.len(), outputs[0].target), (1, target));
    assert_eq!(outputs[0].pixels, a.read_colour(128, 120));
    // Pixel (70, 3) from its 24 planes.
    let planes = (0..24).map(|i| (a.plane(88 + i)[2 * 3 + 1] >> 6 & 1) << i);
    assert_eq!(u64::from(outputs[0].pixels[3 * 128 + 70]), planes.sum::<u64>());
}

#[test]
fn a_single_wrong_bit_is_found() {
    let layout = Layout::slats();
    let (mut a, mut b) = (BitSerial::new(&layout), BitSerial::new(&layout));
    let mut plane = b.plane(207);
    plane[3] |= 1 << 5;
    b.set_plane(207, &plane);
    let mismatch = conformance::agree(&mut a, &mut b, &[], &"nothing").unwrap_err();
    assert!(mismatch.difference.starts_with("bit 207 of pixel (69, 1)"), "{mismatch}");
}
