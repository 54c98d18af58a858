//! CPU work of TRANSFORM. The time of the work comes from the timing table or from i860 code.
//!
//! [`pxpl5_geometry::kernel`] has the code for triangles and [`pxpl5_geometry::sphere_kernel`] the code for spheres.
//! Each program is called once for each structure of the display list. All triangles come before the spheres, in the
//! order in which their commands are sent.

use crate::begin::{PassStartWork, beginning};
use crate::cost::TransformCost;
use crate::layout::{
    BIN_TABLE, CODE, DISPLAY_LIST, PARAMETERS, RIGHT_PARAMETERS, SPHERE_CODE, SPHERE_PARAMETERS, STACK, bins,
};
use crate::list::{PrimitiveCounts, Share};
use crate::pass::Pass;
use crate::picture::{RegionBinning, Shading};
use crate::placed::PlacedStructure;
use crate::programs::{Programs, kept};
use crate::view::DisplayStructure;
use i860::Program;
use pxpl5_geometry::kernel::{
    Heads, Kernel, KernelSurface, PARAMETER_WORDS, Schedule, TRIANGLE_WORDS, display_list_words,
};
use pxpl5_geometry::sphere_kernel::{SPHERE_WORDS, SphereKernel, sphere_words};
use pxpl5_geometry::{Culling, Transform};
use pxpl5_gp::{CodeVersion, GpTiming, Processor, ProcessorFault, Work};
use pxpl5_renderer::{Command, PhongSphereCommand, PhongTriangleCommand, SphereCommand, TriangleCommand};
use pxpl5_sim::Span;
use pxpl5_wire::{RegionId, Word};
use std::ops::Range;
use std::sync::{Arc, LazyLock, Mutex};

pub(crate) const TRIANGLE_BYTES: u32 = 4 * TRIANGLE_WORDS as u32;
pub(crate) const SPHERE_BYTES: u32 = 4 * SPHERE_WORDS as u32;

/// Largest number of triangles into which clipping divides a triangle: six planes leave a polygon of up to nine
/// corners.
const MAX_PIECES: u32 = 7;

/// Largest number of instructions for one primitive, much more than a kernel needs. A kernel that exceeds the limit
/// counts as an endless loop.
const BUDGET_OF_PRIMITIVE: u64 = 100_000;
pub(crate) const BUDGET: u64 = 10_000;

pub(crate) const fn budget(primitives: u32) -> u64 {
    BUDGET + BUDGET_OF_PRIMITIVE * primitives as u64
}

/// The work of TRANSFORM for one graphics processor, for one eye or for both eyes.
///
/// Some kernels transform both eyes in one pass over the primitives ([`Kernel::can_serve_both_eyes`]). With other
/// kernels, each eye needs a separate pass.
#[derive(Clone, Copy, Debug)]
pub struct TransformWork<'a> {
    /// Result of TRANSFORM for each eye.
    pub passes: &'a [Arc<Pass>],
    /// Set of bins of the first eye, 0 or 1. A board has two sets. The second eye uses the other set.
    pub context: u8,
    /// True if the work includes the steps before the first primitive ([`PassStartWork`]).
    pub begins: bool,
}

/// Time of the kernels, and the addresses of commands and bins in the board's memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KernelOutput {
    /// Simulated time of all kernels.
    pub span: Span,
    /// Simulated time of the kernels for spheres, which is included in `span`.
    pub of_spheres: Span,
    /// Address range of the commands. Commands of triangles come first, then commands of spheres.
    pub commands: Range<u32>,
    /// Address of the first sphere's command.
    pub spheres: u32,
    /// Address range of each bin. A bin entry is the address of a command. If every region gets all triangles, only
    /// spheres have bins.
    pub bins: Vec<Range<u32>>,
}

impl KernelOutput {
    pub fn entries(&self) -> u64 {
        self.bins.iter().map(|bin| u64::from(bin.end - bin.start) / 4).sum()
    }
}

