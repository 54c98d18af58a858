//! TRANSFORM of six views around an eye, such as the faces of a cube, as i860 code over the board's memory.
//!
//! Each primitive is transformed for those views alone that it may touch: kernels/sort.s finds them, kernels/runs.s gives them to the
//! kernels. The rules are ours and stand in kernels/sort_rules.md.

use crate::begin::Beginning;
use crate::code::{Destination, KernelOutput, Marks, Needs, SPHERE_BYTES, TRIANGLE_BYTES, budget, sphere_kernel};
use crate::counts::PrimitiveCounts;
use crate::layout::{DISPLAY_LIST, MOST_VIEWS, PARAMETERS, SORT_CODE, SPHERE_PARAMETERS};
use crate::pass::Pass;
use crate::placed::PlacedStructure;
use i860::Program;
use pxpl5_geometry::kernel::Kernel;
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_sim::Span;
use pxpl5_wire::Word;
use std::ops::Range;
use std::sync::{Arc, LazyLock};

/// How much farther out the sides of a view are taken when primitives are sorted: rule 4.
const MARGIN: f32 = 1.0 / 32.0;

/// The TRANSFORM of a share for six views of one place.
#[derive(Clone, Copy, Debug)]
pub struct Surrounding<'a> {
    /// What the views give: those along +x, -x, +y, -y, +z and -z of the last one's eye, with one projection, whose axes these are.
    pub passes: &'a [Arc<Pass>; MOST_VIEWS as usize],
    /// The bin context of all of them, 0 or 1.
    pub context: u8,
}

/// What the code left in the memory of a board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SurroundingOutput {
    /// Simulated time of all.
    pub span: Span,
    /// The part of it that the beginning of the pass took.
    pub of_beginning: Span,
    /// The part that it took to find the views of each primitive.
    pub of_sorting: Span,
    /// What each view is given, seen or not.
    pub given: Vec<PrimitiveCounts>,
    /// What each view's kernels left.
    pub views: Vec<KernelOutput>,
}

impl Surrounding<'_> {
    /// Runs the code on a board that holds the display list; `None` for pictures that have no kernel.
    ///
    /// # Errors
    ///
    /// [`ProcessorFault`] when the code does not come to its end, or its data do not fit.
    pub fn run_code(
        &self,
        timing: &GpTiming,
        processor: &mut Processor,
    ) -> Result<Option<SurroundingOutput>, ProcessorFault> {
        let [.., ahead] = self.passes;
        let Some(kernel) = ahead.kernel(processor.version()) else { return Ok(None) };
        let eyes = self.passes.iter().map(|pass| pass.placed()).collect();
        let beginning = Beginning::new(ahead.share().list(), eyes, *ahead.picture()).of_chosen(ahead.chosen());
        let of_beginning = beginning.by_code(timing, processor)?;
        let (of_sorting, given) = self.sort(processor, kernel)?;
        let needs = || self.passes.iter().zip(&given).map(|(pass, given)| pass.needs(kernel, *given));
        let bytes = needs().map(|needs| needs.bytes()).sum();
        let [.., end] = marks(ahead);
        let mut begin = processor.place_output(self.context, end, bytes)?;
        let mut views = Vec::with_capacity(given.len());
        for ((view, pass), needs) in (0..).zip(self.passes).zip(needs()) {
            views.push(self.run_view(processor, kernel, (view, pass), &needs, begin)?);
            begin += needs.bytes();
        }
        let of_kernels = views.iter().fold(Span::ZERO, |all, view| all + view.span);
        let span = of_beginning + of_sorting + of_kernels;
        Ok(Some(SurroundingOutput { span, of_beginning, of_sorting, given, views }))
    }

    fn run_view(
        &self,
        processor: &mut Processor,
        kernel: Kernel,
        (view, pass): (u8, &Arc<Pass>),
        needs: &Needs,
        begin: u32,
    ) -> Result<KernelOutput, ProcessorFault> {
        let [triangles, spheres, _] = marks(pass);
        let marks = Marks { triangles, spheres, bit: 1 << view };
        let to = Destination { context: self.context, view, begin };
        pass.run_kernels(processor, kernel, needs, to, Some(marks))
    }

    /// Marks every primitive of the structures that are drawn; the time, and what each view is given.
    fn sort(&self, processor: &mut Processor, kernel: Kernel) -> Result<(Span, Vec<PrimitiveCounts>), ProcessorFault> {
        let [.., ahead] = self.passes;
        let [triangles, spheres, _] = marks(ahead);
        let mut given = vec![PrimitiveCounts::default(); self.passes.len()];
        let mut span = Span::ZERO;
        let heads = ahead.heads();
        for (place, transform, held) in ahead.calls_of_triangles() {
            processor.write(PARAMETERS, &kernel.parameters(transform, &place.light, &heads, 0))?;
            let sorted = Sorted { held, first: DISPLAY_LIST, bytes: TRIANGLE_BYTES, marks: triangles };
            span += sorted.run(processor, "triangles", place)?;
            given.iter_mut().zip(sorted.counts(processor)?).for_each(|(given, more)| given.triangles += more);
        }
        let of_spheres = sphere_kernel(kernel);
        for (place, transform, held) in ahead.calls_of_spheres() {
            let Some(parameters) = of_spheres.parameters(transform, &place.light, &[]) else { continue };
            processor.write(PARAMETERS, &kernel.parameters(transform, &place.light, &heads, 0))?;
            processor.write(SPHERE_PARAMETERS, &parameters)?;
            let first = ahead.share().place_of_spheres();
            let sorted = Sorted { held, first, bytes: SPHERE_BYTES, marks: spheres };
            span += sorted.run(processor, "spheres", place)?;
            given.iter_mut().zip(sorted.counts(processor)?).for_each(|(given, more)| given.spheres += more);
        }
        Ok((span, given))
    }
}

