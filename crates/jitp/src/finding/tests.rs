//! Tests of the i860 code that searches the triangles and spheres of a window. For random scenes and windows, the code
//! must give the same messages to renderers as the native firmware.

use crate::config::{Beam, BlockOrder, DrawingSchedule, Interpolation, JitpConfig, Viewpoint};
use crate::drawing::{DrawnList, Ends, Window, interpolated};
use crate::finding::StripSearchWork;
use crate::pieces::{messages, window};
use crate::timing::JitpTiming;
use crate::whole::{WholeList, picture};
use glam::{Mat4, Vec3};
use pphigs::{
    DisplayList, DisplayStructure, EyeView, FrameView, MemoryPart, ModelEdit, ModelFrame, SearchOutput, Share,
    TransformCost, WindowSearchWork,
};
use pxpl5_geometry::{Culling, Viewport, WorldSphere};
use pxpl5_gp::{CodeVersion, GpTiming, Processor, Work};
use pxpl5_renderer::Layout;
use pxpl5_sim::{SplitMix64, Time};
use pxpl5_wire::display::Aim;
use pxpl5_wire::{NodeId, PeriodNumber, PictureNumber, RegionId, ViewNumber, Word};
use std::sync::Arc;

const VERSIONS: [CodeVersion; 3] = [CodeVersion::Unoptimised, CodeVersion::Compiled, CodeVersion::Scheduled];
/// Half of the picture's height, for a picture plane at distance 1 from the eye.
const TANGENT: f32 = 0.5;

struct Numbers(SplitMix64);

impl Numbers {
    /// Returns a random number from -1 to 1.
    fn next(&mut self) -> f32 {
        2.0 * self.0.unit() - 1.0
    }

    fn below(&mut self, n: usize) -> usize {
        (self.0.unit() * n as f32) as usize % n
    }

    fn vector(&mut self, size: f32) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * size
    }

    /// Returns the point at the depth `distance` that appears at pixel (x, y) of a frame of 640 x 480 pixels.
    fn seen_at([x, y]: [f32; 2], distance: f32) -> Vec3 {
        let across = (x / 320.0 - 1.0) * TANGENT * 4.0 / 3.0;
        Vec3::new(across, (1.0 - y / 240.0) * TANGENT, -1.0) * distance
    }

    /// Returns the corners of a random triangle. The triangle can be small, a sliver, large, or beside the eye. Small
    /// triangles are anywhere in the picture, or where four regions meet.
    ///
    /// No sliver extends so far in depth that its depth plane would be flattened, because kernels flatten only the
    /// planes of clipped pieces.
    fn triangle(&mut self) -> [Vec3; 3] {
        let [x, y] = match self.below(4) {
            0 => [128.0 * (1 + self.below(4)) as f32, 120.0 * (1 + self.below(3)) as f32],
            1 => [128.0 * (1 + self.below(4)) as f32, 128.0 * (1 + self.below(3)) as f32],
            _ => [320.0 + 400.0 * self.next(), 240.0 + 300.0 * self.next()],
        };
        let sizes = [[0.8, 0.8], [0.8, 0.8], [2.0, 2.0], [30.0, 0.7], [0.7, 40.0], [300.0, 200.0], [20.0, 20.0]];
        let [wide, high] = sizes[self.below(7)];
        if self.below(25) == 0 {
            return [self.vector(9.0), self.vector(9.0), self.vector(9.0)];
        }
        let distance = 3.0 + self.next();
        [0; 3].map(|_| {
            let at = [x + wide * self.next(), y + high * self.next()];
            Self::seen_at(at, distance + 0.001 * self.next())
        })
    }
}

