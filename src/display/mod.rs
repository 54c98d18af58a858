//! What a display does between the frame buffer and the eye.

mod vdrt;

pub use vdrt::{RasterOffsets, Vdrt};

use serde::{Deserialize, Serialize};
use std::fmt;

/// What stands between the frame buffer and the eye.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Display {
    /// A raster that shows what the frame buffer holds.
    #[default]
    Plain,
    /// A raster that is shifted while it is scanned ([`Vdrt`]).
    Vdrt,
}

impl Display {
    /// All, by name.
    pub const ALL: [(&str, Self); 2] = [("plain", Self::Plain), ("vdrt", Self::Vdrt)];
}

impl fmt::Display for Display {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = Self::ALL.iter().find(|(_, display)| display == self).map_or("", |(name, _)| name);
        f.write_str(name)
    }
}
