use crate::cube::update::FaceUpdate;
use address_recalculation::CubeFace;
use glam::{Mat4, Vec4};
use pphigs::{CubeTransform, EyeView, Pass, PrimitiveCounts, Share, TransformCost};
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_sim::Span;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Returns the view from an eye through one face of the cube around the head.
///
/// The argument `ahead` is the view of the eye while the head has its initial orientation. Structures that are fixed to
/// the head are drawn as for this orientation.
pub fn face_view(ahead: &EyeView, face: CubeFace) -> EyeView {
    let turn = to_face(face);
    EyeView {
        world_to_eye: turn * ahead.world_to_eye,
        head_to_eye: turn * ahead.head_to_eye,
        projection: ahead.projection,
    }
}

/// Returns the rotation from the axes of the world to the axes of a face, which point to the right, up and backwards.
fn to_face(face: CubeFace) -> Mat4 {
    let [right, up, forward] = [face.right(), face.up(), face.forward()].map(|axis| axis.map(|i| i as f32));
    let column = |i: usize| Vec4::new(right[i], up[i], -forward[i], 0.0);
    Mat4::from_cols(column(0), column(1), column(2), Vec4::W)
}

/// CPU work of TRANSFORM for the six faces of an update, for one slave.
pub(crate) struct CubeWork<'a> {
    faces: &'a [Arc<Pass>],
    /// Index of the set of bins, 0 or 1. A slave has two sets and uses them in turn.
    context: u8,
    /// Work before the first triangle: each structure is placed once for each face.
    begin: TransformCost,
    /// Numbers of triangles and spheres, each counted once for each face that it touches. A triangle or sphere that
    /// touches no face still counts once.
    transformed: PrimitiveCounts,
}

impl<'a> CubeWork<'a> {
    /// Counts the triangles, spheres and structures, from which the time of the work follows. `faces` has one pass for
    /// each of the six faces.
    pub(crate) fn new(share: &Share, update: &FaceUpdate, faces: &'a [Arc<Pass>], context: u8) -> Self {
        let held = share.chosen_counts(&update.structures);
        let transformed = PrimitiveCounts {
            triangles: transformed(faces, 0, held.triangles),
            spheres: transformed(faces, 1, held.spheres),
        };
        let chosen = || share.list().structures.iter().zip(&update.structures).filter(|(_, chosen)| **chosen);
        let begin = TransformCost::beginning((0..faces.len()).flat_map(|_| chosen()).map(|(structure, _)| structure));
        Self { faces, context, begin, transformed }
    }
}

/// Returns the number of transformations of triangles (`kind` 0) or of spheres (`kind` 1), summed over the faces.
/// `held` is the number of triangles or spheres that the update draws.
fn transformed(faces: &[Arc<Pass>], kind: usize, held: u32) -> u32 {
    let touching = || faces.iter().filter_map(|pass| Some(&pass.touching()?[kind]));
    let anywhere: BTreeSet<u32> = touching().flatten().copied().collect();
    let nowhere = held.saturating_sub(anywhere.len() as u32);
    touching().map(|numbers| numbers.len() as u32).sum::<u32>() + nowhere
}

impl Work for CubeWork<'_> {
    /// Returns the time of TRANSFORM from the timing table. The time includes structures, triangles and spheres for
    /// each face, and the entries of bins.
    fn by_table(&self, timing: &GpTiming) -> Span {
        let PrimitiveCounts { triangles, spheres } = self.transformed;
        let primitives = TransformCost { triangles: triangles.into(), spheres: spheres.into(), ..self.begin };
        let entries = self.faces.iter().map(|pass| pass.entries()).sum();
        TransformCost { entries, ..primitives }.span(timing)
    }

    fn by_code(&self, timing: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        let Ok(passes) = self.faces.try_into() else { return Ok(self.by_table(timing)) };
        let made = CubeTransform { passes, context: self.context }.run_code(timing, processor)?;
        Ok(made.map_or_else(|| self.by_table(timing), |made| made.span))
    }

    fn vertex_transforms(&self) -> u64 {
        self.transformed.vertices()
    }
}
