//! The option `pxpl5 sweep --slurm`, which writes scripts that run a sweep as jobs of Slurm. The option itself neither
//! runs nor submits jobs.
//!
//! ```text
//!  submit.sh --> array.sh   task I of N: pxpl5 sweep --shard I/N --resume, into OUT/shard-I
//!           `--> merge.sh   when all tasks have ended: pxpl5 merge OUT/shard-* --out OUT
//! ```
//!
//! Slurm restarts a task whose node was lost. The restarted task keeps the rows that the lost task has written. If the
//! lost task still runs on a node that does not answer, the restarted task waits. Two processes must not write into one
//! folder.
//!
//! The requested time and memory are estimated from a sample of points, which are spread evenly over the parameter
//! space ([`Resources`]).

use crate::error::{BUSY, CliError};
use crate::estimate::Estimate;
use crate::numbers::count_of;
use crate::output::OutputFolder;
use crate::version::LONG_VERSION;
use pxpl5::sweep::Sweep;
use std::path::{Path, PathBuf};

/// A sweep's inputs, outputs and division into tasks of Slurm.
#[derive(Clone, Debug)]
pub(crate) struct Jobs<'a> {
    pub(crate) file: &'a Path,
    /// Settings shared by all points of the sweep, as `path=value`.
    pub(crate) sets: &'a [String],
    pub(crate) out: &'a Path,
    /// Number of tasks in the Slurm array. `None` computes the number from the estimated work.
    pub(crate) tasks: Option<u64>,
    pub(crate) threads: u64,
}

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

#[derive(Clone, Copy, Debug, PartialEq)]
struct Sample {
    points: u64,
    /// Mean time to simulate a point, in seconds on one core.
    mean_s: f64,
    most_s: f64,
    most_bytes: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Resources {
    tasks: u64,
    threads: u64,
    /// Time limit of one task in minutes. Members with the prefix `merge` belong to the job that merges the rows.
    minutes: u64,
    megabytes: u64,
    merge_minutes: u64,
    merge_megabytes: u64,
}

impl Sample {
    fn of(sweep: &Sweep) -> Self {
        let points = sweep.space().points();
        let chosen: Vec<u64> = spread(points, SAMPLE).collect();
        let estimates = sweep.estimates(&chosen);
        let seconds = || estimates.iter().map(|estimate| estimate.seconds);
        // The mean determines the time of the sweep, the maximum the limits of a task.
        Self {
            points,
            mean_s: seconds().sum::<f64>() / estimates.len().max(1) as f64,
            most_s: seconds().fold(0.0, f64::max),
            most_bytes: estimates.iter().map(|estimate| estimate.bytes).fold(0.0, f64::max),
        }
    }