fn list(numbers: &mut Numbers, triangles: u32, spheres: usize) -> Arc<DisplayList> {
    let mut list = DisplayList { towards_light: Vec3::Y, ambient: 0.25, diffuse: 0.75, ..DisplayList::default() };
    for number in 0..triangles {
        for (n, corner) in numbers.triangle().into_iter().enumerate() {
            list.positions.push(corner);
            list.normals.push(numbers.vector(1.0));
            list.colours.push([100 * n as u8; 3]);
        }
        list.triangles.push([3 * number, 3 * number + 1, 3 * number + 2]);
    }
    let sphere = |_| {
        let at = [320.0 + 350.0 * numbers.next(), 240.0 + 260.0 * numbers.next()];
        WorldSphere {
            centre: Numbers::seen_at(at, 3.0 + numbers.next()),
            radius: (0.1 * numbers.next()).abs(),
            colour: [200, 100, 50],
        }
    };
    list.spheres = (0..spheres).map(sphere).collect();
    let third = |all: usize, n: usize| all * n / 3..all * (n + 1) / 3;
    list.structures = (0..3)
        .map(|n| DisplayStructure {
            triangles: third(triangles as usize, n),
            spheres: third(spheres, n),
            frame: if n == 1 { ModelFrame::Head } else { ModelFrame::World },
            culling: if n == 2 { Culling::Back } else { Culling::None },
        })
        .collect();
    Arc::new(list)
}

fn view(numbers: &mut Numbers) -> FrameView {
    let moved = Mat4::from_translation(numbers.vector(0.01));
    let projection = Mat4::perspective_rh(2.0 * TANGENT.atan(), 4.0 / 3.0, 0.5, 60.0);
    let eye = EyeView { world_to_eye: moved, head_to_eye: Mat4::IDENTITY, projection };
    FrameView { number: ViewNumber::FIRST, eyes: vec![eye], edits: Vec::new() }
}

fn config(schedule: DrawingSchedule) -> JitpConfig {
    JitpConfig {
        host: NodeId(0),
        master: NodeId(1),
        slaves: vec![NodeId(2)],
        renderers: vec![NodeId(3)],
        frame_buffer: NodeId(4),
        schedule,
        beam: Beam::new(|_, _, _| Time::ZERO, |_| Time::ZERO),
        aim: Aim::default(),
        layout: Layout::slats(),
        pixels: true,
        timing: JitpTiming::PAPERS,
    }
}

fn strips(strip_rows: u32) -> JitpConfig {
    config(DrawingSchedule::Beam { viewpoint: Viewpoint::Field, racing: false, strip_rows })
}

/// Returns two random views. In the second view, both the eye and structure 0 are rotated by about `turn` radians.
fn two_views(numbers: &mut Numbers, turn: f32) -> [FrameView; 2] {
    [0.0, turn].map(|turn| {
        let mut view = view(numbers);
        view.eyes[0].world_to_eye *= Mat4::from_rotation_y(0.3 * turn) * Mat4::from_rotation_z(turn);
        view.eyes[0].head_to_eye *= Mat4::from_rotation_x(0.1 * turn);
        view.edits = vec![ModelEdit { structure: 0, model: Mat4::from_rotation_z(turn) }];
        view
    })
}

fn blocks(block: u32) -> JitpConfig {
    config(DrawingSchedule::Roam { block, batch: 16, order: BlockOrder::new(|step| RegionId(step as u16)) })
}

/// A board with i860 code, and a random scene that the code has transformed into the board's memory.
struct Scene {
    processor: Processor,
    share: Share,
    drawn: Arc<DrawnList>,
    config: JitpConfig,
    picture: PictureNumber,
    viewport: Viewport,
    part: MemoryPart,
    interpolation: Option<Interpolation>,
}

impl Scene {
    fn new(config: &JitpConfig, version: CodeVersion, seed: u64, [triangles, spheres]: [u32; 2]) -> Self {
        let numbers = &mut Numbers(SplitMix64::new(seed));
        let list = list(numbers, triangles, spheres as usize);
        let share = Share::new(Arc::clone(&list), 0, 1);
        let mut processor = Processor::new(NodeId(2), 8 << 20, version, i860::Config::cycle());
        share.install(&mut processor).expect("it fits");
        let picture = PictureNumber::drawn_for(PeriodNumber(seed));
        let viewport = config.extent(picture).0;
        let part = MemoryPart::of(seed as usize % 4, 5);
        let view = view(numbers);
        let drawn = Arc::new(DrawnList::from_view(&list, &view, viewport));
        let (config, interpolation) = (config.clone(), None);
        let mut scene = Self { processor, share, drawn, config, picture, viewport, part, interpolation };
        scene.keep(std::slice::from_ref(&view));
        scene
    }

