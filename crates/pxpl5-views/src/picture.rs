//! The encoder of all PNG pictures.

use image::RgbImage;
use pxpl5_machine::RunError;
use pxpl5_run::ExperimentError;
use pxpl5_sim::parameters::SettingError;
use std::io::Write;
use thiserror::Error;

/// Error of a picture or a film.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PictureError {
    /// The experiment cannot be run.
    #[error(transparent)]
    Experiment(#[from] ExperimentError),
    /// The machine failed before the last frame of the film.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The number of periods is out of range, or the display has no surface with the chosen number.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// The PNG encoder refuses the picture, for example a picture without pixels, or a text with a key that PNG does
    /// not allow.
    #[error("a picture cannot be encoded: {0}")]
    Png(#[from] png::EncodingError),
}

/// Encodes a picture as PNG with texts, such as the texts of [`origin`](crate::results::origin). Each text becomes an
/// iTXt chunk with the keyword `pxpl5 KEY`, which metadata viewers can read.
///
/// # Errors
///
/// Returns [`PictureError`] if the encoder refuses the picture or a text.
pub fn png_bytes(picture: &RgbImage, texts: &[(&str, String)]) -> Result<Vec<u8>, PictureError> {
    let mut bytes = Vec::new();
    let mut writer = encoder(&mut bytes, picture.dimensions(), texts)?.write_header()?;
    writer.write_image_data(picture.as_raw())?;
    writer.finish()?;
    Ok(bytes)
}

/// Returns an encoder for pictures with eight bits per colour component. The encoder also writes `texts` into the file.
pub(crate) fn encoder<W: Write>(
    out: W,
    (width, height): (u32, u32),
    texts: &[(&str, String)],
) -> Result<png::Encoder<'static, W>, png::EncodingError> {
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    for (key, value) in texts {
        encoder.add_itxt_chunk(format!("pxpl5 {key}"), value.clone())?;
    }
    Ok(encoder)
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;
    use std::io::Cursor;

    #[test]
    fn the_pixels_and_texts_of_a_written_png_file_are_read_back() {
        let picture = RgbImage::from_fn(3, 2, |x, y| Rgb([x as u8, y as u8, 7]));
        let bytes = png_bytes(&picture, &[("scene", "M\u{fc}nster".to_owned())]).expect("it has pixels");
        let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().expect("PNG");
        let mut pixels = vec![0; reader.output_buffer_size()];
        reader.next_frame(&mut pixels).expect("a picture");
        assert_eq!(&pixels, picture.as_raw());
        let text = &reader.info().utf8_text[0];
        assert_eq!(text.keyword, "pxpl5 scene");
        assert_eq!(text.get_text().expect("UTF-8"), "M\u{fc}nster");
    }

    #[test]
    fn a_picture_without_pixels_is_refused() {
        let error = png_bytes(&RgbImage::new(0, 0), &[]).expect_err("no pixels");
        assert!(error.to_string().starts_with("a picture cannot be encoded: "), "{error}");
    }
}
