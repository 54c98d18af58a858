//! Tests of TRANSFORM as i860 code on a board. The words must equal the words of the native firmware. Other tests check
//! the time of the code.

use crate::native::native;
use crate::numbers::Numbers;
use glam::{Mat4, Vec3};
use pphigs::{
    DisplayList, DisplayStructure, EyeView, FrameView, KernelOutput, ModelEdit, ModelFrame, Pass, Picture,
    RegionBinning, Shading, Share, TransformWork,
};
use pxpl5_geometry::{Culling, Viewport, WorldSphere};
use pxpl5_gp::{CodeVersion, GpTiming, Processor, Work};
use pxpl5_renderer::Layout;
use pxpl5_sim::SplitMix64;
use pxpl5_wire::{FieldParity, NodeId, RegionId, ViewNumber, Word};
use std::sync::Arc;

const MEMORY: u64 = 8 << 20;
const VERSIONS: [CodeVersion; 3] = [CodeVersion::Unoptimised, CodeVersion::Compiled, CodeVersion::Scheduled];

/// Returns triangles in front of the eye in two structures, one of them fixed to the head.
fn list(triangles: u32) -> Arc<DisplayList> {
    let mut numbers = Numbers(SplitMix64::new(7));
    let mut list = DisplayList { towards_light: Vec3::new(0.48, 0.6, 0.64), ..DisplayList::default() };
    list.ambient = 0.25;
    list.diffuse = 0.75;
    for number in 0..triangles {
        let centre = Vec3::new(0.0, 0.0, -6.0) + numbers.vector(1.5);
        for _ in 0..3 {
            list.positions.push(centre + numbers.vector(0.3));
            list.normals.push(numbers.vector(1.0));
            list.colours.push([0; 3].map(|_| (numbers.0.unit() * 255.0) as u8));
        }
        list.triangles.push([3 * number, 3 * number + 1, 3 * number + 2]);
    }
    let middle = triangles as usize / 3;
    let end = triangles as usize;
    list.structures = vec![
        DisplayStructure { triangles: 0..middle, spheres: 0..0, frame: ModelFrame::World, culling: Culling::None },
        DisplayStructure { triangles: middle..end, spheres: 0..0, frame: ModelFrame::Head, culling: Culling::None },
    ];
    Arc::new(list)
}

/// Returns an eye beside the middle of the head.
fn eye(x: f32) -> EyeView {
    EyeView {
        world_to_eye: Mat4::from_translation(Vec3::new(x, 0.1, 0.0)) * Mat4::from_rotation_y(0.1),
        head_to_eye: Mat4::from_translation(Vec3::new(x, 0.0, 0.0)),
        projection: Mat4::perspective_rh(0.9, 4.0 / 3.0, 0.5, 40.0),
    }
}

fn view() -> FrameView {
    let model = Mat4::from_translation(Vec3::new(0.2, 0.0, 0.0)) * Mat4::from_rotation_z(0.5);
    FrameView {
        number: ViewNumber::FIRST,
        eyes: vec![eye(-0.03), eye(0.03)],
        edits: vec![ModelEdit { structure: 1, model }],
    }
}

fn picture(viewport: Viewport, shading: Shading, binning: RegionBinning) -> Picture {
    Picture { viewport, shading, binning, layout: Layout::rendering_control_phong(), pixels: true }
}

/// Returns the only share of a list. The compiled program of Slats draws it in single precision.
fn share_for_slats(triangles: u32, version: CodeVersion) -> Share {
    let is_single = version == CodeVersion::Compiled;
    Share::new(Arc::new(DisplayList { is_single, ..(*list(triangles)).clone() }), 0, 1)
}

fn board(version: CodeVersion, share: &Share) -> Processor {
    let mut processor = Processor::new(NodeId(1), MEMORY, version, i860::Config::cycle());
    share.install(&mut processor).expect("it fits");
    processor
}

/// Returns the words of a region's primitives that the i860 code has written to memory.
fn of_code(processor: &Processor, output: &KernelOutput, region: usize, command_words: usize) -> Vec<Word> {
    let bin = &output.bins[region];
    let entries = processor.read(bin.start, (bin.end - bin.start) as usize / 4).expect("in memory");
    entries.iter().flat_map(|at| processor.read(*at, command_words).expect("in memory")).collect()
}

#[test]
fn code_writes_the_words_of_the_native_firmware() {
    assert_native_words(list(300));
}

/// Tests two structures with different matrices. Both structures leave out back faces.
#[test]
fn code_leaves_out_back_facing_triangles() {
    let mut list = Arc::unwrap_or_clone(list(300));
    list.structures.iter_mut().for_each(|structure| structure.culling = Culling::Back);
    assert_native_words(Arc::new(list));
}

