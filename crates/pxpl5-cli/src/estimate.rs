//! What a run will take of this computer, from what it is: known before it starts.
//!
//! Memory, bytes:
//! `BASE + GP gps + PRIMITIVE primitives + WAITING batch + kept`, where `kept = fields (FIELD + COPY copies)` of a run that keeps
//! everything, and `fields STATISTICS + min(fields, WINDOW) BLOCK blocks` of one that keeps statistics and its last pictures; behind a tracker
//! either has `min(fields, JUDGED) ERRORS` more. `batch` and `blocks` (copied in a field, at
//! most what the ring takes) are those of frameless rendering.
//!
//! Time, seconds: `fields (FIELD_S + GP_S gps + BLOCK_S blocks) level`, `level` 1 or, of a cycle level, [`CYCLE_TIMES`].
//!
//! The constants are measured: peak memory and time of 23 runs of all pipelines, rounded up (docs/hardening.md). An estimate is for
//! telling minutes from weeks; what a run really takes is looked at while it runs.

use pxpl5::scene::Scene;
use pxpl5::{KeyValue, Level, Pixels, Plan};

/// What decides on memory and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Work {
    pub(crate) fields: u64,
    pub(crate) gps: u64,
    pub(crate) primitives: u64,
    /// Blocks drawn with one view; 0 where a pipeline has none.
    pub(crate) batch: u64,
    /// Width of a block, pixels; 0 where a pipeline has none.
    pub(crate) block: u64,
    pub(crate) is_cycle_level: bool,
    pub(crate) keeps_everything: bool,
    pub(crate) is_tracked: bool,
    pub(crate) computes_all_pixels: bool,
}

/// What a run is expected to take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Estimate {
    pub(crate) bytes: f64,
    pub(crate) seconds: f64,
}

/// Bytes of the command, of a small machine, and of pictures that are computed in advance.
const BASE: f64 = 15e6;
const PICTURES: f64 = 10e6;
/// Bytes of a graphics processor, of a primitive with its place in all lists, and of a block that waits to be drawn.
const GP: f64 = 60e3;
const PRIMITIVE: f64 = 200.0;
const WAITING: f64 = 5.5e3;
/// Bytes that a field leaves: where everything is kept, a field and each of its blocks; where statistics are kept.
const FIELD: f64 = 4e3;
const COPY: f64 = 350.0;
const STATISTICS: f64 = 10.0;
const BLOCK: f64 = 100.0;
const WINDOW: f64 = 240.0;
/// Bytes that the pixel errors of a field take, and fields of which they are kept one by one.
const ERRORS: f64 = 1e3;
const JUDGED: f64 = 20_971.0;
/// Seconds of the host for a field, and for a graphics processor and a block in it.
const FIELD_S: f64 = 1e-3;
const GP_S: f64 = 30e-6;
const BLOCK_S: f64 = 40e-6;
/// How many times longer a field takes when processors execute instructions.
const CYCLE_TIMES: f64 = 30.0;

/// A field of NTSC, and a word on the ring, nanoseconds; words that go along with a block. Of other displays and rings the same.
const FIELD_NS: u64 = 16_683_333;
const WORD_NS: u64 = 50;
const OVERHEAD_WORDS: u64 = 16;
/// The shortest time between two blocks, nanoseconds: processors send messages for each. Derived: half of 12 us, of two at a time.
const LEAST_BLOCK_NS: u64 = 6_000;

impl Estimate {
    /// Of runs that follow each other on so many threads: the sum of their times, the largest memory on each.
    pub(crate) fn of_all(runs: impl Iterator<Item = Self>, threads: usize) -> Self {
        let threads = threads.max(1) as f64;
        let (bytes, seconds) =
            runs.fold((0.0, 0.0), |(bytes, seconds): (f64, f64), run| (bytes.max(run.bytes), seconds + run.seconds));
        Self { bytes: bytes * threads, seconds: seconds / threads }
    }
}

impl Work {
    /// Of a checked experiment with its scene.
    pub(crate) fn of(plan: &Plan, scene: &Scene, keeps_everything: bool) -> Self {
        let settings = plan.pipeline.settings();
        let whole = |key: &str| match settings.iter().find(|(name, _)| *name == key) {
            Some((_, KeyValue::Whole(value))) => *value,
            _ => 0,
        };
        Self {
            fields: plan.fields,
            gps: plan.machine.n_gps as u64,
            primitives: (scene.triangles().len() + scene.spheres().len()) as u64,
            batch: whole("batch"),
            block: whole("block"),
            is_cycle_level: plan.level == Level::Cycle,
            keeps_everything: keeps_everything || !plan.pipeline.can_forget(),
            is_tracked: plan.head.is_some(),
            computes_all_pixels: plan.pixels == Pixels::All,
        }
    }

