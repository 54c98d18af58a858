//! Pictures as bytes of a canvas: red, green, blue and 255 for each pixel, row by row.

use address_recalculation::{AddressRecalculationPipeline, CubeFace, DisplayMemory, TexelAddress};
use image::RgbImage;
use pphigs::oracle::IdealPicture;
use pxpl5_renderer::PixelArray;
use pxpl5_run::{Stepper, bit_of};
use pxpl5_wire::{Eye, REGION_SIZE, SurfaceId};
use serde_json::{Value, json};

pub(crate) fn rgba(picture: &RgbImage) -> Vec<u8> {
    let mut bytes = vec![u8::MAX; picture.len() / 3 * 4];
    for (four, three) in bytes.chunks_exact_mut(4).zip(picture.chunks_exact(3)) {
        four[..3].copy_from_slice(three);
    }
    bytes
}

const fn opaque([red, green, blue]: [u8; 3]) -> [u8; 4] {
    [red, green, blue, u8::MAX]
}

/// The difference between the seen and the ideal picture: a heat map and sums. The difference at a pixel is the largest
/// of the differences of red, green and blue.
pub(crate) struct Difference {
    pub(crate) heat: Vec<u8>,
    pixels: usize,
    differing: usize,
    /// Sum of the differences at all pixels, in units of 1/255 of full brightness.
    sum: u64,
}

impl Difference {
    /// Computes the difference between the seen and the ideal picture of a surface. Returns `None` if either picture is
    /// not available.
    pub(crate) fn of(stepper: &Stepper, surface: SurfaceId) -> Option<Self> {
        let seen = stepper.seen(surface)?;
        let ideal = stepper.ideal_picture(surface)?;
        let both = seen.pixels().zip(ideal.image().pixels());
        let mut difference = Self { heat: Vec::new(), pixels: seen.pixels().len(), differing: 0, sum: 0 };
        for (seen, ideal) in both {
            let largest = seen.0.iter().zip(ideal.0).map(|(a, b)| a.abs_diff(b)).max().unwrap_or_default();
            difference.differing += usize::from(largest > 0);
            difference.sum += u64::from(largest);
            difference.heat.extend(opaque(heat(largest)));
        }
        Some(difference)
    }

    /// Returns the percentage of pixels that differ, and the mean difference over all pixels in per cent of full
    /// brightness.
    pub(crate) fn numbers(&self) -> Value {
        let pixels = self.pixels.max(1) as f64;
        json!({
            "differing_percent": 100.0 * self.differing as f64 / pixels,
            "mean_percent": 100.0 * self.sum as f64 / (255.0 * pixels),
        })
    }
}

/// Returns the colour of a difference in the heat map: black for 0, then red, yellow and white as the difference grows.
fn heat(difference: u8) -> [u8; 3] {
    let rising = |from: u16| (u16::from(difference).saturating_sub(from) * 3).min(255) as u8;
    [rising(0), rising(85), rising(170)]
}

/// Returns the 128 x 128 pixels of a renderer, after all commands that have started. A pixel is green if it is enabled
/// after the last of these commands. Other pixels have the colours in their memory. The result is empty before the
/// renderer's first command.
pub(crate) fn renderer(stepper: &Stepper, number: usize) -> Vec<u8> {
    let Some(array) = stepper.array(number) else { return Vec::new() };
    let colours = array.read_colour(REGION_SIZE, REGION_SIZE);
    let enabled = array.enable();
    let pixels = (0..REGION_SIZE * REGION_SIZE).zip(colours.iter());
    pixels
        .flat_map(|(at, word)| {
            let [_, red, green, blue] = word.to_be_bytes();
            let is_on = bit_of(&enabled, at % REGION_SIZE, at / REGION_SIZE);
            opaque(if is_on { ENABLED } else { [red, green, blue] })
        })
        .collect()
}

const ENABLED: [u8; 3] = [79, 209, 165];

/// Number of pixels on each side of a cube face in the picture of all six faces.
pub(crate) const FACE_SIDE: u32 = 128;

/// Returns the number of display memories for each eye. The number is 0 for a display without address recalculation.
pub(crate) fn memories(stepper: &Stepper) -> usize {
    let display = stepper.record().display_of_kind::<AddressRecalculationPipeline>();
    display.map_or(0, |display| display.memories(Eye::Left).len())
}

