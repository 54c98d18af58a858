//! Work of a board before the first triangle of a pass. The board applies edits to the display list and places the
//! list's structures for an eye.
//!
//! To *place* a structure is to compute its matrices and its light source in the coordinates of an eye. Both steps run
//! i860 code in the style of compiled code (`pxpl5_geometry::kernel::place_source`). All versions of the kernels (the
//! programs that transform primitives) use the same code for these steps. The code computes the view-dependent part of
//! each structure's parameter block before the pass. The kernels, however, read a parameter block that the simulator
//! computes without i860 code. Both blocks are equal in every word (tests/begin.rs).

use crate::cost::TransformCost;
use crate::layout::{BEGIN_CODE, BIN_TABLE, MESSAGE, MODELS, MODELS_END, PARAMETERS, SPHERE_PARAMETERS, STACK};
use crate::list::{DisplayList, Share};
use crate::picture::{Picture, RegionBinning};
use crate::placed::PlacedStructure;
use crate::placing::place_cached;
use crate::view::{FrameView, MAX_EDITS};
use glam::Mat4;
use i860::Program;
use pxpl5_geometry::Culling;
use pxpl5_geometry::kernel::KernelSurface;
use pxpl5_geometry::sphere_kernel::{SPHERE_VIEW_WORDS, SphereKernel};
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_sim::Span;
use pxpl5_wire::Word;
use std::sync::{Arc, LazyLock};

/// Largest number of structures whose matrices fit in memory.
const MOST_STRUCTURES: u32 = (MODELS_END - MODELS) / MATRIX_BYTES;
const MATRIX_BYTES: u32 = 64;
/// Number of words of an edit: the structure's index and its matrix.
const EDIT_WORDS: u32 = 17;

const _: () =
    assert!(MESSAGE + MAX_EDITS as u32 * 4 * EDIT_WORDS <= MODELS, "what a message holds lies before the matrices");

/// Instruction limit, much higher than the need of the code. Code that exceeds the limit counts as an endless loop.
const BUDGET: u64 = 20_000;

/// Work of the EDIT step, which stores the new model matrices of a view's edited structures.
#[derive(Clone, Copy, Debug)]
pub struct EditWork<'a>(pub &'a FrameView);

impl Work for EditWork<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        Span::from_ns(timing.edit_ns) * self.0.edits.len() as u64
    }

    fn by_code(&self, _: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        // Edits of unknown structures change nothing.
        let known: Vec<_> = self.0.edits.iter().filter(|edit| edit.structure < MOST_STRUCTURES).collect();
        let mut span = Span::ZERO;
        // Call the code for each message of edits. A view without edits still takes one call.
        for edits in known.chunks(MAX_EDITS).chain(known.is_empty().then_some([].as_slice())) {
            let words = edits.iter().flat_map(|edit| {
                let matrix = edit.model.to_cols_array().map(f32::to_bits);
                std::iter::once(edit.structure).chain(matrix)
            });
            processor.write(MESSAGE, &words.collect::<Vec<Word>>())?;
            let count = edits.len() as u32;
            let registers = [(16, MESSAGE), (17, count), (18, MODELS)];
            span += processor.call(&PROGRAM, "edit", &registers, BUDGET * u64::from(count + 1))?;
        }
        Ok(span)
    }
}

/// Work at the beginning of a pass over the display list. The work empties the bins and places structures (computes
/// their matrices and light in eye coordinates), for one eye or both eyes.
#[derive(Clone, Debug)]
pub struct PassStartWork {
    list: Arc<DisplayList>,
    eyes: Vec<Arc<[PlacedStructure]>>,
    /// Number of bins to empty for each eye, 0 if there are no bins.
    bins: u32,
    /// For each structure, by its index in the display list: true if the work places the structure. `None` places all
    /// structures.
    chosen: Option<Arc<[bool]>>,
}

impl Share {
    /// Returns the work at the beginning of a pass. `eyes` are the indices of the view's eyes that the pass draws.
    #[must_use]
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
            RegionBinning::All | RegionBinning::Touched => picture.viewport.grid().regions(),
        };
        Self { list: Arc::clone(list), eyes, bins, chosen: None }
    }

    /// Returns the same work for a pass that fills no bins.
    pub(crate) fn without_bins(self) -> Self {
        Self { bins: 0, ..self }
    }

    /// Returns the same work for only the chosen structures. `chosen` has one element for each structure.
    pub(crate) fn for_structures(self, chosen: Option<&[bool]>) -> Self {
        Self { chosen: chosen.map(Arc::from), ..self }
    }

    /// Returns the structures of an eye that this work places. The result omits structures that cannot be drawn.
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
                span += processor.call(&PROGRAM, "reset", &registers, BUDGET)?;
            }
            for place in self.begun(placed) {
                span += place.run_code(&self.list, processor)?;
            }
        }
        Ok(span)
    }
}

/// Returns the work at the beginning of a pass as counts for the timing table. `eyes` has the structures of each eye.
/// The counts omit structures that cannot be drawn.
pub(crate) fn beginning<'a>(eyes: impl IntoIterator<Item = &'a [PlacedStructure]>) -> TransformCost {
    let drawn = |place: &&PlacedStructure| place.transform.is_some();
    TransformCost::beginning(eyes.into_iter().flatten().filter(drawn).map(|place| &place.structure))
}

impl PlacedStructure {
    /// Runs the i860 code on a board, which computes the view-dependent part of each structure's parameter block.
    /// Returns the simulated time of the code.
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
        processor.call(&PROGRAM, "place", &registers, BUDGET)
    }
}

impl PlacedStructure {
    /// Writes the part of the sphere kernel's parameter block that is the same for all views. Returns the address of
    /// the block, or 0 if the structure draws no sphere.
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

#[cfg(test)]
pub(crate) fn program() -> Arc<Program> {
    Arc::clone(&PROGRAM)
}

static PROGRAM: LazyLock<Arc<Program>> =
    LazyLock::new(|| match i860::assemble("place", BEGIN_CODE, &pxpl5_geometry::kernel::place_source()) {
        Ok(program) => Arc::new(program),
        Err(errors) => unreachable!("it is assembled by the tests: {errors}"),
    });
