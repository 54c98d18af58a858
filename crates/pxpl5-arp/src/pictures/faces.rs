//! Picture of the six faces as an unfolded cube.

use crate::walk_faces::rgb;
use address_recalculation::{CubeFace, FaceSet, TexelAddress};
use image::RgbImage;

/// Returns the six faces unfolded into a cross, in a grid of 4 by 3 faces. Empty texels have the colour `empty`.
pub fn cross(faces: &FaceSet, empty: u32) -> RgbImage {
    let size = faces.texels();
    let mut picture = RgbImage::from_pixel(4 * size, 3 * size, rgb(0));
    for (face, (across, down)) in CubeFace::ALL.into_iter().zip(CubeFace::CROSS) {
        for row in 0..size {
            for column in 0..size {
                let colour = faces.texel(TexelAddress { face, column, row }).map_or(empty, |texel| texel.0);
                picture.put_pixel(across * size + column, down * size + row, rgb(colour));
            }
        }
    }
    picture
}