    /// Transforms the scene for two views that differ by a rotation of `turn` radians, and returns the result.
    fn between(&mut self, seed: u64, turn: f32, interpolation: Interpolation) -> Ends {
        let views = two_views(&mut Numbers(SplitMix64::new(seed)), turn).to_vec();
        self.keep(&views);
        self.interpolation = Some(interpolation);
        Ends::new(self.share.list(), views, self.viewport)
    }

    /// Interpolates a strip between two views: `s` is 0 for the first view and 1 for the second view. Searches the
    /// strip's triangles and spheres, and compares the messages with the messages of the native firmware.
    fn search_between(&mut self, ends: &Ends, s: f64, strip: u32) -> SearchOutput {
        let interpolation = self.interpolation.expect("between two views");
        self.drawn = Arc::new(DrawnList::between(self.share.list(), ends, s, interpolation, self.viewport));
        let regions = self.config.strip_regions(strip);
        let windows = self.windows(&regions);
        let parts = [self.part, MemoryPart::of(4, 5)];
        let drawn = Arc::clone(&self.drawn);
        let picture = picture(self.viewport, self.config.layout);
        let interpolating = drawn.interpolating(&self.share, &windows, picture, parts).expect("between two views");
        interpolating.run_code(&GpTiming::PAPERS, &mut self.processor).expect("it returns").expect("it has kernels");
        let of_ends = std::mem::replace(&mut self.part, parts[1]);
        let output = self.search(&regions);
        self.part = of_ends;
        output
    }

    fn windows(&self, regions: &[RegionId]) -> Vec<Window> {
        regions.iter().map(|region| window(&self.config, &self.viewport, *region)).collect()
    }

    fn keep(&mut self, views: &[FrameView]) {
        let pass = TransformCost::pass_over(self.share.list(), self.share.counts());
        let layout = self.config.layout;
        let whole = WholeList { share: &self.share, pass, views, viewport: self.viewport, layout, part: self.part };
        whole.by_code(&GpTiming::PAPERS, &mut self.processor).expect("it returns");
    }

    /// Searches the triangles and spheres of `regions` by i860 code, and compares the messages with the messages of the
    /// native firmware.
    fn search(&mut self, regions: &[RegionId]) -> SearchOutput {
        let windows = self.windows(regions);
        let (counts, _) = self.drawn.count(&windows);
        for (window, counts) in windows.iter().zip(&counts) {
            let mut commands = 0;
            self.drawn.triangle_commands(window, |_| commands += 1);
            assert_eq!(commands, counts.triangles, "as many are drawn as are counted: {window:?}");
        }
        let searching = WindowSearchWork {
            part: self.part,
            viewport: self.viewport,
            grid: self.config.grid(),
            windows: regions,
            counts: &counts,
        };
        let output = searching.run_code(&mut self.processor).expect("it returns").expect("a pass is kept");
        let listed = output.listed(&self.processor).expect("in memory");
        let mut listed = listed.iter();
        for (number, region) in regions.iter().enumerate() {
            let target = self.config.target(self.picture, *region);
            let native = messages(&self.config, &self.drawn, windows[number], counts[number], target);
            assert_eq!(output.messages[number] as usize, native.len(), "messages of {region:?}");
            for list in native {
                let mut words = Vec::new();
                list.content.as_ref().expect("pixels are wanted").append_words(&mut words);
                let pieces = listed.next().expect("as many as are counted");
                self.assert_words(pieces, &words, *region);
            }
        }
        output
    }

