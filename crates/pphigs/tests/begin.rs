//! Tests of the i860 code that begins a pass and applies edits. The parameter blocks and matrices must equal the blocks
//! and matrices of the native firmware.

use crate::numbers::Numbers;
use glam::{Mat4, Quat, Vec3};
use pphigs::{
    DisplayList, DisplayStructure, EditWork, EyeView, FrameView, ModelEdit, ModelFrame, Picture, PlacedStructure,
    RegionBinning, Shading, Share, place_all,
};
use pxpl5_geometry::kernel::{Kernel, KernelSurface, PARAMETER_WORDS, Schedule};
use pxpl5_geometry::sphere_kernel::{SPHERE_PARAMETER_WORDS, SphereKernel};
use pxpl5_geometry::{Culling, Viewport, WorldSphere};
use pxpl5_gp::{CodeVersion, GpTiming, Processor, Work};
use pxpl5_renderer::Layout;
use pxpl5_sim::SplitMix64;
use pxpl5_wire::{FieldParity, NodeId, ViewNumber, Word};
use std::sync::Arc;

const PARAMETERS: u32 = 0x1_0000;
const SPHERE_PARAMETERS: u32 = 0x1_0400;
const MODELS: u32 = 0x1_6000;

fn board() -> Processor {
    Processor::new(NodeId(1), 2 << 20, CodeVersion::Compiled, i860::Config::cycle())
}

impl Numbers {
    fn rigid(&mut self) -> Mat4 {
        let turn = Quat::from_scaled_axis(self.vector(3.0));
        Mat4::from_rotation_translation(turn, self.vector(20.0))
    }

    /// Returns a matrix that rotates, moves and scales uniformly. Every third matrix also mirrors.
    fn model(&mut self, n: usize) -> Mat4 {
        let size = 10.0_f32.powf(self.next());
        let mirror = if n.is_multiple_of(3) { -1.0 } else { 1.0 };
        self.rigid() * Mat4::from_scale(Vec3::new(mirror * size, size, size))
    }

    fn projection(&mut self, n: usize) -> Mat4 {
        if n % 5 == 4 {
            return Mat4::orthographic_rh(-3.0 + self.next(), 4.0, -2.0, 2.0 + self.next(), 0.1, 60.0);
        }
        let lens = Mat4::perspective_rh(1.2 + 0.5 * self.next(), 4.0 / 3.0, 0.1, 60.0);
        let mut beside = lens;
        beside.z_axis.x = 0.2 * self.next();
        beside
    }
}

fn list(culling: Culling, light: Vec3) -> DisplayList {
    let structure = |spheres, frame| DisplayStructure { triangles: 0..0, spheres, frame, culling };
    DisplayList {
        spheres: vec![WorldSphere { centre: Vec3::ZERO, radius: 1.0, colour: [0; 3] }],
        structures: vec![structure(0..1, ModelFrame::World), structure(1..1, ModelFrame::Head)],
        towards_light: light.normalize(),
        ambient: 0.3,
        diffuse: 0.6,
        ..DisplayList::default()
    }
}

fn view(numbers: &mut Numbers, n: usize) -> FrameView {
    let eye =
        EyeView { world_to_eye: numbers.rigid(), head_to_eye: numbers.rigid(), projection: numbers.projection(n) };
    let edits = (0..2).map(|structure| ModelEdit { structure, model: numbers.model(n + structure as usize) });
    // Every seventh view leaves a structure without an edit.
    FrameView { number: ViewNumber::FIRST, eyes: vec![eye], edits: edits.skip(usize::from(n % 7 == 6)).collect() }
}

fn native(kernel: Kernel, place: &PlacedStructure) -> [Word; PARAMETER_WORDS] {
    let transform = place.transform.as_ref().expect("finite matrices");
    kernel.parameters(transform, &place.light, &[0; 8], 0)
}

#[test]
fn the_code_fills_parameter_blocks_as_the_native_firmware_does() {
    let mut numbers = Numbers(SplitMix64::new(31));
    let mut processor = board();
    for n in 0..3000 {
        let culls = n % 2 == 1;
        let list = list(if culls { Culling::Back } else { Culling::None }, numbers.vector(1.0));
        // The program of Slats has other matrices.
        let list = DisplayList { is_single: n % 4 < 2, ..list };
        let view = view(&mut numbers, n);
        let viewport = Viewport::FRAME;
        let kernel = Kernel::for_picture(Schedule::Compiled, KernelSurface::Phong, &viewport, true).expect("a frame");
        let kernel = Kernel { culls, ..kernel };
        for place in place_all(&list, &view, 0, viewport) {
            let expected = native(kernel, &place);
            // First, overwrite the part of the block that depends on a view.
            let mut spoilt = expected;
            [0..19, 68..71, 72..75, 76..79, 80..83, 84..86, 118..120]
                .into_iter()
                .flatten()
                .for_each(|at| spoilt[at] = 0xAAAA_AAAA);
            processor.write(PARAMETERS, &spoilt).expect("in memory");
            place.run_code(&list, &mut processor).expect("it returns");
            let found = processor.read(PARAMETERS, PARAMETER_WORDS).expect("in memory");
            for (at, (f, e)) in found.iter().zip(expected).enumerate() {
                assert_eq!(*f, e, "view {n}, word {at}: {} for {}", f32::from_bits(*f), f32::from_bits(e));
            }
        }
    }
}

