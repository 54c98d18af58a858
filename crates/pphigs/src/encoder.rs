use crate::picture::{Picture, Shading};
use pxpl5_renderer::{PhongTriangleEncoder, TriangleEncoder};

#[derive(Debug)]
pub(crate) enum Encoder {
    Gouraud(TriangleEncoder),
    Phong(PhongTriangleEncoder),
}

impl Encoder {
    /// Creates the encoder of a picture. Returns `None` if the layout of pixel memory lacks a bit field of the
    /// commands. The machine's configuration refuses such a layout.
    pub(crate) fn for_picture(picture: &Picture) -> Option<Self> {
        match picture.shading {
            Shading::Gouraud | Shading::Precomputed => Some(Self::Gouraud(TriangleEncoder::new(&picture.layout))),
            Shading::Phong => PhongTriangleEncoder::new(&picture.layout).ok().map(Self::Phong),
        }
    }
}
