//! How triangles become words.

use crate::picture::{Picture, Shading};
use pxpl5_renderer::{PhongTriangleEncoder, TriangleEncoder};

/// Makes the words of a picture's triangles.
#[derive(Debug)]
pub(crate) enum Encoder {
    Gouraud(TriangleEncoder),
    Phong(PhongTriangleEncoder),
}

impl Encoder {
    /// `None` where the layout cannot hold what they need, which is refused when the machine is configured.
    pub(crate) fn for_picture(picture: &Picture) -> Option<Self> {
        match picture.shading {
            Shading::Gouraud | Shading::Precomputed => Some(Self::Gouraud(TriangleEncoder::new(&picture.layout))),
            Shading::Phong => PhongTriangleEncoder::new(&picture.layout).ok().map(Self::Phong),
        }
    }
}