    /// Compares the words of a message with the words of the native message. Pieces below address 0x100000 are skipped:
    /// these are the commands that begin and end a region.
    fn assert_words(&self, pieces: &[[Word; 2]], native: &[Word], region: RegionId) {
        let mut native = native;
        for [address, length] in pieces {
            let (of_piece, rest) = native.split_at_checked(*length as usize).expect("no longer than the native one");
            native = rest;
            if *address >= 1 << 20 {
                let found = self.processor.read(*address, *length as usize).expect("in memory");
                assert!(
                    found == of_piece,
                    "a command at {address:#x} for {region:?} by {:?} code",
                    self.processor.version()
                );
            }
        }
        assert!(native.is_empty(), "no shorter than the native message for {region:?}");
    }

    fn all_regions(&self) -> Vec<RegionId> {
        (0..self.config.grid().regions() as u16).map(RegionId).collect()
    }
}

#[test]
fn code_selects_the_same_primitives_on_a_strip_as_the_native_firmware() {
    for (seed, rows) in [1, 7, 8, 50, 120].into_iter().enumerate() {
        for version in VERSIONS {
            for field in 0..2 {
                let config = strips(rows);
                let mut scene = Scene::new(&config, version, 2 * seed as u64 + field, [600, 40]);
                for strip in 0..config.grid().rows() {
                    scene.search(&config.strip_regions(strip));
                }
            }
        }
    }
}

#[test]
fn code_selects_the_same_primitives_in_blocks_as_the_native_firmware() {
    for (seed, block) in [16, 24, 128].into_iter().enumerate() {
        for version in VERSIONS {
            let mut scene = Scene::new(&blocks(block), version, 20 + seed as u64, [600, 40]);
            let mut all = scene.all_regions();
            let numbers = &mut Numbers(SplitMix64::new(3));
            (1..all.len()).for_each(|n| all.swap(n, numbers.below(n)));
            all.chunks(16).for_each(|batch| {
                scene.search(batch);
            });
        }
    }
}

/// Tests more windows than a table holds, and a region with more commands than a message holds.
#[test]
fn many_windows_need_several_passes_and_a_region_with_many_entries_needs_several_messages() {
    let mut scene = Scene::new(&blocks(128), CodeVersion::Compiled, 5, [3_000, 100]);
    let all = scene.all_regions();
    assert!(scene.search(&all).messages.iter().all(|messages| *messages > 1));
    let mut scene = Scene::new(&blocks(16), CodeVersion::Compiled, 5, [300, 20]);
    let all = scene.all_regions();
    scene.search(&all[300..500]);
}

#[test]
fn empty_lists_and_lists_of_one_kind_are_searched() {
    for primitives in [[0, 0], [40, 0], [0, 40]] {
        let config = strips(8);
        let mut scene = Scene::new(&config, CodeVersion::Scheduled, 7, primitives);
        for strip in 0..config.grid().rows() {
            let output = scene.search(&config.strip_regions(strip));
            assert_eq!(output.messages, [1; 5], "one that clears and copies, each");
        }
    }
}

/// Tests strips at five times: before the first view, at each of the two views, and between them. The large rotations
/// move the corners of triangles on curved paths across the screen.
#[test]
fn code_draws_a_strip_between_two_views_as_the_native_firmware_does() {
    for (seed, (rows, turn)) in (40..).zip([(1, 0.05), (8, 0.05), (7, 0.8), (1, 1.5)]) {
        for interpolation in [Interpolation::Screen, Interpolation::View] {
            for field in 0..2 {
                let config = strips(rows);
                let mut scene = Scene::new(&config, VERSIONS[seed as usize % 3], 2 * seed + field, [150, 10]);
                let ends = scene.between(seed, turn, interpolation);
                for strip in (field as u32..config.grid().rows()).step_by(if rows == 1 { 7 } else { 2 }) {
                    let part = [-0.06, 0.0, 0.37, 0.5, 1.0][strip as usize % 5];
                    scene.search_between(&ends, part, strip);
                }
            }
        }
    }
}

