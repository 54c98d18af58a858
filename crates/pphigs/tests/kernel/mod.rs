//! A bench that runs a triangle kernel on the processor model with 8 MB of memory, and compares its output with native
//! code.
//!
//! The tests of the kernels share this module with the example that reports their clocks.

#![allow(dead_code, reason = "the test and the example each use a part")]

use super::numbers::Numbers;
use glam::{Mat4, Vec3};
use i860::{Config, Cpu, Profile, Program, Ram, RunEnd, linear, link};
use pxpl5_geometry::kernel::{
    Heads, Kernel, KernelList, KernelPicture, KernelSurface, Schedule, display_list_words, vertex_words,
};
use pxpl5_geometry::{Culling, GouraudTriangle, Light, SetupStats, Transform, Triangle, ViewTransform, Viewport};
use pxpl5_renderer::{Command, Layout};
use pxpl5_sim::SplitMix64;
use std::collections::BTreeMap;

/// Memory of a graphics processor in bytes (published).
pub(crate) const MEMORY: usize = 8 << 20;
const CODE: u32 = 0x1000;
const PARAMETERS: u32 = 0x1_0000;
const BIN_TABLE: u32 = 0x1_0200;
const STACK: u32 = 0x1_1400;
const TRIANGLES: u32 = 0x2_0000;
const COMMANDS: u32 = 0x20_0000;
const BINS: u32 = 0x60_0000;
/// Address of the right eye's parameter block.
const RIGHT_PARAMETERS: u32 = 0x1_2500;
const RIGHT_COMMANDS: u32 = 0x40_0000;

/// Returns the bytes reserved for each bin. The published figures were measured with 20 bins of an NTSC frame.
const fn bin_bytes(regions: u32) -> u32 {
    let share = (MEMORY as u32 - BINS) / regions / 32 * 32;
    if share < 0x1_8000 { share } else { 0x1_8000 }
}

const RETURN: u32 = 0x0800;

/// Returns the kernel that the report measures: Gouraud triangles in the bins of a frame, in the given schedule.
pub(crate) const fn frame(schedule: Schedule) -> Kernel {
    let list = KernelList::Triangles;
    let picture = KernelPicture::Frame;
    Kernel {
        schedule,
        surface: KernelSurface::Gouraud,
        list,
        picture,
        binned: true,
        culls: false,
        keeps_boxes: false,
        both_eyes: false,
    }
}

/// Returns the assembled program of the kernel and its clipper.
pub(crate) fn program(kernel: Kernel) -> Program {
    let source = linear::schedule(&kernel.source()).unwrap_or_else(|e| panic!("{e}"));
    let sources = [("kernel", source.as_str()), ("clipper", &kernel.clipper_source())];
    link(CODE, &sources).unwrap_or_else(|e| panic!("{e}"))
}

/// Returns a view of a frame of 640 x 480.
pub(crate) fn view() -> ViewTransform {
    let turn = Mat4::from_rotation_y(0.3) * Mat4::from_rotation_x(-0.2);
    let model_view = Mat4::from_translation(Vec3::new(0.25, -0.5, -6.0)) * turn;
    ViewTransform { model_view, projection: Mat4::perspective_rh(0.9, 4.0 / 3.0, 0.5, 40.0) }
}

/// Returns a light from above and behind the eye.
pub(crate) fn light() -> Light {
    Light { direction: [0.48, 0.6, 0.64], ambient: 0.2, diffuse: 0.7 }
}

impl Numbers {
    fn colour(&mut self) -> [u8; 3] {
        [0, 1, 2].map(|_| ((self.next() + 1.0) * 127.0) as u8)
    }

    fn triangle(&mut self, size: f32) -> Triangle {
        let centre = self.vector(2.4);
        let positions = [0, 1, 2].map(|_| centre + self.vector(size));
        let normals = [0, 1, 2].map(|_| self.vector(1.0));
        let colours = [0, 1, 2].map(|_| self.colour());
        Triangle { positions, normals, colours }
    }
}

/// Returns triangles of about `size` world units around the middle of the picture, with random colours at the corners.
pub(crate) fn triangles(count: usize, size: f32, seed: u64) -> Vec<Triangle> {
    let mut numbers = Numbers(SplitMix64::new(seed));
    (0..count).map(|_| numbers.triangle(size)).collect()
}