fn assert_native_words(list: Arc<DisplayList>) {
    let view = view();
    let share = Share::new(Arc::clone(&list), 1, 3);
    for version in VERSIONS {
        let mut processor = board(version, &share);
        for viewport in [Viewport::FRAME, Viewport::field(FieldParity::Even), Viewport::field(FieldParity::Odd)] {
            for (shading, command_words) in [(Shading::Gouraud, 30), (Shading::Phong, 32)] {
                for eye in 0..2 {
                    let pass = share.transform(&view, eye, picture(viewport, shading, RegionBinning::Touched));
                    assert_eq!(pass.stats().clipped + pass.stats().outside, 0, "all are inside the guard band");
                    let made = pass.run_code(&mut processor, eye as u8).expect("it returns").expect("it has a kernel");
                    for region in 0..viewport.grid().regions() as u16 {
                        let expected = native(&pass, RegionId(region));
                        let found = of_code(&processor, &made, usize::from(region), command_words);
                        // With several contexts, the words would begin with a selection. This layout has only one
                        // context.
                        assert!(found == expected, "region {region}, {version:?}, {shading:?}, {viewport:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn without_bins_commands_are_written_in_the_order_of_the_primitives() {
    let list = list(90);
    let view = view();
    let share = Share::new(list, 0, 1);
    let viewport = Viewport::field(FieldParity::Odd);
    for version in VERSIONS {
        let mut processor = board(version, &share);
        for (clump, first) in share.clumps(30).zip([0, 30]) {
            let pass = clump.transform(&view, 0, picture(viewport, Shading::Gouraud, RegionBinning::All));
            assert_eq!(pass.stats().screen_triangles, 30, "clump from {first}: all are on the screen");
            let made = pass.run_code(&mut processor, 0).expect("it returns").expect("it has a kernel");
            let words = (made.commands.end - made.commands.start) as usize / 4;
            let found = processor.read(made.commands.start, words).expect("in memory");
            assert!(found == native(&pass, RegionId(0)), "clump from {first}, {version:?}");
        }
    }
}

/// All corners are left of the picture, and one of them is also outside the guard band. No triangle is cut, so each
/// triangle has at most one command.
#[test]
fn without_bins_triangles_are_not_clipped_at_the_sides_of_the_picture() {
    let mut list = Arc::unwrap_or_clone(list(30));
    for triangle in 0..30 {
        for (corner, x) in [-20.0, -25.0, -5_000.0].into_iter().enumerate() {
            list.positions[3 * triangle + (corner + triangle) % 3].x = x;
        }
    }
    let share = Share::new(Arc::new(list), 0, 1);
    let viewport = Viewport::field(FieldParity::Odd);
    for version in VERSIONS {
        let pass = share.transform(&view(), 0, picture(viewport, Shading::Gouraud, RegionBinning::All));
        assert_eq!((pass.stats().outside, pass.stats().clipped), (30, 0));
        let made = pass.run_code(&mut board(version, &share), 0).expect("it returns").expect("it has a kernel");
        assert!(made.commands.is_empty(), "{version:?}: {:?}", made.commands);
    }
}

/// Triangles of both structures reach behind the eye. Their pieces must be in the same bins as the native pieces.
#[test]
fn code_clips_triangles_as_the_native_firmware_does() {
    let mut list = Arc::unwrap_or_clone(list(300));
    (0..300).step_by(4).for_each(|triangle| list.positions[3 * triangle].z = 5.0);
    let share = Share::new(Arc::new(list), 1, 3);
    for version in VERSIONS {
        let mut processor = board(version, &share);
        let pass = share.transform(&view(), 0, picture(Viewport::FRAME, Shading::Phong, RegionBinning::Touched));
        assert!(pass.stats().clipped > 20, "{:?}", pass.stats());
        let made = pass.run_code(&mut processor, 0).expect("it returns").expect("it has a kernel");
        for region in 0..20 {
            let found = of_code(&processor, &made, usize::from(region), 32);
            assert!(found == native(&pass, RegionId(region)), "region {region}, {version:?}");
        }
    }
}

/// If the board runs code, the time of a pass must not depend on any number of the timing table, including the numbers
/// for spheres.
#[test]
fn the_time_of_a_pass_by_code_does_not_depend_on_the_timing_table() {
    let mut list = Arc::unwrap_or_clone(list(30));
    list.spheres = vec![WorldSphere { centre: Vec3::new(0.0, 0.0, -5.0), radius: 0.1, colour: [9; 3] }];
    list.structures[0].spheres = 0..1;
    let share = Share::new(Arc::new(list), 0, 1);
    let pass = share.transform(&view(), 0, picture(Viewport::FRAME, Shading::Phong, RegionBinning::Touched));
    assert_eq!(pass.stats().screen_spheres, 1);
    let mut processor = board(CodeVersion::Scheduled, &share);
    let beginning = share.beginning(&view(), &[0], *pass.picture());
    let begun = beginning.by_code(&GpTiming::PAPERS, &mut processor).expect("it returns");
    let made = pass.run_code(&mut processor, 0).expect("it returns").expect("a kernel");
    assert_eq!(made.entries(), pass.entries());
    let timing = GpTiming { triangle_ns: 1_000_000, sphere_ns: 50_000, bin_entry_ns: 700, ..GpTiming::PAPERS };
    let work = TransformWork { passes: &[Arc::clone(&pass)], context: 0, begins: true };
    let span = work.by_code(&timing, &mut board(CodeVersion::Scheduled, &share)).expect("it returns");
    assert_eq!(span, begun + made.span);
}

#[test]
fn a_picture_without_a_kernel_takes_the_times_of_the_table() {
    let share = Share::new(list(30), 0, 1);
    let grid = pxpl5_wire::RegionGrid { width: 320, height: 240, region_width: 64, region_height: 64 };
    let viewport = Viewport::new(grid, pxpl5_wire::Lines::Frame).expect("a valid picture");
    let passes = [share.transform(&view(), 0, picture(viewport, Shading::Phong, RegionBinning::Touched))];
    let work = TransformWork { passes: &passes, context: 0, begins: false };
    let span = work.by_code(&GpTiming::PAPERS, &mut board(CodeVersion::Compiled, &share)).expect("it returns");
    assert_eq!(span, work.by_table(&GpTiming::PAPERS));
}

#[test]
fn a_display_list_larger_than_the_memory_is_refused() {
    let share = Share::new(list(300), 0, 1);
    let mut small = Processor::new(NodeId(4), 1 << 20, CodeVersion::Compiled, i860::Config::cycle());
    let error = share.install(&mut small).expect_err("it begins behind the first megabyte");
    assert_eq!(error.to_string(), "graphics processor at node 4: no memory for 24 words at 0x00100000");
}

/// Returns the bytes of a context's output, computed from their definition.
///
/// The output contains a command for every triangle and one more command. Each bin has an entry of four bytes for each
/// of its triangles. No triangle is clipped.
fn output_bytes(pass: &Pass, triangles: u32, command_bytes: u32) -> u32 {
    let regions = pass.picture().viewport.grid().regions() as u16;
    let entries: u32 = (0..regions).map(|region| pass.counts(RegionId(region)).triangles).sum();
    command_bytes * (triangles + 1) + 4 * entries
}

/// Returns a board with the given memory, both eyes' passes over 90 triangles, and the bytes of a command.
fn both_contexts(memory: u64) -> (Processor, [Arc<Pass>; 2]) {
    let share = Share::new(list(90), 0, 1);
    let view = view();
    let mut processor = Processor::new(NodeId(2), memory, CodeVersion::Scheduled, i860::Config::cycle());
    share.install(&mut processor).expect("it fits");
    let picture = picture(Viewport::FRAME, Shading::Gouraud, RegionBinning::Touched);
    (processor, [0, 1].map(|eye| share.transform(&view, eye, picture)))
}

#[test]
fn adjacent_contexts_keep_their_words_and_overlapping_contexts_are_refused() {
    let (_, passes) = both_contexts(MEMORY);
    let [lower, upper] = [0, 1].map(|eye| output_bytes(&passes[eye], 90, 120));
    let behind_list = (1 << 20) + 90 * 96_u32;
    let border = (behind_list.next_multiple_of(32) + lower).next_multiple_of(32);
    let fits = u64::from(border + upper);

    let (mut processor, passes) = both_contexts(fits);
    let made = [0, 1].map(|eye| passes[eye].run_code(&mut processor, eye as u8).expect("it fits").expect("a kernel"));
    assert_eq!(made[1].commands.start, border, "the upper context begins where the lower one ends");
    for (pass, made) in passes.iter().zip(&made) {
        for region in 0..20 {
            let found = of_code(&processor, made, usize::from(region), 30);
            assert!(found == native(pass, RegionId(region)), "region {region}");
        }
    }

    let (mut processor, passes) = both_contexts(fits - 1);
    let made = passes[0].run_code(&mut processor, 0).expect("it is alone").expect("a kernel");
    let error = passes[1].run_code(&mut processor, 1).expect_err("they would meet");
    assert_eq!(
        error.to_string(),
        format!(
            "graphics processor at node 2: output of bin context 1 needs {upper} bytes, {} are available",
            upper - 1
        )
    );
    assert!(
        (0..20).all(|region| of_code(&processor, &made, region, 30) == native(&passes[0], RegionId(region as u16)))
    );
    // If the contexts are placed in the opposite order, the lower context is rejected.
    let (mut processor, passes) = both_contexts(fits - 1);
    passes[1].run_code(&mut processor, 1).expect("it is alone");
    let error = passes[0].run_code(&mut processor, 0).expect_err("they would meet");
    assert!(error.to_string().contains("output of bin context 0 needs"), "{error}");
}

#[test]
fn a_context_larger_than_the_memory_is_refused() {
    let (_, passes) = both_contexts(MEMORY);
    let behind_list = u64::from((1 << 20) + 90 * 96_u32);
    for context in [0, 1] {
        let (mut processor, _) = both_contexts(behind_list + 64);
        let error = passes[0].run_code(&mut processor, context).expect_err("64 bytes");
        assert!(error.to_string().ends_with("64 are available"), "{error}");
    }
}

/// Transforms both structures clump by clump. One structure is edited. The words of either eye must be the native
/// words, in the order of the display list.
///
/// With compiled code, one pass for both eyes takes less time than two passes. With scheduled code, one pass can take
/// more time, because this code does not stay in the cache.
#[test]
fn one_pass_for_both_eyes_writes_the_native_words_of_each_eye() {
    let picture = picture(Viewport::field(FieldParity::Odd), Shading::Precomputed, RegionBinning::All);
    for version in [CodeVersion::Compiled, CodeVersion::Scheduled] {
        let share = share_for_slats(90, version);
        let mut processor = board(version, &share);
        for clump in share.clumps(30) {
            let [left, right] = [0, 1].map(|eye| clump.transform(&view(), eye, picture));
            let made = left.run_code_for_both(&right, &mut processor, 0).expect("it returns").expect("there is code");
            for (pass, made) in [&left, &right].into_iter().zip(&made) {
                assert_eq!(pass.stats().screen_triangles, 30, "all are on the screen");
                let words = (made.commands.end - made.commands.start) as usize / 4;
                let found = processor.read(made.commands.start, words).expect("in memory");
                assert!(found == native(pass, RegionId(0)), "{version:?}");
            }
            let passes = [left, right];
            let together = TransformWork { passes: &passes, context: 0, begins: false };
            let together = together.by_code(&GpTiming::PAPERS, &mut processor).expect("it returns");
            let alone =
                [0, 1].map(|eye| passes[eye].run_code(&mut processor, 0).expect("it returns").expect("code").span);
            let saves = together < alone[0] + alone[1];
            assert!(saves || version == CodeVersion::Scheduled, "{together:?}, {alone:?}");
        }
    }
}

#[test]
fn a_structure_that_the_left_eye_cannot_draw_is_drawn_for_the_right_eye() {
    let mut view = view();
    view.eyes[0].head_to_eye.w_axis.x = f32::NAN;
    let picture = picture(Viewport::field(FieldParity::Even), Shading::Precomputed, RegionBinning::All);
    for version in [CodeVersion::Compiled, CodeVersion::Scheduled] {
        let share = share_for_slats(30, version);
        let mut processor = board(version, &share);
        let [left, right] = [0, 1].map(|eye| share.transform(&view, eye, picture));
        let made = left.run_code_for_both(&right, &mut processor, 0).expect("it returns").expect("there is code");
        let commands = made.each_ref().map(|made| (made.commands.end - made.commands.start) / 120);
        assert_eq!(commands, [10, 30], "{version:?}");
        let found = processor.read(made[1].commands.start, 30 * 30).expect("in memory");
        assert!(found == native(&right, RegionId(0)), "{version:?}");
    }
}

/// A triangle has only ambient light if its normal points away from the light, and full light if it points to the
/// light. Other normals give light in between.
#[test]
fn a_precomputed_colour_has_ambient_light_and_on_the_lit_side_also_diffuse_light() {
    let mut list = DisplayList { towards_light: Vec3::Z, ambient: 0.25, diffuse: 0.5, ..DisplayList::default() };
    list.normals = vec![Vec3::Z * 3.0, -Vec3::Z, Vec3::new(0.0, 3f32.sqrt(), 1.0)];
    list.positions = vec![Vec3::ZERO; 3];
    list.colours = vec![[200, 100, 0]; 3];
    let colours = list.with_precomputed_colours().colours;
    assert_eq!(colours, [[150, 75, 0], [50, 25, 0], [100, 50, 0]]);
}
