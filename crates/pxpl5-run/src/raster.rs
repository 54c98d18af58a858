use crate::reprojection::Reprojection;
use pxpl5_sim::parameters::SettingError;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// The correction that a display applies to a picture during scan-out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Raster {
    /// No correction: each pixel is displayed at the position at which the pixel was drawn.
    #[default]
    Plain,
    /// Each line is shifted by the error of the pose for which the picture was drawn (VDRT, Breglia 1981).
    Vdrt,
    /// A device after the frame buffer moves the picture to the newest pose.
    Reprojected(Reprojection),
}

impl Raster {
    /// The corrections without parameters, with their names on the command line.
    pub const ALL: [(&str, Self); 2] = [("plain", Self::Plain), ("vdrt", Self::Vdrt)];

    /// Returns the correction as a device that moves pictures, or `None` without a correction.
    pub const fn reprojection(self) -> Option<Reprojection> {
        match self {
            Self::Plain => None,
            Self::Vdrt => Some(Reprojection::VDRT),
            Self::Reprojected(reprojection) => Some(reprojection),
        }
    }
}

impl FromStr for Raster {
    type Err = SettingError;

    fn from_str(text: &str) -> Result<Self, SettingError> {
        let named = Self::ALL.iter().find(|(name, _)| *name == text).map(|(_, raster)| *raster);
        named.map_or_else(|| text.parse().map(Self::Reprojected), Ok)
    }
}

impl fmt::Display for Raster {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Self::Reprojected(reprojection) = self {
            return write!(f, "{reprojection}");
        }
        let name = Self::ALL.iter().find(|(_, raster)| raster == self).map_or("", |(name, _)| name);
        f.write_str(name)
    }
}
