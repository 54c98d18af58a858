//! The pictures of all pipelines beside each other.

use crate::error::CliError;
use crate::output::OutputFolder;
use crate::run::INCOMPLETE;
use pxpl5::compare::{Comparison, GalleryPicture};
use pxpl5::views::page::{PagePicture, PageTable, html_of_tables};
use pxpl5::views::png_bytes;

/// Writes a picture for each row, the one that should be there, and a page of all of them.
///
/// # Errors
///
/// When a file cannot be written.
pub(super) fn put(
    folder: &mut OutputFolder,
    comparison: &Comparison,
    gallery: &[GalleryPicture],
) -> Result<(), CliError> {
    let mut pictures = Vec::new();
    if let Some(should_be) = gallery.iter().find_map(|one| one.should_be.as_ref()) {
        let texts = [("scene", comparison.scene.clone())];
        let png = png_bytes(should_be, &texts).map_err(CliError::failure)?;
        folder.put("picture-should-be.png", &png)?;
        pictures.push(PagePicture { label: "as it should be in the middle of the last field".to_owned(), png });
    }
    for one in gallery {
        let Ok(seen) = &one.seen else { continue };
        let texts = [
            ("pipeline", one.pipeline.clone()),
            ("scene", comparison.scene.clone()),
            ("complete", one.is_complete.to_string()),
        ];
        let png = png_bytes(seen, &texts).map_err(CliError::failure)?;
        let mark = if one.is_complete { "" } else { INCOMPLETE };
        folder.put(&format!("picture-{}{mark}.png", one.pipeline), &png)?;
        pictures.push(PagePicture { label: caption(comparison, one), png });
    }
    let page = PageTable {
        name: format!("{}: what the first eye sees at the end", comparison.scene),
        about: about(comparison, gallery),
        pictures,
        ..PageTable::default()
    };
    folder.put("gallery.html", html_of_tables(&[page]).as_bytes())
}

/// Whose picture it is, how old, and how wrong.
fn caption(comparison: &Comparison, one: &GalleryPicture) -> String {
    let mut caption = one.pipeline.clone();
    if !one.is_complete {
        caption.push_str(": not complete, it was not there in time");
        return caption;
    }
    let to_light_ms = comparison.row(&one.pipeline).map_or(f64::NAN, |row| row.head_to_light_ms.mean);
    if to_light_ms.is_finite() {
        caption.push_str(&format!(": {to_light_ms:.1} ms from head to light"));
    }
    if let Some(error) = &one.last_error {
        caption.push_str(&format!(", {:.2} px beside its place", error.mean_px));
    }
    caption
}

/// The run, and the rows without a picture.
fn about(comparison: &Comparison, gallery: &[GalleryPicture]) -> Vec<String> {
    let seed = comparison.seeds.first().copied().unwrap_or_default();
    let triangles = comparison.triangles;
    let run = format!("{triangles} triangles on {}, {} fields, seed {seed}", comparison.machine, comparison.fields);
    let without = gallery.iter().filter_map(|one| Some(format!("{}: {}", one.pipeline, one.seen.as_ref().err()?)));
    std::iter::once(run).chain(without).collect()
}
