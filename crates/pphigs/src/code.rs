//! TRANSFORM as work of a board: by the timing table, or as i860 code over the board's memory.
//!
//! The code is that of [`pxpl5_geometry::kernel`]; each structure of the display list is one call. What has no code
//! takes the table's time: spheres and their entries in bins.

use crate::begin::Beginning;
use crate::cost::TransformCost;
use crate::layout::{BIN_TABLE, CODE, DISPLAY_LIST, PARAMETERS, STACK};
use crate::list::Share;
use crate::pass::Pass;
use crate::picture::{RegionBinning, Shading};
use crate::placed::PlacedStructure;
use i860::Program;
use pxpl5_geometry::kernel::{
    Heads, Kernel, KernelSurface, PARAMETER_WORDS, Schedule, TRIANGLE_WORDS, display_list_words,
};
use pxpl5_geometry::{Culling, Transform};
use pxpl5_gp::{CodeVersion, GpTiming, Processor, ProcessorFault, Work};
use pxpl5_renderer::{Command, PhongTriangleCommand, TriangleCommand};
use pxpl5_sim::Span;
use pxpl5_wire::{RegionId, Word};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// Bytes of a triangle in it.
const TRIANGLE_BYTES: u32 = 4 * TRIANGLE_WORDS as u32;

/// Pieces that clipping makes of a triangle at most: six planes leave nine corners.
const MOST_PIECES: u32 = 7;

/// Instructions after which a kernel is taken to be endless: many times what a triangle needs, and its prologue.
const BUDGET_OF_TRIANGLE: u64 = 100_000;
const BUDGET: u64 = 10_000;

/// The TRANSFORM of a share for one eye, or for both one after the other.
#[derive(Clone, Copy, Debug)]
pub struct Transforming<'a> {
    /// What each eye's TRANSFORM gives.
    pub passes: &'a [Arc<Pass>],
    /// Bin context of the first one, 0 or 1; the next one has the other.
    pub context: u8,
    /// Whether a pass over the display list begins with it.
    pub begins: bool,
}

/// What a kernel left in the memory of a board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KernelOutput {
    /// Simulated time that the kernel took.
    pub span: Span,
    /// Addresses of the commands, one after the other.
    pub commands: Range<u32>,
    /// Addresses of the bins' entries, which are addresses of commands; none where there are no bins.
    pub bins: Vec<Range<u32>>,
}

impl KernelOutput {
    /// Entries of all bins together.
    #[must_use]
    pub fn entries(&self) -> u64 {
        self.bins.iter().map(|bin| u64::from(bin.end - bin.start) / 4).sum()
    }
}

impl Work for Transforming<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        let of_passes = self.passes.iter().map(|pass| pass.cost().span(timing));
        of_passes.fold(self.begin(timing), |all, span| all + span)
    }

    fn by_code(&self, timing: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        let mut span = match self.passes.first() {
            Some(pass) if self.begins => {
                let eyes = self.passes.iter().map(|pass| pass.placed()).collect();
                Beginning::new(pass.share().list(), eyes, *pass.picture()).by_code(timing, processor)?
            }
            _ => Span::ZERO,
        };
        for (context, pass) in (self.context..).zip(self.passes) {
            span += match pass.run_code(processor, context % 2)? {
                Some(output) => output.span + pass.cost_without_code().span(timing),
                None => pass.cost().span(timing),
            };
        }
        Ok(span)
    }
}

impl Transforming<'_> {
    const fn begin(&self, timing: &GpTiming) -> Span {
        if self.begins { TransformCost::PASS.span(timing) } else { Span::ZERO }
    }
}

impl Share {
    /// Puts the whole share, of which this may be a clump, into a board's memory.
    ///
    /// # Errors
    ///
    /// [`ProcessorFault::Unmapped`] when it does not fit.
    pub fn install(&self, processor: &mut Processor) -> Result<(), ProcessorFault> {
        for (place, number) in (0..).zip(self.all_triangles()) {
            let words = display_list_words(&self.list.triangle(number));
            processor.write(DISPLAY_LIST + place * TRIANGLE_BYTES, &words)?;
        }
        Ok(())
    }
}

/// Places of one context's output.
struct Places {
    commands: u32,
    bins: Vec<u32>,
}

impl Pass {
    /// What it takes by the table, but for the beginning of a pass over the display list.
    #[must_use]
    pub fn cost(&self) -> TransformCost {
        let counted = TransformCost::primitives(self.transformed());
        TransformCost { clipped: self.stats().clipped, entries: self.entries(), ..counted }
    }

    /// What the kernel does not do, so that it takes the table's time: spheres.
    fn cost_without_code(&self) -> TransformCost {
        let regions = self.picture().viewport.grid().regions() as u16;
        let entries = (0..regions).map(|region| u64::from(self.counts(RegionId(region)).spheres)).sum();
        TransformCost { triangles: 0, entries, ..TransformCost::primitives(self.transformed()) }
    }

