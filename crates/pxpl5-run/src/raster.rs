//! Correction of a picture during its scan, between the frame buffer and the eye.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Correction that a display applies while it scans its frame buffer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Raster {
    /// No correction: each pixel is displayed in its own place.
    #[default]
    Plain,
    /// The picture is shifted during the scan by the error of the pose that it was drawn for (VDRT, Breglia 1981).
    Vdrt,
}

impl Raster {
    /// All corrections, with their names on the command line.
    pub const ALL: [(&str, Self); 2] = [("plain", Self::Plain), ("vdrt", Self::Vdrt)];
}

impl fmt::Display for Raster {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = Self::ALL.iter().find(|(_, raster)| raster == self).map_or("", |(name, _)| name);
        f.write_str(name)
    }
}
