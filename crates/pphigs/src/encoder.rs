//! Encoder of triangle commands, chosen by the picture's shading.

use crate::picture::{Picture, Shading};
use pxpl5_renderer::{PhongTriangleEncoder, TriangleEncoder};

/// Encoder of the triangle commands of a picture.
#[derive(Debug)]
pub(crate) enum Encoder {
    Gouraud(TriangleEncoder),
    Phong(PhongTriangleEncoder),
}

impl Encoder {
    /// Creates the encoder of a picture's triangle commands. Returns `None` if the layout of pixel memory lacks a
    /// field. The machine's configuration rejects such layouts.
    pub(crate) fn for_picture(picture: &Picture) -> Option<Self> {
        match picture.shading {
            Shading::Gouraud | Shading::Precomputed => Some(Self::Gouraud(TriangleEncoder::new(&picture.layout))),
            Shading::Phong => PhongTriangleEncoder::new(&picture.layout).ok().map(Self::Phong),
        }
    }
}