    /// Runs the kernel for all triangles on a board that holds the display list, in one of its two bin contexts; `None`
    /// for a picture that has no kernel.
    ///
    /// # Errors
    ///
    /// [`ProcessorFault`] when the code does not come to its end, or its data do not fit.
    pub fn run_code(&self, processor: &mut Processor, context: u8) -> Result<Option<KernelOutput>, ProcessorFault> {
        let Some(kernel) = self.kernel(processor.version()) else { return Ok(None) };
        let heads = self.heads();
        let places = self.places(processor, kernel, context)?;
        processor.write(BIN_TABLE, &places.bins)?;
        let mut span = Span::ZERO;
        let mut command = places.commands;
        for (place, transform, held) in self.calls() {
            let kernel = Kernel { culls: place.structure.culling != Culling::None, ..kernel };
            let program = program(kernel);
            let light = &place.light;
            let clipper = program.symbol("clipper").unwrap_or_default();
            let parameters: [Word; PARAMETER_WORDS] = kernel.parameters(transform, light, &heads, clipper);
            processor.write(PARAMETERS, &parameters)?;
            let first = DISPLAY_LIST + held.start as u32 * TRIANGLE_BYTES;
            let count = held.len() as u32;
            let data = [(16, first), (17, count), (18, command)];
            let fixed = [(2, STACK), (19, BIN_TABLE), (20, PARAMETERS)];
            let budget = BUDGET + BUDGET_OF_TRIANGLE * u64::from(count);
            span += processor.call(&program, "start", &[data.as_slice(), &fixed].concat(), budget)?;
            command = processor.register(18);
        }
        let tails = processor.read(BIN_TABLE, places.bins.len())?;
        let bins = places.bins.iter().zip(tails).map(|(head, tail)| *head..tail).collect();
        Ok(Some(KernelOutput { span, commands: places.commands..command, bins }))
    }

    fn kernel(&self, version: CodeVersion) -> Option<Kernel> {
        let schedule = match version {
            CodeVersion::Unoptimised => Schedule::Straight,
            CodeVersion::Compiled => Schedule::Compiled,
            CodeVersion::Scheduled => Schedule::Dual,
        };
        let surface = match self.picture().shading {
            Shading::Gouraud => KernelSurface::Gouraud,
            Shading::Phong => KernelSurface::Phong,
        };
        Kernel::for_picture(schedule, surface, &self.picture().viewport, self.is_binned())
    }

    fn is_binned(&self) -> bool {
        self.picture().binning == RegionBinning::Touched
    }

    /// What is alike in all triangle commands, read off one of zeros.
    fn heads(&self) -> Heads {
        let blank = match self.picture().shading {
            Shading::Gouraud => Command::Triangle(TriangleCommand::default()),
            Shading::Phong => Command::PhongTriangle(PhongTriangleCommand::default()),
        };
        let mut words = Vec::new();
        let encoded = blank.encode(&self.picture().layout, &mut words);
        debug_assert!(encoded.is_ok(), "{encoded:?}");
        [0, 1, 13, 17, 18, 22, 26, 30].map(|at| words.get(at).copied().unwrap_or_default())
    }

    /// Structures with their triangles, counted in those that the GP holds.
    fn calls(&self) -> impl Iterator<Item = (&PlacedStructure, &Transform, Range<usize>)> {
        self.drawn().filter_map(|(place, transform)| {
            let held = self.share().held_places(&place.structure.triangles);
            Some((place, transform, held)).filter(|call| !call.2.is_empty())
        })
    }

    /// Context 0 lies behind the display list, context 1 at the end of memory. The kernel needs a place for a command of
    /// every triangle, seen or not, for as many as a clipped one may have pieces, and for the one being made, which may be
    /// dropped: more than the accounts of [`pxpl5_gp::Memory`], which know what will be seen.
    fn places(&self, processor: &mut Processor, kernel: Kernel, context: u8) -> Result<Places, ProcessorFault> {
        let regions = self.picture().viewport.grid().regions() as u16;
        let entries: Vec<u32> = (0..regions).map(|region| self.counts(RegionId(region)).triangles).collect();
        let entries = if self.is_binned() { entries } else { vec![0; entries.len()] };
        let more_pieces = (MOST_PIECES - 1) * self.stats().clipped as u32;
        let commands = kernel.command_bytes() * (self.transformed().triangles + more_pieces + 1);
        let list = DISPLAY_LIST + self.share().all_triangles().len() as u32 * TRIANGLE_BYTES;
        let bytes = commands + 4 * entries.iter().sum::<u32>();
        let begin = processor.place_output(context, list, bytes)?;
        let mut next = begin + commands;
        let mut bins = Vec::with_capacity(entries.len());
        for entries in entries {
            bins.push(next);
            next += 4 * entries;
        }
        Ok(Places { commands: begin, bins })
    }
}

/// A kernel's program with its clipper, assembled when first asked for.
fn program(kernel: Kernel) -> Arc<Program> {
    static PROGRAMS: LazyLock<Mutex<HashMap<Kernel, Arc<Program>>>> = LazyLock::new(Mutex::default);
    let mut programs = PROGRAMS.lock().unwrap_or_else(PoisonError::into_inner);
    Arc::clone(programs.entry(kernel).or_insert_with(|| Arc::new(assembled(kernel))))
}

fn assembled(kernel: Kernel) -> Program {
    let source = match i860::linear::schedule(&kernel.source()) {
        Ok(source) => source,
        Err(error) => unreachable!("every kernel is scheduled by the tests: {error}"),
    };
    match i860::link(CODE, &[("kernel", &source), ("clipper", &kernel.clipper_source())]) {
        Ok(program) => program,
        Err(errors) => unreachable!("every kernel is assembled by the tests: {errors}"),
    }
}
