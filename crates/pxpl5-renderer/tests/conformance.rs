//! Tests that all pixel arrays agree in every bit. `PXPL5_FUZZ_SECONDS` sets the duration of the random part.

use pxpl5_renderer::conformance::{self, Mismatch, Random};
use pxpl5_renderer::isa::{ArrayInstruction, Expression, ExpressionUse, Operand};
use pxpl5_renderer::{
    ArrayFault, BitSerial, Clear, Command, CopyRegion, Executed, Lanes, Layout, PhongSphereCommand,
    PhongTriangleCommand, PixelArray, Plane, SelectRegion, Shade, SphereBody, SphereCommand, TriangleCommand, Vectors,
};
use pxpl5_wire::{
    CopyTarget, FieldParity, Linear, Lines, NodeId, PictureNumber, Quadratic, RegionGrid, RegionId, Word,
};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Number of rounds for each layout if the environment variable is not set.
const ROUNDS: u64 = 20;

/// Number of lists for each vector unit.
const CORNER_RUNS: u64 = 300;

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
fn an_array_that_skips_unnecessary_work_has_the_same_results_on_any_vector_unit() {
    for vectors in Vectors::available() {
        for layout in layouts() {
            let mut definition = BitSerial::new(&layout);
            let mut subject = BitSerial::with_vectors(&layout, vectors).skipping();
            check(conformance::instructions(&mut definition, &mut subject));
            check(conformance::commands(&layout, &mut definition, &mut subject));
        }
    }
}

/// Compares lists of commands on every vector unit, each of them on the results of the lists before it.
fn lists_agree(layouts: &[Layout], rounds: u32, list: impl Fn(&mut Random, &Layout, u32) -> Vec<Command>) {
    for vectors in Vectors::available() {
        for layout in layouts {
            let mut random = Random::new(77);
            let mut definition = BitSerial::new(layout);
            let mut subject = Lanes::with_vectors(layout, vectors);
            conformance::scramble(&mut random, &mut definition, &mut subject);
            for round in 0..rounds {
                let commands = list(&mut random, layout, round);
                let mut words = Vec::new();
                commands.iter().for_each(|c| c.encode(layout, &mut words).expect("the layout has what it needs"));
                check(conformance::agree(&mut definition, &mut subject, &words, &commands));
            }
        }
    }
}

/// Tests triangles of common sizes at the borders of the array and of vectors. Errors in the rows and columns that a
/// fast array adds or leaves out for its vectors appear here.
#[test]
fn small_triangles_agree_where_the_array_ends_on_every_vector_unit() {
    lists_agree(&layouts()[..2], 60, |random, layout, _| (0..20).map(|_| small_triangle(random, layout)).collect());
}

/// Returns a triangle whose box is up to 20 pixels wide and 9 high, near a border or anywhere.
fn small_triangle(random: &mut Random, layout: &Layout) -> Command {
    let width = 1 + below(random, 20);
    let height = 1 + below(random, 9);
    let left = small_box_begins(random, width);
    let top = small_box_begins(random, height);
    let p = [left, top + below(random, height + 1)];
    let q = [left + width, top + below(random, height + 1)];
    let r = [left + below(random, width + 1), [top, top + height][below(random, 2) as usize]];
    let area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    let edges = if area < 0 { [edge(p, r), edge(r, q), edge(q, p)] } else { [edge(p, q), edge(q, r), edge(r, p)] };
    let depth = plane(random, 31);
    let components = [plane(random, 22), plane(random, 22), plane(random, 22)];
    if layout.normal(0).is_some() {
        Command::PhongTriangle(PhongTriangleCommand { edges, depth, normal: components, colour: 0x12_3456 })
    } else {
        Command::Triangle(TriangleCommand { edges, depth, colour: components })
    }
}

/// Returns a number from 0 to `n` - 1.
fn below(random: &mut Random, n: i32) -> i32 {
    random.below(n as u64) as i32
}

/// Returns the first column (or row) of a box of `size`: across the first border, across the last border, or anywhere.
fn small_box_begins(random: &mut Random, size: i32) -> i32 {
    match below(random, 4) {
        0 => -below(random, 3),
        1 => 128 - size + below(random, 3),
        _ => below(random, 128),
    }
}

/// Returns an edge that is at least 0 on one side of the line from a to b.
fn edge([ax, ay]: [i32; 2], [bx, by]: [i32; 2]) -> Linear {
    let dx = bx - ax;
    let dy = by - ay;
    Linear { a: -dy, b: dx, c: dy * ax - dx * ay }
}

