//! The papers' pipeline figures, re-drawn from simulation.

use super::{TimelineOptions, svg};
use crate::experiment::{ExperimentError, Outcome};
use crate::experiment_file::{ExperimentFile, FileError};
use std::fmt;

/// A pipeline figure of a paper and the experiment that it is re-drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PipelineFigure {
    /// Name of its file, without the ending.
    pub name: &'static str,
    /// Where it was published.
    pub source: &'static str,
    /// What it shows.
    pub shows: &'static str,
    /// The experiment, as text of an experiment file.
    pub experiment: &'static str,
    /// The number of fields drawn, where it is not left to the picture.
    fields: Option<u64>,
}

/// The figures. Scenes are chosen so that the stages have the published relations; the papers name none. For figure
/// 4 the times of a triangle are, too: TRANSFORM, RENDER and COPY then take about 15.8, 16.0 and 15.6 ms.
pub const PIPELINE_FIGURES: [PipelineFigure; 6] = [
    PipelineFigure {
        name: "tr94-1-rendering-control-mono",
        source: "TR94 figure 1",
        shows: "Rendering Control, one picture: frames overlap",
        experiment: "pipeline = \"rendering-control\"\nmono = true\nscene = \"molecules\"\npixels = \"off\"\nfields = 60",
        fields: None,
    },
    PipelineFigure {
        name: "tr94-2-rendering-control-stereo",
        source: "TR94 figure 2, I3D95 figure 6",
        shows: "Rendering Control, stereo: two frame buffers take turns",
        experiment: "pipeline = \"rendering-control\"\nscene = \"molecules\"\npixels = \"off\"\nfields = 60",
        fields: None,
    },
    PipelineFigure {
        name: "tr94-3-rendering-control-trivial",
        source: "TR94 figure 3, I3D95 figure 7",
        shows: "Rendering Control, trivial scene: COPY is the bottleneck",
        experiment: "pipeline = \"rendering-control\"\nscene = \"full-screen:12\"\ntriangles = 1\npixels = \"off\"\nfields = 60",
        fields: None,
    },
    PipelineFigure {
        name: "tr94-4-rendering-control-balanced",
        source: "TR94 figure 4",
        shows: "Rendering Control, stages of equal length: everything busy",
        experiment: "pipeline = \"rendering-control\"\nscene = \"full-screen:12\"\npixels = \"off\"\nfields = 60\n\
                     [machine]\ngp.triangle_ns = 15_000_000\nrenderer.phong_triangle_clocks = 11_000",
        fields: None,
    },
    PipelineFigure {
        name: "tr94-5-slats-whole",
        source: "TR94 figure 5",
        shows: "Slats, all regions copied before the retrace",
        experiment: "pipeline = \"slats\"\nscene = \"mig\"\ntriangles = 100\ncopy = \"whole\"\npixels = \"off\"\nfields = 30",
        fields: None,
    },
    PipelineFigure {
        name: "tr94-6-slats-split",
        source: "TR94 figure 6, I3D95 figure 8",
        shows: "Slats, bottom half copied after the retrace",
        experiment: "pipeline = \"slats\"\nscene = \"mig\"\ntriangles = 130\ncopy = \"split\"\npixels = \"off\"\nfields = 30",
        fields: None,
    },
];

/// Why a figure could not be drawn.
#[derive(Debug)]
#[non_exhaustive]
pub enum FigureError {
    /// Its experiment is wrong.
    File(FileError),
    /// Its experiment gave no result.
    Experiment(ExperimentError),
}

impl fmt::Display for FigureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(error) => error.fmt(f),
            Self::Experiment(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for FigureError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::File(error) => Some(error),
            Self::Experiment(error) => Some(error),
        }
    }
}

impl From<FileError> for FigureError {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}

impl From<ExperimentError> for FigureError {
    fn from(error: ExperimentError) -> Self {
        Self::Experiment(error)
    }
}

impl PipelineFigure {
    /// Runs its experiment.
    ///
    /// # Errors
    ///
    /// [`FigureError`].
    pub fn run(&self) -> Result<Outcome, FigureError> {
        let plan = ExperimentFile::parse(self.experiment, self.name)?.resolve()?;
        Ok(plan.experiment(plan.load_scene()?).run()?)
    }

    /// Draws it as SVG.
    ///
    /// # Errors
    ///
    /// [`FigureError`].
    pub fn draw(&self) -> Result<String, FigureError> {
        let title = Some(format!("{} ({})", self.shows, self.source));
        Ok(svg(&self.run()?, &TimelineOptions { title, fields: self.fields, ..TimelineOptions::default() }))
    }
}