    fn whole(self, threads: usize) -> Estimate {
        let threads = threads.max(1) as f64;
        Estimate { bytes: self.most_bytes * threads, seconds: self.mean_s * self.points as f64 / threads }
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

pub(crate) fn estimate(sweep: &Sweep, threads: usize) -> Estimate {
    Sample::of(sweep).whole(threads)
}

impl Resources {
    /// Computes the time and memory to request by these formulas:
    ///
    /// - tasks: `mean_s points / (threads TASK_S)`, rounded up to a number without a common factor with the number of
    ///   points. Every task then has its share of every value of every axis.
    /// - time of a task: `START_S + TIME_MARGIN (mean_s points / (tasks threads) + most_s)`
    /// - memory of a task: `MEMORY_MARGIN threads most_bytes`
    /// - time of the merging job: `START_S + MERGE_ROW_S points`
    /// - memory of the merging job: `MERGE_BYTES + MERGE_ROW_BYTES points + MERGE_TASK_BYTES tasks`
    fn of(sample: Sample, tasks: Option<u64>, threads: u64) -> Self {
        let Sample { points, mean_s, most_s, most_bytes } = sample;
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

#[derive(Debug)]
pub(crate) struct Written {
    resources: Resources,
    submit: PathBuf,
}

impl Written {
    pub(crate) fn text(&self) -> String {
        let Resources { tasks, threads, minutes, megabytes, .. } = self.resources;
        format!(
            "{} of {}, each at most {minutes} min and {megabytes} MB. To submit them:\n  bash {}\n",
            count_of(tasks, "task"),
            count_of(threads, "thread"),
            quoted(&self.submit.display().to_string())
        )
    }
}

pub(crate) fn write(sweep: &Sweep, jobs: &Jobs, folder: &Path) -> Result<Written, CliError> {
    let sample = Sample::of(sweep);
    let resources = Resources::of(sample, jobs.tasks, jobs.threads);
    let scripts = Scripts::of(jobs, sample, resources)?;
    let mut output = OutputFolder::open(folder, "--slurm")?;
    // All three scripts appear together, or none.
    for (name, text) in [("array.sh", &scripts.array), ("merge.sh", &scripts.merge), ("submit.sh", &scripts.submit)] {
        output.put(name, text.as_bytes())?;
    }
    output.commit()?;
    Ok(Written { resources, submit: folder.join("submit.sh") })
}

struct Scripts {
    array: String,
    merge: String,
    submit: String,
}

impl Scripts {
    /// Builds the scripts with absolute paths, because Slurm chooses the working directory of a task.
    fn of(jobs: &Jobs, sample: Sample, resources: Resources) -> Result<Self, CliError> {
        // Relative paths would depend on the folder in which Slurm starts a task.
        let absolute = |path: &Path| {
            let found = std::path::absolute(path);
            let found = found.map_err(|error| CliError::failure(format!("{}: {error}", path.display())))?;
            Ok::<_, CliError>(quoted(&found.display().to_string()))
        };
        let command = std::env::current_exe();
        let command = command.map_err(|error| CliError::failure(format!("the path of this command: {error}")))?;
        let (command, file, out) = (absolute(&command)?, absolute(jobs.file)?, absolute(jobs.out)?);
        let here = absolute(Path::new("."))?;
        let sets: String = jobs.sets.iter().map(|set| format!(" --set {}", quoted(set))).collect();
        // The command is the executable of this process; PXPL5 in the environment of a job overrides the path.
        let Resources { tasks, threads, minutes, megabytes, merge_minutes, merge_megabytes } = resources;
        let Sample { points, mean_s, most_s, most_bytes } = sample;
        let made = format!("# Written by pxpl5 {LONG_VERSION} (pxpl5 sweep --slurm).");
        // Each task runs one shard, and retries while a lost copy of itself still holds the folder.
        let array = format!(
            "#!/bin/bash
{made}
# {points} points, estimated: {mean_s:.3} s each, {most_s:.3} s and {:.0} MB at most.
#SBATCH --job-name=pxpl5-sweep
#SBATCH --array=1-{tasks}
#SBATCH --cpus-per-task={threads}
#SBATCH --time={minutes}
#SBATCH --mem={megabytes}M
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=array-%a.log
set -u
pxpl5=${{PXPL5:-{command}}}
out={out}
# Paths in --set count from the folder in which the sweep was prepared.
cd {here} || exit
# Exit code {BUSY}: another process writes into the shard. It is an earlier start of this task, on a node that was lost but still runs.
while :; do
    \"$pxpl5\" sweep {file}{sets} --out \"$out/shard-$SLURM_ARRAY_TASK_ID\" --shard \"$SLURM_ARRAY_TASK_ID/{tasks}\" \\
        --threads {threads} --resume --quiet
    status=$?
    [ \"$status\" -eq {BUSY} ] || exit \"$status\"
    sleep 5
done
",
            most_bytes / 1e6
        );
        // The merge job reads the shards of all tasks.
        let merge = format!(
            "#!/bin/bash
{made}
#SBATCH --job-name=pxpl5-merge
#SBATCH --time={merge_minutes}
#SBATCH --mem={merge_megabytes}M
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=merge.log
set -eu
pxpl5=${{PXPL5:-{command}}}
out={out}
\"$pxpl5\" merge \"$out\"/shard-* --out \"$out\"
"
        );
        // The user calls this script; it submits both jobs with a dependency.
        let submit = format!(
            "#!/bin/bash
{made}
# Submits the array, and the merging for when all its tasks have ended; options are handed on to sbatch (--partition, --account).
# May be called again: finished points are kept.
set -eu
cd \"$(dirname \"$0\")\"
array=$(sbatch --parsable \"$@\" array.sh)
array=${{array%%;*}}
merge=$(sbatch --parsable --dependency=\"afterany:$array\" \"$@\" merge.sh)
echo \"array $array, merging ${{merge%%;*}}\"
"
        );
        Ok(Self { array, merge, submit })
    }
}

/// Quotes a word so that a shell reads it as one argument.
pub(crate) fn quoted(word: &str) -> String {
    let is_plain = word.chars().all(|c| c.is_alphanumeric() || "-_./=:,".contains(c)) && !word.is_empty();
    if is_plain { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    const SAMPLED: Sample = Sample { points: 20_000, mean_s: 0.9, most_s: 3.0, most_bytes: 40e6 };

    /// Tests the resources of a job array. 20,000 points of 0.9 s take 18,000 s, which is 20 tasks of 900 s on one
    /// thread. The number of tasks must have no common factor with 20,000 = 2^5 5^4, so the next number is 21.
    #[test]
    fn the_resources_of_a_job_array_follow_the_formulas() {
        let one = Resources::of(SAMPLED, None, 1);
        // Time 60 + 5 (18,000 / 21 + 3) = 4,361 s; memory 2 x 40 MB. To merge: time 60 + 40e-6 x 20,000 = 60.8 s;
        // memory 50 + 0.32 + 0.67 MB.
        let expected =
            Resources { tasks: 21, threads: 1, minutes: 73, megabytes: 80, merge_minutes: 2, merge_megabytes: 51 };
        assert_eq!(one, expected);
        // On four threads, 4,500 s of work are 5 tasks. The next allowed number is 7, which gives 60 + 5 (4,500 / 7 +
        // 3) = 3,289 s.
        let four = Resources::of(SAMPLED, None, 4);
        assert_eq!((four.tasks, four.minutes, four.megabytes), (7, 55, 320));
        let resources = Resources::of(SAMPLED, Some(10), 1);
        // Ten tasks take 60 + 5 (1,800 + 3) = 9,075 s.
        assert_eq!((resources.tasks, resources.minutes), (10, 152));
    }

    #[test]
    fn an_array_fits_the_limit_of_slurm_and_no_task_is_empty() {
        let million = Sample { points: 1_000_000, mean_s: 10.0, ..SAMPLED };
        // The formula gives 11,112 tasks. The greatest number below 1,000 without the factors 2 and 5 is 999.
        assert_eq!(Resources::of(million, None, 1).tasks, 999);
        assert_eq!(Resources::of(Sample { points: 3, mean_s: 1e4, ..SAMPLED }, None, 1).tasks, 2);
        assert_eq!(Resources::of(Sample { points: 3, ..SAMPLED }, Some(9), 1).tasks, 3);
        assert_eq!(Resources::of(Sample { points: 1, ..SAMPLED }, None, 1).tasks, 1);
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

    #[test]
    fn arguments_pass_through_a_shell_unchanged() {
        assert_eq!(quoted("a/b-1.toml"), "a/b-1.toml");
        assert_eq!(quoted("it's $HOME"), "'it'\\''s $HOME'");
        assert_eq!(quoted(""), "''");
    }
}
