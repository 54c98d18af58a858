//! Converters of a figure to PDF and PNG with a built-in typeface.

use crate::error::CliError;
use svg2pdf::usvg::{Options, Transform, Tree};
use svg2pdf::{ConversionOptions, PageOptions};

const PNG_DOTS: f32 = 300.0;

/// Resolution of an SVG drawing. The unit of length is the CSS pixel, and an inch has 96 CSS pixels.
const SVG_DOTS: f32 = 96.0;

pub(super) fn pdf(svg: &str) -> Result<Vec<u8>, CliError> {
    let page = PageOptions { dpi: SVG_DOTS };
    svg2pdf::to_pdf(&tree(svg)?, ConversionOptions::default(), page).map_err(CliError::failure)
}

pub(super) fn png(svg: &str) -> Result<Vec<u8>, CliError> {
    let tree = tree(svg)?;
    let scale = PNG_DOTS / SVG_DOTS;
    let [width, height] = [tree.size().width(), tree.size().height()].map(|length| (length * scale).round() as u32);
    let blank = resvg::tiny_skia::Pixmap::new(width, height);
    let mut picture = blank.ok_or_else(|| CliError::failure(format!("no picture of {width} x {height} pixels")))?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut picture.as_mut());
    picture.encode_png().map_err(CliError::failure)
}

fn tree(svg: &str) -> Result<Tree, CliError> {
    let mut options = Options { font_family: "DejaVu Sans".to_owned(), ..Options::default() };
    let fonts = options.fontdb_mut();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    Tree::from_str(svg, &options).map_err(CliError::failure)
}
