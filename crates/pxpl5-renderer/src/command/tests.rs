use super::*;
use crate::RendererTiming;
use crate::isa::timing::{CLOCK_HZ, SET_UP_CLOCKS};
use crate::isa::{Expression, ExpressionUse, Operand};
use crate::layout::ContextPlan;
use proptest::prelude::*;
use pxpl5_sim::{Clock, Cycles};
use pxpl5_wire::{CopyTarget, FieldParity, Linear, Lines, NodeId, PictureNumber, Quadratic, RegionGrid, RegionId};

fn linear() -> impl Strategy<Value = Linear> {
    any::<[i32; 3]>().prop_map(|[a, b, c]| Linear { a, b, c })
}

fn three() -> impl Strategy<Value = [Linear; 3]> {
    [linear(), linear(), linear()]
}

fn quadratic() -> impl Strategy<Value = Quadratic> {
    any::<[i64; 6]>().prop_map(|[xx, xy, yy, x, y, one]| Quadratic { xx, xy, yy, x, y, one })
}

fn triangle() -> impl Strategy<Value = Command> {
    (three(), linear(), three())
        .prop_map(|(edges, depth, colour)| Command::Triangle(TriangleCommand { edges, depth, colour }))
}

fn phong_triangle() -> impl Strategy<Value = Command> {
    (three(), linear(), three(), any::<u32>()).prop_map(|(edges, depth, normal, colour)| {
        Command::PhongTriangle(PhongTriangleCommand { edges, depth, normal, colour })
    })
}

fn body() -> impl Strategy<Value = SphereBody> {
    (quadratic(), 0..=24_u8, linear(), 0..=20_u8).prop_map(|(silhouette, root_shift, depth, depth_shift)| SphereBody {
        silhouette,
        root_shift,
        depth,
        depth_shift,
    })
}

fn sphere() -> impl Strategy<Value = Command> {
    (body(), three(), [-512_i16..512, -512_i16..512, -512_i16..512])
        .prop_map(|(body, colour, root_factor)| Command::Sphere(SphereCommand { body, colour, root_factor }))
}

fn phong_sphere() -> impl Strategy<Value = Command> {
    (body(), [linear(), linear()], any::<u32>())
        .prop_map(|(body, normal, colour)| Command::PhongSphere(PhongSphereCommand { body, normal, colour }))
}

fn vector() -> impl Strategy<Value = [i16; 3]> {
    [-2048_i16..2048, -2048_i16..2048, -2048_i16..2048]
}

fn shade() -> impl Strategy<Value = Command> {
    (vector(), vector(), any::<[u8; 3]>()).prop_map(|(light, half, [ambient, diffuse, specular])| {
        Command::Shade(Shade { light, half, ambient, diffuse, specular })
    })
}

fn copy() -> impl Strategy<Value = Command> {
    (any::<u16>(), any::<u8>(), 0..3, 0..10_u16, any::<u64>()).prop_map(|(node, buffer, lines, region, picture)| {
        let lines = match lines {
            0 => Lines::Frame,
            1 => Lines::Field(FieldParity::Even),
            _ => Lines::Field(FieldParity::Odd),
        };
        let target = CopyTarget {
            frame_buffer: NodeId(node),
            buffer,
            lines,
            grid: RegionGrid::FIELD,
            region: RegionId(region),
            picture: PictureNumber(picture),
        };
        Command::CopyRegion(CopyRegion { target })
    })
}

fn control() -> impl Strategy<Value = Command> {
    prop_oneof![
        (0..4_u8, any::<u16>(), any::<u16>())
            .prop_map(|(context, left, top)| { Command::SelectRegion(SelectRegion { context, left, top }) }),
        any::<u32>().prop_map(|colour| Command::Clear(Clear { colour })),
        (0..128_u8, 0..=176_u8).prop_map(|(block, address)| Command::StoreBacking(StoreBacking { block, address })),
        (0..128_u8, 0..=176_u8).prop_map(|(block, address)| Command::LoadBacking(LoadBacking { block, address })),
        Just(Command::WaitBacking),
    ]
}

fn any_command() -> impl Strategy<Value = Command> {
    prop_oneof![triangle(), phong_triangle(), sphere(), phong_sphere(), shade(), copy(), control()]
}

fn phong() -> Layout {
    Layout::rendering_control_phong()
}