/// Tests structures with spheres under any projection. For other structures the spheres' parameter block must stay
/// unchanged.
#[test]
fn the_code_fills_the_parameter_block_of_spheres_as_the_native_firmware_does() {
    let mut numbers = Numbers(SplitMix64::new(35));
    let mut processor = board();
    for n in 0..1000 {
        let list = DisplayList { is_single: n % 2 == 1, ..list(Culling::None, numbers.vector(1.0)) };
        let view = view(&mut numbers, n);
        let viewport = Viewport::field(FieldParity::Odd);
        let kernel = SphereKernel::for_picture(KernelSurface::Phong, &viewport).expect("a field");
        for place in place_all(&list, &view, 0, viewport) {
            processor.write(SPHERE_PARAMETERS, &[0xAAAA_AAAA; SPHERE_PARAMETER_WORDS]).expect("in memory");
            place.run_code(&list, &mut processor).expect("it returns");
            let found = processor.read(SPHERE_PARAMETERS, SPHERE_PARAMETER_WORDS).expect("in memory");
            if place.structure.spheres.is_empty() {
                assert!(found.iter().all(|word| *word == 0xAAAA_AAAA), "view {n}");
                continue;
            }
            let transform = place.transform.as_ref().expect("finite");
            let expected = kernel.parameters(transform, &place.light, &[]).expect("it can show spheres");
            for (at, (f, e)) in found.iter().zip(expected).enumerate() {
                assert_eq!(*f, e, "view {n}, word {at}");
            }
        }
    }
}

#[test]
fn edits_replace_the_matrices_of_their_structures_and_no_others() {
    let mut numbers = Numbers(SplitMix64::new(32));
    let mut processor = board();
    let mut models = vec![[0; 16]; 40];
    // Some counts exceed one message, and the largest count exceeds the table.
    for count in [0, 1, 2, 17, 54, 55, 200, 500] {
        let edits: Vec<_> =
            (0..count).map(|n| ModelEdit { structure: (7 * n + count) as u32 % 40, model: numbers.model(n) }).collect();
        edits.iter().for_each(|edit| models[edit.structure as usize] = edit.model.to_cols_array().map(f32::to_bits));
        let view = FrameView { number: ViewNumber::FIRST, eyes: Vec::new(), edits };
        let span = EditWork(&view).by_code(&GpTiming::PAPERS, &mut processor).expect("it returns");
        assert!(span > pxpl5_sim::Span::ZERO);
        assert!(processor.read(MODELS, 40 * 16).expect("in memory") == models.concat(), "{count} edits");
    }
}

/// A structure number beyond the table of matrices must be ignored, however large it is.
#[test]
fn edits_of_missing_structures_change_nothing() {
    let edits = vec![ModelEdit { structure: u32::MAX, model: Mat4::IDENTITY }];
    let view = FrameView { number: ViewNumber::FIRST, eyes: Vec::new(), edits };
    let mut processor = board();
    EditWork(&view).by_code(&GpTiming::PAPERS, &mut processor).expect("it returns");
    assert!(processor.read(MODELS, 1 << 10).expect("in memory").iter().all(|word| *word == 0));
}

/// If there are no structures, the beginning of a pass only resets the bins.
#[test]
fn bins_are_reset_to_their_first_addresses() {
    const MESSAGE: u32 = 0x1_4000;
    const BIN_TABLE: u32 = 0x1_0200;
    let mut numbers = SplitMix64::new(33);
    let heads: Vec<Word> = (0..40).map(|_| numbers.bits() as Word).collect();
    let share = Share::new(Arc::new(DisplayList::default()), 0, 1);
    let view = view(&mut Numbers(SplitMix64::new(34)), 0);
    for (viewport, bins) in [(Viewport::FRAME, 20), (Viewport::field(FieldParity::Odd), 10)] {
        let mut processor = board();
        processor.write(MESSAGE, &heads).expect("in memory");
        let layout = Layout::rendering_control_phong();
        let binning = RegionBinning::Touched;
        let picture = Picture { viewport, shading: Shading::Phong, binning, layout, pixels: false };
        share.beginning(&view, &[0], picture).by_code(&GpTiming::PAPERS, &mut processor).expect("it returns");
        let table = processor.read(BIN_TABLE, 40).expect("in memory");
        assert_eq!(table[..bins], heads[..bins]);
        assert!(table[bins..].iter().all(|word| *word == 0), "{bins} bins");
    }
}