/// Returns a plane whose values use about `bits` bits over the array.
fn plane(random: &mut Random, bits: u32) -> Linear {
    Linear { a: random.signed(bits - 8), b: random.signed(bits - 8), c: random.signed(bits) }
}

/// Returns a sphere of radius up to 40 pixels in or near the array, and the same sphere in other colours. The depths of
/// the second sphere are never nearer.
fn sphere_twice(random: &mut Random, layout: &Layout) -> [Command; 2] {
    let [x, y] = [(); 2].map(|()| i64::from(below(random, 168) - 20));
    let r = i64::from(1 + below(random, 40));
    let scale = 1 + random.below(5000) as i64;
    let silhouette = Quadratic {
        xx: -scale,
        xy: 0,
        yy: -scale,
        x: 2 * scale * x,
        y: 2 * scale * y,
        one: scale * (r * r - x * x - y * y),
    };
    let [root_shift, depth_shift] = [25, 21].map(|n| below(random, n) as u8);
    let body = SphereBody { silhouette, root_shift, depth: plane(random, 31), depth_shift };
    let components = [(); 3].map(|()| plane(random, 22));
    let [p, q, r] = components;
    if layout.normal(0).is_some() {
        let coloured = |colour| Command::PhongSphere(PhongSphereCommand { body, normal: [p, q], colour });
        [0x12_3456, 0x65_4321].map(coloured)
    } else {
        let root_factor = [(); 3].map(|()| random.signed(10) as i16);
        [components, [q, r, p]].map(|colour| Command::Sphere(SphereCommand { body, colour, root_factor }))
    }
}

#[test]
fn spheres_agree_on_every_vector_unit() {
    lists_agree(&layouts()[..2], 8, |random, layout, _| (0..2).flat_map(|_| sphere_twice(random, layout)).collect());
}

#[test]
fn a_read_of_the_enable_bits_finds_the_value_that_the_previous_command_left() {
    for layout in [Layout::rendering_control_phong(), Layout::slats()] {
        let mut random = Random::new(80);
        let mut definition = BitSerial::new(&layout);
        let mut subject = Lanes::new(&layout);
        conformance::scramble(&mut random, &mut definition, &mut subject);
        for triangles in 0..20 {
            let mut words = Vec::new();
            for command in sphere_twice(&mut random, &layout) {
                command.encode(&layout, &mut words).expect("the layout has what it needs");
                ArrayInstruction::EnableStore(Operand::absolute(200, 1)).encode(&mut words);
            }
            for _ in 0..triangles {
                let triangle = small_triangle(&mut random, &layout);
                triangle.encode(&layout, &mut words).expect("the layout has what it needs");
            }
            ArrayInstruction::EnableStore(Operand::absolute(201, 1)).encode(&mut words);
            (0..40).for_each(|_| ArrayInstruction::EnableAll { label: 0 }.encode(&mut words));
            check(conformance::agree(&mut definition, &mut subject, &words, &triangles));
        }
    }
}

/// Shades random bits twice, and then a cleared region with some triangles. Random depths are almost never at the far
/// plane.
#[test]
fn shading_agrees_on_every_vector_unit() {
    lists_agree(&layouts()[..1], 4, |random, layout, round| {
        let mut list = Vec::new();
        if round >= 2 {
            list.push(Command::Clear(Clear { colour: 0x65_4321 }));
            list.extend((0..20).map(|_| small_triangle(random, layout)));
        }
        let [light, half] = [(); 2].map(|()| [(); 3].map(|()| random.signed(12) as i16));
        let [ambient, diffuse, specular, ..] = random.next().to_le_bytes();
        list.push(Command::Shade(Shade { light, half, ambient, diffuse, specular }));
        list
    });
}

fn pick(random: &mut Random, from: &[i32]) -> i32 {
    from[random.below(from.len() as u64) as usize]
}