impl Work for TransformWork<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        let of_passes = self.passes.iter().map(|pass| pass.cost().span(timing));
        of_passes.fold(self.begin(timing), |all, span| all + span)
    }

    fn by_code(&self, timing: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        let mut span = match self.passes.first() {
            Some(pass) if self.begins => {
                let eyes = self.passes.iter().map(|pass| pass.placed()).collect();
                PassStartWork::new(pass.share().list(), eyes, *pass.picture()).by_code(timing, processor)?
            }
            _ => Span::ZERO,
        };
        // Use one pass for both eyes if a kernel supports this.
        if let [left, right] = self.passes
            && let Some(outputs) = left.run_code_for_both(right, processor, self.context)?
        {
            return Ok(outputs.iter().fold(span, |all, output| all + output.span));
        }
        // Otherwise use one pass for each eye, in alternating contexts.
        for (context, pass) in (self.context..).zip(self.passes) {
            span += match pass.run_code(processor, context % 2)? {
                Some(output) => output.span,
                None => pass.cost().span(timing),
            };
        }
        Ok(span)
    }

    fn vertex_transforms(&self) -> u64 {
        self.passes.iter().map(|pass| pass.transformed().vertices()).sum()
    }
}

impl TransformWork<'_> {
    fn begin(&self, timing: &GpTiming) -> Span {
        if !self.begins {
            return Span::ZERO;
        }
        let eyes: Vec<_> = self.passes.iter().map(|pass| pass.placed()).collect();
        beginning(eyes.iter().map(|placed| &placed[..])).span(timing)
    }
}

impl Share {
    /// Stores all primitives of the graphics processor in the board's memory, even if this share is only a clump.
    ///
    /// # Errors
    ///
    /// Returns [`ProcessorFault::Unmapped`] if the primitives do not fit.
    pub fn install(&self, processor: &mut Processor) -> Result<(), ProcessorFault> {
        for (place, number) in (0..).zip(self.all_triangles()) {
            let words = display_list_words(&self.list.triangle(number));
            processor.write(DISPLAY_LIST + place * TRIANGLE_BYTES, &words)?;
        }
        for (place, number) in (0..).zip(self.all_spheres()) {
            processor
                .write(self.place_of_spheres() + place * SPHERE_BYTES, &sphere_words(&self.list.spheres[number]))?;
        }
        Ok(())
    }

    pub(crate) fn place_of_spheres(&self) -> u32 {
        DISPLAY_LIST + self.all_triangles().len() as u32 * TRIANGLE_BYTES
    }

    pub(crate) fn end_of_list(&self) -> u32 {
        self.place_of_spheres() + self.all_spheres().len() as u32 * SPHERE_BYTES
    }
}

pub(crate) struct OutputSize {
    commands: u32,
    entries: Vec<u32>,
}

impl OutputSize {
    pub(crate) fn bytes(&self) -> u32 {
        self.commands + 4 * self.entries.iter().sum::<u32>()
    }

    fn places(&self, begin: u32) -> Places {
        let mut next = begin + self.commands;
        let bin = |entries: &u32| {
            let begin = next;
            next += 4 * entries;
            begin
        };
        Places { commands: begin, bins: self.entries.iter().map(bin).collect() }
    }
}

struct Places {
    commands: u32,
    bins: Vec<u32>,
}

/// Address of the next command, and of the table of bins. If the kernel stores bounding boxes, `table` is the address
/// of the next box.
#[derive(Clone, Copy)]
pub(crate) struct Next {
    pub(crate) command: u32,
    pub(crate) table: u32,
}

impl Next {
    /// Returns the addresses for the next call of the kernel. The last call has left these addresses in the processor's
    /// registers.
    pub(crate) const fn left(self, processor: &Processor, keeps_boxes: bool) -> Self {
        let table = if keeps_boxes { processor.register(19) } else { self.table };
        Self { command: processor.register(18), table }
    }
}

/// Place of a kernel's output for one view: set of bins, index of the view in this set, and address of the first
/// command.
#[derive(Clone, Copy)]
pub(crate) struct Destination {
    pub(crate) context: u8,
    pub(crate) view: u8,
    pub(crate) begin: u32,
}

/// Addresses of the marks that select the primitives of a view. Each primitive has a word of marks, with a bit for each
/// view.
#[derive(Clone, Copy)]
pub(crate) struct Marks {
    pub(crate) triangles: u32,
    pub(crate) spheres: u32,
    pub(crate) bit: Word,
}

