//! A device between frame buffer and eye that moves the last picture to the current pose of the head.

use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::REGION_SIZE;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// The method by which a device moves a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Warp {
    /// The whole picture is shifted by yaw and pitch. The result is exact only in the middle of the picture.
    Shift,
    /// The picture is rotated about the eye by a homography, as in timewarp, the method of current headsets. The result
    /// is exact for rotations of the head. Translations remain uncorrected.
    Rotation,
    /// Each pixel is moved according to its depth. The result is exact for rotations and translations, except where the
    /// picture lacks the content.
    Depth,
}

/// The part of a scan that is moved by the same pose. The device takes the newest pose for each part.
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
    /// The part of a scan that is moved by the same pose. The device takes the newest pose for each part.
    pub every: Every,
    /// Time from the instant at which the device takes a pose until the first pixel that is moved to this pose is lit,
    /// in microseconds.
    pub latency_us: u64,
}

impl Warp {
    /// All methods by which a device moves a picture, with their names in experiment files.
    pub const ALL: [(&str, Self); 3] = [("shift", Self::Shift), ("rotation", Self::Rotation), ("depth", Self::Depth)];
}

impl Every {
    /// All parts of a scan, with their names in experiment files.
    pub const ALL: [(&str, Self); 3] = [("field", Self::Field), ("strip", Self::Strip), ("line", Self::Line)];

    /// Number of lines in a strip, equal to the number of lines in a region.
    pub const STRIP: u32 = REGION_SIZE;

    /// Returns the default latency of a device, in microseconds (assumed).
    ///
    /// The latency is 2,000 for one pose per field, because the graphics hardware of a current headset begins this long
    /// before the retrace (range 1,000 to 4,000). For one pose per strip the latency is 500, and for one pose per line
    /// 100 (range 64 to 1,000). In both cases the device works during the scan and holds only a few lines.
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
    /// The smallest and the largest valid latency, in microseconds.
    pub const LATENCY_US: (u64, u64) = (0, 100_000);

    /// Creates a device with the default latency.
    #[must_use]
    pub const fn new(by: Warp, every: Every) -> Self {
        Self { by, every, latency_us: every.usual_latency_us() }
    }

    /// The raster offset of VDRT (Breglia 1981): a shift whose pose is taken at the retrace, once per field.
    ///
    /// The rates of yaw and pitch continue the shift during the field. The picture is assumed to extend beyond the edge
    /// of the screen.
    pub const VDRT: Self = Self { by: Warp::Shift, every: Every::Field, latency_us: 0 };
}

pxpl5_sim::parameters::named!(Warp, "method of reprojection", Warp::ALL);
pxpl5_sim::parameters::named!(Every, "part of a scan", Every::ALL);

impl fmt::Display for Reprojection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} every {}, {} us", self.by, self.every, self.latency_us)
    }
}

/// The forms in which a correction of the raster can be written as text.
pub(crate) const RASTER_FORMS: &str = "plain, vdrt or a device such as `rotation every line, 100 us`";

impl FromStr for Reprojection {
    type Err = SettingError;

    /// Parses a text such as `rotation every line, 100 us`, the form in which a device is written.
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
