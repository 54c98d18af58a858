//! Tests of a slave: the use of memory, waiting, and the positions of vertices.

use super::*;
use crate::cube::{FaceUpdate, Faces, WarpedLists};
use crate::protocol::RegionEnd;
use glam::{Mat4, Vec3};
use pphigs::{BIN_ENTRY_BYTES, DisplayStructure, EyeView, FrameView, ModelFrame, Picture, RegionBinning, Shading};
use pxpl5_geometry::{Culling, Viewport};
use pxpl5_gp::{BoardBench, CodeVersion, GpBoard, GpEvent, GpTiming, OutOfMemory, Processor, Received, Work};
use pxpl5_renderer::{CommandKind, Layout};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{CopyContent, Lines, Message, RegionGrid, ViewNumber};

const MASTER: NodeId = NodeId(1);
const BOARD: NodeId = NodeId(2);
/// Number of triangles in the display list. All of them lie within one region of one face.
const TRIANGLES: u64 = 3;
const BIN_BYTES: u64 = TRIANGLES * BIN_ENTRY_BYTES;

/// The token of an update with a single region, in the state in which the last slave gets the token.
pub(crate) const TOKEN: Token =
    Token { drawing: Drawing(0), region: RegionId(0), renderer: 0, slaves_left: 1, of: 1, end: RegionEnd::Copied };

/// Returns a configuration with faces so small that each face is one region.
pub(crate) fn config() -> RenderingControlConfig<Faces> {
    let size = 128;
    let grid = RegionGrid { width: size, height: size, region_width: size, region_height: size };
    let picture = Picture {
        viewport: Viewport::new(grid, Lines::Frame).expect("a region"),
        shading: Shading::Gouraud,
        binning: RegionBinning::Touched,
        layout: Layout::slats(),
        pixels: false,
    };
    let content = CopyContent::Colour;
    RenderingControlConfig {
        host: NodeId(0),
        master: MASTER,
        slaves: vec![BOARD],
        renderers: vec![NodeId(3)],
        drawn: Faces { memories: vec![NodeId(4)], picture, content, warped: WarpedLists::default() },
    }
}

/// Returns a display list of `triangles` triangles, one behind the other, in front of the eye.
pub(crate) fn ahead(triangles: usize) -> Arc<DisplayList> {
    let mut list = DisplayList { towards_light: Vec3::Z, ambient: 0.2, diffuse: 0.8, ..DisplayList::default() };
    for number in 0..triangles {
        let depth = -2.0 - number as f32;
        list.positions.extend([Vec3::new(-0.5, -0.5, depth), Vec3::new(0.5, -0.5, depth), Vec3::new(0.0, 0.5, depth)]);
        list.normals.extend([Vec3::Z; 3]);
        list.colours.extend([[200; 3]; 3]);
        list.triangles.push([0, 1, 2].map(|corner| corner + 3 * number as u32));
    }
    let structure =
        DisplayStructure { triangles: 0..triangles, spheres: 0..0, frame: ModelFrame::World, culling: Culling::None };
    list.structures.push(structure);
    Arc::new(list)
}

pub(crate) fn update(number: u64) -> FaceUpdate {
    let projection = Mat4::perspective_rh(std::f32::consts::FRAC_PI_2, 1.0, 0.1, 100.0);
    let eye = EyeView { world_to_eye: Mat4::IDENTITY, head_to_eye: Mat4::IDENTITY, projection };
    FaceUpdate {
        number: PictureNumber(number),
        memory: 0,
        buffer: 0,
        together: 0,
        view: FrameView { number: ViewNumber::FIRST, eyes: vec![eye], edits: Vec::new() },
        structures: vec![true],
        warp: None,
    }
}

/// A slave on a test bench, which accepts each message at once.
struct Rig {
    bench: BoardBench,
    us: u64,
}

impl Rig {
    fn new(bin_bytes: u64) -> Self {
        let timing = GpTiming { bin_bytes, ..GpTiming::PAPERS };
        let mut board = GpBoard::new(BOARD, timing, Span(25_000));
        let gp = board.handle_for(Priority::Foreground);
        let share = Share::new(ahead(TRIANGLES as usize), 0, 1);
        slave(&gp, &config(), share, 0).into_iter().for_each(|(level, program)| board.load(level, Box::pin(program)));
        Self { bench: BoardBench::new(board), us: 0 }
    }

    /// Delivers two messages to the slave: the host's message with update `number`, and the master's message that
    /// permits EDIT.
    fn send(&mut self, number: u64) {
        self.deliver(&StageOrder::Send(update(number)));
        self.deliver(&StageOrder::Edit(PictureNumber(number)));
    }

    fn send_token(&mut self, number: u64) {
        let token = Token { drawing: Drawing(number), ..TOKEN };
        self.deliver(&StageOrder::Token(token));
    }

    /// Waits until the slave has finished its work, and then delivers a message.
    fn deliver(&mut self, order: &StageOrder<FaceUpdate>) {
        self.run_for(1_000);
        let (words, body) = order.message();
        let message = Message { source: MASTER, destination: BOARD, words, body };
        self.bench.feed(Time(self.us * 1_000_000), GpEvent::Delivered(message));
        self.run_for(1_000);
    }