    /// Blocks of a field at most.
    fn blocks(&self) -> f64 {
        match self.block {
            0 => 0.0,
            block => (FIELD_NS / (WORD_NS * (block * block + OVERHEAD_WORDS)).max(LEAST_BLOCK_NS)) as f64,
        }
    }

    /// What it takes, by the formula above.
    pub(crate) fn estimate(&self) -> Estimate {
        let fields = self.fields as f64;
        let gps = self.gps as f64;
        let kept = if self.keeps_everything {
            fields * (FIELD + COPY * self.blocks())
        } else {
            fields * STATISTICS + fields.min(WINDOW) * BLOCK * self.blocks()
        };
        let errors = if self.is_tracked { fields.min(JUDGED) * ERRORS } else { 0.0 };
        let pictures = if self.computes_all_pixels { PICTURES } else { 0.0 };
        let lists = PRIMITIVE * self.primitives as f64 + WAITING * self.batch as f64;
        let level = if self.is_cycle_level { CYCLE_TIMES } else { 1.0 };
        Estimate {
            bytes: BASE + pictures + GP * gps + lists + kept + errors,
            seconds: fields * (FIELD_S + GP_S * gps + BLOCK_S * self.blocks()) * level,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: Work = Work {
        fields: 1_200,
        gps: 11,
        primitives: 417,
        batch: 0,
        block: 0,
        is_cycle_level: false,
        keeps_everything: false,
        is_tracked: false,
        computes_all_pixels: false,
    };

    /// Of runs under `/usr/bin/time`: what it was, and MB that the process had at its peak.
    const MEASURED: [(Work, f64); 12] = [
        (SMALL, 13.8),
        (Work { fields: 12_000, keeps_everything: true, ..SMALL }, 61.4),
        (Work { fields: 120, primitives: 1_000_000, ..SMALL }, 195.2),
        (Work { fields: 1_200, gps: 1_000, ..SMALL }, 50.6),
        (Work { fields: 120, block: 16, ..SMALL }, 25.3),
        (Work { fields: 120, block: 16, batch: 65_535, ..SMALL }, 421.0),
        (Work { fields: 120, block: 16, gps: 1_000, ..SMALL }, 130.9),
        (Work { fields: 480, block: 16, primitives: 8, keeps_everything: true, ..SMALL }, 228.9),
        (Work { is_cycle_level: true, ..SMALL }, 18.6),
        (Work { fields: 4_000, gps: 1, primitives: 140, is_tracked: true, ..SMALL }, 20.1),
        (Work { fields: 100_000, gps: 1, primitives: 140, is_tracked: true, ..SMALL }, 42.7),
        (Work { fields: 215_784, gps: 1, primitives: 140, is_tracked: true, ..SMALL }, 47.1),
    ];

    #[test]
    fn many_runs_take_the_sum_of_their_times_and_the_largest_memory_of_each_thread() {
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

    /// Bounds of the same runs on two cores that others used too: the least is a tenth of what they took, the most what they took.
    #[test]
    fn time_is_estimated_between_a_tenth_and_the_double_of_a_busy_computer() {
        for (work, seconds) in [
            (Work { fields: 12_000, ..SMALL }, 47.5),
            (Work { fields: 120, block: 16, ..SMALL }, 7.5),
            (Work { fields: 1_200, gps: 1_000, ..SMALL }, 41.2),
            (Work { is_cycle_level: true, ..SMALL }, 74.8),
        ] {
            let ratio = work.estimate().seconds / seconds;
            assert!((0.1..2.0).contains(&ratio), "{work:?}: {ratio} times {seconds} s");
        }
    }

    #[test]
    fn more_of_anything_takes_more() {
        let least = Work { block: 16, batch: 4, ..SMALL }.estimate();
        for more in [
            Work { fields: 1_201, block: 16, batch: 4, ..SMALL },
            Work { gps: 12, block: 16, batch: 4, ..SMALL },
            Work { block: 8, batch: 4, ..SMALL },
        ] {
            assert!(more.estimate().bytes >= least.bytes && more.estimate().seconds > least.seconds, "{more:?}");
        }
        assert!(Work { block: 16, batch: 5, ..SMALL }.estimate().bytes > least.bytes);
    }
}
