//! What an experiment is made of.

use crate::error::ExperimentError;
use address_recalculation::{ArpConfig, ArpTiming};
use cube_faces::{CubeView, DepthRange};
use priority_rendering::{Falloff, PriorityTiming};
use serde::{Deserialize, Serialize};

/// Who decides what is drawn when.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PolicyKind {
    /// One memory, everything in every frame.
    Full,
    /// Every object in the slowest memory in which its image stays right.
    Objects,
    /// Square cells, dealt to memories by their distance from the user's.
    #[default]
    Cells,
}

impl PolicyKind {
    /// All, by their names on the command line.
    pub const ALL: [(&str, Self); 3] = [("full", Self::Full), ("objects", Self::Objects), ("cells", Self::Cells)];

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Full => "full",
            Self::Objects => "objects",
            Self::Cells => "cells",
        }
    }
}

/// How fast the source of faces draws.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum SourceKind {
    /// In no time: what is due in a frame is shown in it.
    #[default]
    Ideal,
    /// So many triangles a second, one memory after the other; what is due in a frame is shown in the next one at the earliest.
    Timed {
        /// Triangles of an update that it draws in a second, all faces together.
        triangles_per_s: f64,
    },
}

/// Nearest and farthest distance along a face's axis, m. Assumed: nearer than the 1 m of the gallery's path divided by the square root
/// of 3, farther than its hall; a step of depth is 0.24 mm at 20 m.
const NEAR_M: f64 = 0.1;
const FAR_M: f64 = 100.0;

/// What an experiment is made of, besides scene and walk.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Who decides what is drawn when.
    pub policy: PolicyKind,
    /// Whether objects are cut at the borders of cells.
    pub is_segmented: bool,
    /// How warping falls off from a border to a slower memory; with [`Falloff::None`] cuts tear.
    pub falloff: Falloff,
    /// Whether an update of a memory makes all faster ones due.
    pub has_cascade: bool,
    /// The policies' numbers.
    pub numbers: PriorityTiming,
    /// The display.
    pub display: ArpConfig,
    /// How fast faces are drawn.
    pub source: SourceKind,
}

impl Settings {
    /// Cells of table 1's size, cut, drawn in no time, torn.
    pub const CELLS: Self = Self {
        policy: PolicyKind::Cells,
        is_segmented: true,
        falloff: Falloff::None,
        has_cascade: false,
        numbers: PriorityTiming::PAPERS,
        display: ArpConfig::IDEAL,
        source: SourceKind::Ideal,
    };

    /// The same, warped, with the cascade that warping needs.
    pub const WARPED: Self = Self { falloff: Falloff::Linear, has_cascade: true, ..Self::CELLS };

    /// One memory, everything in every frame.
    pub const FULL: Self = Self {
        policy: PolicyKind::Full,
        numbers: PriorityTiming { memories: 1, ..PriorityTiming::PAPERS },
        display: ArpConfig { timing: ArpTiming { display_memories: 1, ..ArpConfig::IDEAL.timing }, ..ArpConfig::IDEAL },
        ..Self::CELLS
    };

    /// Uncut objects in the slowest memories in which they stay right.
    pub const OBJECTS: Self = Self { policy: PolicyKind::Objects, is_segmented: false, ..Self::CELLS };

    /// The same with so many memories of the policy and of the display.
    #[must_use]
    pub const fn with_memories(mut self, memories: u64) -> Self {
        self.numbers.memories = memories;
        self.display.timing.display_memories = memories;
        self
    }

    /// The same with cells of this side, m.
    #[must_use]
    pub const fn with_cells(mut self, side_m: f64) -> Self {
        self.numbers.cell_m = side_m;
        self
    }

    /// Checks everything together.
    ///
    /// # Errors
    ///
    /// [`ExperimentError`] names what was expected and found.
    pub fn check(&self) -> Result<(), ExperimentError> {
        self.numbers.check()?;
        self.display.check()?;
        if let SourceKind::Timed { triangles_per_s } = self.source
            && (triangles_per_s.is_nan() || triangles_per_s <= 0.0)
        {
            return Err(ExperimentError::Rate(triangles_per_s));
        }
        Ok(())
    }

    /// Memories that are used.
    #[must_use]
    pub const fn memories(&self) -> usize {
        match self.policy {
            PolicyKind::Full => 1,
            PolicyKind::Objects | PolicyKind::Cells => self.numbers.memories as usize,
        }
    }

    /// How faces are drawn.
    ///
    /// # Errors
    ///
    /// As [`DepthRange::new`].
    pub fn view(&self) -> Result<CubeView, ExperimentError> {
        Ok(CubeView { geometry: self.display.geometry(), depth: DepthRange::new(NEAR_M, FAR_M)? })
    }

    /// Mean angle between texels, degrees: 90 over those of a face's edge.
    #[must_use]
    pub fn texel_deg(&self) -> f64 {
        90.0 / self.display.timing.face_texels as f64
    }
}
