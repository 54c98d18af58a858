//! The comparison itself: one row for each pipeline.

use super::possible::triangles_possible;
use crate::{Workstation, parallel};
use pphigs::Binning;
use pxpl5_machine::MachineConfig;
use pxpl5_measure::{Budget, Measured, Percentiles, PixelErrors, UNJUDGED_FIELDS};
use pxpl5_run::{
    Aim, DuePictures, Experiment, ExperimentError, FIELDS_WITH_HEAD, Head, Outcome, Pipeline, PipelineEntry,
    PipelineSettings, Pixels, Registry, Slats,
};
use pxpl5_scene::Scene;
use serde::Serialize;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// What came of one pipeline on the shared machine, scene and head.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Row {
    /// Name of the row: the pipeline, or a variant of it.
    pub pipeline: String,
    /// Frame buffers that it draws into.
    pub eyes: usize,
    /// What its latency is of.
    pub latency_definition: String,
    /// Mean latency of the machine alone, milliseconds; nothing where no complete picture was shown.
    pub latency_ms: Option<f64>,
    /// Complete pictures that it is the mean of.
    pub pictures: usize,
    /// From the head's pose to light.
    pub end_to_end: Budget,
    /// Whole new pictures a second; nothing where none was shown.
    pub updates_hz: Option<f64>,
    /// The pictures that were due, and what became of them; nothing where none ever is.
    pub due: Option<DuePictures>,
    /// Pictures that were due and not shown.
    pub missed_retraces: Option<u64>,
    /// Regions that came after their deadline.
    pub late_regions: usize,
    /// Registration over a grid of pixels and all fields.
    pub error: PixelErrors,
    /// Most full-screen triangles; `None` where it was not asked for or means nothing.
    pub triangles_possible: Option<u32>,
    /// What that number means.
    pub triangles_definition: String,
    /// Why there are no numbers, if so.
    pub failure: Option<String>,
    /// Time that the run took on this host, seconds.
    pub host_seconds: f64,
}

/// A row for each pipeline, and what they share.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Name and version of this record's layout.
    pub schema: &'static str,
    /// Preset of the machine.
    pub machine: String,
    /// Graphics processors and renderers.
    pub boards: [usize; 2],
    /// Name of the scene that all draw.
    pub scene: String,
    /// Triangles of the scene that all draw.
    pub triangles: usize,
    /// Name of the tracker that all have.
    pub tracker: String,
    /// Name of the predictor that all have.
    pub predictor: String,
    /// The instant of what is shown from it that a view is predicted for.
    pub aim: Aim,
    /// Periods of the display that each was simulated for: NTSC fields.
    pub fields: u64,
    /// A row for each.
    pub pipelines: Vec<Row>,
}

/// A row of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// The picture as it is.
    Plain,
    /// The raster is shifted as it is scanned.
    RasterOffset,
    /// The reference, evaluated at the times of the run.
    Ideal,
}

/// A run and the rows that it gives.
struct Contender {
    pipeline: Arc<dyn Pipeline>,
    rows: Vec<(String, Kind)>,
}

impl Contender {
    fn plain(entry: &PipelineEntry) -> Self {
        let rows = vec![(entry.name.to_owned(), Kind::Plain)];
        Self { pipeline: (entry.build)(&PipelineSettings::default()), rows }
    }

    /// As published every clump of Slats goes to all regions, which limits the scene to little more than 100 triangles;
    /// clumps that go where they are seen leave the raster offset a picture to work on.
    fn with_raster_offset() -> Self {
        let touched = Slats { binning: Binning::Touched, ..Slats::split() };
        let rows = [("slats-touched", Kind::Plain), ("vdrt", Kind::RasterOffset), ("ideal", Kind::Ideal)];
        let rows = rows.into_iter().map(|(name, kind)| (name.to_owned(), kind)).collect();
        Self { pipeline: Arc::new(touched), rows }
    }
}

/// Every pipeline of the registry that is compared, in its order, and the raster offset behind Slats.
fn contenders(registry: &Registry) -> Vec<Contender> {
    let mut all = Vec::new();
    for entry in registry.pipelines().iter().filter(|entry| entry.compared) {
        all.push(Contender::plain(entry));
        if entry.name == "slats" {
            all.push(Contender::with_raster_offset());
        }
    }
    all
}

