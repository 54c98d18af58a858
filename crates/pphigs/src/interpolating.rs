//! CPU work of interpolating triangles between two views (a *dual display list*).
//!
//! The i860 code records each triangle's corners in the views at the start and at the end of a field. For each strip of
//! lines, the i860 code then makes commands for a view between these views. The sources are `ends.s` and `compiled.s`
//! of `pxpl5-geometry`. No paper describes the code; kernels/between_rules.md states its rules.

use crate::code::{BUDGET, Next, TRIANGLE_BYTES, budget};
use crate::layout::{BLENDED, BLENDED_ELEMENTS, CODE, DISPLAY_LIST, PARAMETERS, STACK};
use crate::list::Share;
use crate::pass::Pass;
use crate::picture::Picture;
use crate::programs::{Programs, kept};
use crate::view::FrameView;
use crate::windows::MemoryPart;
use i860::Program;
use pxpl5_geometry::Culling;
use pxpl5_geometry::kernel::{ENDS_VIEW_WORDS, ENDS_WORDS, Kernel};
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_sim::Span;
use pxpl5_wire::Word;
use std::ops::Range;
use std::sync::{Arc, LazyLock, Mutex};

const RECORD_BYTES: u32 = 4 * ENDS_WORDS as u32;
const VIEW_BYTES: u32 = 4 * ENDS_VIEW_WORDS as u32;

/// Work that records the corners of all triangles in two views, in a part of the board's memory.
#[derive(Clone, Copy, Debug)]
pub struct TriangleEndsRecorder<'a> {
    pub share: &'a Share,
    /// Views at the start and at the end of a field.
    pub views: [&'a FrameView; 2],
    pub picture: Picture,
    pub part: MemoryPart,
}

impl TriangleEndsRecorder<'_> {
    /// Executes the i860 code that records the corners, and returns the simulated time. The board's memory must already
    /// contain the display list. The time includes the preparation of structures for both views.
    ///
    /// Returns `None` if no kernel can draw this kind of picture.
    ///
    /// # Errors
    ///
    /// Returns [`ProcessorFault`] if the code does not end, or has no room for the records.
    pub fn run_code(&self, timing: &GpTiming, processor: &mut Processor) -> Result<Option<Span>, ProcessorFault> {
        let n_triangles = self.share.counts().triangles;
        let records = self.part.checked(processor, self.share, RECORD_BYTES * n_triangles)?;
        // Clear all records. If one view does not draw a structure, its triangles must not count as recorded.
        processor.write(records, &vec![0; ENDS_WORDS * n_triangles as usize])?;
        let passes = self.views.map(|view| self.share.transform(view, 0, self.picture));
        let mut span = Span::ZERO;
        for (pass, of_view) in passes.iter().zip([0, VIEW_BYTES]) {
            let Some(kernel) = pass.kernel(processor.version()) else { return Ok(None) };
            let kernel = Kernel { keeps_boxes: true, ..kernel };
            span += pass.beginning_without_bins().by_code(timing, processor)?;
            let heads = pass.heads();
            for (place, transform, held) in pass.calls_of_triangles() {
                processor.write(PARAMETERS, &kernel.parameters(transform, &place.light, &heads, 0))?;
                let [first, count, record] = addresses(&held, records);
                let data = [(2, STACK), (16, first), (17, count), (18, record), (20, PARAMETERS), (21, of_view)];
                span += processor.call(&program(kernel), "keepends", &data, budget(count))?;
            }
        }
        Ok(Some(span))
    }
}

const fn addresses(held: &Range<usize>, records: u32) -> [u32; 3] {
    let first = held.start as u32;
    [DISPLAY_LIST + first * TRIANGLE_BYTES, (held.end - held.start) as u32, records + first * RECORD_BYTES]
}

