//! Figures of Rendering Control: times of copies, latencies, application scenes, full bins and the pendulum rig.

mod experiments;

use super::measurement::{LatencyDefinition, Measurement, RC, Varied, figure};
use super::rig_lines::PHOTODIODE_LINE;
use super::value::rate_hz;
use crate::edges::to_other_retraces;
use experiments::{
    application, copy_alone, equal_stages, full_bins, inside_and_outside, long_stages, most_in_bins, regions_touched,
    rig, spread_ms, trivial,
};
use pxpl5_run::Statistics;
use pxpl5_sim::figures::Basis;

const TR94: (&str, &str) = ("TR94", RC);
const I3D95: (&str, &str) = ("I3D95", RC);

const TRANSFORM: &str = "start of an eye's TRANSFORM";
const FIRST_TRANSFORM: &str = "start of TRANSFORM of a frame's first eye";
const END_OF_COPY: &str = "end of its COPY";
const END_OF_LAST_COPY: &str = "end of COPY of its second eye";
const SWAP: &str = "swap of the double buffer";

/// Definition of the latencies that TR94 measured.
pub(super) const TO_THE_SWAP: LatencyDefinition = LatencyDefinition {
    from: TRANSFORM,
    to: SWAP,
    eyes: "each eye",
    statistic: "mean",
    sentence: "TR94: from the beginning of TRANSFORM to the swap. Each eye has its own TRANSFORM",
};

const OF_THE_VIEWER: LatencyDefinition = LatencyDefinition {
    statistic: "mean, in fields of 1001/60 ms",
    sentence: "TR94: measured like row 4, whose 56.5 ms it converts to 3.4 fields",
    ..TO_THE_SWAP
};

const OF_THEORY: LatencyDefinition = LatencyDefinition {
    from: TRANSFORM,
    to: END_OF_COPY,
    eyes: "each eye",
    statistic: "mean",
    sentence: "TR94: the analysis ends with COPY",
};

const GREATEST: LatencyDefinition = LatencyDefinition {
    from: FIRST_TRANSFORM,
    to: END_OF_LAST_COPY,
    eyes: "both eyes of a frame",
    statistic: "greatest",
    sentence: "TR94: up to four fields. An eye alone takes three, so a frame is meant",
};

const OF_FRAME: LatencyDefinition = LatencyDefinition {
    statistic: "mean of seven lengths of TRANSFORM",
    sentence: "TR94: three TRANSFORMs and one to two COPYs. One TRANSFORM and both RENDERs are three such times",
    ..GREATEST
};

const OF_FULL_BINS: LatencyDefinition = LatencyDefinition {
    sentence: "TR94: a frame time of 293 ms at two frames a second, so one eye is meant",
    ..OF_THEORY
};

const OF_RIG: LatencyDefinition = LatencyDefinition {
    from: "step of the host's D/A output, at the start of SEND",
    to: "light under a photodiode in the middle of the screen",
    eyes: "left eye",
    statistic: "mean of 24 frames on demand",
    sentence: "I3D95: from the D/A converter's signal to the photodiode's",
};

/// Parameters of machine and host that can change the latency of a frame by more than a thousandth.
const OF_FRAMES: &[&str] = &[
    "gp.message_ns",
    "gp.triangle_ns",
    "gp.sphere_ns",
    "gp.bin_entry_ns",
    "gp.edit_ns",
    "ring.source_channels",
    "ring.fifo_channels",
    "renderer.fifo_words",
    "renderer.phong_triangle_clocks",
    "renderer.phong_sphere_clocks",
    "renderer.shade_clocks",
    "renderer.backing_block_clocks",
];

const APPLICATION: Basis = Basis::Interpretation("each eye, the large machine, culling");
const OF_APPLICATION: &str = "TR94 names neither the machine nor culling; on the small one, or with all faces, `head` takes twice the printed time. \
    Samples of each eye were chosen because of the printed deviations";
const GAP: &str = "If TR94's fields are exact, the model lacks about one field (one COPY; see the section above)";
const BIN_RULE: Basis = Basis::Rule("TRANSFORM waits until the bins have room for it");
const OF_BINS: &str = "No paper states the rule for full bins. It was chosen because both figures follow from it";

const fn interpreted(figure: Measurement) -> Measurement {
    Measurement { is_interpreted: true, varied: Varied::ByFormula, ..figure }
}

