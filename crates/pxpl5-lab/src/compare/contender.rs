//! What is compared: pipelines with settings, and how their pictures come before the eyes.

use pxpl5_measure::Showing;
use pxpl5_run::Registry;

/// One row: settings on top of those that all share.
#[derive(Clone, Debug)]
pub(super) struct Contender {
    pub(super) name: String,
    pub(super) pipeline: &'static str,
    pub(super) settings: &'static [(&'static str, &'static str)],
    pub(super) showing: Showing,
}

/// As published every clump of Slats goes to all regions, which limits the scene to little more than 100 triangles; clumps that go
/// where they are seen leave the raster offset a picture to work on.
const TOUCHED: &[(&str, &str)] = &[("binning", "touched")];

/// The same before eyes whose raster is shifted.
const SHIFTED: &[(&str, &str)] = &[("binning", "touched"), ("head.raster", "vdrt")];

impl Contender {
    fn plain(pipeline: &'static str) -> Self {
        Self { name: pipeline.to_owned(), pipeline, settings: &[], showing: Showing::Plain }
    }

    fn of_slats(name: &str, showing: Showing) -> Self {
        let settings = if showing == Showing::RasterOffset { SHIFTED } else { TOUCHED };
        Self { name: name.to_owned(), pipeline: "slats", settings, showing }
    }
}

/// Every pipeline of the registry that is compared, in its order, and the raster offset and the reference behind Slats.
pub(super) fn contenders(registry: &Registry) -> Vec<Contender> {
    let mut all = Vec::new();
    for entry in registry.pipelines().iter().filter(|entry| entry.compared) {
        all.push(Contender::plain(entry.name));
        if entry.name == "slats" {
            all.push(Contender::of_slats("slats-touched", Showing::Plain));
            all.push(Contender::of_slats("vdrt", Showing::RasterOffset));
            all.push(Contender::of_slats("ideal", Showing::Ideal));
        }
    }
    all
}