impl Pass {
    /// Returns the counts of primitives and bin entries for the timing table, without the placement of structures.
    pub fn cost(&self) -> TransformCost {
        let counted = TransformCost::primitives(self.transformed());
        TransformCost { clipped: self.stats().clipped, entries: self.entries(), ..counted }
    }

    /// Executes the kernels for all primitives. The board's memory must already contain the display list. `context` is
    /// the set of bins, 0 or 1.
    ///
    /// Returns `None` if no kernel can draw this kind of picture.
    ///
    /// # Errors
    ///
    /// Returns [`ProcessorFault`] if the code does not end, or if its data do not fit.
    pub fn run_code(&self, processor: &mut Processor, context: u8) -> Result<Option<KernelOutput>, ProcessorFault> {
        let Some(kernel) = self.kernel(processor.version()) else { return Ok(None) };
        let needs = self.needs(kernel, self.transformed());
        let begin = processor.place_output(context, self.share().end_of_list(), needs.bytes())?;
        self.run_kernels(processor, kernel, &needs, Destination { context, view: 0, begin }, None).map(Some)
    }

    /// Executes the kernels for the left eye (`self`) and the right eye, with a single pass over the triangles.
    ///
    /// Returns `None` if no kernel serves both eyes. The output of the left eye contains the time of the triangles of
    /// both eyes.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Pass::run_code`].
    pub fn run_code_for_both(
        &self,
        right: &Self,
        processor: &mut Processor,
        context: u8,
    ) -> Result<Option<[KernelOutput; 2]>, ProcessorFault> {
        // Compiled code for both eyes has other planes than the list of another pipeline.
        let fits = |kernel: &Kernel| self.share().list().is_single == (kernel.schedule == Schedule::Compiled);
        let kernel = self.kernel(processor.version()).filter(Kernel::can_serve_both_eyes).filter(fits);
        let (Some(kernel), Some(other)) = (kernel, right.kernel(processor.version())) else { return Ok(None) };
        if kernel != other {
            return Ok(None);
        }
        let mut place = |eye: &Self, context: u8| {
            let needs = eye.needs(kernel, eye.transformed());
            let begin = processor.place_output(context % 2, eye.share().end_of_list(), needs.bytes())?;
            Ok((needs.places(begin), Destination { context: context % 2, view: 0, begin }))
        };
        // Each eye has its own bin context, so the table of bins is written again for each eye's spheres.
        let [(left_places, to_left), (right_places, to_right)] = [place(self, context)?, place(right, context + 1)?];
        let first = [&left_places, &right_places].map(|places| Next { command: places.commands, table: BIN_TABLE });
        let (span, next) = self.run_triangles_for_both(right, processor, kernel, first)?;
        processor.write(BIN_TABLE, &left_places.bins)?;
        let of_left = self.run_rest(processor, kernel, &left_places, to_left, (span, next[0]), None)?;
        processor.write(BIN_TABLE, &right_places.bins)?;
        let of_right = right.run_rest(processor, kernel, &right_places, to_right, (Span::ZERO, next[1]), None)?;
        Ok(Some([of_left, of_right]))
    }

    /// Executes the triangle kernel for both eyes. Returns the time, and the addresses for the next output of each eye.
    ///
    /// For a structure that only one eye can draw, the code also computes the other eye's output from the same view, and
    /// this output is discarded.
    fn run_triangles_for_both(
        &self,
        right: &Self,
        processor: &mut Processor,
        kernel: Kernel,
        mut next: [Next; 2],
    ) -> Result<(Span, [Next; 2]), ProcessorFault> {
        let heads = self.heads();
        let mut span = Span::ZERO;
        let (of_left, of_right) = (self.placed(), right.placed());
        for places in of_left.iter().zip(of_right.iter()).map(|(left, right)| [left, right]) {
            let held = self.share().held_places(&places[0].structure.triangles);
            let transforms = places.map(|place| place.transform.as_ref());
            let Some(any) = transforms[0].or(transforms[1]).filter(|_| !held.is_empty()) else { continue };
            let kernel = Kernel { culls: places[0].structure.culling != Culling::None, both_eyes: true, ..kernel };
            let program = program(kernel, false);
            let clipper = program.symbol("clipper").unwrap_or_default();
            let blocks = [PARAMETERS, RIGHT_PARAMETERS];
            // Each eye has a parameter block.
            for ((place, transform), block) in places.iter().zip(transforms).zip(blocks) {
                let transform = transform.unwrap_or(any);
                processor.write(block, &kernel.parameters(transform, &place.light, &heads, clipper))?;
            }
            let first = DISPLAY_LIST + held.start as u32 * TRIANGLE_BYTES;
            let count = held.len() as u32;
            let call = Call { first, count, next: Next { table: next[1].command, ..next[0] }, parameters: blocks[0] };
            let registers = [call.registers().as_slice(), &[(21, blocks[1])]].concat();
            span += processor.call(&program, "start", &registers, 2 * budget(count))?;
            for ((next, transform), register) in next.iter_mut().zip(transforms).zip([18, 19]) {
                if transform.is_some() {
                    next.command = processor.register(register);
                }
            }
        }
        Ok((span, next))
    }

