//! Estimates of the memory and time of an experiment, computed from its settings before the experiment starts.
//!
//! Budgets, sweeps and Slurm jobs use these estimates.
//!
//! Memory in bytes: `BASE + GP gps + PRIMITIVE primitives + WAITING batch + kept (FIELD + BLOCK blocks)`
//!
//! - `kept` is the number of fields whose observations are in memory: all fields, or at most `KEPT_FIELDS` in a run that
//!   keeps statistics.
//! - A tracked head adds `min(fields, EVALUATED_FIELDS) ERRORS`.
//! - `batch` is the number of blocks of pixels drawn with one head pose. `blocks` is the number of blocks that the
//!   processors of the experiment can send in a field. Both are 0 except in frameless rendering.
//!
//! The constants of memory come from the measured peaks of 23 runs of all pipelines, rounded up (docs/hardening.md). A
//! test compares the formula with twelve of them: it is at most a factor of two off.
//!
//! Time in seconds on one core: `runs (FIELD_S fields + pictures eyes (PICTURE_S + GP_S gps) + BLOCK_S blocks fields) +
//! LOAD_S eyes primitives + EVALUATED_FIELD_S fields`
//!
//! - `runs` is `RUNS_OF_HEAD` for a tracked head, otherwise 1.
//! - `LOAD_S` counts only if a closed form gives the times of pictures. At the cycle level, the time of a picture also
//!   contains `PRIMITIVE_AS_CODE_S primitives`.
//! - `BLOCK_S` counts only for pipelines that draw blocks.
//! - `EVALUATED_FIELD_S` counts only for a tracked head.
//!
//! The constants of time are fitted to 606 points of all pipelines (experiments/sweep-costs.toml and
//! sweep-costs-heads.toml, release build). The fit minimizes the error of the logarithms, so that overestimates and
//! underestimates count alike. docs/guide/sweep-times.md, "What a point costs", lists the errors of single points. The
//! cost also depends on the visible part of a scene and on repeated head poses, which no formula predicts. An estimate
//! is good enough to distinguish minutes from weeks. Running experiments are monitored as well.

use pxpl5_run::{Experiment, KeyValue, Level};

/// Quantities of an experiment that determine its memory and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunWork {
    /// Number of display periods.
    pub fields: u64,
    /// Number of graphics processors.
    pub gps: u64,
    /// Number of triangles and spheres.
    pub primitives: u64,
    /// Number of eyes for which pictures are drawn.
    pub eyes: u64,
    /// Number of pictures for each eye in a display field, at most 1.
    pub pictures_a_field: f64,
    /// True if a closed form gives the times of the pictures. The estimate then counts the time to transform each
    /// primitive once for each eye.
    pub uses_closed_form: bool,
    /// Number of blocks of pixels that are drawn with one head pose. 0 for a pipeline without blocks.
    pub batch: u64,
    /// Width of a block in pixels. 0 for a pipeline without blocks.
    pub block: u64,
    /// True if the simulated processors execute i860 instructions.
    pub is_cycle_level: bool,
    /// True if the run keeps all observations until its end.
    pub keeps_everything: bool,
    /// True if the experiment has a tracked head.
    pub is_tracked: bool,
}

/// Estimated cost of a computation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Peak memory in bytes.
    pub bytes: f64,
    /// Run time in seconds on a computer that is busy with other work.
    pub seconds: f64,
}

/// Bytes of the process with a small machine.
pub const BASE: f64 = 15e6;
/// Bytes for one graphics processor.
const GP: f64 = 60e3;
/// Bytes for one primitive, including its entries in all lists.
pub const PRIMITIVE: f64 = 200.0;
/// Bytes for each block of pixels that is drawn with one head pose.
const WAITING: f64 = 5.5e3;
/// Bytes for the observations of a field.
const FIELD: f64 = 4e3;
/// Bytes for the observations of a block of pixels.
const BLOCK: f64 = 350.0;
/// Number of fields whose observations take as much memory as a run that keeps only statistics. Derived from such a run,
/// which stores the blocks of the last 240 fields, each in 100 bytes: 240 x 100 / [`BLOCK`].
const KEPT_FIELDS: f64 = 70.0;
/// Bytes for the pixel errors of one display field.
const ERRORS: f64 = 1e3;
/// Maximum number of display fields for which a run stores separate pixel errors.
const EVALUATED_FIELDS: f64 = 20_971.0;