/// A triangle strip: each vertex forms a triangle with the two vertices before it.
pub(crate) struct Strip {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    colours: Vec<[u8; 3]>,
}

impl Strip {
    /// Returns the strip's triangles, each with its own corners.
    fn triangles(&self) -> impl Iterator<Item = Triangle> {
        let corners = |first: usize| [first, first + 1, first + 2];
        (2..self.positions.len()).map(move |last| Triangle {
            positions: corners(last - 2).map(|n| self.positions[n]),
            normals: corners(last - 2).map(|n| self.normals[n]),
            colours: corners(last - 2).map(|n| self.colours[n]),
        })
    }

    fn words(&self) -> Vec<u32> {
        let vertex = |n: usize| vertex_words(self.positions[n], self.normals[n], self.colours[n], n < 2);
        (0..self.positions.len()).flat_map(vertex).collect()
    }
}

/// Returns strips of the given numbers of triangles. The vertices form a zigzag line that starts near the middle of the
/// picture. Each step has about `size` world units.
pub(crate) fn strips(lengths: &[usize], size: f32, seed: u64) -> Vec<Strip> {
    let mut numbers = Numbers(SplitMix64::new(seed));
    let strip = |length: &usize| {
        let mut along = numbers.vector(2.4);
        let mut vertex = |n: usize| {
            // Reverse the direction before the strip leaves the picture.
            let way = along.abs().max_element() > 2.4;
            along = if way { along * 0.9 } else { along + numbers.vector(0.5 * size) };
            let side = Vec3::new(size, size, 0.0) * if n.is_multiple_of(2) { 0.5 } else { -0.5 };
            (along + side, numbers.vector(1.0), numbers.colour())
        };
        let vertices: Vec<_> = (0..length + 2).map(&mut vertex).collect();
        let positions = vertices.iter().map(|v| v.0).collect();
        let normals = vertices.iter().map(|v| v.1).collect();
        Strip { positions, normals, colours: vertices.iter().map(|v| v.2).collect() }
    };
    lengths.iter().map(strip).collect()
}

pub(crate) fn triangles_of(strips: &[Strip]) -> Vec<Triangle> {
    strips.iter().flat_map(Strip::triangles).collect()
}

/// Output of a kernel in memory.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Output {
    /// Words of each command, in the order of the triangles.
    pub(crate) commands: Vec<Vec<u32>>,
    /// For each command, the regions that it touches, in ascending order.
    pub(crate) regions: Vec<Vec<u16>>,
}

/// Returns the output of native code for triangles in a view: the commands of all pieces, their regions, and the
/// counts.
pub(crate) fn native(
    kernel: Kernel,
    view: &ViewTransform,
    viewport: Viewport,
    triangles: &[Triangle],
) -> (Output, SetupStats) {
    let transform = transform(kernel, view, viewport);
    let light = if kernel.surface == KernelSurface::Precomputed { Light::NONE } else { light() };
    let mut stats = SetupStats::default();
    let mut flattened = SetupStats::default();
    let mut output = Output { commands: Vec::new(), regions: Vec::new() };
    for triangle in triangles {
        let mut found = Vec::new();
        let gouraud = |t: GouraudTriangle| {
            Command::Triangle(pxpl5_renderer::TriangleCommand { edges: t.edges, depth: t.z, colour: t.rgb })
        };
        match kernel.surface {
            KernelSurface::Precomputed if transform.is_single() => {
                transform.single_precision(triangle, &mut stats, |screen, t| found.push((gouraud(t), screen.outline)));
            }
            KernelSurface::Gouraud | KernelSurface::Precomputed => {
                transform.gouraud(triangle, &light, &mut stats, |screen| {
                    found.push((gouraud(screen.gouraud(&viewport, &mut flattened)), screen.outline));
                })
            }
            KernelSurface::Phong => transform.phong(triangle, &mut stats, |screen| {
                let t = screen.phong(&viewport, &mut flattened);
                let colour = t.colour.iter().fold(0, |word, byte| word << 8 | u32::from(*byte));
                let command =
                    pxpl5_renderer::PhongTriangleCommand { edges: t.edges, depth: t.z, normal: t.normal, colour };
                found.push((Command::PhongTriangle(command), screen.outline));
            }),
        }
        for (command, outline) in found {
            output.commands.push(words(&command));
            output.regions.push(outline.regions.iter().map(|r| r.0).collect());
        }
    }
    (output, SetupStats { flattened_planes: flattened.flattened_planes, ..stats })
}

