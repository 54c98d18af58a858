//! Runs a triangle kernel on the processor model with 8 MB of memory, and says what native code makes of the same
//! triangles. Shared by the test of the kernels and by the example that reports their clocks.

#![allow(dead_code, reason = "the test and the example each use a part")]

use glam::{Mat4, Vec3};
use i860::{Config, Cpu, Outcome, Profile, Program, Ram, assemble};
use pxpl5_geometry::{Culling, Light, SetupStats, Transform, Triangle, ViewTransform, Viewport};
use pxpl5_renderer::{Command, Layout};
use std::collections::BTreeMap;

const KERNELS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../pxpl5-geometry/kernels/");

/// Memory of a graphics processor in bytes (published).
pub(crate) const MEMORY: usize = 8 << 20;
const CODE: u32 = 0x1000;
const PARAMETERS: u32 = 0x1_0000;
const BIN_TABLE: u32 = 0x1_0200;
const STACK: u32 = 0x1_0400;
const TRIANGLES: u32 = 0x2_0000;
const COMMANDS: u32 = 0x20_0000;
const CLIP_LIST: u32 = 0x50_0000;
const BINS: u32 = 0x60_0000;
const BIN_BYTES: u32 = 0x1_8000;
const RETURN: u32 = 0x0800;
const REGIONS: u32 = 20;
const COMMAND_WORDS: usize = 30;

/// Which kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kernel {
    /// As a compiler of 1989 would give it, inlined.
    Straight,
    /// Scheduled in dual-instruction mode, in cache.
    Dual,
}

fn source(kernel: Kernel) -> String {
    let file = match kernel {
        Kernel::Straight => "triangle_straight.s",
        Kernel::Dual => "triangle_dual.s",
    };
    let read = |name: &str| {
        let path = format!("{KERNELS}{name}");
        std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"))
    };
    format!("{}\n{}\n{}\n", read("parameters.s"), read(file), read("bins.s"))
}

/// Assembles a kernel with its bins.
pub(crate) fn program(kernel: Kernel) -> Program {
    assemble("kernel", CODE, &source(kernel)).unwrap_or_else(|e| panic!("{e}"))
}

/// A view down -Z over a frame of 640 x 480.
pub(crate) fn view() -> ViewTransform {
    let model_view = Mat4::from_translation(Vec3::new(0.25, -0.5, -6.0));
    ViewTransform { model_view, projection: Mat4::perspective_rh(0.9, 4.0 / 3.0, 0.5, 40.0) }
}

/// Numbers in -1 to 1, the same on every host.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1u32 << 23) as f32 - 1.0
    }

    fn vector(&mut self, size: f32) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * size
    }
}

/// Triangles of about `size` world units around the middle of the picture, each corner coloured at random.
pub(crate) fn triangles(count: usize, size: f32, seed: u64) -> Vec<Triangle> {
    let mut numbers = Numbers(seed);
    let mut one = |_| {
        let centre = numbers.vector(2.4);
        let positions = [0, 1, 2].map(|_| centre + numbers.vector(size));
        let mut byte = || ((numbers.next() + 1.0) * 127.0) as u8;
        let colours = [0, 1, 2].map(|_| [byte(), byte(), byte()]);
        Triangle { positions, normals: [Vec3::Z; 3], colours }
    };
    (0..count).map(&mut one).collect()
}

/// What a kernel left in memory.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Output {
    /// Commands in order.
    pub(crate) commands: Vec<Vec<u32>>,
    /// Regions of each command, by rising number.
    pub(crate) regions: Vec<Vec<u16>>,
    /// Numbers of the triangles left to the clipper.
    pub(crate) clipped: Vec<usize>,
}

