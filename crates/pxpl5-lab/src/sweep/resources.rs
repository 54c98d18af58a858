//! Resources of a sweep whose points are divided among the tasks of a job array.

use super::Sweep;

/// Seconds of work in one task. Longer tasks would delay the end of the sweep. Shorter tasks would waste time on their
/// start.
const TASK_S: f64 = 900.0;
/// Maximum number of tasks in an array: Slurm's default (`MaxArraySize` 1001).
const MAX_TASKS: u64 = 1_000;
const SAMPLE: u64 = 300;
/// Seconds to start a task and load its scenes. Assumed.
const START_S: f64 = 60.0;
/// Factor on the estimated time of a task, because Slurm kills a task at its time limit. The points of one pipeline
/// together took at most three times their estimate (docs/guide/sweep-times.md, "What a point costs").
const TIME_MARGIN: f64 = 5.0;
/// Factor on the estimated memory: the maximum measured ratio of used to estimated memory (docs/hardening.md).
const MEMORY_MARGIN: f64 = 2.0;
/// Seconds to merge one row, rounded up (docs/guide/sweep-times.md, "A million points").
const MERGE_ROW_S: f64 = 40e-6;
/// Bytes held for one row during a merge, rounded up (docs/guide/sweep-times.md, "A million points").
const MERGE_ROW_BYTES: f64 = 16.0;
/// Bytes held for the files of one task during a merge, rounded up.
const MERGE_TASK_BYTES: f64 = 32e3;
/// Memory in bytes of the merging process before the first row, rounded up.
const MERGE_BYTES: f64 = 50e6;

/// Estimated cost of the points of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointSample {
    /// Number of points of the sweep.
    pub points: u64,
    /// Mean time to simulate a point, in seconds on one core.
    pub mean_s: f64,
    /// Greatest time of a point, in seconds on one core.
    pub most_s: f64,
    /// Greatest memory of a point, in bytes.
    pub most_bytes: f64,
}

/// Tasks of a job array, and the resources that they request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TaskResources {
    /// Number of tasks.
    pub tasks: u64,
    /// Threads of one task.
    pub threads: u64,
    /// Time limit of one task, in minutes.
    pub minutes: u64,
    /// Memory of one task, in MB of 10^6 bytes.
    pub megabytes: u64,
    /// Time limit of the job that merges the rows, in minutes.
    pub merge_minutes: u64,
    /// Memory of the job that merges the rows, in MB of 10^6 bytes.
    pub merge_megabytes: u64,
}

impl Sweep {
    /// Estimates the cost of points that are spread evenly over the parameter space.
    pub fn sample(&self) -> PointSample {
        let points = self.space().points();
        let chosen: Vec<u64> = spread(points, SAMPLE).collect();
        let estimates = self.estimates(&chosen);
        let seconds = || estimates.iter().map(|estimate| estimate.seconds);
        // The mean determines the time of the sweep, the maximum the limits of a task.
        PointSample {
            points,
            mean_s: seconds().sum::<f64>() / estimates.len().max(1) as f64,
            most_s: seconds().fold(0.0, f64::max),
            most_bytes: estimates.iter().map(|estimate| estimate.bytes).fold(0.0, f64::max),
        }
    }
}

/// Returns at most `most` distinct indices of points, spread evenly over every axis of the sweep. The step between
/// indices is 0.618 times the number of points (golden section). The step is increased until it has no common factor
/// with the number of points, so that no index occurs twice.
fn spread(points: u64, most: u64) -> impl Iterator<Item = u64> {
    let golden = (points as f64 * 0.618_033_988_75) as u64;
    let step = (golden..).find(|step| common_factor(*step, points) == 1).unwrap_or(1);
    (0..points.min(most)).map(move |n| (u128::from(n) * u128::from(step) % u128::from(points.max(1))) as u64)
}

const fn common_factor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { common_factor(b, a % b) }
}