/// Returns instructions with an expression that changes its sign, or overflows, at or near a corner of a block of
/// pixels.
fn corner_run(random: &mut Random) -> Vec<ArrayInstruction> {
    let slopes = [0, 1, -1, 16, -16, 333, -70_001, 1 << 23, -(1 << 24), i32::MAX, i32::MIN];
    let mut out = Vec::new();
    for _ in 0..pick(random, &[1, 3, 12]) {
        let a = pick(random, &slopes);
        let b = pick(random, &slopes);
        let corner = [0, 15, 16, 31, 32, 63, 64, 95, 112, 127];
        let beside = Linear { a, b, c: 0 }.at(pick(random, &corner), pick(random, &corner));
        let value = pick(random, &[-1, 0, 1, i32::MAX, i32::MIN]);
        let c = value.wrapping_sub(beside);
        let expression = if pick(random, &[0, 0, 0, 1]) == 1 {
            Expression::LinearAgain
        } else {
            Expression::Linear(Linear { a, b, c })
        };
        let field = Operand::absolute(24, 20);
        let shift = 12;
        let usage = match pick(random, &[0, 0, 0, 1, 2, 3, 4, 5]) {
            0 => ExpressionUse::DisableNegative,
            1 => ExpressionUse::Load { field, shift },
            2 => ExpressionUse::Add { field, shift },
            3 => ExpressionUse::DisableNotLess { field, shift },
            4 => {
                let subtrahend = Operand::absolute(60, 9).signed();
                ExpressionUse::LoadMinus { field, shift, subtrahend, left_shift: 3 }
            }
            _ => {
                out.push(ArrayInstruction::LoadConstant { destination: field.signed(), value: c as u32 });
                continue;
            }
        };
        out.push(ArrayInstruction::Evaluate { expression, usage });
    }
    out
}

#[test]
fn runs_whose_signs_turn_at_corners_of_blocks_agree_on_every_vector_unit() {
    let layout = Layout::slats();
    for vectors in Vectors::available() {
        let mut definition = BitSerial::new(&layout);
        let mut subject = BitSerial::with_vectors(&layout, vectors).skipping();
        let mut random = Random::new(5);
        conformance::scramble(&mut random, &mut definition, &mut subject);
        for _ in 0..CORNER_RUNS {
            let mut run = corner_run(&mut random);
            let noise = ArrayInstruction::EnableLoad(Operand::absolute(random.below(208) as u8, 1));
            run.insert(0, if random.below(2) == 0 { noise } else { ArrayInstruction::EnableAll { label: 0 } });
            let mut words = Vec::new();
            run.iter().for_each(|instruction| instruction.encode(&mut words));
            check(conformance::agree(&mut definition, &mut subject, &words, &run));
        }
    }
}

#[test]
fn random_lists_give_equal_pixel_memory_on_both_arrays() {
    let seconds = std::env::var("PXPL5_FUZZ_SECONDS").ok();
    let limit = seconds.map(|text| Duration::from_secs(text.parse().expect("a number of seconds")));
    let start = Instant::now();
    let layouts = layouts();
    let mut lanes = layouts.map(|layout| (BitSerial::new(&layout), Lanes::new(&layout)));
    let mut skipping = layouts.map(|layout| (BitSerial::new(&layout), BitSerial::new(&layout).skipping()));
    let mut round = 0;
    while limit.map_or(round < ROUNDS, |limit| start.elapsed() < limit) {
        for (layout, (definition, subject)) in layouts.iter().zip(&mut lanes) {
            check(conformance::random_round(layout, 1000 + round, definition, subject));
        }
        for (layout, (definition, subject)) in layouts.iter().zip(&mut skipping) {
            check(conformance::random_round(layout, 1000 + round, definition, subject));
        }
        round += 1;
    }
}

#[test]
fn all_constants_of_commands_agree() {
    for layout in layouts() {
        let mut a = BitSerial::new(&layout);
        let mut b = Lanes::new(&layout);
        let mut words = Vec::new();
        Command::Clear(Clear { colour: 0x12_3456 }).encode(&layout, &mut words).unwrap();
        // This word is the depth, which a clear always sets to the far plane. One bit is flipped.
        words[4] ^= 1 << 13;
        check(conformance::agree(&mut a, &mut b, &words, &"a clear to a nearer depth"));
    }
}

#[test]
fn both_arrays_send_the_same_pixels_of_a_context_to_a_frame_buffer() {
    let layout = Layout::slats();
    let mut a = BitSerial::new(&layout);
    let mut b = Lanes::new(&layout);
    conformance::scramble(&mut Random::new(3), &mut a, &mut b);
    let target = CopyTarget {
        frame_buffer: NodeId(9),
        buffer: 1,
        lines: Lines::Field(FieldParity::Odd),
        grid: RegionGrid::FIELD,
        region: RegionId(9),
        picture: PictureNumber(77),
    };
    let mut words = Vec::new();
    let select = SelectRegion { context: 2, left: 512, top: 120 };
    Command::SelectRegion(select).encode(&layout, &mut words).unwrap();
    Command::CopyRegion(CopyRegion { target }).encode(&layout, &mut words).unwrap();
    check(conformance::agree(&mut a, &mut b, &words, &"copy"));
    let outputs = b.execute(&words).unwrap().outputs;
    assert_eq!((outputs.len(), outputs[0].target), (1, target));
    assert_eq!(outputs[0].pixels, a.read_colour(128, 120));
    // Compute the expected colour of pixel (70, 3) from its 24 planes.
    let planes = (0..24).map(|i| (a.plane(88 + i)[2 * 3 + 1] >> 6 & 1) << i);
    assert_eq!(u64::from(outputs[0].pixels[3 * 128 + 70]), planes.sum::<u64>());
}