/// Seconds to simulate a field, including its retrace and the samples of the head pose.
const FIELD_S: f64 = 3.5e-4;
/// Seconds to simulate the regions of one eye's picture.
const PICTURE_S: f64 = 1.8e-4;
/// Seconds to simulate the messages of one processor for one eye's picture.
const GP_S: f64 = 1.3e-5;
/// Seconds to simulate a block of pixels in frameless rendering.
const BLOCK_S: f64 = 5.6e-6;
/// Seconds to transform a primitive for one eye. Primitives are transformed when a head pose is first drawn.
const LOAD_S: f64 = 2.8e-5;
/// Seconds to simulate one primitive of a picture as i860 code. Assumed, from the speeds in the README.
const PRIMITIVE_AS_CODE_S: f64 = 2.7e-5;
/// Number of simulations with a tracked head: a dry run, which measures the prediction interval, and the run itself.
const RUNS_OF_HEAD: f64 = 2.0;
/// Seconds to evaluate the pixel errors of a field.
const EVALUATED_FIELD_S: f64 = 6e-4;
/// Factor on the time for a computer that is busy with other work. Assumed. Four measured runs on two busy cores took
/// 1.3 to 12 times as long as the estimate for an idle core.
pub const BUSY: f64 = 2.5;

/// Duration of an NTSC field in seconds, which estimates use for every display.
const NTSC_FIELD_S: f64 = 16.683_333e-3;
/// Seconds to send a word over the ring, which estimates use for every machine.
const WORD_S: f64 = 50e-9;
/// Seconds in which a simulated graphics processor transforms a primitive, which estimates use for every machine.
const TRANSFORM_S: f64 = 21.7e-6;
/// Number of words in the messages of a block in addition to its pixels.
const BLOCK_WORDS: f64 = 16.0;
/// Number of processors whose blocks of pixels fill the ring completely.
const BLOCK_GPS: f64 = 20.0;

impl Estimate {
    /// Almost no memory and time.
    pub const NOTHING: Self = Self { bytes: 0.0, seconds: 0.0 };

    /// Combines the estimates of many runs that are divided among `threads` threads. The time is the sum of all times
    /// divided by `threads`. The memory is the largest memory of a run times `threads`.
    pub fn of_all(all: impl IntoIterator<Item = Self>, threads: usize) -> Self {
        let threads = threads.max(1) as f64;
        let (bytes, seconds) = all
            .into_iter()
            .fold((0.0, 0.0), |(bytes, seconds): (f64, f64), one| (bytes.max(one.bytes), seconds + one.seconds));
        Self { bytes: bytes * threads, seconds: seconds / threads }
    }
}

impl RunWork {
    /// Returns the quantities that determine the cost of an experiment. Each field has one picture, or less if the
    /// processors need longer than a field to transform all primitives.
    pub fn of(experiment: &Experiment, keeps_everything: bool) -> Self {
        let pipeline = experiment.pipeline();
        let settings = pipeline.settings();
        // Settings that a pipeline does not have count as 0.
        let whole = |key: &str| match settings.iter().find(|(name, _)| *name == key) {
            Some((_, KeyValue::Whole(value))) => *value,
            _ => 0,
        };
        let mut work = Self {
            fields: experiment.fields,
            gps: experiment.config().n_gps as u64,
            primitives: experiment.scene().primitives() as u64,
            eyes: pipeline.properties().eyes as u64,
            pictures_a_field: 1.0,
            uses_closed_form: false,
            batch: whole("batch"),
            block: whole("block"),
            is_cycle_level: experiment.level == Level::Cycle,
            keeps_everything: keeps_everything || !pipeline.properties().can_discard_records,
            is_tracked: experiment.head.is_some(),
        };
        // A pipeline shows at most one picture in a field, and fewer if TRANSFORM takes longer.
        work.pictures_a_field = (1.0 / work.fields_of_transform()).min(1.0);
        work
    }

    /// Returns the number of NTSC fields in which the simulated processors transform all primitives for all eyes.
    pub fn fields_of_transform(&self) -> f64 {
        let primitives = (self.primitives * self.eyes).max(1) as f64;
        TRANSFORM_S * primitives / (NTSC_FIELD_S * self.gps.max(1) as f64)
    }

    /// Returns the number of blocks of pixels that the processors of the experiment can send in a field.
    fn blocks(&self) -> f64 {
        let block_s = WORD_S * ((self.block * self.block) as f64 + BLOCK_WORDS);
        if self.block == 0 { 0.0 } else { NTSC_FIELD_S / block_s * (self.gps as f64 / BLOCK_GPS).min(1.0) }
    }

    /// Estimates memory and time by the formulas in the documentation of [`crate::estimate`].
    pub fn estimate(&self) -> Estimate {
        Estimate { bytes: self.bytes(), seconds: BUSY * self.core_seconds() }
    }

    /// Estimates the peak memory in bytes.
    pub fn bytes(&self) -> f64 {
        let fields = self.fields as f64;
        // In long runs, observations take most of the memory. In large scenes, lists take most of the memory.
        let kept = if self.keeps_everything { fields } else { fields.min(KEPT_FIELDS) };
        let observations = kept * (FIELD + BLOCK * self.blocks());
        let errors = if self.is_tracked { fields.min(EVALUATED_FIELDS) * ERRORS } else { 0.0 };
        let lists = PRIMITIVE * self.primitives as f64 + WAITING * self.batch as f64;
        BASE + GP * self.gps as f64 + lists + observations + errors
    }

