//! Tests of the i860 code for six views around an eye. Each view's words and bins must equal the words and bins of the
//! native firmware. Few primitives outside a view may be transformed for this view.

use crate::native::native;
use crate::numbers::Numbers;
use glam::{Mat4, Quat, Vec3, Vec4};
use pphigs::{
    BinHandoffWork, CubeTransform, CubeTransformOutput, DisplayList, DisplayStructure, EyeView, FrameView, ModelEdit,
    ModelFrame, Pass, Picture, RegionBinning, RegionEnvelope, Shading, Share,
};
use pxpl5_geometry::{Culling, Viewport, WorldSphere};
use pxpl5_gp::{CodeVersion, GpTiming, Processor, ProcessorFault, Work};
use pxpl5_renderer::Layout;
use pxpl5_sim::{Span, SplitMix64};
use pxpl5_wire::{Lines, NodeId, RegionGrid, RegionId, ViewNumber, Word};
use std::sync::Arc;

const VERSIONS: [CodeVersion; 3] = [CodeVersion::Unoptimised, CodeVersion::Compiled, CodeVersion::Scheduled];

impl Numbers {
    /// Returns a position near or far from the eye.
    fn place(&mut self) -> Vec3 {
        self.vector(1.0).normalize_or(Vec3::X) * 20.0_f32.powf(0.9 * self.next())
    }
}

/// Returns triangles and spheres in five structures, all around the origin. Most primitives appear small from the
/// origin.
///
/// One structure is fixed to the head, one is not drawn, and one has back faces that are dropped.
fn list(numbers: &mut Numbers, triangles: u32, spheres: usize) -> Arc<DisplayList> {
    let mut list = DisplayList { towards_light: Vec3::Y, ambient: 0.25, diffuse: 0.75, ..DisplayList::default() };
    for number in 0..triangles {
        let centre = numbers.place();
        let size = centre.length() * if number % 11 == 0 { 2.0 } else { 0.1 };
        for corner in 0..3 {
            list.positions.push(centre + numbers.vector(size));
            list.normals.push(numbers.vector(1.0));
            list.colours.push([corner * 100; 3]);
        }
        list.triangles.push([3 * number, 3 * number + 1, 3 * number + 2]);
    }
    let sphere = |_| {
        let centre = numbers.place();
        WorldSphere { centre, radius: centre.length() * (0.3 * numbers.next()).abs(), colour: [200, 100, 50] }
    };
    list.spheres = (0..spheres).map(sphere).collect();
    let fifth = |all: usize, n: usize| all * n / 5..all * (n + 1) / 5;
    list.structures = (0..5)
        .map(|n| DisplayStructure {
            triangles: fifth(triangles as usize, n),
            spheres: fifth(spheres, n),
            frame: if n == 1 { ModelFrame::Head } else { ModelFrame::World },
            culling: if n == 3 { Culling::Back } else { Culling::None },
        })
        .collect();
    Arc::new(list)
}

const CHOSEN: [bool; 5] = [true, true, false, true, true];

/// Returns the six views along +x, -x, +y, -y, +z and -z of an eye whose axes are nearly the world's.
fn views(numbers: &mut Numbers, scale: f32) -> FrameView {
    let ahead =
        Mat4::from_translation(numbers.vector(0.5)) * Mat4::from_quat(Quat::from_scaled_axis(numbers.vector(0.1)));
    let (near, far) = (0.1, 60.0);
    let deep = far / (near - far);
    let projection = Mat4::from_cols(
        Vec4::new(scale, 0.0, 0.0, 0.0),
        Vec4::new(0.0, scale, 0.0, 0.0),
        Vec4::new(0.0, 0.0, deep, -1.0),
        Vec4::new(0.0, 0.0, near * deep, 0.0),
    );
    // The rows of a rotation are the directions to the right, up, and opposite to the view direction.
    let turns = [
        [Vec3::Z, Vec3::Y, Vec3::NEG_X],
        [Vec3::NEG_Z, Vec3::Y, Vec3::X],
        [Vec3::X, Vec3::NEG_Z, Vec3::NEG_Y],
        [Vec3::X, Vec3::Z, Vec3::Y],
        [Vec3::NEG_X, Vec3::Y, Vec3::NEG_Z],
        [Vec3::X, Vec3::Y, Vec3::Z],
    ];
    let eyes = turns.map(|[right, up, back]| {
        let turn = Mat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), Vec4::W).transpose();
        EyeView { world_to_eye: turn * ahead, head_to_eye: turn, projection }
    });
    let model = |numbers: &mut Numbers, mirror: f32| {
        let turn = Quat::from_scaled_axis(numbers.vector(3.0));
        Mat4::from_rotation_translation(turn, numbers.vector(1.0)) * Mat4::from_scale(Vec3::new(mirror, 1.0, 1.0) * 1.5)
    };
    let edits = vec![
        ModelEdit { structure: 3, model: model(numbers, 1.0) },
        ModelEdit { structure: 4, model: model(numbers, -1.0) },
    ];
    FrameView { number: ViewNumber::FIRST, eyes: eyes.into(), edits }
}

fn face(texels: u32) -> Viewport {
    let grid = RegionGrid { width: texels, height: texels, ..RegionGrid::FRAME };
    Viewport::new(grid, Lines::Frame).expect("at most 128 regions")
}

