//! Work of a graphics processor before the first triangle of a pass: edits of the scene, and placement of structures.
//!
//! To *place* a structure is to compute its matrices and its light source in the coordinates of an eye. Both steps are
//! i860 code in the style of compiled code (`pxpl5_geometry::kernel::place_source`). The code computes the parameters
//! that a kernel needs for each structure. The kernels nevertheless read parameters that the simulator computes. The
//! parameters of the code and of the simulator are equal in every word (tests/begin.rs).

use crate::cost::TransformCost;
use crate::layout::{BEGIN_CODE, BIN_TABLE, MESSAGE, MODELS, MODELS_END, PARAMETERS, SPHERE_PARAMETERS, STACK};
use crate::list::{DisplayList, Share};
use crate::picture::{Picture, RegionBinning};
use crate::placed::PlacedStructure;
use crate::placing::place_cached;
use crate::programs::{Programs, kept};
use crate::view::{FrameView, MAX_EDITS};
use glam::Mat4;
use i860::Program;
use pxpl5_geometry::Culling;
use pxpl5_geometry::kernel::KernelSurface;
use pxpl5_geometry::sphere_kernel::{SPHERE_VIEW_WORDS, SphereKernel};
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_sim::Span;
use pxpl5_wire::Word;
use std::sync::{Arc, LazyLock, Mutex};

const MAX_STRUCTURES: u32 = (MODELS_END - MODELS) / MATRIX_BYTES;
const MATRIX_BYTES: u32 = 64;
const EDIT_WORDS: u32 = 17;

const _: () =
    assert!(MESSAGE + MAX_EDITS as u32 * 4 * EDIT_WORDS <= MODELS, "what a message holds lies before the matrices");

/// Largest number of instructions, much more than the code needs. Code that exceeds the limit counts as an endless
/// loop.
const BUDGET: u64 = 20_000;

/// Work of EDIT: the board stores the new matrices of the moved structures.
#[derive(Clone, Copy, Debug)]
pub struct EditWork<'a>(pub &'a FrameView);

impl Work for EditWork<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        Span::from_ns(timing.edit_ns) * self.0.edits.len() as u64
    }

    fn by_code(&self, _: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        // Edits of unknown structures change nothing.
        let edits_of_structures: Vec<_> = self.0.edits.iter().filter(|edit| edit.structure < MAX_STRUCTURES).collect();
        let mut span = Span::ZERO;
        // Call the code for each message of edits. A view without edits still takes one call.
        for edits in
            edits_of_structures.chunks(MAX_EDITS).chain(edits_of_structures.is_empty().then_some([].as_slice()))
        {
            let words = edits.iter().flat_map(|edit| {
                let matrix = edit.model.to_cols_array().map(f32::to_bits);
                std::iter::once(edit.structure).chain(matrix)
            });
            processor.write(MESSAGE, &words.collect::<Vec<Word>>())?;
            let count = edits.len() as u32;
            let registers = [(16, MESSAGE), (17, count), (18, MODELS)];
            span += processor.call(&program(false), "edit", &registers, BUDGET * u64::from(count + 1))?;
        }
        Ok(span)
    }
}

/// Work before the first triangle of a pass, for one eye or both eyes. The board empties the bins, and computes the
/// matrices and the light of each structure.
#[derive(Clone, Debug)]
pub struct PassStartWork {
    list: Arc<DisplayList>,
    eyes: Vec<Arc<[PlacedStructure]>>,
    /// Number of bins for each eye, 0 if there are no bins.
    bins: u32,
    /// True for each structure that is drawn, by index in the display list. `None` if all structures are drawn.
    chosen: Option<Arc<[bool]>>,
}

impl Share {
    /// Returns the work before the first triangle of a pass. `eyes` has the indices of the drawn eyes in the view.
    pub fn beginning(&self, view: &FrameView, eyes: &[usize], picture: Picture) -> PassStartWork {
        let eyes = eyes.iter().map(|eye| place_cached(&self.list, view, *eye, picture.viewport)).collect();
        PassStartWork::new(&self.list, eyes, picture)
    }
}

impl PassStartWork {
    pub(crate) fn new(list: &Arc<DisplayList>, eyes: Vec<Arc<[PlacedStructure]>>, picture: Picture) -> Self {
        let bins = match picture.binning {
            // Spheres always have bins.
            RegionBinning::All if list.spheres.is_empty() => 0,
            _ => picture.viewport.grid().regions(),
        };
        Self { list: Arc::clone(list), eyes, bins, chosen: None }
    }

    pub(crate) fn without_bins(self) -> Self {
        Self { bins: 0, ..self }
    }

