//! The table of published figures.

use pxpl5_sim::figures::Basis;
use serde::Serialize;

/// A figure printed in a paper.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Figure {
    /// Number of the figure in [`FIGURES`], with a letter if one statement of a paper holds several numbers.
    pub id: &'static str,
    /// Short name of the paper.
    pub paper: &'static str,
    /// Topic of the part of the paper that prints the figure.
    pub section: &'static str,
    /// Statement of the paper with the figure, in a few words.
    pub statement: &'static str,
    /// Value printed in the paper, in `unit`.
    pub value: f64,
    /// Unit of the printed value.
    pub unit: &'static str,
    /// Half the width of the range that the paper prints, or implies by words like "about" and "1 to 2". `None` if the
    /// paper gives no range.
    pub spread: Option<f64>,
    /// Experiment that simulates the figure.
    pub experiment: &'static str,
    /// Relation between the figure and the choices in the model: checked, fitted, or rule chosen.
    pub basis: Basis,
    /// Known cause of a difference between model and paper. Empty if the model reproduces the figure.
    pub cause: &'static str,
}

const RC: &str = "Rendering Control";
const SLATS: &str = "Slats";
const HEAD: &str = "from head to light";
const FREE: Basis = Basis::Free;

/// Creates a figure without a known difference between model and paper. The method `because` adds the cause of a
/// difference.
const fn figure(
    id: &'static str,
    (paper, section): (&'static str, &'static str),
    statement: &'static str,
    (value, unit, spread): (f64, &'static str, Option<f64>),
    experiment: &'static str,
    basis: Basis,
) -> Figure {
    Figure { id, paper, section, statement, value, unit, spread, experiment, basis, cause: "" }
}

impl Figure {
    const fn because(self, cause: &'static str) -> Self {
        Self { cause, ..self }
    }
}

/// All published figures, in the order of their numbers.
pub const FIGURES: [Figure; 26] = [
    figure(
        "1",
        ("TR94", RC),
        "copy of one region",
        (780.0, "us", None),
        "mean over all regions of a stereo frame, per 15,360 pixels of port time",
        Basis::Fitted("ring.overhead_words"),
    ),
    figure(
        "2",
        ("TR94", RC),
        "copy of both eyes in stereo",
        (31.2, "ms", None),
        "full-screen:12 on small-hmd: the time of COPY left plus COPY right of a frame, each from its first word to its last word",
        FREE,
    ),
    figure(
        "3",
        ("TR94", RC),
        "stereo, trivial scene, theory: from the start of an eye's TRANSFORM to the end of its COPY",
        (50.0, "ms", None),
        "full-screen:12 on small-hmd. Software, transform and array take no time, so COPY is the only work. The experiment uses the rules \
         alone: a renderer keeps all finished regions and gets the next region at once.",
        FREE,
    ),
    figure(
        "4",
        ("TR94", RC),
        "small HMD machine, 12 triangles that cover the screen: mean from the start of TRANSFORM to the swap",
        (56.5, "ms", None),
        "full-screen:12 on small-hmd: mean over both eyes, each from the start of its own TRANSFORM",
        FREE,
    ),
    figure("4b", ("TR94", RC), "the same: frames per second", (30.0, "Hz", None), "full-screen:12 on small-hmd", FREE),
    figure(
        "5",
        ("TR94", RC),
        "TRANSFORM, RENDER and COPY of equal length at 30 Hz: up to",
        (4004.0 / 60.0, "ms", None),
        "full-screen:516 on small-hmd: RENDER of these triangles takes 15.6 ms, like COPY. The time of a triangle on a GP is set so that \
         TRANSFORM also takes 15.6 ms. The experiment uses the rules alone, like figure 3. The result is the longest latency of a frame.",
        FREE,
    ),
    figure(
        "6",
        ("TR94", RC),
        "TRANSFORM = RENDER, both longer than COPY: 3 x TRANSFORM + 1 to 2 x COPY",
        (98.4, "ms", Some(7.8)),
        "full-screen:732 to 936 on small-hmd, like figure 5. TRANSFORM and RENDER take 22 to 28 ms (mean 25 ms), and COPY takes 15.6 ms. The \
         expected latency is 75 ms + 15.6 to 31.2 ms. The latency of a frame includes TRANSFORM of its first eye and RENDER of both eyes.",
        FREE,
    ),
    figure(
        "7",
        ("TR94", RC),
        "Mig, 417 triangles, fly-through in an HMD: mean latency (sd 0.589)",
        (4.61, "fields", Some(0.589)),
        "mig on large without back faces, 10 seeds of head motion with 150 frames each. The result is the mean over both eyes of all frames. \
         Each latency is the number of retraces from the start of the eye's TRANSFORM.",
        FREE,
    ),
    figure(
        "7b",
        ("TR94", RC),
        "molecules, 2,620 triangles and 1,219 spheres, fly-through: mean latency (sd 0.502)",
        (4.47, "fields", Some(0.502)),
        "molecules as in figure 7: 4 seeds of head motion, 150 frames each",
        FREE,
    ),
    figure(
        "7c",
        ("TR94", RC),
        "head, 59,592 triangles, fly-through: mean latency (sd 2.48)",
        (8.13, "fields", Some(2.48)),
        "head as in figure 7: 2 seeds of head motion, 150 frames each",
        FREE,
    ),
    figure(
        "8",
        ("TR94", RC),
        "regions that a typical triangle touches, an eye",
        (1.3, "regions", None),
        "mig, molecules and head during 20 s of their head motions: the result is the number of entries of all bins per triangle on the screen",
        FREE,
    )
    .because(
        "Figure 8 depends only on the scenes, and the project's scenes only resemble the original scenes. The 59,592 triangles \
         of the scene `head` are tiny, and the triangles of the scene `mig` are larger. No parameter changes figure 8, so figure \
         8 has no interval. A test compares the counted regions with the number of regions that a triangle of a given size \
         touches on average"
    ),
    figure(
        "9",
        ("TR94, I3D95", SLATS),
        "rendering latency, constant",
        (1.0, "fields", None),
        "full-screen:100 on slats with the COPY optimisation: the result is the mean, which equals the minimum and the maximum",
        FREE,
    ),
    figure(
        "9b",
        ("TR94, I3D95", SLATS),
        "updates per second",
        (60.0, "Hz", None),
        "full-screen:100 on slats with the COPY optimisation",
        FREE,
    ),
    figure(
        "10",
        ("TR94", SLATS),
        "20 field regions to two frame buffers",
        (11.0, "region times", None),
        "full-screen:60 on slats without the COPY optimisation: the time from the first word to the last word, in units of 780 us",
        Basis::Rule("a frame-buffer port serves in order of arrival"),
    ),
    figure(
        "11",
        ("I3D95", SLATS),
        "half of them",
        (3.9, "ms", None),
        "full-screen:100 on slats with the COPY optimisation: the time from the first word to the last word of the bottom regions",
        Basis::Rule("odd renderers begin with the right eye"),
    ),
    figure(
        "12",
        ("TR94", SLATS),
        "most triangles without the COPY optimisation",
        (110.0, "triangles", None),
        "limit of full-screen:N on slats",
        FREE,
    ),
    figure(
        "13",
        ("TR94", SLATS),
        "most triangles with the COPY optimisation",
        (140.0, "triangles", None),
        "limit of full-screen:N on slats",
        FREE,
    )
    .because(
        "The COPY optimisation saves 4.68 ms. In the paper TR94, the saved 4.68 ms are enough for 30 more triangles, so each \
         triangle takes 156 us. In the model, each triangle takes 106 us. Of the 106 us, 55 us are code for both eyes, and the \
         rest is the wait until all renderers have begun with a clump (a group of 30 triangles). If each board could use one \
         channel instead of two, the limit of the same code would be 139 triangles",
    ),
    figure(
        "14",
        ("I3D95", SLATS),
        "most triangles with the COPY optimisation, code of 1995: about",
        (100.0, "triangles", None),
        "limit of full-screen:N on slats-1995",
        Basis::Fitted("gp.triangle_ns of slats-1995"),
    ),
    figure(
        "15",
        ("I3D95", SLATS),
        "time before the first copy in a field: about",
        (12.8, "ms", None),
        "the largest scene of figure 13: the time from the retrace to the first word of the first copy",
        FREE,
    ),
    figure(
        "16",
        ("TR94", RC),
        "triangles that cover the screen, as many as the bins of 12 slaves hold: about",
        (7_700.0, "triangles", None),
        "full-screen:N on small-hmd: the largest N whose bins fit for one eye, computed from the size of the bins. The test tests/interpretations.rs runs this N and N + 1.",
        Basis::Fitted("gp.bin_bytes"),
    ),
    figure(
        "16b",
        ("TR94", RC),
        "7,700 of them: frames a second",
        (2.0, "Hz", Some(0.5)),
        "full-screen:7700 on small-hmd",
        Basis::Rule("TRANSFORM waits until the bins have room for it"),
    ),
    figure(
        "16c",
        ("TR94", RC),
        "the same: mean frame time, by which the latency is meant, about 17.5 fields",
        (293.0, "ms", None),
        "full-screen:7700 on small-hmd: the time of an eye from the start of its TRANSFORM to the end of its COPY",
        Basis::Rule("TRANSFORM waits until the bins have room for it"),
    )
    .because(
        "With bins for both eyes, TRANSFORM of one eye begins while the other eye is rendered. The result would then be 454 ms at 2.2 Hz"
    ),
    figure(
        "17",
        ("I3D95", RC),
        "measured from outside with pendulum and photodiode, a minimal data set, rendering alone",
        (55.5, "ms", Some(1.5)),
        "full-screen:2 on small-hmd, one frame for each of 24 passes of the bob through its lowest point. The result is the mean time from the start of SEND to the \
         light under a photodiode in the middle of the screen. The brackets give the results for a photodiode on the first and the last line.",
        FREE,
    )
    .because(
        "A frame on demand finds every stage idle. SEND, EDIT, TRANSFORM and RENDER of two triangles are short. COPY of both eyes takes \
         31.2 ms, and the wait for the retrace takes half a field on average. The beam reaches the photodiode up to one field later. The \
         position of the photodiode on the screen is not published. The other work of the pendulum's program is not published either",
    ),
    figure(
        "18",
        ("I3D95", HEAD),
        "errors in pixels of two systems with 90 and 50 ms from head to light: ratio",
        (1.8, "", None),
        "The head follows a synthetic motion of recorded use, for four seeds of two minutes. The pictures are drawn for the poses of 90 ms and of 50 ms before.",
        FREE,
    ),
    figure(
        "19",
        ("I3D95", HEAD),
        "optical tracker and Rendering Control together",
        (90.0, "ms", None),
        "full-screen:12 on small-hmd, with a synthetic motion and without prediction. The result is the sum of two times. The first is the time \
         from the pose to the arrival of its report. The second is the time from the start of TRANSFORM to the swap, like figure 4.",
        FREE,
    ),
    figure(
        "19b",
        ("I3D95", HEAD),
        "optical tracker and Slats together",
        (50.0, "ms", None),
        "the same with Slats on slats",
        FREE,
    ),
];

/// Figures without a closed form: a property of the scenes, and figures that need a tracker or a motion. These figures
/// are always simulated with events. The intervals at the analytic level omit these figures.
pub const WITHOUT_CLOSED_FORM: [&str; 5] = ["8", "17", "18", "19", "19b"];