/// Returns the six cube faces that a display memory shows to an eye now, arranged as a cross. Each side of a face has
/// [`FACE_SIDE`] pixels. Without a memory's index, all memories are combined: each texel is the nearest texel of all
/// memories. Returns `None` for a memory that does not exist.
pub(crate) fn faces(stepper: &Stepper, eye: usize, memory: Option<usize>) -> Option<Vec<u8>> {
    let display = stepper.record().display_of_kind::<AddressRecalculationPipeline>()?;
    let all = display.memories(*Eye::BOTH.get(eye)?);
    let some = match memory {
        Some(number) => std::slice::from_ref(all.get(number)?),
        None => all,
    };
    let some: Vec<_> = some.iter().map(DisplayMemory::shown_faces).collect();
    let mut cross = RgbImage::from_pixel(4 * FACE_SIDE, 3 * FACE_SIDE, image::Rgb([40, 44, 48]));
    for (face, (column, row)) in CubeFace::ALL.into_iter().zip(CubeFace::CROSS) {
        // Sample each face at the resolution of the picture.
        for (x, y) in (0..FACE_SIDE * FACE_SIDE).map(|at| (at % FACE_SIDE, at / FACE_SIDE)) {
            let texels = some.iter().filter_map(|faces| {
                let step = faces.texels() / FACE_SIDE;
                faces.texel(TexelAddress { face, column: x * step, row: y * step })
            });
            let colour = texels.min_by_key(|(_, depth)| *depth).map_or(0, |(colour, _)| colour);
            let [_, red, green, blue] = colour.to_be_bytes();
            cross.put_pixel(column * FACE_SIDE + x, row * FACE_SIDE + y, image::Rgb([red, green, blue]));
        }
    }
    Some(rgba(&cross))
}

/// Colour of outlines (amber). No built-in scene uses this colour.
const OUTLINE: [u8; 3] = [255, 196, 61];

/// Threshold of the second difference of depth over a pixel and two neighbours. A pixel with a greater difference is an
/// edge. The unit is the lowest of 24 depth bits. Within a flat triangle, depth is linear on the screen, so that the
/// second difference comes only from rounding.
const BEND: i64 = 24;

/// Returns the edges in an ideal picture as bytes: red, green, blue and opacity of each pixel. A pixel is opaque where
/// the depth on the screen is not linear: at edges between triangles and at the rim of objects. All other pixels are
/// transparent.
pub(crate) fn outlines(picture: &IdealPicture) -> Vec<u8> {
    let [width, height] = [picture.image().width() as usize, picture.image().height() as usize];
    let depths = picture.depths();
    let mut bytes = vec![0; 4 * width * height];
    // Pixels at the border lack a neighbour on one side.
    for y in 1..height.saturating_sub(1) {
        for x in 1..width.saturating_sub(1) {
            let at = y * width + x;
            // The second difference is zero where depth is linear, as within a triangle.
            let bends = |step: usize| {
                let [before, here, after] = [at - step, at, at + step].map(|at| i64::from(depths[at]));
                (before + after - 2 * here).abs() > BEND
            };
            if bends(1) || bends(width) {
                bytes[4 * at..4 * at + 4].copy_from_slice(&opaque(OUTLINE));
            }
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_heat_scale_goes_from_black_over_red_and_yellow_to_white() {
        assert_eq!(heat(0), [0, 0, 0]);
        assert_eq!(heat(85), [255, 0, 0]);
        assert_eq!(heat(170), [255, 255, 0]);
        assert_eq!(heat(255), [255, 255, 255]);
    }

    fn session(settings: &str, to_ps: u64) -> crate::session::Session {
        let mut session = crate::session::Session::new(settings, &crate::files::Files::default()).expect("known");
        session.run_to(to_ps);
        session
    }

    /// Tests the outlines, which are drawn where the depth changes suddenly. The depth of a plane is linear on the
    /// screen, so a plane has none.
    #[test]
    fn a_plane_that_covers_the_screen_has_no_outlines_and_an_aircraft_has_outlines() {
        let opaque =
            |session: &crate::session::Session| session.outlines(0).chunks(4).filter(|rgba| rgba[3] > 0).count();
        let plane = session("pipeline=slats\nscene=full-screen:1\nfields=9", 1);
        assert_eq!(plane.outlines(0).len(), 4 * 640 * 480);
        assert_eq!(opaque(&plane), 0);
        let aircraft = session("pipeline=slats\nscene=aircraft\nfields=9", 1);
        assert!((100..20_000).contains(&opaque(&aircraft)), "{}", opaque(&aircraft));
        assert!(aircraft.outlines(9).is_empty());
    }

    #[test]
    fn joined_faces_are_lit_where_any_memory_is_lit() {
        let session = session("pipeline=arp-priority\ndisplay=arp\nscene=aircraft\nfields=60", 500_000_000_000);
        let joined = faces(&session.stepper, 0, None).expect("a display with faces");
        let is_lit = |rgba: &[u8]| rgba[..3] != [0, 0, 0];
        for memory in 0..memories(&session.stepper) {
            let one = faces(&session.stepper, 0, Some(memory)).expect("a memory");
            let lost =
                one.chunks(4).zip(joined.chunks(4)).filter(|(one, joined)| is_lit(one) && !is_lit(joined)).count();
            assert_eq!(lost, 0, "memory {memory}");
        }
        assert!(faces(&session.stepper, 0, Some(99)).is_none());
    }
}