/// The reference model with one bit inverted after every list, which the suite must detect.
struct Wrong(BitSerial);

impl PixelArray for Wrong {
    fn execute(&mut self, words: &[Word]) -> Result<Executed, ArrayFault> {
        let result = self.0.execute(words);
        let mut plane = self.0.plane(130);
        plane[9] ^= 1;
        self.0.set_plane(130, &plane);
        result
    }

    fn plane(&self, bit: usize) -> Plane {
        self.0.plane(bit)
    }

    fn set_plane(&mut self, bit: usize, plane: &Plane) {
        self.0.set_plane(bit, plane);
    }

    fn enable(&self) -> Plane {
        self.0.enable()
    }

    fn set_enable(&mut self, plane: &Plane) {
        self.0.set_enable(plane);
    }

    fn read_colour(&self, width: u32, height: u32) -> Arc<[Word]> {
        self.0.read_colour(width, height)
    }

    fn reset(&mut self) {
        self.0.reset();
    }

    fn faults(&self) -> u64 {
        self.0.faults()
    }
}

#[test]
fn every_part_of_the_suite_finds_a_wrong_array() {
    let layout = Layout::slats();
    let arrays = || (BitSerial::new(&layout), Wrong(BitSerial::new(&layout)));
    let (mut a, mut b) = arrays();
    let found = conformance::instructions(&mut a, &mut b).expect_err("it is wrong behind the first");
    assert!(found.difference.starts_with("bit 130 of pixel (64, 4)"), "{found}");
    let (mut a, mut b) = arrays();
    conformance::commands(&layout, &mut a, &mut b).expect_err("it is wrong behind the first");
    let (mut a, mut b) = arrays();
    let found = conformance::random_round(&layout, 7, &mut a, &mut b).expect_err("it is wrong behind the first");
    assert_eq!(found.after, "\"round 7, step 0\"");
}

/// Each plane is one of eight kinds. In one kind no bit is set, in one kind all bits, in one kind a quarter, and in one
/// kind three quarters. In four kinds, half of the bits are set.
#[test]
fn both_arrays_start_with_the_same_noise() {
    let layout = Layout::slats();
    let [mut a, mut b] = [(); 2].map(|()| BitSerial::new(&layout));
    let mut counts = [0; 5];
    for round in 0..5 {
        conformance::scramble(&mut Random::new(round), &mut a, &mut b);
        check(conformance::agree(&mut a, &mut b, &[], &"noise"));
        for bit in 0..208 {
            let ones: u32 = a.plane(bit).iter().map(|word| word.count_ones()).sum();
            // The number of set bits is a multiple of a quarter of the pixels, with a tolerance of less than a
            // fiftieth.
            let kind = (0..5).find(|quarters| ones.abs_diff(quarters * 4096) < 320).expect("one of these");
            counts[kind as usize] += 1;
            assert!(kind > 0 && kind < 4 || ones == kind * 4096, "{ones}");
        }
    }
    // There are about 130 planes of each kind, and 520 planes with half of the bits.
    for (kind, count) in counts.into_iter().enumerate() {
        let expected = if kind == 2 { 420..620 } else { 80..190 };
        assert!(expected.contains(&count), "{counts:?}");
    }
}

#[test]
fn a_mismatch_names_the_first_wrong_pixel_and_counts_the_wrong_pixels() {
    let layout = Layout::slats();
    for (bit, places, difference) in [
        (9, vec![(3, 5)], "bit 9 of pixel (69, 1) is not 1; 1 pixels differ"),
        (9, vec![(3, 6)], "bit 9 of pixel (70, 1) is not 0; 1 pixels differ"),
        (9, vec![(250, 63), (4, 0), (4, 9)], "bit 9 of pixel (0, 2) is not 1; 3 pixels differ"),
        (207, vec![(255, 33)], "bit 207 of pixel (97, 127) is not 1; 1 pixels differ"),
    ] {
        let [mut a, mut b] = [(); 2].map(|()| BitSerial::new(&layout));
        let mut plane: Plane = [!(1 << 6); 256];
        a.set_plane(bit, &plane);
        places.iter().for_each(|(word, place)| plane[*word] ^= 1 << place);
        b.set_plane(bit, &plane);
        let mismatch = conformance::agree(&mut a, &mut b, &[], &"nothing").unwrap_err();
        assert_eq!(mismatch.difference, difference);
    }
}