    /// Estimates the run time in seconds on one idle core.
    pub fn core_seconds(&self) -> f64 {
        let (fields, eyes, primitives) = (self.fields as f64, self.eyes as f64, self.primitives as f64);
        let as_code = if self.is_cycle_level { PRIMITIVE_AS_CODE_S * primitives } else { 0.0 };
        let picture = eyes * (PICTURE_S + GP_S * self.gps as f64 + as_code);
        // Fields, pictures and blocks each add their own cost.
        let run = fields * FIELD_S + fields * self.pictures_a_field * picture + fields * self.blocks() * BLOCK_S;
        let load = if self.uses_closed_form { LOAD_S * eyes * primitives } else { 0.0 };
        let (runs, evaluated) = if self.is_tracked { (RUNS_OF_HEAD, fields * EVALUATED_FIELD_S) } else { (1.0, 0.0) };
        runs * run + load + evaluated
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: RunWork = RunWork {
        fields: 1_200,
        gps: 11,
        primitives: 417,
        eyes: 2,
        pictures_a_field: 1.0,
        uses_closed_form: false,
        batch: 0,
        block: 0,
        is_cycle_level: false,
        keeps_everything: false,
        is_tracked: false,
    };

    /// Measured runs: the work, and the peak memory in MB as `/usr/bin/time` reports it.
    const MEASURED: [(RunWork, f64); 12] = [
        (SMALL, 13.8),
        (RunWork { fields: 12_000, keeps_everything: true, ..SMALL }, 61.4),
        (RunWork { fields: 120, primitives: 1_000_000, ..SMALL }, 195.2),
        (RunWork { fields: 1_200, gps: 1_000, ..SMALL }, 50.6),
        (RunWork { fields: 120, block: 16, ..SMALL }, 25.3),
        (RunWork { fields: 120, block: 16, batch: 65_535, ..SMALL }, 421.0),
        (RunWork { fields: 120, block: 16, gps: 1_000, ..SMALL }, 130.9),
        (RunWork { fields: 480, block: 16, primitives: 8, keeps_everything: true, ..SMALL }, 228.9),
        (RunWork { is_cycle_level: true, ..SMALL }, 18.6),
        (RunWork { fields: 4_000, gps: 1, primitives: 140, is_tracked: true, ..SMALL }, 20.1),
        (RunWork { fields: 100_000, gps: 1, primitives: 140, is_tracked: true, ..SMALL }, 42.7),
        (RunWork { fields: 215_784, gps: 1, primitives: 140, is_tracked: true, ..SMALL }, 47.1),
    ];

    #[test]
    fn many_runs_take_the_sum_of_times_and_the_largest_memory_of_each_thread() {
        let runs = [(3e9, 10.0), (5e9, 20.0), (4e9, 30.0)].map(|(bytes, seconds)| Estimate { bytes, seconds });
        assert_eq!(Estimate::of_all(runs.into_iter(), 2), Estimate { bytes: 10e9, seconds: 30.0 });
        assert_eq!(Estimate::of_all(std::iter::empty(), 0), Estimate { bytes: 0.0, seconds: 0.0 });
    }

    #[test]
    fn memory_is_estimated_to_a_factor_of_two() {
        for (work, megabytes) in MEASURED {
            let ratio = work.estimate().bytes / 1e6 / megabytes;
            assert!((0.5..2.0).contains(&ratio), "{work:?}: {ratio} times {megabytes} MB");
        }
    }

    /// Tests the estimated time of four runs whose time was measured on a busy computer. The estimate must be 0.1 to 2
    /// times the measured time.
    #[test]
    fn the_estimated_time_of_a_run_is_0_1_to_2_times_the_measured_time() {
        for (work, seconds) in [
            (RunWork { fields: 12_000, ..SMALL }, 47.5),
            (RunWork { fields: 120, block: 16, ..SMALL }, 7.5),
            (RunWork { fields: 1_200, gps: 1_000, ..SMALL }, 41.2),
            (RunWork { is_cycle_level: true, ..SMALL }, 74.8),
        ] {
            let ratio = work.estimate().seconds / seconds;
            assert!((0.1..2.0).contains(&ratio), "{work:?}: {ratio} times {seconds} s");
        }
    }

    #[test]
    fn larger_inputs_have_larger_estimates() {
        let least = RunWork { block: 16, batch: 4, ..SMALL }.estimate();
        for more in [
            RunWork { fields: 1_201, block: 16, batch: 4, ..SMALL },
            RunWork { gps: 12, block: 16, batch: 4, ..SMALL },
            RunWork { block: 8, batch: 4, ..SMALL },
        ] {
            assert!(more.estimate().bytes >= least.bytes && more.estimate().seconds > least.seconds, "{more:?}");
        }
        assert!(RunWork { block: 16, batch: 5, ..SMALL }.estimate().bytes > least.bytes);
    }
}
