//! TRANSFORM of six views from one eye position, such as the faces of a cube, as i860 code.
//!
//! Each primitive is transformed only for the views that it may touch. The code kernels/sort.s finds these views, and
//! kernels/runs.s passes the primitives to the kernels. No paper describes this code; kernels/sort_rules.md states its
//! rules.

use crate::begin::PassStartWork;
use crate::code::{Destination, KernelOutput, Marks, OutputSize, SPHERE_BYTES, TRIANGLE_BYTES, budget, sphere_kernel};
use crate::layout::{DISPLAY_LIST, MAX_VIEWS, PARAMETERS, SORT_CODE, SPHERE_PARAMETERS};
use crate::list::PrimitiveCounts;
use crate::pass::Pass;
use crate::placed::PlacedStructure;
use i860::Program;
use pxpl5_geometry::kernel::Kernel;
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_sim::Span;
use pxpl5_wire::Word;
use std::ops::Range;
use std::sync::{Arc, LazyLock};

/// Margin around a view in the search for its primitives, as a fraction of the projection's scale (rule 4 of
/// kernels/sort_rules.md).
const MARGIN: f32 = 1.0 / 32.0;

/// Work of TRANSFORM for six views from one eye position.
#[derive(Clone, Copy, Debug)]
pub struct CubeTransform<'a> {
    /// Results of TRANSFORM for the views along +x, -x, +y, -y, +z and -z, in the eye coordinates of the last view. All
    /// views have the same projection.
    pub passes: &'a [Arc<Pass>; MAX_VIEWS as usize],
    /// Set of bins for all views, 0 or 1. A board has two sets.
    pub context: u8,
}

/// Result of TRANSFORM for six views, in the memory of a board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CubeTransformOutput {
    pub span: Span,
    /// Simulated time of the steps before the first primitive, which is included in `span`.
    pub start_span: Span,
    /// Simulated time of the search for the views of each primitive, which is included in `span`.
    pub sort_span: Span,
    /// Number of primitives that were transformed for each view, visible or not.
    pub given: Vec<PrimitiveCounts>,
    /// Output of the kernels, for each view.
    pub views: Vec<KernelOutput>,
}