/// Work that makes the commands of a strip of lines, for a view between two recorded views.
///
/// The result has commands and bounding boxes of the triangles near the strip, and of all spheres.
#[derive(Clone, Copy, Debug)]
pub struct StripInterpolation<'a> {
    pub share: &'a Share,
    /// Views at the start and at the end of a field, in which a [`TriangleEndsRecorder`] has recorded the triangles.
    pub views: [&'a FrameView; 2],
    /// View between these views. Spheres, light and clipped triangles are computed for this view instead of
    /// interpolated.
    pub between: &'a FrameView,
    /// The instant of `between`, from 0 (first view) to 1 (second view).
    pub part_of_way: f64,
    /// True if triangles are interpolated in eye space, before the division by depth. False if triangles are
    /// interpolated on the screen.
    pub in_eye_space: bool,
    /// First and last line of a range around the strip, in 1/16 px from the top of the frame. Triangles outside this
    /// range cannot touch the strip in any view between the two views.
    pub near: [i32; 2],
    pub picture: Picture,
    /// Part of the board's memory with the [recorded corners](TriangleEndsRecorder).
    pub ends: MemoryPart,
    /// Part of the board's memory for the strip's commands.
    pub commands: MemoryPart,
}

impl StripInterpolation<'_> {
    /// Executes the i860 code that makes the strip's commands, and returns the simulated time. The board's memory must
    /// already contain the corners that a [`TriangleEndsRecorder`] has recorded. Returns `None` if no kernel can draw
    /// this kind of picture.
    ///
    /// # Errors
    ///
    /// Returns [`ProcessorFault`] if the code does not end, or has no room for the commands.
    pub fn run_code(&self, timing: &GpTiming, processor: &mut Processor) -> Result<Option<Span>, ProcessorFault> {
        let pass = self.share.transform(self.between, 0, self.picture);
        let Some(kernel) = pass.kernel(processor.version()) else { return Ok(None) };
        let kernel = Kernel { keeps_boxes: true, ..kernel };
        let blended = self.blend(processor, kernel)?;
        let beginning = pass.beginning_without_bins().by_code(timing, processor)?;
        let triangles = |processor: &mut Processor, first| self.run_triangles(processor, kernel, &pass, first);
        let of_kernels = pass.keep_commands(processor, kernel, self.commands, triangles)?;
        Ok(Some(blended + beginning + of_kernels))
    }

    fn blend(&self, processor: &mut Processor, kernel: Kernel) -> Result<Span, ProcessorFault> {
        let [from, to] = self.views.map(elements);
        let [low, high] = [self.part_of_way.to_bits(), self.part_of_way.to_bits() >> 32].map(|word| word as Word);
        let room = BLENDED_ELEMENTS as usize;
        let mut span = Span::ZERO;
        for (from, to) in from.chunks(room).zip(to.chunks(room)) {
            let [first, second, out] = [0, 1, 2].map(|n| BLENDED + 4 * n * BLENDED_ELEMENTS);
            processor.write(first, from)?;
            processor.write(second, to)?;
            let data = [(16, first), (17, second), (18, out), (19, from.len() as Word), (20, low), (21, high)];
            span += processor.call(&program(kernel), "blend", &data, BUDGET + 100 * from.len() as u64)?;
        }
        Ok(span)
    }

    fn run_triangles(
        &self,
        processor: &mut Processor,
        kernel: Kernel,
        pass: &Pass,
        mut next: Next,
    ) -> Result<(Span, Next), ProcessorFault> {
        let records = self.ends.checked(processor, self.share, 0)?;
        let [low, high] = [self.part_of_way.to_bits(), self.part_of_way.to_bits() >> 32].map(|word| word as Word);
        let [top, bottom] = self.near.map(|y| y as Word);
        let heads = pass.heads();
        let mut span = Span::ZERO;
        // Each structure needs one call with its own parameter block.
        for (place, transform, held) in pass.calls_of_triangles() {
            let kernel = Kernel { culls: place.structure.culling != Culling::None, ..kernel };
            let program = program(kernel);
            let clipper = program.symbol("clipper").unwrap_or_default();
            processor.write(PARAMETERS, &kernel.parameters(transform, &place.light, &heads, clipper))?;
            let [first, count, record] = addresses(&held, records);
            let data = [(2, STACK), (16, first), (17, count), (20, PARAMETERS), (21, record)];
            let to = [(18, next.command), (19, next.table)];
            let strip = [(22, top), (23, bottom), (24, Word::from(self.in_eye_space)), (25, low), (26, high)];
            span += processor.call(&program, "start", &[data.as_slice(), &to, &strip].concat(), budget(count))?;
            next = next.left(processor, true);
        }
        Ok((span, next))
    }
}

