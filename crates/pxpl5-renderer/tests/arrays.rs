//! Tests of outputs, drawing, and state that is kept between commands. The arrays start with random bits.

use pxpl5_renderer::conformance::{Random, scramble};
use pxpl5_renderer::isa::{ArrayInstruction, Expression, ExpressionUse, MEMORY_BITS, Operand};
use pxpl5_renderer::{
    BitSerial, Command, CopyRegion, Lanes, Layout, PhongSphereCommand, PhongTriangleCommand, PixelArray, Plane,
    SphereBody, SphereCommand, TriangleCommand,
};
use pxpl5_wire::{
    CommandContent, CommandWords, CopyTarget, Linear, Lines, NodeId, PictureNumber, Quadratic, RegionGrid, RegionId,
    Word,
};
use std::sync::Arc;

fn layouts() -> [Layout; 3] {
    [Layout::rendering_control_phong(), Layout::slats(), Layout::slats_quarters()]
}

/// Returns a target in a picture of 100 x 75 pixels with regions of 30 x 20. Regions at the right border are 10 pixels
/// wide, and regions at the bottom are 15 pixels high.
fn target(region: u16) -> CopyTarget {
    CopyTarget {
        frame_buffer: NodeId(9),
        buffer: 1,
        lines: Lines::Frame,
        grid: RegionGrid { width: 100, height: 75, region_width: 30, region_height: 20 },
        region: RegionId(region),
        picture: PictureNumber(77),
    }
}

/// Returns `bits` bits of the upper left pixels, from bit `first` on, row by row.
fn expected(planes: &[Plane], first: usize, bits: usize, [width, height]: [usize; 2]) -> Vec<Word> {
    let pixel = |x: usize, y: usize| {
        let bit = |i: usize| planes[first + i][2 * y + x / 64] >> (x % 64) & 1;
        (0..bits).map(|i| (bit(i) as Word) << i).sum()
    };
    (0..height).flat_map(|y| (0..width).map(move |x| pixel(x, y))).collect()
}

fn sends_what_its_planes_hold(mut array: impl PixelArray, layout: &Layout) {
    scramble(&mut Random::new(1), &mut array, &mut BitSerial::new(layout));
    let planes: Vec<Plane> = (0..MEMORY_BITS as usize).map(|bit| array.plane(bit)).collect();
    for (first, (region, size)) in
        (0..=184).zip([(0, [30, 20]), (3, [10, 20]), (12, [30, 15]), (15, [10, 15])].into_iter().cycle())
    {
        let mut words = Vec::new();
        let field = Operand::absolute(first, 24);
        ArrayInstruction::Output { field, target: target(region) }.encode(&mut words);
        let [output] = &array.execute(&words).expect("a field and a region").outputs[..] else { panic!("one") };
        assert_eq!(output.target, target(region));
        assert_eq!(output.pixels[..], expected(&planes, first.into(), 24, size), "bits from {first} on");
    }
    let Operand { address, width, .. } = layout.plan().colour;
    for size in [[128, 128], [128, 3], [1, 128], [40, 30], [0, 5]] {
        let [w, h] = size;
        let found = array.read_colour(w as u32, h as u32);
        assert_eq!(found[..], expected(&planes, address.into(), width.into(), size), "{size:?}");
    }
    assert_eq!(array.read_colour(1000, 2)[..], expected(&planes, address.into(), width.into(), [128, 2]));
}

#[test]
fn arrays_send_the_contents_of_their_bit_planes() {
    for layout in layouts() {
        sends_what_its_planes_hold(BitSerial::new(&layout), &layout);
        sends_what_its_planes_hold(Lanes::new(&layout), &layout);
    }
}

#[derive(Debug)]
struct Words(Vec<Word>);

impl CommandWords for Words {
    fn append_words(&self, _: u32, out: &mut Vec<Word>) {
        out.extend(&self.0);
    }
}

fn draws_what_it_executes(mut drawing: impl PixelArray, mut executing: impl PixelArray, layout: &Layout) {
    scramble(&mut Random::new(2), &mut drawing, &mut executing);
    let mut random = Random::new(3);
    for fault in [false, false, true] {
        let mut words = random.list(layout);
        let copied = Command::CopyRegion(CopyRegion { target: target(3) });
        copied.encode(layout, &mut words).expect("no field but the colour");
        if fault {
            words.push(Word::MAX);
        }
        let expected = executing.execute(&words).map_or_else(|_| Vec::new(), |executed| executed.outputs);
        assert_eq!(expected.len(), usize::from(!fault));
        // Earlier content of the scratch memory must not matter.
        let outputs = drawing.draw(&CommandContent::new(Arc::new(Words(words)), 0), &mut vec![Word::MAX]);
        assert_eq!(outputs, expected);
        assert_eq!(drawing.faults(), executing.faults());
        for bit in 0..MEMORY_BITS as usize {
            assert_eq!(drawing.plane(bit), executing.plane(bit), "bit {bit}");
        }
    }
}

