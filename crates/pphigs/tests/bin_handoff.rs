//! Tests of the code that sends a bin. The messages and words must equal the messages and words of the native firmware.

use crate::numbers::Numbers;
use glam::{Mat4, Vec3};
use pphigs::{
    BinHandoffWork, DisplayList, DisplayStructure, EyeView, FrameView, ModelFrame, Pass, Picture, RegionBinning,
    RegionEnvelope, Shading, Share, region_messages,
};
use pxpl5_geometry::{Culling, Viewport, WorldSphere};
use pxpl5_gp::{CodeVersion, GpTiming, Processor, ProcessorFault, Work};
use pxpl5_renderer::Layout;
use pxpl5_sim::{Span, SplitMix64};
use pxpl5_wire::{
    CopyContent, CopyOrder, CopyPath, CopyTarget, Lines, NodeId, PictureNumber, RegionGrid, RegionId, ViewNumber, Word,
};
use std::sync::Arc;

/// Commands lie after the first megabyte of memory. The commands of the envelopes lie in the first megabyte, which
/// belongs to the program.
const PROGRAMS_END: Word = 1 << 20;

/// Returns small triangles and spheres in front of the eye. Most primitives are near the middle, so that some bins fill
/// several messages.
fn share(triangles: u32, spheres: usize) -> Share {
    let mut numbers = Numbers(SplitMix64::new(3));
    let mut list = DisplayList { towards_light: Vec3::Z, ambient: 0.2, diffuse: 0.8, ..DisplayList::default() };
    for number in 0..triangles {
        let centre = Vec3::new(0.0, 0.0, -6.0) + numbers.vector(if number % 3 == 0 { 1.5 } else { 0.3 });
        for corner in 0..3 {
            list.positions.push(centre + numbers.vector(0.1));
            list.normals.push(Vec3::Z);
            list.colours.push([corner * 100; 3]);
        }
        list.triangles.push([3 * number, 3 * number + 1, 3 * number + 2]);
    }
    let sphere =
        |_| WorldSphere { centre: Vec3::new(0.0, 0.0, -6.0) + numbers.vector(0.8), radius: 0.05, colour: [9; 3] };
    list.spheres = (0..spheres).map(sphere).collect();
    let (frame, culling) = (ModelFrame::World, Culling::None);
    list.structures = vec![DisplayStructure { triangles: 0..triangles as usize, spheres: 0..spheres, frame, culling }];
    Share::new(Arc::new(list), 0, 1)
}

fn pass(share: &Share, x: f32, shading: Shading, layout: Layout, binning: RegionBinning) -> Arc<Pass> {
    let matrix = Mat4::from_translation(Vec3::new(x, 0.0, 0.0));
    let projection = Mat4::perspective_rh(0.9, 4.0 / 3.0, 0.5, 40.0);
    let eyes = vec![EyeView { world_to_eye: matrix, head_to_eye: matrix, projection }];
    let view = FrameView { number: ViewNumber::FIRST, eyes, edits: Vec::new() };
    share.transform(&view, 0, Picture { viewport: Viewport::FRAME, shading, binning, layout, pixels: true })
}

fn order(region: RegionId) -> CopyOrder {
    let target = CopyTarget {
        frame_buffer: NodeId(40),
        buffer: 0,
        lines: Lines::Frame,
        grid: RegionGrid::FRAME,
        region,
        picture: PictureNumber::FIRST,
    };
    CopyOrder { target, context: 0, way: CopyPath::ThroughBacking, acknowledge: None, content: CopyContent::Colour }
}

fn envelopes(region: RegionId) -> [RegionEnvelope; 4] {
    let nothing = RegionEnvelope::default();
    let begin = RegionEnvelope { begin: true, ..nothing };
    let end = RegionEnvelope { shade: true, copy: Some(order(region)), ..nothing };
    [nothing, begin, end, RegionEnvelope { begin: true, ..end }]
}

/// Compares the messages of a bin that code has filled with the native messages. Returns the number of messages.
fn compare(
    processor: &mut Processor,
    pass: &Arc<Pass>,
    context: u8,
    region: RegionId,
    envelope: RegionEnvelope,
) -> usize {
    let handoff = BinHandoffWork { pass, context, view: 0, region, envelope };
    let span = handoff.by_code(&GpTiming::PAPERS, processor).expect("it returns");
    assert!(span > Span::ZERO);
    let found = BinHandoffWork::listed(processor).expect("in memory");
    let expected = region_messages(pass, region, 0, envelope);
    assert_eq!(found.len(), expected.len(), "messages of region {region:?} with {envelope:?}");
    for (pieces, list) in found.iter().zip(&expected) {
        let mut words = Vec::new();
        list.content.as_ref().expect("pixels are wanted").append_words(&mut words);
        assert_eq!(pieces.iter().map(|piece| piece[1]).sum::<Word>(), list.words());
        let mut rest = words.as_slice();
        for [address, length] in pieces {
            let (piece, behind) = rest.split_at(*length as usize);
            if *address >= PROGRAMS_END {
                assert_eq!(processor.read(*address, piece.len()).expect("in memory"), piece, "region {region:?}");
            }
            rest = behind;
        }
    }
    found.len()
}