proptest! {
    #[test]
    fn every_command_is_decoded_from_its_words(
        command in any_command().prop_filter("one context", |c| !matches!(c, Command::SelectRegion(s) if s.context > 0)),
    ) {
        let mut words = vec![0xdead_beef; 3];
        command.encode(&phong(), &mut words).unwrap();
        let used = command.kind().words() as usize;
        prop_assert_eq!(words.len(), 3 + used);
        prop_assert_eq!(Command::decode(&words, 3, &phong()), Ok((command, used)));
    }

    #[test]
    fn the_words_of_a_command_equal_the_words_of_its_program(command in any_command(), before in any::<[u32; 2]>()) {
        for layout in [phong(), Layout::slats(), Layout::slats_quarters()] {
            let mut words = before.to_vec();
            let mut expected = before.to_vec();
            let program = command.program(&layout);
            let result = command.encode(&layout, &mut words);
            prop_assert_eq!(result, program.as_ref().map(|_| ()).map_err(|error| *error));
            for instruction in program.unwrap_or_default() {
                instruction.encode(&mut expected);
            }
            prop_assert_eq!(words, expected);
        }
    }

    #[test]
    fn triangles_made_from_templates_have_the_words_of_their_programs(
        plain in triangle(),
        with_normals in phong_triangle(),
        before in any::<[u32; 2]>(),
    ) {
        let layout = phong();
        let (Command::Triangle(a), Command::PhongTriangle(b)) = (&plain, &with_normals) else { panic!("triangles") };
        let [mut found, mut expected] = [before.to_vec(), before.to_vec()];
        TriangleEncoder::new(&layout).encode(a, &mut found);
        PhongTriangleEncoder::new(&layout).expect("it has normals").encode(b, &mut found);
        for command in [&plain, &with_normals] {
            for instruction in command.program(&layout).expect("it has the fields") {
                instruction.encode(&mut expected);
            }
        }
        prop_assert_eq!(found, expected);
    }

    #[test]
    fn commands_of_slats_are_decoded_with_a_narrow_depth(
        command in prop_oneof![triangle(), sphere(), control(), copy()],
    ) {
        let mut words = Vec::new();
        command.encode(&Layout::slats(), &mut words).unwrap();
        let used = command.kind().words() as usize;
        prop_assert_eq!(Command::decode(&words, 0, &Layout::slats()), Ok((command, used)));
    }

    #[test]
    fn any_words_decode_or_name_the_position_without_a_panic(words in any::<Vec<u32>>()) {
        if let Err(error) = ArrayInstruction::decode_all(&words) {
            prop_assert!(error.position < words.len());
        }
        let _ = Command::decode(&words, 0, &phong());
    }

    #[test]
    fn a_decoded_instruction_encodes_to_its_words(
        opcode in 1..0x71_u32,
        rest in any::<[u32; 12]>(),
    ) {
        let mut words = vec![opcode << 24 | rest[0] & 0xff_ffff];
        words.extend(rest);
        if let Ok((instruction, used)) = ArrayInstruction::decode(&words, 0) {
            let mut again = Vec::new();
            instruction.encode(&mut again);
            prop_assert_eq!(&again[..], &words[..used]);
        }
    }
}

#[test]
fn the_published_rate_lies_between_the_two_kinds_of_triangle_and_both_keep_the_bit_budget() {
    // The published rate is 150,000 triangles a second at 40 MHz (TR94).
    let published = 40_000_000_u32.div_ceil(150_000);
    let gouraud = clocks(CommandKind::Triangle);
    let phong = clocks(CommandKind::PhongTriangle);
    assert!(gouraud <= published && published <= phong);
    // The terms are enable, edges, Z comparison and store, colours, and fetches. Normals take 6 more clocks, or 36 with
    // the object's colour.
    let budget = 2 + 3 * 24 + 28 + 28 + 3 * 18 + 9 * 8;
    assert!((budget..=published).contains(&gouraud));
    assert!((budget + 6..=budget + 36).contains(&phong));
    assert_eq!(CommandKind::Triangle.clocks(&Layout::slats()), Ok(gouraud));
}

#[test]
fn the_timing_table_holds_the_clocks_of_the_programs() {
    let table = RendererTiming::PAPERS;
    let kinds = CommandKind::ALL.into_iter().filter(|kind| kind.opcode() <= CommandKind::Shade.opcode());
    for kind in kinds {
        let of_program = Clock::from_hz(CLOCK_HZ).map(|clock| clock.span(Cycles(clocks(kind).into())));
        assert_eq!(table.span(kind), of_program, "{kind:?}");
    }
}