#[test]
fn drawing_a_command_list_gives_the_same_pixels_as_executing_the_list() {
    for layout in layouts() {
        draws_what_it_executes(BitSerial::new(&layout), BitSerial::new(&layout), &layout);
        draws_what_it_executes(Lanes::new(&layout), Lanes::new(&layout), &layout);
    }
}

const SILHOUETTE: Quadratic = Quadratic { xx: -1, xy: 0, yy: -1, x: 80, y: 80, one: -3000 };

fn linear(i: i32) -> Linear {
    Linear { a: 1000 + i, b: -2000 - i, c: 3_000_000 + i }
}

fn planes(i: i32) -> [Linear; 3] {
    [linear(i), linear(i + 10), linear(i + 20)]
}

/// Returns a command of a kind, its last linear coefficients, and its last quadratic coefficients.
fn command(kind: usize, i: i32) -> (Command, Linear, Quadratic) {
    let body = SphereBody { silhouette: SILHOUETTE, root_shift: 0, depth: linear(i), depth_shift: 3 };
    let [edges, depth, components] = [planes(i), planes(i + 30), planes(i + 60)];
    match kind {
        0 => {
            let triangle = TriangleCommand { edges, depth: depth[0], colour: components };
            (Command::Triangle(triangle), components[2], Quadratic::default())
        }
        1 => {
            let triangle = PhongTriangleCommand { edges, depth: depth[0], normal: components, colour: 7 };
            (Command::PhongTriangle(triangle), components[2], Quadratic::default())
        }
        2 => {
            let sphere = SphereCommand { body, colour: components, root_factor: [3, -4, 5] };
            (Command::Sphere(sphere), components[2], SILHOUETTE)
        }
        _ => {
            let sphere = PhongSphereCommand { body, normal: [components[0], components[1]], colour: 7 };
            (Command::PhongSphere(sphere), components[1], SILHOUETTE)
        }
    }
}

/// Executes three commands of a kind, which an array can draw together. Then stores the last expression in 32 bits of
/// every pixel.
fn holds_the_last_coefficients(mut array: impl PixelArray, layout: &Layout, kind: usize) -> bool {
    let mut words = Vec::new();
    let [.., (_, linear, quadratic)] = [1, 2, 3].map(|i| {
        let some = command(kind, i);
        let _ = some.0.encode(layout, &mut words);
        some
    });
    if words.is_empty() {
        return false;
    }
    ArrayInstruction::EnableAll { label: 0 }.encode(&mut words);
    let fields = [Operand::absolute(9, 32), Operand::absolute(50, 32)];
    for (expression, field) in [Expression::LinearAgain, Expression::QuadraticAgain].into_iter().zip(fields) {
        let usage = ExpressionUse::Load { field, shift: 0 };
        ArrayInstruction::Evaluate { expression, usage }.encode(&mut words);
    }
    array.execute(&words).expect("instructions");
    for [x, y] in [[0, 0], [127, 0], [0, 127], [100, 57]] {
        let bit = |bit: usize| array.plane(bit)[2 * y + x / 64] >> (x % 64) & 1;
        let [held_linear, held_quadratic] = [9, 50].map(|first| (0..32).map(|i| (bit(first + i) as u32) << i).sum());
        let expected = (linear.at(x as i32, y as i32) as u32, quadratic.at(x as i32, y as i32) as u32);
        assert_eq!((held_linear, held_quadratic), expected, "kind {kind} at {x}, {y}");
    }
    true
}

#[test]
fn the_evaluator_holds_the_last_coefficients_of_a_command() {
    let mut held = 0;
    for layout in layouts() {
        for kind in 0..4 {
            held += u32::from(holds_the_last_coefficients(BitSerial::new(&layout), &layout, kind));
            held += u32::from(holds_the_last_coefficients(Lanes::new(&layout), &layout, kind));
        }
    }
    assert!(held >= 12, "{held}");
}
