//! Tests of the numbered cases 23 and 24: the words that the projector receives.

use crate::support;
use spatialgl::{
    Combine, CommandBuffer, OneThread, SliceImage, SliceRenderer, SliceStats, SliceView, SliceWork, Tiling,
    VolumeConfig, render_volume,
};

/// A renderer that gives each pixel a colour determined by its position.
struct Painted(fn(u32) -> [u8; 3]);

impl SliceRenderer for Painted {
    fn render(&self, _: SliceWork<'_>, _: &SliceView, image: &mut SliceImage) -> SliceStats {
        let [width, height] = image.size();
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            image.draw_pixel(x, y, (self.0)(x), Combine::Last);
        }
        SliceStats::default()
    }
}

/// Draws a slice of 32 x 8 pixels with tiles and without, and returns bytes 0 to 3 of one of its words.
fn bytes(colours: fn(u32) -> [u8; 3], row: usize, word: usize) -> [u8; 4] {
    let display = support::Screen::new([32, 8]);
    let words = [Tiling::PAPER, Tiling::OFF].map(|tiling| {
        let config = VolumeConfig { tiling, ..VolumeConfig::paper() };
        let frame = render_volume(&display, &CommandBuffer::default(), &config, &Painted(colours), &OneThread);
        frame.expect("valid").planes.slice(0)[row * 4 + word]
    });
    assert_eq!(words[0], words[1]);
    words[0].to_le_bytes()
}

#[test]
fn case_23_eight_equal_pixels_are_packed_into_the_computed_bytes() {
    assert_eq!(bytes(|_| [128, 64, 255], 0, 1), [0xAA, 0xAA, 0xFF, 0x00]);
    assert_eq!(bytes(|_| [128, 64, 255], 1, 1), [0x55, 0x00, 0xFF, 0x00]);
}

#[test]
fn case_24_a_ramp_is_packed_into_the_computed_bytes() {
    let ramp = |x: u32| {
        let i = (x % 8) as u8;
        [36 * i, 255 - 36 * i, 255 * (i % 2)]
    };
    for (row, expected) in [(0, [0x2F, 0xE8, 0x55]), (1, [0x15, 0xD4, 0x55]), (5, [0x05, 0xD4, 0x55])] {
        let [red, green, blue, rest] = bytes(ramp, row, 2);
        assert_eq!(([red, green, blue], rest), (expected, 0), "row {row}");
    }
}
