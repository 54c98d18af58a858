//! A device between frame buffer and eye that moves the last picture to where the head is now.

use serde::{Deserialize, Serialize};
use std::fmt;

/// How a picture is moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Warp {
    /// Shifted as a whole by yaw and pitch, exact in the middle of the picture.
    Shift,
    /// Turned about the eye, a homography: today's timewarp. Exact for all turns; what a step changes remains.
    Rotation,
    /// Moved pixel by pixel with its depth: exact for turns and steps, except for what the picture does not hold.
    Depth,
}

/// How often the newest pose is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Every {
    /// Once for all of a period of the display.
    Field,
    /// Once for each strip of 128 lines, or of columns where the scan goes sideways.
    Strip,
    /// Once for each line, or column: beam racing.
    Line,
}

/// A device that reprojects pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Reprojection {
    /// How a picture is moved.
    pub by: Warp,
    /// How often the newest pose is taken.
    pub every: Every,
    /// Time from the pose to the first light of what it moves, microseconds.
    pub latency_us: u64,
}

impl Warp {
    /// All, by their names in experiment files.
    pub const ALL: [(&str, Self); 3] = [("shift", Self::Shift), ("rotation", Self::Rotation), ("depth", Self::Depth)];
}

impl Every {
    /// All, by their names in experiment files.
    pub const ALL: [(&str, Self); 3] = [("field", Self::Field), ("strip", Self::Strip), ("line", Self::Line)];

    /// Lines of a strip: those of a region.
    pub const STRIP: u32 = 128;

    /// Returns the latency of a device where none is given, microseconds.
    ///
    /// Assumed. 2,000 a field: a graphics processor begins so long before the retrace (1,000 to 4,000). 500 a strip and 100 a line: a
    /// pipeline beside the scan that holds a few lines (64 to 1,000).
    #[must_use]
    pub const fn usual_latency_us(self) -> u64 {
        match self {
            Self::Field => 2_000,
            Self::Strip => 500,
            Self::Line => 100,
        }
    }
}

impl Reprojection {
    /// The least and the greatest latency, microseconds.
    pub const LATENCY_US: (u64, u64) = (0, 100_000);

    /// A device with the usual latency.
    #[must_use]
    pub const fn new(by: Warp, every: Every) -> Self {
        Self { by, every, latency_us: every.usual_latency_us() }
    }

    /// The raster offset of VDRT (Breglia 1981): a shift whose pose is taken at the retrace, once a field. The rates of yaw and pitch carry it
    /// on during the field, and the picture counts as drawn beyond the edge of the screen.
    pub const VDRT: Self = Self { by: Warp::Shift, every: Every::Field, latency_us: 0 };
}

impl fmt::Display for Reprojection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let by = Warp::ALL.iter().find(|(_, by)| *by == self.by).map_or("", |(name, _)| name);
        let every = Every::ALL.iter().find(|(_, every)| *every == self.every).map_or("", |(name, _)| name);
        write!(f, "{by} every {every}, {} us", self.latency_us)
    }
}
