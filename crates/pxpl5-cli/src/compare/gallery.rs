//! Writer of the page gallery.html, which shows the pictures of all pipelines side by side.

use crate::error::CliError;
use crate::numbers::count_of;
use crate::output::OutputFolder;
use crate::run::INCOMPLETE;
use image::RgbImage;
use pxpl5::compare::{Comparison, ComparisonRow, LastPicture};
use pxpl5::views::page::{PagePicture, PageTable, html_of_tables};
use pxpl5::views::png_bytes;

/// Writes the picture of each row, the ideal pictures, and a page that shows all these pictures.
pub(super) fn put(folder: &mut OutputFolder, comparison: &Comparison) -> Result<(), CliError> {
    let mut gallery = Gallery { folder, comparison, pictures: Vec::new(), ideals: Vec::new() };
    // The ideal picture precedes the first picture with the same shading.
    for row in &comparison.pipelines {
        if let Some(last) = &row.picture {
            gallery.ideal(row, last)?;
            gallery.seen(row, last)?;
        }
    }
    let Gallery { pictures, .. } = gallery;
    let page = PageTable {
        name: format!("{}: pictures seen by the first eye at the end of the run", comparison.scene),
        about: about(comparison),
        pictures,
        ..PageTable::default()
    };
    folder.put("gallery.html", html_of_tables(&[page]).as_bytes())
}

struct Gallery<'a> {
    folder: &'a mut OutputFolder,
    comparison: &'a Comparison,
    pictures: Vec<PagePicture>,
    /// Ideal pictures that are already on the page, because pipelines with equal shading share one ideal picture.
    ideals: Vec<&'a RgbImage>,
}

impl<'a> Gallery<'a> {
    fn ideal(&mut self, row: &ComparisonRow, last: &'a LastPicture) -> Result<(), CliError> {
        let Some(ideal) = last.should_be.as_ref().filter(|ideal| !self.ideals.contains(ideal)) else { return Ok(()) };
        self.ideals.push(ideal);
        let name = format!("picture-should-be-{}.png", self.ideals.len());
        let caption = format!("ideal picture in the middle of the last period, with the shading of {}", row.pipeline);
        self.add(&name, caption, ideal, [("picture", "ideal".to_owned())])
    }

    fn seen(&mut self, row: &ComparisonRow, last: &LastPicture) -> Result<(), CliError> {
        let mark = if last.is_complete { "" } else { INCOMPLETE };
        let name = format!("picture-{}{mark}.png", row.pipeline);
        let texts = [("pipeline", row.pipeline.clone()), ("complete", last.is_complete.to_string())];
        self.add(&name, caption(row, last), &last.seen, texts)
    }

    fn add<const N: usize>(
        &mut self,
        name: &str,
        label: String,
        picture: &RgbImage,
        texts: [(&str, String); N],
    ) -> Result<(), CliError> {
        let texts = [texts.as_slice(), &[("scene", self.comparison.scene.clone())]].concat();
        let png = png_bytes(picture, &texts).map_err(CliError::failure)?;
        self.folder.put(name, &png)?;
        self.pictures.push(PagePicture { label, png });
        Ok(())
    }
}

fn caption(row: &ComparisonRow, last: &LastPicture) -> String {
    let mut caption = row.pipeline.clone();
    if !last.is_complete {
        caption.push_str(": not complete in time");
        return caption;
    }
    if row.head_to_light_ms.mean.is_finite() {
        caption.push_str(&format!(": {:.1} ms from head to light", row.head_to_light_ms.mean));
    }
    if let Some(error) = row.by_field.last() {
        caption.push_str(&format!(", pixel error {:.2} px in the last field", error.mean_px));
    }
    caption
}

/// Returns lines of text about the run, and a line for each row without a picture.
fn about(comparison: &Comparison) -> Vec<String> {
    let Comparison { triangles, machine, fields, seeds, pipelines, .. } = comparison;
    let seed = seeds.first().copied().unwrap_or_default();
    let (triangles, fields) = (count_of(*triangles, "triangle"), count_of(*fields, "field"));
    let mut about = vec![format!("{triangles} on {machine}, {fields}, seed {seed}")];
    let failed = pipelines.iter().filter(|row| row.picture.is_none());
    about.extend(failed.filter_map(|row| Some(format!("{}: {}", row.pipeline, row.failure.as_ref()?))));
    about
}