/// Tests that the search counts as many triangles as are drawn, for large rotations. The corners of a triangle then
/// move on strongly curved paths across the screen.
#[test]
fn the_counts_of_a_strip_between_two_views_equal_the_drawn_primitives() {
    let config = strips(1);
    let mut scene = Scene::new(&config, CodeVersion::Compiled, 60, [600, 0]);
    for interpolation in [Interpolation::Screen, Interpolation::View] {
        let ends = scene.between(60, 1.5, interpolation);
        let drawn = DrawnList::between(scene.share.list(), &ends, 0.5, interpolation, scene.viewport);
        for strip in 0..config.grid().rows() {
            let windows = scene.windows(&config.strip_regions(strip));
            let (counts, _) = drawn.count(&windows);
            for (window, counts) in windows.iter().zip(counts) {
                let mut commands = 0;
                drawn.triangle_commands(window, |_| commands += 1);
                assert_eq!(commands, counts.triangles, "{window:?}, {interpolation:?}");
            }
        }
    }
}

#[test]
fn a_strip_between_two_views_takes_the_time_of_interpolation_plus_the_time_of_the_search() {
    let spans = [false, true].map(|is_one_work| {
        let config = strips(8);
        let mut scene = Scene::new(&config, CodeVersion::Compiled, 80, [150, 10]);
        let ends = scene.between(80, 0.05, Interpolation::Screen);
        let drawn = DrawnList::between(scene.share.list(), &ends, 0.5, Interpolation::Screen, scene.viewport);
        let regions = config.strip_regions(12);
        let windows = scene.windows(&regions);
        let (counts, met) = drawn.count(&windows);
        let parts = [scene.part, MemoryPart::of(4, 5)];
        let interpolating = drawn.interpolating(&scene.share, &windows, picture(scene.viewport, config.layout), parts);
        let viewport = scene.viewport;
        let searching =
            WindowSearchWork { part: parts[1], viewport, grid: config.grid(), windows: &regions, counts: &counts };
        let (timing, processor) = (&GpTiming::PAPERS, &mut scene.processor);
        if is_one_work {
            let finding = StripSearchWork { searching, interpolating, met, interpolate_ns: 0 };
            return finding.by_code(timing, processor).expect("it returns");
        }
        let interpolated = interpolating.expect("between two views").run_code(timing, processor).expect("it returns");
        interpolated.expect("it has kernels") + searching.by_code(timing, processor).expect("it returns")
    });
    assert_eq!(spans[0], spans[1]);
}

/// Tests a rotation by 20 degrees about the line of sight, for the view and a structure together. Corners then deviate
/// from a straight path by up to 7 pixels. A triangle can therefore touch a strip between the views and lie far from
/// the strip in both views. The search must find such triangles.
#[test]
fn primitives_that_cross_a_strip_between_two_views_are_kept() {
    let config = strips(1);
    let scene = Scene::new(&config, CodeVersion::Compiled, 90, [3_000, 0]);
    let views = [-10_f32, 10.0].map(|degrees| {
        let turn = Mat4::from_rotation_z(degrees.to_radians());
        let mut view = view(&mut Numbers(SplitMix64::new(90)));
        view.eyes[0].world_to_eye = turn * view.eyes[0].world_to_eye;
        view.edits = vec![ModelEdit { structure: 0, model: turn }];
        view
    });
    let list = scene.share.list();
    let ends = Ends::new(list, views.to_vec(), scene.viewport);
    let between = DrawnList::between(list, &ends, 0.5, Interpolation::View, scene.viewport);
    let alone = DrawnList::from_view(list, &interpolated(&views[0], &views[1], 0.5), scene.viewport);
    for strip in 0..config.grid().rows() {
        let windows = scene.windows(&config.strip_regions(strip));
        assert_eq!(between.count(&windows), alone.count(&windows), "{strip}");
    }
}