impl CubeTransform<'_> {
    /// Executes the i860 code of TRANSFORM for the six views. The board's memory must already contain the display list.
    /// Returns `None` if no kernel can draw this kind of picture.
    ///
    /// # Errors
    ///
    /// Returns [`ProcessorFault`] if the code does not end, or if its data do not fit.
    pub fn run_code(
        &self,
        timing: &GpTiming,
        processor: &mut Processor,
    ) -> Result<Option<CubeTransformOutput>, ProcessorFault> {
        let [.., ahead] = self.passes;
        let Some(kernel) = ahead.kernel(processor.version()) else { return Ok(None) };
        let eyes = self.passes.iter().map(|pass| pass.placed()).collect();
        // The pass begins once for all six views, with the picture and structures of the last view.
        let beginning = PassStartWork::new(ahead.share().list(), eyes, *ahead.picture()).for_structures(ahead.chosen());
        let start_span = beginning.by_code(timing, processor)?;
        let (sort_span, given) = self.sort(processor, kernel)?;
        // Each view needs room only for the primitives that were sorted into it.
        let needs = || self.passes.iter().zip(&given).map(|(pass, given)| pass.needs(kernel, *given));
        let bytes = needs().map(|needs| needs.bytes()).sum();
        let [.., end] = marks(ahead);
        let mut begin = processor.place_output(self.context, end, bytes)?;
        let mut views = Vec::with_capacity(given.len());
        // The views' outputs follow each other in memory.
        for ((view, pass), needs) in (0..).zip(self.passes).zip(needs()) {
            views.push(self.run_view(processor, kernel, (view, pass), &needs, begin)?);
            begin += needs.bytes();
        }
        let of_kernels = views.iter().fold(Span::ZERO, |all, view| all + view.span);
        let span = start_span + sort_span + of_kernels;
        Ok(Some(CubeTransformOutput { span, start_span, sort_span, given, views }))
    }

    fn run_view(
        &self,
        processor: &mut Processor,
        kernel: Kernel,
        (view, pass): (u8, &Arc<Pass>),
        needs: &OutputSize,
        begin: u32,
    ) -> Result<KernelOutput, ProcessorFault> {
        let [triangles, spheres, _] = marks(pass);
        let marks = Marks { triangles, spheres, bit: 1 << view };
        let to = Destination { context: self.context, view, begin };
        pass.run_kernels(processor, kernel, needs, to, Some(marks))
    }

    /// Writes a word of marks for every primitive of the drawn structures. Bit `n` is set if view `n` may contain the
    /// primitive. Returns the time, and the number of primitives of each view.
    fn sort(&self, processor: &mut Processor, kernel: Kernel) -> Result<(Span, Vec<PrimitiveCounts>), ProcessorFault> {
        let [.., ahead] = self.passes;
        let [triangles, spheres, _] = marks(ahead);
        let mut given = vec![PrimitiveCounts::default(); self.passes.len()];
        let mut span = Span::ZERO;
        let heads = ahead.heads();
        // Triangles first, then spheres, as in the display list.
        for (place, transform, held) in ahead.calls_of_triangles() {
            processor.write(PARAMETERS, &kernel.parameters(transform, &place.light, &heads, 0))?;
            let sorted = ViewSort { held, first: DISPLAY_LIST, bytes: TRIANGLE_BYTES, marks: triangles };
            span += sorted.run(processor, "triangles", place)?;
            given.iter_mut().zip(sorted.counts(processor)?).for_each(|(given, more)| given.triangles += more);
        }
        let of_spheres = sphere_kernel(kernel);
        for (place, transform, held) in ahead.calls_of_spheres() {
            let Some(parameters) = of_spheres.parameters(transform, &place.light, &[]) else { continue };
            processor.write(PARAMETERS, &kernel.parameters(transform, &place.light, &heads, 0))?;
            processor.write(SPHERE_PARAMETERS, &parameters)?;
            let first = ahead.share().place_of_spheres();
            let sorted = ViewSort { held, first, bytes: SPHERE_BYTES, marks: spheres };
            span += sorted.run(processor, "spheres", place)?;
            given.iter_mut().zip(sorted.counts(processor)?).for_each(|(given, more)| given.spheres += more);
        }
        Ok((span, given))
    }
}

/// Returns the addresses of the marks of triangles and of spheres, and the end of the marks. The marks lie after the
/// display list.
fn marks(pass: &Pass) -> [u32; 3] {
    let share = pass.share();
    let triangles = share.end_of_list();
    let spheres = triangles + 4 * share.all_triangles().len() as u32;
    [triangles, spheres, spheres + 4 * share.all_spheres().len() as u32]
}

/// The primitives of one structure, and addresses in memory for the search that finds the views of each primitive.
///
/// `held` has the indices of the structure's primitives in the list of the graphics processor's primitives. `first` is
/// the address of the processor's first primitive, and `bytes` the size of a primitive. `marks` is the address of the
/// first word of marks, with a bit for each view.
struct ViewSort {
    held: Range<usize>,
    first: u32,
    bytes: u32,
    marks: u32,
}

impl ViewSort {
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

    fn counts(&self, processor: &Processor) -> Result<[u32; MAX_VIEWS as usize], ProcessorFault> {
        let words: Vec<Word> = processor.read(self.words(), self.held.len())?;
        Ok(std::array::from_fn(|view| words.iter().map(|word| word >> view & 1).sum()))
    }
}

#[cfg(test)]
pub(crate) fn program() -> Arc<Program> {
    Arc::clone(&PROGRAM)
}

static PROGRAM: LazyLock<Arc<Program>> =
    LazyLock::new(|| match i860::assemble("sort", SORT_CODE, include_str!("../kernels/sort.s")) {
        Ok(program) => Arc::new(program),
        Err(errors) => unreachable!("it is assembled by the tests: {errors}"),
    });