/// Returns the native transform whose words equal the kernel's words.
fn transform(kernel: Kernel, view: &ViewTransform, viewport: Viewport) -> Transform {
    let is_single = kernel.both_eyes && kernel.schedule == Schedule::Compiled;
    let new = if is_single { Transform::in_single_precision } else { Transform::new };
    new(view, viewport, culling(kernel)).expect("finite")
}

fn culling(kernel: Kernel) -> Culling {
    if kernel.culls { Culling::Back } else { Culling::None }
}

fn words(command: &Command) -> Vec<u32> {
    let mut words = Vec::new();
    command.encode(&Layout::rendering_control_phong(), &mut words).expect("this layout has both");
    words
}

/// Returns the instruction words that all triangle commands share. The function encodes a command whose values are
/// zero, and reads the words from this command.
fn heads(surface: KernelSurface) -> Heads {
    let blank = match surface {
        KernelSurface::Gouraud | KernelSurface::Precomputed => {
            words(&Command::Triangle(pxpl5_renderer::TriangleCommand::default()))
        }
        KernelSurface::Phong => words(&Command::PhongTriangle(pxpl5_renderer::PhongTriangleCommand::default())),
    };
    [0, 1, 13, 17, 18, 22, 26, 30].map(|at| blank.get(at).copied().unwrap_or_default())
}

/// A processor with a kernel and triangles in its memory.
pub(crate) struct Bench {
    pub(crate) cpu: Cpu,
    pub(crate) program: Program,
    ram: Ram,
    /// Number of triangles. In a bench for strips, the number of vertices.
    count: u32,
    /// Bytes of a triangle in memory. In a bench for strips, the bytes of a vertex.
    step: u32,
    command_bytes: u32,
    regions: u32,
    both_eyes: bool,
}

impl Bench {
    /// Creates a processor with kernel, tables and triangles in its memory, ready to be called.
    pub(crate) fn new(kernel: Kernel, viewport: Viewport, config: Config, triangles: &[Triangle]) -> Bench {
        let data: Vec<u32> = triangles.iter().flat_map(display_list_words).collect();
        Bench::over(kernel, &view(), viewport, config, &data, triangles.len())
    }

    /// Creates a bench for any view, not only for the view of the reports.
    pub(crate) fn in_eye_space(
        kernel: Kernel,
        view: &ViewTransform,
        viewport: Viewport,
        triangles: &[Triangle],
    ) -> Bench {
        let data: Vec<u32> = triangles.iter().flat_map(display_list_words).collect();
        Bench::over(kernel, view, viewport, Config::functional(), &data, triangles.len())
    }

    /// Creates a bench for both eyes in one pass.
    pub(crate) fn for_both_eyes(
        kernel: Kernel,
        views: &[ViewTransform; 2],
        viewport: Viewport,
        config: Config,
        triangles: &[Triangle],
    ) -> Bench {
        let data: Vec<u32> = triangles.iter().flat_map(display_list_words).collect();
        let mut bench = Bench::over(kernel, &views[0], viewport, config, &data, triangles.len());
        let right = transform(kernel, &views[1], viewport);
        let clipper = bench.program.symbol("clipper").expect("clipper");
        let parameters = kernel.parameters(&right, &light(), &heads(kernel.surface), clipper);
        bench.ram.load_words(RIGHT_PARAMETERS, &parameters).expect("fits");
        bench
    }

    /// Returns the commands of each eye, after exactly one run.
    pub(crate) fn commands_of_both(&self) -> [Vec<Vec<u32>>; 2] {
        let ends = [self.cpu.state.r[18], self.cpu.state.r[19]];
        [(COMMANDS, ends[0]), (RIGHT_COMMANDS, ends[1])].map(|(begin, end)| self.words_of_commands(begin, end))
    }

