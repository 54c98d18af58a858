//! TRANSFORM for the six faces of a cube.

use crate::cube::config::CubeControlConfig;
use crate::cube::update::FaceUpdate;
use address_recalculation::CubeFace;
use glam::{Mat4, Vec4};
use pphigs::{BIN_ENTRY_BYTES, CubeTransform, EyeView, FrameView, Pass, PrimitiveCounts, Share, TransformCost};
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_sim::Span;
use pxpl5_wire::{PictureNumber, RegionId};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Returns the view from an eye through one face of the cube around the head. `ahead` is the view of the eye while the
/// head has its initial orientation.
///
/// Structures that are fixed to the head are drawn as for this orientation.
#[must_use]
pub fn face_view(ahead: &EyeView, face: CubeFace) -> EyeView {
    let turn = to_face(face);
    EyeView {
        world_to_eye: turn * ahead.world_to_eye,
        head_to_eye: turn * ahead.head_to_eye,
        projection: ahead.projection,
    }
}

/// Returns the rotation from world axes to the axes of a face: right, up, and backwards.
fn to_face(face: CubeFace) -> Mat4 {
    let [right, up, forward] = [face.right(), face.up(), face.forward()].map(|axis| axis.map(|i| i as f32));
    let column = |i: usize| Vec4::new(right[i], up[i], -forward[i], 0.0);
    Mat4::from_cols(column(0), column(1), column(2), Vec4::W)
}

/// Result of TRANSFORM on one slave for an update of a display memory: the slave's primitives in each region of the six
/// faces.
#[derive(Clone, Debug)]
pub struct CubePass {
    update: Arc<FaceUpdate>,
    /// Set of bins of the update, 0 or 1. A slave has two sets.
    context: u8,
    faces: Vec<Arc<Pass>>,
    /// Work before the first primitive, in which each structure is placed once for each face.
    begin: TransformCost,
    transformed: PrimitiveCounts,
}

impl CubePass {
    /// Transforms the primitives of a slave for all six faces. Structures that the display memory does not hold are
    /// left out.
    ///
    /// The vertices have the positions in the result of [`CubePass::placed`].
    #[must_use]
    pub fn new(config: &CubeControlConfig, share: &Share, update: &Arc<FaceUpdate>) -> Self {
        let ahead = update.view.eyes.first();
        let faces = CubeFace::ALL.iter().flat_map(|face| ahead.map(|ahead| face_view(ahead, *face)));
        let view = FrameView { eyes: faces.collect(), ..update.view.clone() };
        // Transform for each face.
        let share = &Self::placed(config, share, update);
        let pass = |face: usize| share.transform_chosen(&view, face, config.faces.picture, &update.structures);
        let faces: Vec<Arc<Pass>> = (0..view.eyes.len()).map(pass).collect();
        // Count the transformations and the structures to compute the time of the pass.
        let held = share.chosen_counts(&update.structures);
        let transformed = PrimitiveCounts {
            triangles: transformed(&faces, 0, held.triangles),
            spheres: transformed(&faces, 1, held.spheres),
        };
        let chosen = || share.list().structures.iter().zip(&update.structures).filter(|(_, chosen)| **chosen);
        let begin = TransformCost::beginning((0..faces.len()).flat_map(|_| chosen()).map(|(structure, _)| structure));
        Self { update: Arc::clone(update), context: context_of(update.number) as u8, faces, begin, transformed }
    }

    /// Returns the share with displaced vertices if the update has a warp, otherwise the unchanged share.
    #[must_use]
    pub fn placed(config: &CubeControlConfig, share: &Share, update: &FaceUpdate) -> Share {
        if update.warp.is_none() { share.clone() } else { share.with_list(config.warped.placed(share.list(), update)) }
    }

    /// Returns the update to which the bins belong.
    #[must_use]
    pub fn update(&self) -> &FaceUpdate {
        &self.update
    }

    pub(crate) fn face(&self, face: usize) -> Option<&Arc<Pass>> {
        self.faces.get(face)
    }

    /// Returns the number of entries in each region's bin, for the regions of all six faces.
    #[must_use]
    pub fn entries(&self, config: &CubeControlConfig) -> Vec<u32> {
        let entries = |region: RegionId| {
            let (face, region) = config.faces.on_face(region);
            self.face(face).map_or(0, |pass| pass.counts(region).total())
        };
        (0..config.faces.regions()).map(|region| entries(RegionId(region))).collect()
    }

    /// Returns how many triangles and how many spheres were transformed.
    ///
    /// A primitive counts once for each face that it touches. A primitive that touches no face counts once.
    #[must_use]
    pub const fn transformed(&self) -> PrimitiveCounts {
        self.transformed
    }

    pub(crate) fn command_bytes(&self) -> u64 {
        self.faces.iter().map(|pass| pass.command_bytes()).sum()
    }

    pub(crate) fn bin_bytes(&self) -> u64 {
        self.all_entries() * BIN_ENTRY_BYTES
    }

    fn all_entries(&self) -> u64 {
        self.faces.iter().map(|pass| pass.entries()).sum()
    }
}

/// Returns the set of bins for an update, 0 or 1.
pub(crate) const fn context_of(update: PictureNumber) -> usize {
    (update.0 % 2) as usize
}

/// Returns how many triangles (`kind` 0) or spheres (`kind` 1) were transformed, summed over the faces. `held` is the
/// number of triangles or spheres of the update.
fn transformed(faces: &[Arc<Pass>], kind: usize, held: u32) -> u32 {
    let touching = || faces.iter().filter_map(|pass| Some(&pass.touching()?[kind]));
    let anywhere: BTreeSet<u32> = touching().flatten().copied().collect();
    let nowhere = held.saturating_sub(anywhere.len() as u32);
    touching().map(|numbers| numbers.len() as u32).sum::<u32>() + nowhere
}

impl Work for CubePass {
    /// Returns the time of TRANSFORM from the timing table: structures and primitives for each face, and bin entries.
    fn by_table(&self, timing: &GpTiming) -> Span {
        let PrimitiveCounts { triangles, spheres } = self.transformed;
        let primitives = TransformCost { triangles: triangles.into(), spheres: spheres.into(), ..self.begin };
        TransformCost { entries: self.all_entries(), ..primitives }.span(timing)
    }

    fn by_code(&self, timing: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        let Ok(passes) = self.faces.as_slice().try_into() else { return Ok(self.by_table(timing)) };
        let made = CubeTransform { passes, context: self.context }.run_code(timing, processor)?;
        Ok(made.map_or_else(|| self.by_table(timing), |made| made.span))
    }

    fn vertex_transforms(&self) -> u64 {
        self.transformed.vertices()
    }
}