    pub(crate) fn for_structures(self, chosen: Option<&[bool]>) -> Self {
        Self { chosen: chosen.map(Arc::from), ..self }
    }

    fn begun<'a>(&'a self, placed: &'a [PlacedStructure]) -> impl Iterator<Item = &'a PlacedStructure> {
        let is_chosen = |number: usize| self.chosen.as_ref().is_none_or(|chosen| chosen.get(number) == Some(&true));
        let chosen = placed.iter().enumerate().filter(move |(number, _)| is_chosen(*number)).map(|(_, place)| place);
        chosen.filter(|place| place.transform.is_some())
    }
}

impl Work for PassStartWork {
    fn by_table(&self, timing: &GpTiming) -> Span {
        let begun = self.eyes.iter().flat_map(|placed| self.begun(placed));
        TransformCost::beginning(begun.map(|place| &place.structure)).span(timing)
    }

    fn by_code(&self, _: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        let mut span = Span::ZERO;
        for placed in &self.eyes {
            if self.bins > 0 {
                // Reset the beginnings of the bins. The actual table depends on the sizes of the bins. The simulator
                // writes this table before the kernel runs.
                let registers = [(16, MESSAGE), (17, self.bins), (19, BIN_TABLE)];
                span += processor.call(&program(self.list.is_single), "reset", &registers, BUDGET)?;
            }
            for place in self.begun(placed) {
                span += place.run_code(&self.list, processor)?;
            }
        }
        Ok(span)
    }
}

/// Returns the work before the first triangle of a pass as counts for the timing table. `eyes` has the structures of
/// each eye.
pub(crate) fn beginning<'a>(eyes: impl IntoIterator<Item = &'a [PlacedStructure]>) -> TransformCost {
    let drawn = |place: &&PlacedStructure| place.transform.is_some();
    TransformCost::beginning(eyes.into_iter().flatten().filter(drawn).map(|place| &place.structure))
}

impl PlacedStructure {
    /// Executes the i860 code that computes the parameters of a structure. Returns the simulated time of the code.
    ///
    /// # Errors
    ///
    /// Returns [`ProcessorFault`] if the code does not end, or if the board has no room for its data.
    pub fn run_code(&self, list: &DisplayList, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        let matrices = self.matrices.iter().flat_map(Mat4::to_cols_array);
        let [x, y, z] = list.towards_light.to_array();
        let words: Vec<Word> = matrices.chain([x, y, z, list.ambient, list.diffuse]).map(f32::to_bits).collect();
        // Matrices and light go to the message buffer, from which the code reads them.
        processor.write(MESSAGE, &words)?;
        let [to_eye, model, projection, light] = [0, 1, 2, 3].map(|n| MESSAGE + n * MATRIX_BYTES);
        let culls = Word::from(self.structure.culling != Culling::None);
        let spheres = self.prepare_spheres(processor)?;
        let data = [(16, to_eye), (17, model), (18, projection), (19, light)];
        let registers = [data.as_slice(), &[(2, STACK), (20, PARAMETERS), (21, culls), (22, spheres)]].concat();
        processor.call(&program(list.is_single), "place", &registers, BUDGET)
    }
}

impl PlacedStructure {
    /// Writes those parameters of the sphere kernel that are the same for all views. Returns their address, or 0 if the
    /// structure has no sphere to draw.
    fn prepare_spheres(&self, processor: &mut Processor) -> Result<Word, ProcessorFault> {
        let Some(transform) = self.transform.as_ref().filter(|_| !self.structure.spheres.is_empty()) else {
            return Ok(0);
        };
        // The view-dependent part does not depend on the surface, so every kernel gives the same result.
        let kernel = SphereKernel::for_picture(KernelSurface::Phong, transform.viewport());
        let Some(mut block) = kernel.and_then(|kernel| kernel.parameters(transform, &self.light, &[])) else {
            return Ok(0);
        };
        block[..SPHERE_VIEW_WORDS].fill(0);
        processor.write(SPHERE_PARAMETERS, &block)?;
        Ok(SPHERE_PARAMETERS)
    }
}

/// Returns the program, which for the lists of Slats places structures without the eye's position.
pub(crate) fn program(single: bool) -> Arc<Program> {
    static PROGRAMS: Programs<bool> = LazyLock::new(Mutex::default);
    kept(&PROGRAMS, single, |single| {
        match i860::assemble("place", BEGIN_CODE, &pxpl5_geometry::kernel::place_source(single)) {
            Ok(program) => program,
            Err(errors) => unreachable!("it is assembled by the tests: {errors}"),
        }
    })
}