fn passes(share: &Share, view: &FrameView, shading: Shading, viewport: Viewport) -> [Arc<Pass>; 6] {
    let layout = Layout::rendering_control_phong();
    let picture = Picture { viewport, shading, binning: RegionBinning::Touched, layout, pixels: true };
    std::array::from_fn(|eye| share.transform_chosen(view, eye, picture, &CHOSEN))
}

fn board(version: CodeVersion, share: &Share) -> Processor {
    let mut processor = Processor::new(NodeId(1), 8 << 20, version, i860::Config::cycle());
    share.install(&mut processor).expect("it fits");
    processor
}

fn run(processor: &mut Processor, passes: &[Arc<Pass>; 6], context: u8) -> CubeTransformOutput {
    let transform = CubeTransform { passes, context };
    transform.run_code(&GpTiming::PAPERS, processor).expect("it returns").expect("it has kernels")
}

/// Returns the words of a region's primitives as the code sends them.
fn handed_over(processor: &mut Processor, pass: &Pass, context: u8, view: u8, region: RegionId) -> Vec<Word> {
    let handoff = BinHandoffWork { pass, context, view, region, envelope: RegionEnvelope::default() };
    handoff.by_code(&GpTiming::PAPERS, processor).expect("it returns");
    let messages = BinHandoffWork::listed(processor).expect("in memory");
    let words = |[at, words]: [Word; 2]| processor.read(at, words as usize).expect("in memory");
    messages.into_iter().flatten().flat_map(words).collect()
}

#[test]
fn each_view_gets_the_words_and_bins_of_the_native_firmware() {
    let mut numbers = Numbers(SplitMix64::new(51));
    for (n, (texels, scale)) in [(128, 0.98), (256, 1.0), (512, 0.9), (1408, 0.99), (256, 0.99)].into_iter().enumerate()
    {
        let list = list(&mut numbers, 700, 200);
        let view = views(&mut numbers, scale);
        let share = Share::new(list, n % 2, 2);
        for version in VERSIONS {
            let mut processor = board(version, &share);
            let shading = if n % 2 == 0 { Shading::Phong } else { Shading::Gouraud };
            let passes = passes(&share, &view, shading, face(texels));
            // Both contexts are in use at the same time, and the second context has another eye position.
            let other = self::passes(&share, &views(&mut numbers, scale), shading, face(texels));
            let made = run(&mut processor, &passes, 0);
            run(&mut processor, &other, 1);
            assert!(made.sort_span > Span::ZERO && made.start_span > Span::ZERO);
            let mut drawn = 0;
            for (context, passes) in [(0, &passes), (1, &other)] {
                for (view, pass) in (0..).zip(passes) {
                    for region in (0..pass.picture().viewport.grid().regions() as u16).map(RegionId) {
                        let expected = native(pass, region);
                        drawn += usize::from(!expected.is_empty());
                        let found = handed_over(&mut processor, pass, context, view, region);
                        assert!(found == expected, "{region:?} of view {view}, {texels} texels, {version:?}");
                    }
                }
            }
            assert!(drawn >= 12, "{drawn} regions are drawn in");
        }
    }
}

/// If a view does not contain a primitive, the primitive must not be transformed for this view. Exceptions are
/// primitives within the margin, large primitives, and back faces.
#[test]
fn a_view_receives_few_primitives_outside_the_view() {
    let mut numbers = Numbers(SplitMix64::new(52));
    let mut list = Arc::unwrap_or_clone(list(&mut numbers, 2000, 500));
    list.structures.iter_mut().for_each(|structure| structure.culling = Culling::None);
    let share = Share::new(Arc::new(list), 0, 1);
    let passes = passes(&share, &views(&mut numbers, 1.0), Shading::Phong, face(512));
    let made = run(&mut board(CodeVersion::Scheduled, &share), &passes, 0);
    let mut totals = [0, 0];
    for (pass, given) in passes.iter().zip(&made.given) {
        let [triangles, spheres] = pass.touching().expect("of chosen structures");
        let seen = [triangles.len() as u32, spheres.len() as u32];
        assert!(given.triangles >= seen[0] && given.spheres >= seen[1], "{given:?} for {seen:?}");
        totals[0] += given.total();
        totals[1] += seen[0] + seen[1];
    }
    let held = share.chosen_counts(&CHOSEN).total();
    assert!(totals[1] > held * 9 / 10 && totals[0] < totals[1] * 3 / 2, "{totals:?} of {held}");
}

#[test]
fn views_that_do_not_fit_in_memory_are_refused() {
    let mut numbers = Numbers(SplitMix64::new(53));
    let share = Share::new(list(&mut numbers, 500, 0), 0, 1);
    let passes = passes(&share, &views(&mut numbers, 1.0), Shading::Phong, face(256));
    let memory = (1 << 20) + share.bytes() + 4 * 500 + 1000;
    let mut small = Processor::new(NodeId(4), memory, CodeVersion::Compiled, i860::Config::cycle());
    share.install(&mut small).expect("it fits");
    let transform = CubeTransform { passes: &passes, context: 0 };
    let fault = transform.run_code(&GpTiming::PAPERS, &mut small).expect_err("a thousand bytes for all commands");
    assert!(matches!(fault, ProcessorFault::NoRoom { context: 0, .. }), "{fault}");
}