    pub(crate) fn run_kernels(
        &self,
        processor: &mut Processor,
        kernel: Kernel,
        needs: &OutputSize,
        to: Destination,
        marks: Option<Marks>,
    ) -> Result<KernelOutput, ProcessorFault> {
        let places = needs.places(to.begin);
        processor.write(BIN_TABLE, &places.bins)?;
        let first = Next { command: places.commands, table: BIN_TABLE };
        let triangles = self.run_triangles(processor, kernel, first, marks)?;
        self.run_rest(processor, kernel, &places, to, triangles, marks)
    }

    /// Executes the sphere kernel for one view, and stores the bounds of each bin. The table of bins must be in memory.
    fn run_rest(
        &self,
        processor: &mut Processor,
        kernel: Kernel,
        places: &Places,
        to: Destination,
        (of_triangles, spheres): (Span, Next),
        marks: Option<Marks>,
    ) -> Result<KernelOutput, ProcessorFault> {
        let (of_spheres, end) = self.run_spheres(processor, sphere_kernel(kernel), spheres, marks)?;
        let [spheres, end] = [spheres.command, end.command];
        let tails = processor.read(BIN_TABLE, places.bins.len())?;
        let bins: Vec<Range<u32>> = places.bins.iter().zip(tails).map(|(head, tail)| *head..tail).collect();
        note_bins(processor, to, spheres, &bins)?;
        let span = of_triangles + of_spheres;
        Ok(KernelOutput { span, of_spheres, commands: places.commands..end, spheres, bins })
    }

    pub(crate) fn run_triangles(
        &self,
        processor: &mut Processor,
        kernel: Kernel,
        mut next: Next,
        marks: Option<Marks>,
    ) -> Result<(Span, Next), ProcessorFault> {
        let heads = self.heads();
        let mut span = Span::ZERO;
        // Each structure needs one call with its own parameter block.
        for (place, transform, held) in self.calls_of_triangles() {
            let kernel = Kernel { culls: place.structure.culling != Culling::None, ..kernel };
            let program = program(kernel, marks.is_some());
            let light = &place.light;
            let clipper = program.symbol("clipper").unwrap_or_default();
            let parameters: [Word; PARAMETER_WORDS] = kernel.parameters(transform, light, &heads, clipper);
            processor.write(PARAMETERS, &parameters)?;
            let first = DISPLAY_LIST + held.start as u32 * TRIANGLE_BYTES;
            let call = Call { first, count: held.len() as u32, next, parameters: PARAMETERS };
            let marked =
                marks.map(|Marks { triangles, bit, .. }| [triangles + 4 * held.start as u32, bit, TRIANGLE_BYTES]);
            span += call.run(processor, &program, "start", marked)?;
            // The next call continues after this call's output.
            next = next.left(processor, kernel.keeps_boxes);
        }
        Ok((span, next))
    }

