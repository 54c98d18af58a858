//! Writer of animated PNG files.

use crate::picture::{PictureError, encoder};
use image::RgbImage;
use std::io::Write;

/// An animated PNG file that is being written.
pub struct Animation<W: Write> {
    writer: png::Writer<W>,
}

impl<W: Write> Animation<W> {
    /// Starts a file with `pictures` pictures of the same size. The animation repeats.
    ///
    /// Each picture is shown for `delay` (numerator and denominator, in seconds). `texts` become text chunks of the
    /// file, as in [`png_bytes`](crate::png_bytes).
    ///
    /// # Errors
    ///
    /// Returns [`PictureError`] if the encoder refuses the values, for example an animation without pictures.
    pub fn begin(
        out: W,
        size: (u32, u32),
        pictures: u32,
        delay: (u16, u16),
        texts: &[(&str, String)],
    ) -> Result<Self, PictureError> {
        let mut encoder = encoder(out, size, texts)?;
        encoder.set_animated(pictures, 0)?;
        encoder.set_frame_delay(delay.0, delay.1)?;
        Ok(Self { writer: encoder.write_header()? })
    }

    /// Adds the next picture.
    ///
    /// # Errors
    ///
    /// Returns [`PictureError`] if the picture's size differs from the animation's size, or if the animation already
    /// has all announced pictures.
    pub fn add(&mut self, picture: &RgbImage) -> Result<(), PictureError> {
        Ok(self.writer.write_image_data(picture.as_raw())?)
    }

    /// Ends the file after the last picture.
    ///
    /// # Errors
    ///
    /// Returns [`PictureError`] if pictures are missing.
    pub fn finish(self) -> Result<(), PictureError> {
        Ok(self.writer.finish()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;
    use std::io::Cursor;

    #[test]
    fn every_picture_of_an_animation_is_read_back_in_order() {
        let mut bytes = Vec::new();
        let mut animation = Animation::begin(&mut bytes, (2, 1), 3, (1, 25), &[]).expect("valid");
        for level in [10, 20, 30] {
            animation.add(&RgbImage::from_pixel(2, 1, Rgb([level; 3]))).expect("of its size");
        }
        animation.finish().expect("whole");
        let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().expect("PNG");
        assert_eq!(reader.info().animation_control().map(|control| control.num_frames), Some(3));
        for level in [10, 20, 30] {
            let mut pixels = vec![0; 6];
            reader.next_frame(&mut pixels).expect("a picture");
            assert_eq!(pixels, [level; 6]);
        }
    }

    #[test]
    fn an_animation_without_pictures_is_refused() {
        assert!(Animation::begin(Vec::new(), (2, 1), 0, (1, 25), &[]).is_err());
    }
}