#[test]
fn the_clocks_of_a_triangle_are_the_sum_over_its_instructions() {
    let program = Command::Triangle(TriangleCommand::default()).program(&phong()).unwrap();
    let bits: Vec<_> = program.iter().map(ArrayInstruction::bit_clocks).collect();
    assert_eq!(bits, [2, 32, 32, 32, 32, 32, 20, 20, 20]);
    assert_eq!(258, bits.iter().sum::<u32>() + 9 * SET_UP_CLOCKS);
}

#[test]
fn every_kind_of_command_has_its_stated_words_and_opcode() {
    for kind in CommandKind::ALL {
        let mut words = Vec::new();
        Command::blank(kind).encode(&phong(), &mut words).unwrap();
        assert_eq!(words.len() as u32, kind.words(), "{kind:?}");
        assert_eq!(CommandKind::from_opcode(kind.opcode()), Some(kind));
    }
    assert_eq!(CommandKind::from_opcode(0), None);
    assert_eq!(CommandKind::from_opcode(12), None);
}

fn clocks(kind: CommandKind) -> u32 {
    kind.clocks(&phong()).unwrap()
}

#[test]
fn a_phong_triangle_needs_clocks_for_normals_and_object_colour() {
    // Three normals of 10 + 12 bits and a constant of 24 bits replace three colours of 12 + 8 bits.
    let expected = clocks(CommandKind::Triangle) - 3 * 20 + 3 * 22 + SET_UP_CLOCKS + 24;
    assert_eq!(clocks(CommandKind::PhongTriangle), expected);
    assert_eq!(expected, 292);
}

/// Returns the clocks in which a sphere finds its pixels and stores their depths. `root` is the number of clocks of the
/// square root, and `z` is the number of bits of a depth.
const fn sphere_coverage_clocks(root: u32, z: u32) -> u32 {
    2 + 48 + 48 + root + 32 + 2 * z + 7 * SET_UP_CLOCKS
}

#[test]
fn a_sphere_needs_clocks_for_two_quadratics_a_root_and_three_products() {
    // The terms are the product of 8 by 10 bits, the 12 + 10 bits of the linear part, and the limit.
    let component = 10 * 9 + 22 + 10 + 3 * SET_UP_CLOCKS;
    assert_eq!(clocks(CommandKind::Sphere), sphere_coverage_clocks(202, 24) + 3 * component);
    assert_eq!(clocks(CommandKind::Sphere), 810);
    let slats = CommandKind::Sphere.clocks(&Layout::slats()).unwrap();
    assert_eq!(slats, sphere_coverage_clocks(148, 20) + 3 * component);
    assert_eq!(slats, 748);
    let normals = 2 * 22 + 12 + 24 + 4 * SET_UP_CLOCKS;
    assert_eq!(clocks(CommandKind::PhongSphere), sphere_coverage_clocks(202, 24) + normals);
    assert_eq!(clocks(CommandKind::PhongSphere), 504);
}

fn quadratic_clocks(usage: ExpressionUse) -> u32 {
    ArrayInstruction::Evaluate { expression: Expression::QuadraticAgain, usage }.clocks()
}

#[test]
fn a_paraboloid_takes_slightly_more_clocks_than_a_triangle() {
    // These are the steps in the documentation of `SphereCommand`: sign, comparison and store of a quadratic
    // expression, then three colours, or normals and a colour.
    let field = phong().plan().z;
    let load = ExpressionUse::Load { field, shift: 0 };
    let depth = quadratic_clocks(ExpressionUse::DisableNegative)
        + quadratic_clocks(ExpressionUse::DisableNotLess { field, shift: 0 })
        + quadratic_clocks(load);
    let coverage = enable(CommandKind::Sphere).clocks() + depth;
    assert_eq!(coverage + 3 * quadratic_clocks(load), 318);
    let constant = ArrayInstruction::LoadConstant { destination: phong().plan().colour, value: 0 }.clocks();
    assert_eq!(coverage + 3 * (22 + SET_UP_CLOCKS) + constant, 268);
}

#[test]
fn shading_takes_95_microseconds() {
    let length = 3 * 12 * 13 + 2 * 24 + 202;
    let quotient: u32 = (0..10).map(|j| 2 * (23 - j)).sum();
    let cosine = 3 * 12 * 13 + 2 * 24 + 24 + quotient;
    let power = SPECULAR_SQUARINGS * 10 * 11;
    let intensities = 2 * (8 * 11 + 10) + 18 + 19 + 9;
    let combine = 3 * (8 * 9 + 9 + 9);
    let bits = 2 + 24 + length + 2 * cosine + power + intensities + combine;
    assert_eq!(clocks(CommandKind::Shade), bits + 41 * SET_UP_CLOCKS);
    assert_eq!(clocks(CommandKind::Shade), 3790);
}

