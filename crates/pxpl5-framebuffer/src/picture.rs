//! Pixels in memory and in files.

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, RgbImage};
use pxpl5_wire::{FieldParity, Word};
use std::fmt;
use std::io::{self, Write};

/// Words 0x00RRGGBB, row by row.
pub(crate) struct Canvas {
    width: u32,
    words: Vec<Word>,
}

impl Canvas {
    pub(crate) fn new(width: u32, height: u32) -> Self {
        let words = vec![0; (width * height) as usize];
        Self { width, words }
    }

    /// Puts a row of pixels whose first stands at [x, y]; it must lie in the canvas.
    pub(crate) fn put(&mut self, at: [u32; 2], pixels: &[Word]) {
        let begin = self.index(at);
        self.words[begin..begin + pixels.len()].copy_from_slice(pixels);
    }

    /// As `put`, only those pixels whose number is chosen.
    pub(crate) fn put_some(&mut self, at: [u32; 2], pixels: &[Word], chosen: impl Fn(u32) -> bool) {
        let begin = self.index(at);
        for (i, pixel) in (0..).zip(pixels) {
            if chosen(i) {
                self.words[begin + i as usize] = *pixel;
            }
        }
    }

    pub(crate) fn clear_lines(&mut self, parity: FieldParity) {
        let lines = self.words.chunks_exact_mut(self.width as usize);
        for line in lines.skip(parity.first_line() as usize).step_by(2) {
            line.fill(0);
        }
    }

    pub(crate) fn into_image(self) -> RgbImage {
        let height = self.words.len() as u32 / self.width;
        let bytes = self.words.iter().flat_map(|word| {
            let [_, red, green, blue] = word.to_be_bytes();
            [red, green, blue]
        });
        let bytes = bytes.collect();
        RgbImage::from_raw(self.width, height, bytes).unwrap_or_default()
    }

    const fn index(&self, [x, y]: [u32; 2]) -> usize {
        (y * self.width + x) as usize
    }
}

/// Why a picture could not be written.
#[derive(Debug)]
#[non_exhaustive]
pub enum PictureError {
    /// The writer failed.
    Io(io::Error),
    /// The encoder refused the picture.
    Encode(image::ImageError),
}

impl fmt::Display for PictureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => write!(f, "cannot write the picture: {error}"),
            Self::Encode(error) => write!(f, "cannot encode the picture: {error}"),
        }
    }
}

impl std::error::Error for PictureError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io(error) => Some(error),
            Self::Encode(error) => Some(error),
        }
    }
}

/// Writes a picture as PNG.
///
/// # Errors
///
/// [`PictureError::Io`] when the writer fails, [`PictureError::Encode`] when the picture has no pixels.
pub fn write_png(picture: &RgbImage, mut out: impl Write) -> Result<(), PictureError> {
    let (width, height) = picture.dimensions();
    PngEncoder::new(&mut out).write_image(picture.as_raw(), width, height, ExtendedColorType::Rgb8).map_err(
        |error| match error {
            image::ImageError::IoError(error) => PictureError::Io(error),
            error => PictureError::Encode(error),
        },
    )?;
    out.flush().map_err(PictureError::Io)
}
