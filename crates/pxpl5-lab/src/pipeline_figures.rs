//! The papers' pipeline figures, re-drawn from simulation.

use crate::experiment_file::{ExperimentFile, FileError};
use pxpl5_run::{ExperimentError, Outcome};
use thiserror::Error;

/// A pipeline figure of a paper and the experiment that it is re-drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PipelineFigure {
    /// Name of its file, without the ending.
    pub name: &'static str,
    /// Where it was published.
    pub source: &'static str,
    /// What it shows: the pipeline, and what to look at.
    pub shows: &'static str,
    /// The experiment, as text of an experiment file.
    pub experiment: &'static str,
    /// The number of fields drawn, where it is not left to the picture.
    pub fields: Option<u64>,
}

/// The figures. Scenes are chosen so that the stages have the published relations; the papers name none. For figure
/// 4 the number of triangles and their time on a GP are, too: TRANSFORM, RENDER and COPY then take 15.6 ms each, as in row 5 of
/// ACCURACY.md.
///
/// Figures 3 and 4 are TR94's theory, so they are drawn by the rules of its text as rows 3 and 5 of ACCURACY.md are: a renderer whose
/// region is finished goes on with the next (`finished = "store"`). By the default, which fits what TR94 measured, renderers wait.
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
        shows: "Trivial scene, theory: COPY is the bottleneck",
        experiment: "pipeline = \"rendering-control\"\nscene = \"full-screen:12\"\ntriangles = 1\nfinished = \"store\"\npixels = \"off\"\nfields = 60",
        fields: None,
    },
    PipelineFigure {
        name: "tr94-4-rendering-control-balanced",
        source: "TR94 figure 4",
        shows: "Stages of equal length, theory: everything busy",
        experiment: "pipeline = \"rendering-control\"\nscene = \"full-screen:516\"\nfinished = \"store\"\npixels = \"off\"\nfields = 60\n\
                     [machine]\ngp.triangle_ns = 342_674",
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
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PipelineFigureError {
    /// Its experiment is wrong.
    #[error(transparent)]
    File(#[from] FileError),
    /// Its experiment gave no result.
    #[error(transparent)]
    Experiment(#[from] ExperimentError),
}

impl PipelineFigure {
    /// Runs its experiment.
    ///
    /// # Errors
    ///
    /// [`PipelineFigureError`].
    pub fn run(&self) -> Result<Outcome, PipelineFigureError> {
        let plan = ExperimentFile::parse(self.experiment, self.name)?.resolve()?;
        Ok(plan.experiment(plan.load_scene()?).run()?)
    }

    /// What stands above the drawing.
    #[must_use]
    pub fn title(&self) -> String {
        format!("{} ({})", self.shows, self.source)
    }
}