/// What native code makes of the triangles: the commands of those wholly inside the guard band, their regions, and
/// the numbers of the rest; and the number of planes flattened, which the kernels do not do.
pub(crate) fn native(triangles: &[Triangle]) -> (Output, u64) {
    let viewport = Viewport::FRAME;
    let transform = Transform::new(&view(), viewport, Culling::None).expect("finite");
    let mut stats = SetupStats::default();
    let mut output = Output { commands: Vec::new(), regions: Vec::new(), clipped: Vec::new() };
    for (n, triangle) in triangles.iter().enumerate() {
        let before = (stats.clipped, stats.outside, stats.not_finite);
        let mut found = Vec::new();
        transform.gouraud(triangle, &Light::NONE, &mut stats, |screen| found.push(screen));
        if before != (stats.clipped, stats.outside, stats.not_finite) {
            output.clipped.push(n);
            continue;
        }
        for screen in found {
            let set_up = screen.gouraud(&viewport, &mut stats);
            let command = pxpl5_renderer::Triangle { edges: set_up.edges, depth: set_up.z, colour: set_up.rgb };
            let mut words = Vec::new();
            Command::Triangle(command)
                .encode(&Layout::rendering_control_phong(), &mut words)
                .expect("every layout has triangles");
            output.commands.push(words);
            output.regions.push(screen.outline.regions.iter().map(|r| r.0).collect());
        }
    }
    (output, stats.flattened_planes)
}

/// The seven instruction heads of a triangle command, taken from a command of zeros.
fn heads() -> [u32; 7] {
    let mut words = Vec::new();
    let blank = Command::Triangle(pxpl5_renderer::Triangle::default());
    blank.encode(&Layout::rendering_control_phong(), &mut words).expect("every layout has triangles");
    assert_eq!(words.len(), COMMAND_WORDS);
    [0, 1, 13, 17, 18, 22, 26].map(|at| words[at])
}