/// Runs every pipeline of the papers on a machine with a scene and a head; `possible` searches for the most triangles too.
///
/// A pipeline that cannot run there has a row with its failure. No pixels are computed.
///
/// # Errors
///
/// [`ExperimentError::Fields`] when there are too few or too many fields.
pub fn compare(
    config: &MachineConfig,
    scene: &Arc<Scene>,
    head: &Arc<Head>,
    fields: u64,
    possible: bool,
) -> Result<Comparison, ExperimentError> {
    compare_with(&crate::registry(), config, scene, head, fields, possible, |_, _| {})
}

/// The same with every pipeline of a registry; `finished` hears how many of all runs are done.
///
/// # Errors
///
/// As [`compare`].
pub fn compare_with(
    registry: &Registry,
    config: &MachineConfig,
    scene: &Arc<Scene>,
    head: &Arc<Head>,
    fields: u64,
    possible: bool,
    finished: impl Fn(u64, u64) + Sync,
) -> Result<Comparison, ExperimentError> {
    let expected = (UNJUDGED_FIELDS + 2, FIELDS_WITH_HEAD);
    if !(expected.0..=expected.1).contains(&fields) {
        return Err(ExperimentError::Fields { expected, found: fields });
    }
    config.check()?;
    let tracker = head.tracker().config().name.clone();
    let contenders = contenders(registry);
    let done = AtomicU64::new(0);
    let rows = parallel::map(&contenders, |contender| {
        let run = Experiment::with(config.clone(), Arc::clone(&contender.pipeline), Arc::clone(scene))
            .head(Arc::clone(head))
            .fields(fields)
            .pixels(Pixels::Off)
            .host(Workstation::new())
            .run();
        let rows = contender.rows(registry, config, possible, &run);
        finished(done.fetch_add(1, Ordering::Relaxed) + 1, contenders.len() as u64);
        rows
    });
    Ok(Comparison {
        schema: "pxpl5-comparison/2",
        machine: config.preset.clone(),
        boards: [config.n_gps, config.n_renderers],
        scene: scene.name().to_owned(),
        triangles: scene.triangles().len(),
        tracker,
        predictor: format!("{:?}", head.predictor_kind()),
        aim: head.aim(),
        fields,
        pipelines: rows.into_iter().flatten().collect(),
    })
}

impl Contender {
    fn rows(
        &self,
        registry: &Registry,
        config: &MachineConfig,
        possible: bool,
        run: &Result<Outcome, ExperimentError>,
    ) -> Vec<Row> {
        let limit = possible.then(|| triangles_possible(registry, config, &self.pipeline));
        let row = |(name, kind): &(String, Kind)| {
            let limit = limit.as_ref().filter(|_| *kind != Kind::Ideal);
            let blank = Row {
                pipeline: name.clone(),
                eyes: self.pipeline.eyes(),
                triangles_possible: limit.map(|limit| limit.triangles),
                triangles_definition: limit.map_or("", |limit| limit.definition).to_owned(),
                ..Row::default()
            };
            match run {
                Ok(outcome) => of_outcome(*kind, outcome, blank),
                Err(error) => Row { failure: Some(error.to_string()), ..blank },
            }
        };
        self.rows.iter().map(row).collect()
    }
}

fn of_outcome(kind: Kind, outcome: &Outcome, blank: Row) -> Row {
    let error = match kind {
        Kind::Plain => PixelErrors::of(outcome),
        Kind::RasterOffset => PixelErrors::with_raster_offset(outcome),
        Kind::Ideal => {
            let latency_definition = "none: every pixel's own moment, computed and not timed".to_owned();
            return Row { error: PixelErrors::ideal(outcome), latency_definition, ..blank };
        }
    };
    let report = outcome.report();
    Row {
        latency_definition: outcome.pipeline().latency_definition().to_owned(),
        latency_ms: Some(report.latency_ms.statistics.mean).filter(|mean| mean.is_finite()),
        pictures: report.pictures,
        end_to_end: Budget::of(outcome),
        updates_hz: report.updates_hz,
        due: report.due,
        missed_retraces: report.missed_retraces,
        late_regions: report.late_regions,
        error,
        host_seconds: outcome.host_seconds().unwrap_or_default(),
        ..blank
    }
}

impl Comparison {
    /// A row by name.
    #[must_use]
    pub fn row(&self, pipeline: &str) -> Option<&Row> {
        self.pipelines.iter().find(|row| row.pipeline == pipeline)
    }

    /// The errors of a row by name; none for a name that is not there.
    #[must_use]
    pub fn pixels(&self, pipeline: &str) -> Percentiles {
        self.row(pipeline).map_or_else(Percentiles::default, |row| row.error.pixels)
    }
}