    pub(crate) fn run_spheres(
        &self,
        processor: &mut Processor,
        kernel: SphereKernel,
        mut next: Next,
        marks: Option<Marks>,
    ) -> Result<(Span, Next), ProcessorFault> {
        let blank = match kernel.surface {
            KernelSurface::Gouraud | KernelSurface::Precomputed => Command::Sphere(SphereCommand::default()),
            KernelSurface::Phong => Command::PhongSphere(PhongSphereCommand::default()),
        };
        let blank = self.encoded(&blank);
        let mut span = Span::ZERO;
        // Each structure needs one call with its own parameter block.
        for (place, transform, held) in self.calls_of_spheres() {
            let Some(parameters) = kernel.parameters(transform, &place.light, &blank) else { continue };
            processor.write(SPHERE_PARAMETERS, &parameters)?;
            let first = self.share().place_of_spheres() + held.start as u32 * SPHERE_BYTES;
            let call = Call { first, count: held.len() as u32, next, parameters: SPHERE_PARAMETERS };
            let marked = marks.map(|Marks { spheres, bit, .. }| [spheres + 4 * held.start as u32, bit, SPHERE_BYTES]);
            span += call.run(processor, &sphere_program(kernel, marks.is_some()), "spheres", marked)?;
            next = next.left(processor, kernel.keeps_boxes);
        }
        Ok((span, next))
    }

    pub(crate) fn kernel(&self, version: CodeVersion) -> Option<Kernel> {
        let schedule = match version {
            CodeVersion::Unoptimised => Schedule::Straight,
            CodeVersion::Compiled => Schedule::Compiled,
            CodeVersion::Scheduled => Schedule::Dual,
        };
        self.picture().kernel(schedule)
    }

    /// Returns the lengths of a triangle command and of a sphere command in words. Returns `None` if i860 code does not
    /// fill the bins.
    pub(crate) fn binned_words(&self, version: CodeVersion) -> Option<[u32; 2]> {
        let kernel = self.kernel(version).filter(|_| self.is_binned())?;
        Some([kernel.command_bytes() / 4, sphere_kernel(kernel).command_words() as u32])
    }

    pub(crate) fn shades_at_pixels(&self) -> bool {
        self.picture().shading == Shading::Phong
    }

    fn is_binned(&self) -> bool {
        self.picture().binning == RegionBinning::Touched
    }

    /// Returns the words that all triangle commands have in common, found by encoding a command with zeros.
    pub(crate) fn heads(&self) -> Heads {
        let blank = match self.picture().shading {
            Shading::Gouraud | Shading::Precomputed => Command::Triangle(TriangleCommand::default()),
            Shading::Phong => Command::PhongTriangle(PhongTriangleCommand::default()),
        };
        let words = self.encoded(&blank);
        [0, 1, 13, 17, 18, 22, 26, 30].map(|at| words.get(at).copied().unwrap_or_default())
    }

    fn encoded(&self, command: &Command) -> Vec<Word> {
        let mut words = Vec::new();
        let encoded = command.encode(&self.picture().layout, &mut words);
        debug_assert!(encoded.is_ok(), "{encoded:?}");
        words
    }

    pub(crate) fn calls_of_triangles(&self) -> impl Iterator<Item = (&PlacedStructure, &Transform, Range<usize>)> {
        self.calls(|structure| &structure.triangles, Share::held_places)
    }

    pub(crate) fn calls_of_spheres(&self) -> impl Iterator<Item = (&PlacedStructure, &Transform, Range<usize>)> {
        self.calls(|structure| &structure.spheres, Share::held_places_of_spheres)
    }

    fn calls(
        &self,
        of: impl Fn(&DisplayStructure) -> &Range<usize>,
        held: impl Fn(&Share, &Range<usize>) -> Range<usize>,
    ) -> impl Iterator<Item = (&PlacedStructure, &Transform, Range<usize>)> {
        let held = move |place: &PlacedStructure| held(self.share(), of(&place.structure));
        let calls = self.drawn().map(move |(place, transform)| (place, transform, held(place)));
        calls.filter(|call| !call.2.is_empty())
    }

    /// Returns the memory that a kernel needs for its output.
    ///
    /// The memory has room for the commands of all primitives in `given`, visible or not, and of the pieces of clipped
    /// triangles. The memory also has room for one more command that the kernel may write and then discard.
    /// [`pxpl5_gp::Memory`] counts only the commands of visible primitives.
    pub(crate) fn needs(&self, kernel: Kernel, given: PrimitiveCounts) -> OutputSize {
        let regions = self.picture().viewport.grid().regions() as u16;
        let entries = (0..regions).map(|region| {
            let counts = self.counts(RegionId(region));
            if self.is_binned() { counts.total() } else { counts.spheres }
        });
        let entries = entries.collect();
        let sphere_bytes = 4 * sphere_kernel(kernel).command_words() as u32;
        let commands = kernel.command_bytes() * self.most_commands(given) + sphere_bytes * given.spheres;
        OutputSize { commands, entries }
    }