impl TaskResources {
    /// Computes the time and memory to request by these formulas:
    ///
    /// - tasks: `mean_s points / (threads TASK_S)`, rounded up to a number without a common factor with the number of
    ///   points. Every task then has its share of every value of every axis.
    /// - time of a task: `START_S + TIME_MARGIN (mean_s points / (tasks threads) + most_s)`
    /// - memory of a task: `MEMORY_MARGIN threads most_bytes`
    /// - time of the merging job: `START_S + MERGE_ROW_S points`
    /// - memory of the merging job: `MERGE_BYTES + MERGE_ROW_BYTES points + MERGE_TASK_BYTES tasks`
    pub fn of(sample: PointSample, tasks: Option<u64>, threads: u64) -> Self {
        let PointSample { points, mean_s, most_s, most_bytes } = sample;
        let work_s = mean_s * points as f64 / threads as f64;
        let tasks =
            tasks.unwrap_or_else(|| even_tasks((work_s / TASK_S).ceil() as u64, points)).clamp(1, points.max(1));
        let task_s = START_S + TIME_MARGIN * (work_s / tasks as f64 + most_s);
        let merge_s = START_S + MERGE_ROW_S * points as f64;
        let merge_bytes = MERGE_BYTES + MERGE_ROW_BYTES * points as f64 + MERGE_TASK_BYTES * tasks as f64;
        Self {
            tasks,
            threads,
            minutes: (task_s / 60.0).ceil() as u64,
            megabytes: (MEMORY_MARGIN * threads as f64 * most_bytes / 1e6).ceil() as u64,
            merge_minutes: (merge_s / 60.0).ceil() as u64,
            merge_megabytes: (merge_bytes / 1e6).ceil() as u64,
        }
    }
}

/// Returns the smallest number of tasks, at least `wanted`, without a common factor with the number of points. Returns
/// a smaller number if the array would exceed [`MAX_TASKS`].
fn even_tasks(wanted: u64, points: u64) -> u64 {
    let most = MAX_TASKS.min(points).max(1);
    let wanted = wanted.clamp(1, most);
    let is_even = |tasks: &u64| common_factor(*tasks, points) == 1;
    (wanted..=most).find(is_even).or_else(|| (1..wanted).rev().find(is_even)).unwrap_or(wanted)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    const SAMPLED: PointSample = PointSample { points: 20_000, mean_s: 0.9, most_s: 3.0, most_bytes: 40e6 };

    /// Tests the resources of a job array. 20,000 points of 0.9 s take 18,000 s, which is 20 tasks of 900 s on one
    /// thread. The number of tasks must have no common factor with 20,000 = 2^5 5^4, so the next number is 21.
    #[test]
    fn the_resources_of_a_job_array_follow_the_formulas() {
        let one = TaskResources::of(SAMPLED, None, 1);
        // Time 60 + 5 (18,000 / 21 + 3) = 4,361 s; memory 2 x 40 MB. To merge: time 60 + 40e-6 x 20,000 = 60.8 s;
        // memory 50 + 0.32 + 0.67 MB.
        let expected =
            TaskResources { tasks: 21, threads: 1, minutes: 73, megabytes: 80, merge_minutes: 2, merge_megabytes: 51 };
        assert_eq!(one, expected);
        // On four threads, 4,500 s of work are 5 tasks. The next allowed number is 7, which gives 60 + 5 (4,500 / 7 +
        // 3) = 3,289 s.
        let four = TaskResources::of(SAMPLED, None, 4);
        assert_eq!((four.tasks, four.minutes, four.megabytes), (7, 55, 320));
        let resources = TaskResources::of(SAMPLED, Some(10), 1);
        // Ten tasks take 60 + 5 (1,800 + 3) = 9,075 s.
        assert_eq!((resources.tasks, resources.minutes), (10, 152));
    }

    #[test]
    fn an_array_fits_the_limit_of_slurm_and_no_task_is_empty() {
        let million = PointSample { points: 1_000_000, mean_s: 10.0, ..SAMPLED };
        // The formula gives 11,112 tasks. The greatest number below 1,000 without the factors 2 and 5 is 999.
        assert_eq!(TaskResources::of(million, None, 1).tasks, 999);
        assert_eq!(TaskResources::of(PointSample { points: 3, mean_s: 1e4, ..SAMPLED }, None, 1).tasks, 2);
        assert_eq!(TaskResources::of(PointSample { points: 3, ..SAMPLED }, Some(9), 1).tasks, 3);
        assert_eq!(TaskResources::of(PointSample { points: 1, ..SAMPLED }, None, 1).tasks, 1);
    }

    #[test]
    fn sampled_points_are_distinct_and_cover_every_axis_evenly() {
        for points in [1, 2, 7, 300, 301, 4_096, 1_000_000, 9_999_991] {
            let chosen: BTreeSet<u64> = spread(points, SAMPLE).collect();
            assert_eq!(chosen.len() as u64, points.min(SAMPLE), "{points}");
            assert!(chosen.iter().all(|point| *point < points));
        }
        // All axes have 10 values, and the last axis changes fastest.
        for place in [1, 10, 100, 1_000] {
            for value in 0..10 {
                let met = spread(10_000, SAMPLE).filter(|point| point / place % 10 == value).count();
                assert!((24..=36).contains(&met), "{met} of 300 have the value {value} of the axis at {place}");
            }
        }
    }
}
