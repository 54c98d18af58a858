//! A device between frame buffer and eye that moves the last picture to the newest pose of the head.

use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::REGION_SIZE;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// The method by which a device moves a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Warp {
    /// The device shifts the whole picture by the change of yaw and pitch. The result is exact only in the middle.
    Shift,
    /// The device rotates the picture about the eye by a homography, like the timewarp of current headsets. The result
    /// is exact for rotations of the head. Translations remain uncorrected.
    Rotation,
    /// The device moves each pixel according to its depth. The result is exact, except where an object hid the content
    /// in the last picture.
    Depth,
}

/// The part of a scan for which a [`Reprojection`] uses one pose.
///
/// Each part uses the newest pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Every {
    /// One pose for each display period.
    Field,
    /// One pose for each strip of 128 lines. If the scan goes sideways, a strip has 128 columns.
    Strip,
    /// One pose for each line or column: beam racing.
    Line,
}

/// A device that reprojects pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Reprojection {
    /// The method by which the device moves a picture.
    pub by: Warp,
    /// The part of a scan for which the device uses one pose.
    pub every: Every,
    /// Time from the sample of a pose to the light of the first pixel that uses the pose, in microseconds.
    pub latency_us: u64,
}

impl Warp {
    /// All methods, with their names in experiment files.
    pub const ALL: [(&str, Self); 3] = [("shift", Self::Shift), ("rotation", Self::Rotation), ("depth", Self::Depth)];
}

impl Every {
    /// All parts of a scan, with their names in experiment files.
    pub const ALL: [(&str, Self); 3] = [("field", Self::Field), ("strip", Self::Strip), ("line", Self::Line)];

    /// Number of lines in a strip, equal to the number of lines in a region.
    pub const STRIP: u32 = REGION_SIZE;

    /// Returns the default latency of a device, in microseconds (assumed).
    ///
    /// With one pose per field, the latency is 2,000 (range 1,000 to 4,000). The graphics hardware of a current headset
    /// begins this long before the retrace. With one pose per strip the latency is 500. With one pose per line the
    /// latency is 100 (range 64 to 1,000), because the device holds only a few lines.
    pub const fn usual_latency_us(self) -> u64 {
        match self {
            Self::Field => 2_000,
            Self::Strip => 500,
            Self::Line => 100,
        }
    }
}

impl Reprojection {
    /// The smallest and the largest valid latency, in microseconds.
    pub const LATENCY_US: (u64, u64) = (0, 100_000);

    /// Creates a device with the default latency.
    pub const fn new(by: Warp, every: Every) -> Self {
        Self { by, every, latency_us: every.usual_latency_us() }
    }

    /// The raster offset of VDRT (Breglia 1981): a shift whose pose is taken at the retrace, once per field.
    ///
    /// During the field, the shift continues at the rates of yaw and pitch. The picture is assumed to extend beyond the
    /// edge of the screen.
    pub const VDRT: Self = Self { by: Warp::Shift, every: Every::Field, latency_us: 0 };
}

pxpl5_sim::parameters::named!(Warp, "method of reprojection", Warp::ALL);
pxpl5_sim::parameters::named!(Every, "part of a scan", Every::ALL);

impl fmt::Display for Reprojection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} every {}, {} us", self.by, self.every, self.latency_us)
    }
}

pub(crate) const RASTER_FORMS: &str = "plain, vdrt or a device such as `rotation every line, 100 us`";

impl FromStr for Reprojection {
    type Err = SettingError;

    fn from_str(text: &str) -> Result<Self, SettingError> {
        let parse = || {
            let (way, latency) = text.split_once(", ")?;
            let (by, every) = way.split_once(" every ")?;
            let latency_us = latency.strip_suffix(" us")?.parse().ok()?;
            let is_valid = (Self::LATENCY_US.0..=Self::LATENCY_US.1).contains(&latency_us);
            is_valid.then_some(Self { by: by.parse().ok()?, every: every.parse().ok()?, latency_us })
        };
        parse().ok_or_else(|| SettingError::text(RASTER_FORMS, text))
    }
}