/// Returns the matrix elements to interpolate. Projection matrices are left out, because both views have the same
/// projection.
fn elements(view: &FrameView) -> Vec<Word> {
    let of_eyes = view.eyes.iter().flat_map(|eye| [eye.world_to_eye, eye.head_to_eye]);
    let matrices = of_eyes.chain(view.edits.iter().map(|edit| edit.model));
    matrices.flat_map(|matrix| matrix.to_cols_array()).map(f32::to_bits).collect()
}

pub(crate) fn program(kernel: Kernel) -> Arc<Program> {
    static PROGRAMS: Programs<Kernel> = LazyLock::new(Mutex::default);
    kept(&PROGRAMS, kernel, |kernel| {
        let (between, clipper, ends) = (kernel.between_source(), kernel.clipper_source(), Kernel::ends_source());
        let sources = [("between", between.as_str()), ("clipper", clipper.as_str()), ("ends", ends.as_str())];
        match i860::link(CODE, &sources) {
            Ok(program) => program,
            Err(errors) => unreachable!("every program is assembled by the tests: {errors}"),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::{RegionBinning, Shading};
    use crate::{DisplayList, EyeView, ModelEdit};
    use glam::{DMat4, Mat4};
    use pxpl5_geometry::Viewport;
    use pxpl5_gp::CodeVersion;
    use pxpl5_renderer::Layout;
    use pxpl5_wire::{FieldParity, NodeId, ViewNumber};

    fn view(k: f32, edits: u32) -> FrameView {
        let matrix = |k: f32| Mat4::from_cols_array(&std::array::from_fn(|i| (k + i as f32).sin() * 10.0));
        let eye = EyeView { world_to_eye: matrix(k), head_to_eye: matrix(k + 0.3), projection: Mat4::IDENTITY };
        let edits = (0..edits).map(|structure| ModelEdit { structure, model: matrix(k * structure as f32) });
        FrameView { number: ViewNumber::FIRST, eyes: vec![eye], edits: edits.collect() }
    }

    /// Tests the interpolation of the matrices M0 and M1 by i860 code, for up to several blocks of memory. The expected
    /// result is `M0 (1 - s) + M1 s` in double precision, rounded once. The test reads the last matrix.
    #[test]
    fn code_interpolates_matrices_as_double_precision_does() {
        let share = Share::new(Arc::new(DisplayList::default()), 0, 1);
        let viewport = Viewport::field(FieldParity::Even);
        let (shading, binning, layout) = (Shading::Gouraud, RegionBinning::All, Layout::slats());
        let picture = Picture { viewport, shading, binning, layout, pixels: false };
        let kernel =
            Kernel { keeps_boxes: true, ..picture.kernel(pxpl5_geometry::kernel::Schedule::Dual).expect("a field") };
        let mut processor = Processor::new(NodeId(1), 8 << 20, CodeVersion::Scheduled, i860::Config::cycle());
        for (edits, s) in [(0, 0.25), (1, -0.06), (62, 1.0), (70, 1.0 / 3.0)] {
            let [from, to] = [view(0.4, edits), view(1.1, edits)];
            let interpolating = StripInterpolation {
                share: &share,
                views: [&from, &to],
                between: &from,
                part_of_way: s,
                in_eye_space: true,
                near: [0, 0],
                picture,
                ends: MemoryPart::WHOLE,
                commands: MemoryPart::WHOLE,
            };
            interpolating.blend(&mut processor, kernel).expect("it returns");
            let last = |view: &FrameView| -> DMat4 {
                view.edits.last().map_or(view.eyes[0].head_to_eye, |edit| edit.model).as_dmat4()
            };
            let expected = (last(&from) * (1.0 - s) + last(&to) * s).as_mat4().to_cols_array().map(f32::to_bits);
            let of_chunk = (16 * (2 + edits) - 1) % BLENDED_ELEMENTS + 1;
            let at = BLENDED + 4 * (2 * BLENDED_ELEMENTS + of_chunk - 16);
            assert_eq!(processor.read(at, 16).expect("in memory"), expected, "{edits} edits, {s}");
        }
    }
}