/// The parameter block for [`view`] and a frame.
fn parameters() -> Vec<u8> {
    let view = view();
    let (rows, origin) = rows_and_origin(&view);
    let limit = ((pxpl5_geometry::GUARD_PIXELS - 1) * 16) as f32;
    let (cx, cy) = (640.0f32 * 8.0, 480.0f32 * 8.0);
    let mut singles: Vec<f32> = rows.into_iter().flatten().collect();
    singles.extend(origin.to_array());
    singles.extend([0.0, (limit - cx) / cx, (limit - cy) / cy, 1e-30, pxpl5_geometry::MAX_CLIP]);
    singles.extend([cx, -cy, cx, cy, 2.0, 12_582_912.0, f32::from_bits(0x9700_0000), 0.0]);
    let (near, far) = (pxpl5_geometry::DEPTH_NEAR, pxpl5_geometry::DEPTH_FAR);
    let two52 = (1u64 << 52) as f64;
    let doubles = [
        2.0,
        f64::from(far - near),
        f64::from(near),
        0.5,
        two52,
        1.5 * two52,
        1.0 / 16.0,
        16.0,
        two52 + f64::from(1u32 << 31),
        8.0,
        -7.5,
        -8.5,
    ];
    let mut bytes: Vec<u8> = singles.iter().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend(doubles.iter().flat_map(|x| x.to_le_bytes()));
    bytes.extend(heads().iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

/// Rows x, y, z, w of the transform relative to the eye, and the eye: formed in 64 bits as the native code does. The
/// model-view matrix of [`view`] is a translation, so the eye is its negative.
fn rows_and_origin(view: &ViewTransform) -> ([[f32; 4]; 4], Vec3) {
    let (p, m) = (view.projection.to_cols_array_2d(), view.model_view.to_cols_array_2d());
    let times = |a: &[[f32; 4]; 4], v: [f64; 4]| -> [f64; 4] {
        [0, 1, 2, 3].map(|row| {
            let term = |k: usize| f64::from(a[k][row]) * v[k];
            ((term(0) + term(1)) + term(2)) + term(3)
        })
    };
    let origin = Vec3::new(-m[3][0], -m[3][1], -m[3][2]);
    let [x, y, z] = origin.to_array().map(f64::from);
    let columns = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [x, y, z, 1.0]]
        .map(|v| times(&p, times(&m, v)).map(|v| v as f32));
    ([0, 1, 2, 3].map(|row| columns.map(|column| column[row])), origin)
}

fn triangle_bytes(triangle: &Triangle) -> Vec<u8> {
    let corner = |n: usize| {
        let [x, y, z] = triangle.positions[n].to_array();
        let [r, g, b] = triangle.colours[n].map(u32::from);
        let words = [x.to_bits(), y.to_bits(), z.to_bits(), b << 16 | g << 8 | r];
        words.into_iter().flat_map(u32::to_le_bytes)
    };
    (0..3).flat_map(corner).collect()
}

/// A processor with a kernel and triangles in its memory.
pub(crate) struct Bench {
    /// The processor.
    pub(crate) cpu: Cpu,
    /// The kernel.
    pub(crate) program: Program,
    ram: Ram,
    count: u32,
}

impl Bench {
    /// Loads everything.
    pub(crate) fn new(kernel: Kernel, config: Config, triangles: &[Triangle]) -> Bench {
        let mut ram = Ram::new(0, MEMORY);
        let program = program(kernel);
        ram.load(CODE, &program.bytes).expect("fits");
        ram.load(PARAMETERS, &parameters()).expect("fits");
        let data: Vec<u8> = triangles.iter().flat_map(triangle_bytes).collect();
        assert!(data.len() < (COMMANDS - TRIANGLES) as usize);
        ram.load(TRIANGLES, &data).expect("fits");
        let bins: Vec<u32> = (0..REGIONS).map(|n| BINS + n * BIN_BYTES).collect();
        ram.load_words(BIN_TABLE, &bins).expect("fits");
        Bench { cpu: Cpu::new(config), program, ram, count: triangles.len() as u32 }
    }

    fn call(&mut self, first: u32, count: u32, commands: u32, clip_list: u32) {
        let state = &mut self.cpu.state;
        state.pc = self.program.symbol("start").expect("start");
        (state.r[1], state.r[2]) = (RETURN, STACK);
        (state.r[16], state.r[17], state.r[18]) = (first, count, commands);
        (state.r[19], state.r[20], state.r[21]) = (BIN_TABLE, PARAMETERS, clip_list);
        let outcome = self.cpu.run(&mut self.ram, Some(RETURN), 20_000 * u64::from(count) + 1000);
        assert_eq!(outcome, Outcome::Stopped, "pc {:#x}", self.cpu.state.pc);
    }

    /// Runs the kernel over all triangles in one call.
    pub(crate) fn run(&mut self) {
        self.call(TRIANGLES, self.count, COMMANDS, CLIP_LIST);
    }

    /// Runs the kernel over all triangles, with empty caches before each.
    pub(crate) fn run_cold(&mut self) {
        let (mut commands, mut clip_list) = (COMMANDS, CLIP_LIST);
        for n in 0..self.count {
            self.cpu.empty_caches();
            self.call(TRIANGLES + 48 * n, 1, commands, clip_list);
            (commands, clip_list) = (self.cpu.state.r[18], self.cpu.state.r[21]);
        }
    }

    /// Profile of everything run so far.
    pub(crate) fn profile(&self) -> Profile {
        self.cpu.profile()
    }

    /// Reads the output back; only after one run.
    pub(crate) fn output(&self) -> Output {
        let end = self.cpu.state.r[18];
        let words = self.ram.words(COMMANDS, (end - COMMANDS) as usize / 4).expect("inside");
        let commands: Vec<Vec<u32>> = words.chunks(COMMAND_WORDS).map(<[u32]>::to_vec).collect();
        let mut by_command: BTreeMap<u32, Vec<u16>> = BTreeMap::new();
        let tails = self.ram.words(BIN_TABLE, REGIONS as usize).expect("inside");
        for (n, tail) in (0..).zip(tails) {
            let head = BINS + u32::from(n) * BIN_BYTES;
            for command in self.ram.words(head, (tail - head) as usize / 4).expect("inside") {
                by_command.entry((command - COMMANDS) / 120).or_default().push(n);
            }
        }
        let list = (self.cpu.state.r[21] - CLIP_LIST) as usize / 4;
        let clipped = self.ram.words(CLIP_LIST, list).expect("inside");
        Output {
            commands,
            regions: by_command.into_values().collect(),
            clipped: clipped.iter().map(|at| (at - TRIANGLES) as usize / 48).collect(),
        }
    }
}