    fn run_for(&mut self, us: u64) {
        for _ in 0..us {
            self.us += 1;
            let now = Time(self.us * 1_000_000);
            self.bench.accept_all(now);
            self.bench.run_until(now);
        }
    }

    /// Returns the updates whose TRANSFORM the slave has reported, each with its number of bin entries over all
    /// regions.
    fn transformed(&self) -> Vec<(u64, u32)> {
        let to_master = self.bench.sent().filter_map(|(time, message)| {
            let received = Received { arrived: time, source: BOARD, body: message.body.clone() };
            (message.destination == MASTER).then(|| StageOrder::<FaceUpdate>::read(&received, MASTER))
        });
        let transformed = to_master.filter_map(|order| match order {
            Ok(StageOrder::Transformed(update, entries)) => Some((update.0, entries.iter().sum())),
            _ => None,
        });
        transformed.collect()
    }
}

#[test]
fn an_update_needs_memory_for_its_commands_and_a_pointer_for_each_bin_entry() {
    let mut rig = Rig::new(BIN_BYTES);
    rig.send(0);
    assert_eq!(rig.transformed(), [(0, TRIANGLES as u32)]);
    let commands = TRIANGLES * 4 * u64::from(CommandKind::Triangle.words());
    let expected = PROGRAM_BYTES + TRIANGLES * Share::TRIANGLE_BYTES + commands + BIN_BYTES;
    assert_eq!(rig.bench.board.memory_peak_bytes(), expected);
}

/// Tests a board whose memory holds the bins of only one update. The slave has two sets of bins and uses them in turn.
#[test]
fn an_update_waits_until_the_bins_of_the_previous_update_are_free() {
    let mut rig = Rig::new(BIN_BYTES);
    rig.send(0);
    for number in 1..4 {
        rig.send(number);
        assert_eq!(rig.transformed().len() as u64, number, "the one before is still in the bins");
        rig.send_token(number - 1);
        assert_eq!(rig.transformed().last(), Some(&(number, TRIANGLES as u32)));
    }
    assert_eq!(rig.bench.board.fault(), None);
}

#[test]
fn bins_that_are_too_small_for_one_update_are_a_fault() {
    let mut rig = Rig::new(BIN_BYTES - 1);
    rig.send(0);
    let fault = OutOfMemory {
        gp: BOARD,
        account: Account::Bins(0),
        region: Some(RegionId(5)),
        needed_bytes: BIN_BYTES,
        available_bytes: BIN_BYTES - 1,
    };
    assert_eq!(rig.bench.board.fault(), Some(&Fault::Memory(fault)));
}

fn memory(processor: &Processor) -> Vec<u32> {
    processor.read(0, processor.memory_bytes() as usize / 4).expect("all of it")
}

#[test]
fn an_update_replaces_the_vertices_in_memory() {
    let lists = [0.0, 0.25].map(|moved| {
        let mut list = DisplayList::clone(&ahead(2));
        list.positions.iter_mut().for_each(|position| position.x += moved);
        Share::new(Arc::new(list), 0, 1)
    });
    let expected = lists.each_ref().map(|share| {
        let mut alone = Processor::new(BOARD, 8 << 20, CodeVersion::Compiled, i860::Config::cycle());
        share.install(&mut alone).expect("it fits");
        memory(&alone)
    });
    let mut board = GpBoard::new(BOARD, GpTiming::PAPERS, Span(25_000));
    board.run_code(CodeVersion::Compiled, i860::Config::cycle(), &Rc::default());
    let gp = board.handle_for(Priority::Foreground);
    gp.install(|processor| lists[0].install(processor)).expect("it fits");
    let mut installed = Arc::clone(lists[0].list());
    for place in [0, 1, 1, 0] {
        place_vertices(&gp, &lists[place], &mut installed).expect("it fits");
        assert!(board.with_processor(memory) == Some(expected[place].clone()), "{place}");
    }
}

/// Tests the time of TRANSFORM for six faces with the scheduled code. The time of one more triangle must lie between
/// two published times.
///
/// The triangle touches one face. The published times are 870 clocks (optimized code without extras) and 32 us (the
/// design figure).
#[test]
fn the_code_of_a_triangle_takes_the_published_time() {
    let ns = |triangles: usize| {
        let share = Share::new(ahead(triangles), 0, 1);
        let mut processor = Processor::new(BOARD, 8 << 20, CodeVersion::Scheduled, i860::Config::cycle());
        share.install(&mut processor).expect("it fits");
        let (drawn, update) = (config().drawn, update(0));
        let passes = drawn.passes(&share, &update, 0);
        drawn.work(&share, &update, &passes, 0).by_code(&GpTiming::PAPERS, &mut processor).expect("it returns").as_ms()
            * 1e6
    };
    let of_one = (ns(20) - ns(10)) / 10.0;
    assert!((18_000.0..32_000.0).contains(&of_one), "{of_one}");
}

#[test]
fn a_context_counts_the_tokens_of_the_next_update_from_zero() {
    let mut state = SlaveState::<FaceUpdate>::new();
    let tokens = [(0, 3, false), (1, 2, false), (0, 3, false), (0, 3, true), (1, 2, true)];
    for (context, of, is_last) in tokens.into_iter().chain(tokens) {
        assert_eq!(state.count_token(context, of), is_last, "{context}");
    }
}
