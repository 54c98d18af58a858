//! The rows of a comparison: pipelines with settings.

use pxpl5_measure::Showing;
use pxpl5_run::Registry;
use pxpl5_sim::parameters::SettingError;

/// Keys with their values.
type Settings = &'static [(&'static str, &'static str)];

/// A pipeline, with the settings that differ from the shared settings of the comparison.
#[derive(Clone, Copy, Debug)]
pub(super) struct ComparedPipeline {
    pub(super) name: &'static str,
    pub(super) pipeline: &'static str,
    pub(super) settings: Settings,
    pub(super) showing: Showing,
}

/// Settings with which Slats sends each clump only to the regions that the clump touches. The published rule, every
/// clump to all regions, limits the scene to about 100 triangles. So few triangles cannot show the effect of a raster
/// offset.
const TOUCHED: Settings = &[("binning", "touched")];

/// Settings of [`TOUCHED`] with a raster offset: the display shifts each picture during the scan by the error of the
/// predicted pose.
const SHIFTED: Settings = &[("binning", "touched"), ("head.raster", "vdrt")];

/// Settings of [`TOUCHED`] without prediction. Instead, the video of the real world is delayed until the picture of the
/// same instant is ready.
const DELAYED: Settings = &[("binning", "touched"), ("head.predict", "none")];

/// Name of the row with delayed video of the real world. The error of this row is measured against the delayed video,
/// so that it cannot be ranked with the errors of other rows.
pub(super) const DELAYED_VIDEO: &str = "delayed-video";

/// Name of the row with ideal pictures. The row has no pipeline, so that it cannot be ranked with other rows.
pub(super) const IDEAL: &str = "ideal";

/// Rows that follow the plain row of their pipeline.
const VARIANTS: [ComparedPipeline; 4] = [
    variant_of_slats("slats-touched", TOUCHED, Showing::Plain),
    variant_of_slats("vdrt", SHIFTED, Showing::RasterOffset),
    variant_of_slats(DELAYED_VIDEO, DELAYED, Showing::DelayedVideo),
    variant_of_slats(IDEAL, TOUCHED, Showing::Ideal),
];

const fn variant_of_slats(name: &'static str, settings: Settings, showing: Showing) -> ComparedPipeline {
    ComparedPipeline { name, pipeline: "slats", settings, showing }
}

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
                rows.retain(|row| registry.pipeline(row.name).map_or(true, |entry| registry.is_usual(entry)))
            }
            Self::All => {}
            Self::Named(names) => {
                if let Some(found) = names.iter().find(|name| rows.iter().all(|row| row.name != *name)) {
                    return Err(SettingError::unknown("row", found, rows.iter().map(|row| row.name)));
                }
                rows.retain(|row| names.iter().any(|name| name == row.name));
            }
        }
        Ok(rows)
    }
}

/// Returns a row for each compared pipeline, in the order of the registry, followed by its variants.
fn compared_pipelines(registry: &Registry) -> Vec<ComparedPipeline> {
    let mut all = Vec::new();
    for name in registry.pipelines().iter().filter(|entry| entry.compared).map(|entry| entry.name) {
        all.push(ComparedPipeline { name, pipeline: name, settings: &[], showing: Showing::Plain });
        all.extend(VARIANTS.into_iter().filter(|variant| variant.pipeline == name));
    }
    all
}