const fn of_application(figure: Measurement) -> Measurement {
    Measurement {
        basis: APPLICATION,
        reason: OF_APPLICATION,
        latency: Some(OF_THE_VIEWER),
        is_interpreted: true,
        varied: Varied::ByEvents(OF_FRAMES),
        cause: GAP,
        ..figure
    }
}

/// The figures of Rendering Control, in the order of their numbers.
pub(super) const FIGURES: &[Measurement] = &[
    Measurement {
        basis: Basis::Fitted("ring.overhead_words"),
        varied: Varied::ByFormula,
        ..figure(
            ("1", TR94, 780.0, "us"),
            "copy of one region",
            "mean over all regions of a stereo frame, per 15,360 pixels of port time",
            |settings| Ok(trivial(settings)?.region_copy_us.into()),
        )
    },
    Measurement {
        basis: Basis::Derived("40 x row 1"),
        varied: Varied::ByFormula,
        ..figure(
            ("2", TR94, 31.2, "ms"),
            "copy of both eyes in stereo",
            "full-screen:12 on small-hmd: COPY left plus COPY right of a frame, each from first to last word",
            |settings| trivial(settings).map(|summary| (summary.first_copy_ms + summary.last_copy_ms).into()),
        )
    },
    Measurement {
        reason: "`store` follows from TR94's text, and the room for stored regions from F89. TR94 derives the figure from the same rules, so the row checks the firmware",
        latency: Some(OF_THEORY),
        ..interpreted(figure(
            ("3", TR94, 50.0, "ms"),
            "stereo, trivial scene, theory: from the start of TRANSFORM to the end of COPY",
            "full-screen:12 on small-hmd. Software, transform and array take no time, so only COPY works",
            copy_alone,
        ))
    },
    Measurement {
        basis: Basis::Interpretation("each eye"),
        reason: "TR94's text allows samples of the first eye, too",
        latency: Some(TO_THE_SWAP),
        cause: "By TR94's rules, TRANSFORM may begin while two eyes wait for their copies, so with a faster TRANSFORM or RENDER, a picture only waits longer for COPY",
        ..interpreted(figure(
            ("4", TR94, 56.5, "ms"),
            "small HMD machine, 12 triangles that cover the screen: from the start of TRANSFORM to the swap",
            "full-screen:12 on small-hmd",
            |settings| {
                let summary = trivial(settings)?;
                let latencies = settings.interpretation.latencies_ms(&summary).iter().copied();
                Ok(spread_ms(Statistics::of(latencies)).beside(to_other_retraces(&summary)))
            },
        ))
    },
    Measurement {
        basis: Basis::Derived("row 2 takes two fields"),
        ..interpreted(figure(
            ("4b", TR94, 30.0, "Hz"),
            "the same: frames per second",
            "full-screen:12 on small-hmd",
            |settings| trivial(settings).map(|summary| rate_hz(&summary).into()),
        ))
    },
    Measurement {
        reason: "As row 3. The paper's own words choose the greatest latency",
        latency: Some(GREATEST),
        cause: "For its greatest value, TR94 lets COPY begin after RENDER. Here, COPY begins with the first finished region",
        ..interpreted(figure(
            ("5", TR94, 4004.0 / 60.0, "ms"),
            "TRANSFORM, RENDER and COPY of equal length at 30 Hz: up to",
            "full-screen:516 on small-hmd: RENDER takes 15.6 ms, like COPY, and the time of a triangle on a GP is set so that TRANSFORM does, too",
            equal_stages,
        ))
    },
    Measurement {
        range: Some(7.8),
        basis: Basis::Interpretation("a frame, from its first eye"),
        reason: "The text does not name the eyes. The stages of both eyes add up to the formula's three TRANSFORMs",
        latency: Some(OF_FRAME),
        cause: "A renderer may copy its first regions while it draws the others, so COPY overlaps RENDER. TR94's formula lets COPY begin later",
        ..interpreted(figure(
            ("6", TR94, 98.4, "ms"),
            "TRANSFORM = RENDER, both longer than COPY: 3 x TRANSFORM + 1 to 2 x COPY",
            "full-screen:732 to 936 on small-hmd, like figure 5: TRANSFORM and RENDER take 22 to 28 ms (mean 25 ms), COPY 15.6 ms, so 75 ms + 15.6 to \
            31.2 ms are expected",
            long_stages,
        ))
    },
    Measurement {
        deviation: Some(0.589),
        ..of_application(figure(
            ("7", TR94, 4.61, "fields"),
            "Mig, 417 triangles, fly-through in an HMD (sd 0.589)",
            "mig on large without back faces, 10 seeds of head motion with 150 frames each",
            |settings| application(settings, "mig", 1),
        ))
    },
    Measurement {
        deviation: Some(0.502),
        ..of_application(figure(
            ("7b", TR94, 4.47, "fields"),
            "molecules, 2,620 triangles and 1,219 spheres, fly-through (sd 0.502)",
            "molecules as in figure 7: 4 seeds of head motion, 150 frames each",
            |settings| application(settings, "molecules", 3),
        ))
    },
    Measurement {
        deviation: Some(2.48),
        ..of_application(figure(
            ("7c", TR94, 8.13, "fields"),
            "head, 59,592 triangles, fly-through (sd 2.48)",
            "head as in figure 7: 2 seeds of head motion, 150 frames each",
            |settings| application(settings, "head", 5),
        ))
    },
    Measurement {
        reason: "No scene and no rule of binning was chosen by this figure",
        cause: "The number depends on the scenes, and ours only resemble the original ones: the 59,592 \
                triangles of `head` are tiny. Binning by bounding boxes gives hardly more regions",
        ..figure(
            ("8", TR94, 1.3, "regions"),
            "regions that a typical triangle touches, an eye",
            "mig, molecules and head during 20 s of their head motions: entries of all bins per triangle on the screen",
            |settings| settings.applications.value("8".to_owned(), || regions_touched(settings)),
        )
    },
    Measurement {
        basis: Basis::Fitted("gp.bin_bytes"),
        ..interpreted(figure(
            ("16", TR94, 7_700.0, "triangles"),
            "triangles that cover the screen, as many as the bins of 12 slaves hold: about",
            "full-screen:N on small-hmd: the largest N whose bins fit for one eye, computed from their size; tests/interpretations.rs runs N and N + 1",
            most_in_bins,
        ))
    },
    Measurement {
        range: Some(0.5),
        basis: BIN_RULE,
        reason: OF_BINS,
        ..interpreted(figure(
            ("16b", TR94, 2.0, "Hz"),
            "7,700 of them: frames a second",
            "full-screen:7700 on small-hmd",
            |settings| full_bins(settings).map(|summary| rate_hz(&summary).into()),
        ))
    },
    Measurement {
        basis: BIN_RULE,
        reason: OF_BINS,
        latency: Some(OF_FULL_BINS),
        ..interpreted(figure(
            ("16c", TR94, 293.0, "ms"),
            "the same: mean frame time, about 17.5 fields",
            "full-screen:7700 on small-hmd: an eye from the start of its TRANSFORM to the end of its COPY",
            |settings| Ok(spread_ms(Statistics::of(full_bins(settings)?.eye_latencies_ms.iter().copied()))),
        ))
    },
    Measurement {
        range: Some(1.5),
        reason: "Nothing of the rig was chosen by this figure",
        latency: Some(OF_RIG),
        is_interpreted: true,
        varied: Varied::ByEvents(&[
            PHOTODIODE_LINE,
            "renderer.fifo_words",
            "ring.source_channels",
            "host.message_ns",
            "host.application_ns",
        ]),
        cause: "A frame on demand finds every stage idle, so three parts are almost all of its time. \
                COPY of both eyes takes two fields less 2 ms, the wait for the retrace adds half a field on average, \
                and the beam's way to the middle of the screen another half. A slower host would explain the rest (docs/interpretations.md, Findings)",
        ..figure(
            ("17", I3D95, 55.5, "ms"),
            "measured from outside with pendulum and photodiode, a minimal data set, rendering alone",
            "full-screen:2 on small-hmd, one frame for each of 24 passes of the bob through its lowest point; in brackets, with the photodiode on the \
            first and the last line",
            rig,
        )
    },
    Measurement {
        range: Some(1.5),
        basis: Basis::Derived("row 4"),
        latency: Some(LatencyDefinition { sentence: "I3D95: time stamps, without the first frames", ..TO_THE_SWAP }),
        cause: "As row 4. I3D95 found the same range from outside (row 17), where our pipeline is faster, because it is idle before each frame",
        ..interpreted(figure(
            ("17b", I3D95, 55.5, "ms"),
            "measured from inside, in a full pipeline: the same range",
            "the experiment of figure 4, beside the latency of figure 17 by the time stamps of its frames on demand",
            inside_and_outside,
        ))
    },
];