/// Where the words that mark triangles begin, behind the display list, and those that mark spheres; and where these end.
fn marks(pass: &Pass) -> [u32; 3] {
    let share = pass.share();
    let triangles = share.end_of_list();
    let spheres = triangles + 4 * share.all_triangles().len() as u32;
    [triangles, spheres, spheres + 4 * share.all_spheres().len() as u32]
}

/// Primitives of a structure that are sorted: their places among those that the GP holds, where the first of all lies, how large one
/// is, and where the word of the first of all lies.
struct Sorted {
    held: Range<usize>,
    first: u32,
    bytes: u32,
    marks: u32,
}

impl Sorted {
    fn words(&self) -> u32 {
        self.marks + 4 * self.held.start as u32
    }

    fn run(&self, processor: &mut Processor, entry: &str, place: &PlacedStructure) -> Result<Span, ProcessorFault> {
        let scale = place.matrices[2].x_axis.x;
        let [per_scale, less] = [1.0 / scale, scale * (1.0 - MARGIN)].map(f32::to_bits);
        let first = self.first + self.held.start as u32 * self.bytes;
        let count = self.held.len() as u32;
        let data = [(16, first), (17, count), (18, self.words()), (20, PARAMETERS)];
        let numbers = [(21, per_scale), (22, less), (23, SPHERE_PARAMETERS)];
        processor.call(&PROGRAM, entry, &[data.as_slice(), &numbers].concat(), budget(count))
    }

    /// How many of them each view is given.
    fn counts(&self, processor: &Processor) -> Result<[u32; MOST_VIEWS as usize], ProcessorFault> {
        let words: Vec<Word> = processor.read(self.words(), self.held.len())?;
        Ok(std::array::from_fn(|view| words.iter().map(|word| word >> view & 1).sum()))
    }
}

/// The program that sorts.
#[cfg(test)]
pub(crate) fn program() -> Arc<Program> {
    Arc::clone(&PROGRAM)
}

static PROGRAM: LazyLock<Arc<Program>> =
    LazyLock::new(|| match i860::assemble("sort", SORT_CODE, include_str!("../kernels/sort.s")) {
        Ok(program) => Arc::new(program),
        Err(errors) => unreachable!("it is assembled by the tests: {errors}"),
    });