#[test]
fn code_sends_the_same_words_as_the_native_firmware() {
    let layouts = [(Shading::Phong, Layout::rendering_control_phong()), (Shading::Gouraud, Layout::slats())];
    for (triangles, spheres) in [(400, 0), (300, 60), (0, 100), (0, 0)] {
        let share = share(triangles, spheres);
        for (shading, layout) in layouts {
            let mut processor = Processor::new(NodeId(1), 8 << 20, CodeVersion::Scheduled, i860::Config::cycle());
            share.install(&mut processor).expect("it fits");
            let passes = [-0.1, 0.1].map(|x| pass(&share, x, shading, layout, RegionBinning::Touched));
            for (context, pass) in (0..).zip(&passes) {
                pass.run_code(&mut processor, context).expect("it returns").expect("it has a kernel");
            }
            // Tokens of both contexts arrive while both bins are full.
            let mut most = 0;
            for (region, (context, pass)) in
                (0..20).map(RegionId).flat_map(|r| (0..).zip(&passes).map(move |of| (r, of)))
            {
                for envelope in envelopes(region) {
                    most = most.max(compare(&mut processor, pass, context, region, envelope));
                }
            }
            let expected = if triangles + spheres as u32 > 0 { 2..20 } else { 0..2 };
            assert!(expected.contains(&most), "{most} messages at most of {triangles} triangles and {spheres} spheres");
        }
    }
}

/// The list of pieces has room for 44,236 entries of a bin. A board with 8 MB never has so many entries, but a board
/// with more memory can.
#[test]
fn a_bin_with_too_many_entries_is_a_fault() {
    let triangles: usize = 44_300;
    let mut list = DisplayList { towards_light: Vec3::Z, ambient: 0.2, diffuse: 0.8, ..DisplayList::default() };
    list.positions = [Vec3::ZERO, Vec3::X, Vec3::Y].map(|at| at * 0.01 - Vec3::Z * 6.0).to_vec();
    list.normals = vec![Vec3::Z; 3];
    list.colours = vec![[200; 3]; 3];
    list.triangles = vec![[0, 1, 2]; triangles];
    let (frame, culling) = (ModelFrame::World, Culling::None);
    list.structures = vec![DisplayStructure { triangles: 0..triangles, spheres: 0..0, frame, culling }];
    let share = Share::new(Arc::new(list), 0, 1);
    let pass = pass(&share, 0.1, Shading::Gouraud, Layout::slats(), RegionBinning::Touched);
    let full = (0..20).map(RegionId).find(|region| pass.counts(*region).total() as usize == triangles).expect("in one");
    let mut processor = Processor::new(NodeId(7), 64 << 20, CodeVersion::Scheduled, i860::Config::cycle());
    let handoff =
        BinHandoffWork { pass: &pass, context: 1, view: 0, region: full, envelope: RegionEnvelope::default() };
    let fault = handoff.by_code(&GpTiming::PAPERS, &mut processor).expect_err("too many");
    let (needed_bytes, available_bytes) = (8 * triangles as u32, 8 * 44_236);
    assert_eq!(fault, ProcessorFault::NoRoom { gp: NodeId(7), context: 1, needed_bytes, available_bytes });
}

#[test]
fn the_published_time_of_sending_a_message_includes_the_bin_handoff() {
    let share = share(30, 0);
    let layout = Layout::rendering_control_phong();
    let pass = pass(&share, 0.0, Shading::Phong, layout, RegionBinning::Touched);
    let regions = (0..20).map(RegionId);
    let region = regions.max_by_key(|region| pass.counts(*region).total()).expect("twenty");
    let handoff = BinHandoffWork { pass: &pass, context: 0, view: 0, region, envelope: RegionEnvelope::default() };
    assert_eq!(handoff.by_table(&GpTiming::PAPERS), Span::ZERO);
    let entries = u64::from(pass.counts(region).total());
    assert!(entries > 0);
    let timing = GpTiming { token_entry_ns: 700, ..GpTiming::PAPERS };
    assert_eq!(handoff.by_table(&timing), Span::from_ns(700 * entries));
}

#[test]
fn without_bins_in_the_memory_of_the_processor_a_handoff_takes_no_time() {
    let share = share(30, 0);
    let pass = pass(&share, 0.0, Shading::Gouraud, Layout::slats(), RegionBinning::All);
    let mut processor = Processor::new(NodeId(1), 8 << 20, CodeVersion::Scheduled, i860::Config::cycle());
    let handoff =
        BinHandoffWork { pass: &pass, context: 0, view: 0, region: RegionId(9), envelope: RegionEnvelope::default() };
    assert_eq!(handoff.by_code(&GpTiming::PAPERS, &mut processor), Ok(Span::ZERO));
}
