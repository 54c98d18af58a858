//! What happens to a picture between the frame buffer and the eye.

use serde::{Deserialize, Serialize};
use std::fmt;

/// How a raster shows what its frame buffer holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Raster {
    /// Every pixel in its own place.
    #[default]
    Plain,
    /// Shifted while it is scanned, by what the pose that it was drawn for was wrong (VDRT, Breglia 1981).
    Vdrt,
}

impl Raster {
    /// All, by the name on the command line.
    pub const ALL: [(&str, Self); 2] = [("plain", Self::Plain), ("vdrt", Self::Vdrt)];
}

impl fmt::Display for Raster {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = Self::ALL.iter().find(|(_, raster)| raster == self).map_or("", |(name, _)| name);
        f.write_str(name)
    }
}
