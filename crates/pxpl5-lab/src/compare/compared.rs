//! The rows of a comparison: pipelines with settings.

use pxpl5_measure::Showing;
use pxpl5_run::Registry;
use pxpl5_sim::parameters::SettingError;

/// A pipeline, with the settings that differ from the shared settings of the comparison.
#[derive(Clone, Debug)]
pub(super) struct ComparedPipeline {
    pub(super) name: String,
    pub(super) pipeline: &'static str,
    pub(super) settings: &'static [(&'static str, &'static str)],
    pub(super) showing: Showing,
}

/// Settings with which Slats sends each clump only to the regions that the clump touches. The published rule, every
/// clump to all regions, limits the scene to about 100 triangles. So few triangles cannot show the effect of a raster
/// offset.
const TOUCHED: &[(&str, &str)] = &[("binning", "touched")];

/// Settings of [`TOUCHED`] with a raster offset: the display shifts each picture during the scan by the error of the
/// predicted pose.
const SHIFTED: &[(&str, &str)] = &[("binning", "touched"), ("head.raster", "vdrt")];

/// Settings of [`TOUCHED`] without prediction. Instead, the video of the real world is delayed until the picture of the
/// same instant is ready.
const DELAYED: &[(&str, &str)] = &[("binning", "touched"), ("head.predict", "none")];

impl ComparedPipeline {
    fn plain(pipeline: &'static str) -> Self {
        Self { name: pipeline.to_owned(), pipeline, settings: &[], showing: Showing::Plain }
    }

    fn of_slats(name: &str, showing: Showing) -> Self {
        let settings = match showing {
            Showing::RasterOffset => SHIFTED,
            Showing::DelayedVideo => DELAYED,
            _ => TOUCHED,
        };
        Self { name: name.to_owned(), pipeline: "slats", settings, showing }
    }
}

/// Name of the row with delayed video of the real world. The error of this row is measured against the delayed video,
/// so that it cannot be ranked with the errors of other rows.
pub(super) const DELAYED_VIDEO: &str = "delayed-video";

/// Name of the row with ideal pictures. The row has no pipeline, so that it cannot be ranked with other rows.
pub(super) const IDEAL: &str = "ideal";

/// Choice of the rows of a comparison. A row is a pipeline with settings.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum RowChoice {
    /// One or two rows for each family of pipelines ([`Registry::is_usual`]), and all rows with variants of a pipeline.
    #[default]
    Usual,
    /// All rows.
    All,
    /// The rows with these names.
    Named(Vec<String>),
}

/// Chooses the rows with these names. An empty list chooses the usual rows.
impl From<Vec<String>> for RowChoice {
    fn from(names: Vec<String>) -> Self {
        if names.is_empty() { Self::Usual } else { Self::Named(names) }
    }
}

impl RowChoice {
    /// Returns the chosen rows in the order of the registry. Fails for a name that no row has.
    pub(super) fn of(&self, registry: &Registry) -> Result<Vec<ComparedPipeline>, SettingError> {
        let mut rows = compared_pipelines(registry);
        match self {
            Self::Usual => {
                rows.retain(|row| registry.pipeline(&row.name).map_or(true, |entry| registry.is_usual(entry)))
            }
            Self::All => {}
            Self::Named(names) => {
                if let Some(found) = names.iter().find(|name| rows.iter().all(|row| row.name != **name)) {
                    return Err(SettingError::unknown("row", found, rows.iter().map(|row| &row.name)));
                }
                rows.retain(|row| names.contains(&row.name));
            }
        }
        Ok(rows)
    }
}

/// Returns a row for each compared pipeline, in the order of the registry. The variants of Slats (touched regions,
/// raster offset, delayed video, ideal pictures) follow Slats.
fn compared_pipelines(registry: &Registry) -> Vec<ComparedPipeline> {
    let mut all = Vec::new();
    for entry in registry.pipelines().iter().filter(|entry| entry.compared) {
        all.push(ComparedPipeline::plain(entry.name));
        if entry.name == "slats" {
            all.push(ComparedPipeline::of_slats("slats-touched", Showing::Plain));
            all.push(ComparedPipeline::of_slats("vdrt", Showing::RasterOffset));
            all.push(ComparedPipeline::of_slats(DELAYED_VIDEO, Showing::DelayedVideo));
            all.push(ComparedPipeline::of_slats(IDEAL, Showing::Ideal));
        }
    }
    all
}
