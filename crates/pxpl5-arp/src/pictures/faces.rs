//! Picture of the six faces as an unfolded cube.

use crate::walk_faces::rgb;
use address_recalculation::{CubeFace, FaceSet, TexelAddress};
use image::RgbImage;

/// Column and row of each face in the unfolded cube, in the order of [`CubeFace::ALL`]. Neighbouring faces adjoin.
const CROSS: [(u32, u32); 6] = [(2, 1), (0, 1), (1, 0), (1, 2), (3, 1), (1, 1)];

/// Returns the six faces unfolded into a cross, in a grid of 4 by 3 faces. Empty texels have the colour `empty`.
pub fn cross(faces: &FaceSet, empty: u32) -> RgbImage {
    let size = faces.texels();
    let mut picture = RgbImage::from_pixel(4 * size, 3 * size, rgb(0));
    for (face, (across, down)) in CubeFace::ALL.into_iter().zip(CROSS) {
        for row in 0..size {
            for column in 0..size {
                let colour = faces.texel(TexelAddress { face, column, row }).map_or(empty, |texel| texel.0);
                picture.put_pixel(across * size + column, down * size + row, rgb(colour));
            }
        }
    }
    picture
}