    pub(crate) fn most_commands(&self, given: PrimitiveCounts) -> u32 {
        given.triangles + (MAX_PIECES - 1) * self.stats().clipped as u32 + 1
    }
}

/// Stores the bounds of each bin for the code that sends bins. The kernel's own table may be overwritten before the
/// bins are sent.
fn note_bins(
    processor: &mut Processor,
    to: Destination,
    spheres: u32,
    filled: &[Range<u32>],
) -> Result<(), ProcessorFault> {
    let bounds = filled.iter().flat_map(|bin| [bin.start, bin.end]);
    let words: Vec<Word> = std::iter::once(spheres).chain(bounds).collect();
    processor.write(bins(to.context, to.view), &words)
}

/// The registers of a kernel call: address and number of the primitives, addresses of the output and of the parameters.
struct Call {
    first: u32,
    count: u32,
    next: Next,
    parameters: u32,
}

impl Call {
    fn registers(&self) -> [(usize, Word); 6] {
        let Next { command, table } = self.next;
        [(16, self.first), (17, self.count), (18, command), (2, STACK), (19, table), (20, self.parameters)]
    }

    /// Calls the kernel once for all primitives, or once for each group of successive marked primitives.
    ///
    /// `marked` has the address of the marks, the bit to test, and the size of a primitive in bytes.
    fn run(
        &self,
        processor: &mut Processor,
        program: &Arc<Program>,
        kernel: &str,
        marked: Option<[Word; 3]>,
    ) -> Result<Span, ProcessorFault> {
        let Some([words, bit, step]) = marked else {
            return processor.call(program, kernel, &self.registers(), budget(self.count));
        };
        let entry = program.symbol(kernel).unwrap_or_default();
        let of_runs = [(21, words), (22, bit), (23, entry), (24, step)];
        processor.call(program, "runs", &[self.registers().as_slice(), &of_runs].concat(), budget(self.count))
    }
}

pub(crate) const fn sphere_kernel(kernel: Kernel) -> SphereKernel {
    SphereKernel { surface: kernel.surface, picture: kernel.picture, keeps_boxes: kernel.keeps_boxes }
}

/// Name and source of the code that calls a kernel for each group of successive marked primitives.
const RUNS: (&str, &str) = ("runs", include_str!("../kernels/runs.s"));

fn program(kernel: Kernel, by_runs: bool) -> Arc<Program> {
    static PROGRAMS: Programs<(Kernel, bool)> = LazyLock::new(Mutex::default);
    kept(&PROGRAMS, (kernel, by_runs), assembled)
}

fn assembled((kernel, by_runs): (Kernel, bool)) -> Program {
    let source = match i860::linear::schedule(&kernel.source()) {
        Ok(source) => source,
        Err(error) => unreachable!("every kernel is scheduled by the tests: {error}"),
    };
    let clipper = kernel.clipper_source();
    let sources = [("kernel", source.as_str()), ("clipper", &clipper), RUNS];
    match i860::link(CODE, if by_runs { &sources } else { &sources[..2] }) {
        Ok(program) => program,
        Err(errors) => unreachable!("every kernel is assembled by the tests: {errors}"),
    }
}

fn sphere_program(kernel: SphereKernel, by_runs: bool) -> Arc<Program> {
    static PROGRAMS: Programs<(SphereKernel, bool)> = LazyLock::new(Mutex::default);
    kept(&PROGRAMS, (kernel, by_runs), |(kernel, by_runs)| {
        let source = kernel.source();
        let sources = [("sphere", source.as_str()), RUNS];
        match i860::link(SPHERE_CODE, if by_runs { &sources } else { &sources[..1] }) {
            Ok(program) => program,
            Err(errors) => unreachable!("every kernel is assembled by the tests: {errors}"),
        }
    })
}

#[cfg(test)]
mod tests;