#[test]
fn the_clear_command_takes_the_time_of_two_constants() {
    assert_eq!(clocks(CommandKind::Clear), 2 + 24 + 24 + 3 * SET_UP_CLOCKS);
}

#[test]
fn a_command_that_does_not_fit_the_layout_is_refused_with_the_missing_field() {
    let error = CommandKind::Shade.clocks(&Layout::slats()).unwrap_err();
    assert_eq!(error.to_string(), "Shade needs a normal, which layout Slats lacks");
    let error = CommandKind::Sphere.clocks(&Layout::slats_quarters()).unwrap_err();
    assert_eq!(error.missing, "30 bits of scratch");
}

#[test]
fn a_command_label_on_the_words_of_another_program_is_refused() {
    let mut words = Vec::new();
    Command::Triangle(TriangleCommand::default()).encode(&phong(), &mut words).unwrap();
    words[13] ^= 1;
    let error = Command::decode(&words, 0, &phong()).unwrap_err();
    assert_eq!((error.position, error.kind), (0, DecodeErrorKind::NotTheCommand(3)));
}

#[test]
fn an_unknown_label_is_named() {
    let mut words = Vec::new();
    ArrayInstruction::EnableAll { label: 0xEE }.encode(&mut words);
    let error = Command::decode(&words, 0, &phong()).unwrap_err();
    assert_eq!((error.position, error.kind), (0, DecodeErrorKind::NotTheCommand(0xEE)));
}

/// Tests the scratch memory that a sphere needs: for the root, and for the wider of the depth and the root's square.
/// The root has 12 bits, or 10 bits if the scratch memory has fewer than 36 bits.
#[test]
fn a_sphere_needs_scratch_memory_for_its_root_and_the_wider_of_depth_and_squared_root() {
    for z in 8..=24 {
        for scratch in 20..=40 {
            let z_field = Operand::context(24, z);
            let plan = *Layout::slats().plan();
            let plan = ContextPlan { contexts: 1, z: z_field, scratch: Some(Operand::absolute(100, scratch)), ..plan };
            let layout = Layout::new(plan).expect("they lie apart");
            let root = if scratch >= 36 { 12 } else { 10 };
            let has_room = scratch >= 30 && scratch >= root + z.max(2 * root);
            assert_eq!(CommandKind::Sphere.clocks(&layout).is_ok(), has_room, "{z} {scratch}");
        }
    }
}

/// Tests the shifts of operands for a root of 10 bits instead of 12 bits. Operands are made for 12 bits. The square of
/// a 10-bit root is a sixteenth (a shift by 4), and the root is a quarter (a shift by 2).
#[test]
fn shifts_of_a_sphere_compensate_for_a_shorter_root() {
    let body = SphereBody { root_shift: 3, depth_shift: 5, ..SphereBody::default() };
    let sphere = Command::Sphere(SphereCommand { body, ..SphereCommand::default() });
    for (layout, root, depth) in [(phong(), 3, 5), (Layout::slats(), 3 + 4, 5 + 2)] {
        let program = sphere.program(&layout).expect("it has room");
        let shifts: Vec<u8> = program
            .iter()
            .filter_map(|instruction| match instruction {
                ArrayInstruction::Evaluate {
                    expression: Expression::QuadraticAgain,
                    usage: ExpressionUse::Load { shift, .. },
                } => Some(*shift),
                ArrayInstruction::Evaluate { usage: ExpressionUse::LoadMinus { left_shift, .. }, .. } => {
                    Some(*left_shift)
                }
                _ => None,
            })
            .collect();
        assert_eq!(shifts, [root, depth]);
    }
}

/// Tests the time to move the 16,384 pixels of a region, with 32 bits each, to the backing store. Each of 64 chips
/// moves 4 bits per clock, so the region takes about 2,048 clocks.
#[test]
fn storing_a_region_moves_four_bits_per_clock_and_chip() {
    let clocks = crate::RendererTiming::PAPERS.backing_block_clocks;
    assert!(clocks.abs_diff(16_384 * 32 / (64 * 4)) <= 20, "{clocks}");
}
