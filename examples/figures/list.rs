//! The diagrams of pipelines in the papers, redrawn from simulations.

use pxpl5::{ExperimentFile, Outcome, StudyError};

/// A diagram of a pipeline in a paper, with the experiment that redraws it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PipelineFigure {
    /// Name of the drawing's file, without the extension.
    pub(crate) name: &'static str,
    /// Paper and figure number.
    pub(crate) source: &'static str,
    /// Caption of the drawing: the pipeline, and the effect that is visible.
    pub(crate) shows: &'static str,
    /// Text of the experiment file.
    pub(crate) experiment: &'static str,
    /// Number of drawn display fields. `None` draws a default number.
    pub(crate) fields: Option<u64>,
}

/// The papers' diagrams of pipelines. The papers name no scenes. This project chose scenes for which the durations of
/// the stages have the published ratios. For TR94's figure 4, this project also chose the number of triangles and the
/// time per triangle. TRANSFORM, RENDER and COPY then take 15.6 ms each, as in row 5 of ACCURACY.md.
///
/// TR94's figures 3 and 4 show theory. Like all rows of ACCURACY.md, both figures follow the rules in the text of TR94: a
/// renderer with a finished region continues with another region.
pub(crate) const PIPELINE_FIGURES: [PipelineFigure; 6] = [
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
        experiment: "pipeline = \"rendering-control\"\nscene = \"full-screen:12\"\ntriangles = 1\npixels = \"off\"\nfields = 60",
        fields: None,
    },
    PipelineFigure {
        name: "tr94-4-rendering-control-balanced",
        source: "TR94 figure 4",
        shows: "Stages of equal length, theory: everything busy",
        experiment: "pipeline = \"rendering-control\"\nscene = \"full-screen:516\"\npixels = \"off\"\nfields = 60\n\
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

impl PipelineFigure {
    /// Runs the experiment that redraws the diagram.
    ///
    /// # Errors
    ///
    /// Returns [`StudyError`] if the experiment cannot run.
    pub(crate) fn run(&self) -> Result<Outcome, StudyError> {
        let plan = ExperimentFile::parse(self.experiment, self.name)?.resolve()?;
        Ok(plan.experiment(plan.load_scene()?).run()?)
    }

    /// Returns the title of the diagram, which stands above the drawing.
    pub(crate) fn title(&self) -> String {
        format!("{} ({})", self.shows, self.source)
    }
}
