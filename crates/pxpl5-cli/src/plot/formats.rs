//! File formats of figures: SVG, and with the feature `print` also PDF and PNG.

#[cfg(feature = "print")]
mod print;

use crate::error::CliError;
use std::path::Path;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Svg,
    #[cfg(feature = "print")]
    Png,
    #[cfg(feature = "print")]
    Pdf,
}

impl Format {
    /// Returns the format for the extension of a file name. PNG and PDF need the feature `print`.
    pub(super) fn of(path: &Path) -> Result<Self, CliError> {
        let ending = path.extension().map(|end| end.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        // PNG and PDF need the feature `print`.
        match ending.as_str() {
            "svg" => Ok(Self::Svg),
            #[cfg(feature = "print")]
            "png" => Ok(Self::Png),
            #[cfg(feature = "print")]
            "pdf" => Ok(Self::Pdf),
            #[cfg(not(feature = "print"))]
            "png" | "pdf" => Err(CliError::usage(format!(
                "--out {}: this command was built to write figures as .svg only. PDF and PNG need the feature `print`: \
                 cargo build --release -p pxpl5-cli --features print",
                path.display()
            ))),
            _ => Err(CliError::usage(format!(
                "--out: expected a name that ends in .svg, .png or .pdf, found {}",
                path.display()
            ))),
        }
    }
}

pub(super) fn bytes(svg: &str, format: Format) -> Result<Vec<u8>, CliError> {
    match format {
        Format::Svg => Ok(svg.as_bytes().to_vec()),
        #[cfg(feature = "print")]
        Format::Pdf => print::pdf(svg),
        #[cfg(feature = "print")]
        Format::Png => print::png(svg),
    }
}
