//! The formats of figures: SVG as it is drawn, PDF and PNG made of it, with a typeface that is in the command.

use crate::error::CliError;
use std::path::Path;
use svg2pdf::usvg::{Options, Transform, Tree};
use svg2pdf::{ConversionOptions, PageOptions};

/// What a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Svg,
    Png,
    Pdf,
}

/// Dots an inch of a PNG; of an SVG's own unit, the pixel of style sheets.
const PNG_DOTS: f32 = 300.0;
const SVG_DOTS: f32 = 96.0;

impl Format {
    /// By the end of a file's name.
    ///
    /// # Errors
    ///
    /// For any other end.
    pub(super) fn of(path: &Path) -> Result<Self, CliError> {
        let end = path.extension().map(|end| end.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        match end.as_str() {
            "svg" => Ok(Self::Svg),
            "png" => Ok(Self::Png),
            "pdf" => Ok(Self::Pdf),
            _ => Err(CliError::usage(format!(
                "--out: expected a name that ends in .svg, .png or .pdf, found {}",
                path.display()
            ))),
        }
    }
}

/// The bytes of a figure.
///
/// # Errors
///
/// When the drawing cannot be converted.
pub(super) fn bytes(svg: &str, format: Format) -> Result<Vec<u8>, CliError> {
    match format {
        Format::Svg => Ok(svg.as_bytes().to_vec()),
        Format::Pdf => {
            let page = PageOptions { dpi: SVG_DOTS };
            svg2pdf::to_pdf(&tree(svg)?, ConversionOptions::default(), page).map_err(CliError::failure)
        }
        Format::Png => png(&tree(svg)?),
    }
}

fn tree(svg: &str) -> Result<Tree, CliError> {
    let mut options = Options { font_family: "DejaVu Sans".to_owned(), ..Options::default() };
    let fonts = options.fontdb_mut();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    Tree::from_str(svg, &options).map_err(CliError::failure)
}

fn png(tree: &Tree) -> Result<Vec<u8>, CliError> {
    let scale = PNG_DOTS / SVG_DOTS;
    let [width, height] = [tree.size().width(), tree.size().height()].map(|length| (length * scale).round() as u32);
    let blank = resvg::tiny_skia::Pixmap::new(width, height);
    let mut picture = blank.ok_or_else(|| CliError::failure(format!("no picture of {width} x {height} pixels")))?;
    resvg::render(tree, Transform::from_scale(scale, scale), &mut picture.as_mut());
    picture.encode_png().map_err(CliError::failure)
}
