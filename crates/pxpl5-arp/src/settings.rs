//! Settings of an experiment: the policy, the cells, warping, the renderer and the display.

use crate::cube_faces::{CubeView, DepthRange};
use address_recalculation::priority::{Falloff, PriorityTiming};
use address_recalculation::{ArpConfig, ArpTiming};
use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};

/// The policy that decides which segments (parts of objects) are drawn in which frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PolicyKind {
    /// One memory, in which everything is drawn in every frame.
    Full,
    /// Each object is in the least often updated memory that keeps the object's image error below the threshold.
    Objects,
    /// The floor is divided into square cells. Each cell is assigned to a memory by its distance from the viewer's
    /// cell.
    #[default]
    Cells,
}

pxpl5_sim::parameters::named!(PolicyKind, "policy", PolicyKind::ALL);

impl PolicyKind {
    pub const ALL: [(&str, Self); 3] = [("full", Self::Full), ("objects", Self::Objects), ("cells", Self::Cells)];
}

/// Speed of the renderer that draws the cube faces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum SourceKind {
    /// A renderer that takes no time: updates that are due in a frame are shown in the same frame.
    #[default]
    Ideal,
    /// A renderer that draws memories one after the other at a limited rate. Updates are shown in the next frame at the
    /// earliest.
    Timed {
        /// Number of triangles drawn per second. A triangle counts once, even if the triangle covers several faces.
        triangles_per_s: f64,
    },
}

/// Distance of the near plane along a face's axis, in metres. The value is assumed. Walls are at least 1 m away from
/// the gallery's path. Along the axis of a face, the distance is at least 1 m / sqrt(3) = 0.58 m.
const NEAR_M: f64 = 0.1;
/// Distance of the far plane along a face's axis, in metres. The value is assumed and exceeds the size of the hall. At
/// 20 m, the 24-bit depths then have steps of 0.24 mm.
const FAR_M: f64 = 100.0;

/// Settings of an experiment, without the scene and the viewer's walk.
#[derive(Clone, Debug, PartialEq)]
pub struct WalkSettings {
    pub policy: PolicyKind,
    /// True if objects are cut into segments at the borders of cells.
    pub is_segmented: bool,
    /// Rule by which warping moves vertices near the border to a less often drawn memory. The displacement decreases
    /// with the distance from the border. [`Falloff::None`] disables warping, so gaps appear at cuts.
    pub falloff: Falloff,
    /// True if an update of a memory makes all more often drawn memories due for an update.
    pub has_cascade: bool,
    pub numbers: PriorityTiming,
    pub display: ArpConfig,
    pub source: SourceKind,
}

impl WalkSettings {
    /// Settings with objects that are cut but not warped, and with an ideal renderer. The side of a cell is fitted to
    /// table 1 of the paper CPR05. An update of a memory also updates all more often drawn memories.
    pub const CELLS: Self = Self {
        policy: PolicyKind::Cells,
        is_segmented: true,
        falloff: Falloff::None,
        has_cascade: true,
        numbers: PriorityTiming::PAPERS,
        display: ArpConfig::IDEAL,
        source: SourceKind::Ideal,
    };

    /// The settings of [`Self::CELLS`] with warping.
    pub const WARPED: Self = Self { falloff: Falloff::Linear, ..Self::CELLS };

    /// Settings with one memory, in which everything is drawn in every frame.
    pub const FULL: Self = Self {
        policy: PolicyKind::Full,
        numbers: PriorityTiming { memories: 1, ..PriorityTiming::PAPERS },
        display: ArpConfig { timing: ArpTiming { display_memories: 1, ..ArpConfig::IDEAL.timing }, ..ArpConfig::IDEAL },
        ..Self::CELLS
    };

    /// Settings with uncut objects. Each object is in the least often updated memory that keeps the object's image
    /// error below the threshold.
    pub const OBJECTS: Self = Self { policy: PolicyKind::Objects, is_segmented: false, ..Self::CELLS };

    /// Returns the settings with `memories` display memories, for both the policy and the display.
    #[must_use]
    pub const fn with_memories(mut self, memories: u64) -> Self {
        self.numbers.memories = memories;
        self.display.timing.display_memories = memories;
        self
    }

    /// Returns the settings with `side_m` as the side of a cell, in metres.
    #[must_use]
    pub const fn with_cells(mut self, side_m: f64) -> Self {
        self.numbers.cell_m = side_m;
        self
    }

    /// Checks all settings.
    ///
    /// # Errors
    ///
    /// [`SettingError`] describes the expected and the found value.
    pub fn check(&self) -> Result<(), SettingError> {
        self.numbers.check()?;
        self.display.check()?;
        if let SourceKind::Timed { triangles_per_s } = self.source
            && (triangles_per_s.is_nan() || triangles_per_s <= 0.0)
        {
            return Err(SettingError::value("source.triangles_per_s", "more than 0", triangles_per_s));
        }
        Ok(())
    }

    pub const fn memories(&self) -> usize {
        match self.policy {
            PolicyKind::Full => 1,
            PolicyKind::Objects | PolicyKind::Cells => self.numbers.memories as usize,
        }
    }

    /// Returns the projection with which the cube faces are drawn.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`DepthRange::new`].
    pub fn view(&self) -> Result<CubeView, SettingError> {
        Ok(CubeView { geometry: self.display.geometry(), depth: DepthRange::new(NEAR_M, FAR_M)? })
    }

    /// Returns the mean angle between texels in degrees: 90 divided by the texels of a face's edge.
    pub fn texel_deg(&self) -> f64 {
        90.0 / self.display.timing.face_texels as f64
    }
}