    fn words_of_commands(&self, begin: u32, end: u32) -> Vec<Vec<u32>> {
        let words = self.ram.words(begin, (end - begin) as usize / 4).expect("inside");
        words.chunks(self.command_bytes as usize / 4).map(<[u32]>::to_vec).collect()
    }

    /// Creates a bench for the kernel of strips.
    pub(crate) fn of_strips(kernel: Kernel, viewport: Viewport, config: Config, strips: &[Strip]) -> Bench {
        let data: Vec<u32> = strips.iter().flat_map(Strip::words).collect();
        Bench::over(kernel, &view(), viewport, config, &data, data.len() / 8)
    }

    fn over(
        kernel: Kernel,
        view: &ViewTransform,
        viewport: Viewport,
        config: Config,
        data: &[u32],
        count: usize,
    ) -> Bench {
        let mut ram = Ram::new(0, MEMORY);
        let program = program(kernel);
        ram.load(CODE, &program.bytes).expect("fits");
        let transform = transform(kernel, view, viewport);
        let clipper = program.symbol("clipper").expect("clipper");
        let parameters = kernel.parameters(&transform, &light(), &heads(kernel.surface), clipper);
        ram.load_words(PARAMETERS, &parameters).expect("fits");
        assert!(4 * data.len() < (COMMANDS - TRIANGLES) as usize);
        ram.load_words(TRIANGLES, data).expect("fits");
        let regions = viewport.grid().regions();
        let bins: Vec<u32> = (0..regions).map(|n| BINS + n * bin_bytes(regions)).collect();
        ram.load_words(BIN_TABLE, &bins).expect("fits");
        let step = (4 * data.len() / count) as u32;
        let command_bytes = kernel.command_bytes();
        Bench {
            cpu: Cpu::new(config),
            program,
            ram,
            count: count as u32,
            step,
            command_bytes,
            regions,
            both_eyes: kernel.both_eyes,
        }
    }

    fn call(&mut self, first: u32, count: u32, commands: u32) {
        let state = &mut self.cpu.state;
        state.pc = self.program.symbol("start").expect("start");
        (state.r[1], state.r[2]) = (RETURN, STACK);
        (state.r[16], state.r[17], state.r[18]) = (first, count, commands);
        (state.r[19], state.r[20]) = (BIN_TABLE, PARAMETERS);
        if self.both_eyes {
            (state.r[19], state.r[21]) = (RIGHT_COMMANDS, RIGHT_PARAMETERS);
        }
        let outcome = self.cpu.run(&mut self.ram, Some(RETURN), 100_000 * u64::from(count) + 1000);
        assert_eq!(outcome, RunEnd::Stopped, "pc {:#x}", self.cpu.state.pc);
    }

    /// Runs the kernel over all triangles in one call.
    pub(crate) fn run(&mut self) {
        self.call(TRIANGLES, self.count, COMMANDS);
    }

    /// Runs the kernel over all triangles, with empty caches before each triangle.
    pub(crate) fn run_cold(&mut self) {
        let mut commands = COMMANDS;
        for n in 0..self.count {
            self.cpu.empty_caches();
            self.call(TRIANGLES + self.step * n, 1, commands);
            commands = self.cpu.state.r[18];
        }
    }

    /// Returns the profile of all runs of the kernel so far.
    pub(crate) fn profile(&self) -> Profile {
        self.cpu.profile()
    }

    /// Reads the output from memory, after exactly one run.
    pub(crate) fn output(&self) -> Output {
        let end = self.cpu.state.r[18];
        let commands = self.words_of_commands(COMMANDS, end);
        let mut by_command: BTreeMap<u32, Vec<u16>> = BTreeMap::new();
        let tails = self.ram.words(BIN_TABLE, self.regions as usize).expect("inside");
        for (n, tail) in (0..).zip(tails) {
            let head = BINS + u32::from(n) * bin_bytes(self.regions);
            for command in self.ram.words(head, (tail - head) as usize / 4).expect("inside") {
                by_command.entry((command - COMMANDS) / self.command_bytes).or_default().push(n);
            }
        }
        Output { commands, regions: by_command.into_values().collect() }
    }
}
