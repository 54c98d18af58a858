//! `pxpl5 sweep --slurm`: a sweep as jobs of Slurm. Nothing is run or submitted here.
//!
//! ```text
//!  submit.sh --> array.sh   task I of N: pxpl5 sweep --shard I/N --resume, into OUT/shard-I
//!           `--> merge.sh   when all tasks have ended: pxpl5 merge OUT/shard-* --out OUT
//! ```
//!
//! A task that Slurm starts again, because its node was lost, goes on with the rows that it finds. Where the one before it still lives,
//! on a node that does not answer, it waits until that is gone: two would write into one folder.
//!
//! Time and memory that are asked for follow from estimates of points that lie evenly in the space ([`Resources`]).

use crate::error::{BUSY, CliError};
use crate::estimate::Estimate;
use crate::numbers::count_of;
use crate::output::OutputFolder;
use pxpl5::sweep::Sweep;
use std::path::{Path, PathBuf};

/// Where a sweep is, and how it is to be cut.
#[derive(Clone, Debug)]
pub(crate) struct Jobs<'a> {
    /// The experiment file.
    pub(crate) file: &'a Path,
    /// Settings for all points.
    pub(crate) sets: &'a [String],
    /// Where the rows go.
    pub(crate) out: &'a Path,
    /// Tasks of the array; by the estimate where nothing is said.
    pub(crate) tasks: Option<u64>,
    /// Points at a time in a task.
    pub(crate) threads: u64,
}

/// Seconds of work that a task is given: far above what starting it costs, far below what waiting for the last one may cost.
const TASK_S: f64 = 900.0;
/// Most tasks of an array, as Slurm has it where its configuration says nothing (`MaxArraySize` 1001).
const MOST_TASKS: u64 = 1_000;
/// Points that are estimated.
const SAMPLE: u64 = 300;
/// Seconds to start a task and to load its scenes. Assumed.
const START_S: f64 = 60.0;
/// How much slower a node, and dearer its points, may be than estimated: a task that hits its limit is killed. Points of a pipeline together took at most
/// three times their estimate (docs/sweeps.md, "What a point costs").
const TIME_MARGIN: f64 = 5.0;
/// How far estimates of memory are off at most (docs/hardening.md).
const MEMORY_MARGIN: f64 = 2.0;
/// Seconds that merging takes for a row, and bytes that it holds of one, with as much for the tasks' files; rounded up (docs/sweeps.md, "A million points").
const MERGE_ROW_S: f64 = 40e-6;
const MERGE_ROW_BYTES: f64 = 16.0;
const MERGE_TASK_BYTES: f64 = 32e3;
const MERGE_BYTES: f64 = 50e6;

/// What some points of a sweep are estimated to take.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sample {
    /// Points of the sweep.
    points: u64,
    /// Seconds of a point on one core: in the mean, and the most.
    mean_s: f64,
    most_s: f64,
    /// Bytes of the greatest point.
    most_bytes: f64,
}

/// What is asked of Slurm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Resources {
    tasks: u64,
    threads: u64,
    /// For each task, and for the merging.
    minutes: u64,
    megabytes: u64,
    merge_minutes: u64,
    merge_megabytes: u64,
}

impl Sample {
    /// Of points that lie evenly in the space.
    fn of(sweep: &Sweep) -> Self {
        let points = sweep.space().points();
        let chosen: Vec<u64> = spread(points, SAMPLE).collect();
        let estimates = sweep.estimates(&chosen);
        let seconds = || estimates.iter().map(|estimate| estimate.seconds);
        Self {
            points,
            mean_s: seconds().sum::<f64>() / estimates.len().max(1) as f64,
            most_s: seconds().fold(0.0, f64::max),
            most_bytes: estimates.iter().map(|estimate| estimate.bytes).fold(0.0, f64::max),
        }
    }

    /// The whole sweep on so many threads.
    fn whole(self, threads: usize) -> Estimate {
        let threads = threads.max(1) as f64;
        Estimate { bytes: self.most_bytes * threads, seconds: self.mean_s * self.points as f64 / threads }
    }
}

/// Numbers of some points, each once, that lie evenly in every axis: steps of the golden section of the whole, which have no factor in common with it.
fn spread(points: u64, most: u64) -> impl Iterator<Item = u64> {
    let golden = (points as f64 * 0.618_033_988_75) as u64;
    let step = (golden..).find(|step| common_factor(*step, points) == 1).unwrap_or(1);
    (0..points.min(most)).map(move |n| (u128::from(n) * u128::from(step) % u128::from(points.max(1))) as u64)
}

/// The greatest number that divides both; 1 for 0 and 1.
const fn common_factor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { common_factor(b, a % b) }
}

/// What a sweep is estimated to take on so many threads, by points that lie evenly in its space.
pub(crate) fn estimate(sweep: &Sweep, threads: usize) -> Estimate {
    Sample::of(sweep).whole(threads)
}

impl Resources {
    /// By the formulas
    ///
    /// - tasks: `mean_s points / (threads TASK_S)`, rounded up to a number without a factor in common with the points, so that every
    ///   task has its share of every value of every axis;
    /// - time of a task: `START_S + TIME_MARGIN (mean_s points / (tasks threads) + most_s)`;
    /// - memory of a task: `MEMORY_MARGIN threads most_bytes`;
    /// - merging: `START_S + MERGE_ROW_S points`, `MERGE_BYTES + MERGE_ROW_BYTES points + MERGE_TASK_BYTES tasks`.
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

/// The next number of tasks from `wanted` on that has no factor in common with the points, at most what an array takes.
fn even_tasks(wanted: u64, points: u64) -> u64 {
    let most = MOST_TASKS.min(points).max(1);
    let wanted = wanted.clamp(1, most);
    let is_even = |tasks: &u64| common_factor(*tasks, points) == 1;
    (wanted..=most).find(is_even).or_else(|| (1..wanted).rev().find(is_even)).unwrap_or(wanted)
}

/// What was written.
#[derive(Debug)]
pub(crate) struct Written {
    resources: Resources,
    submit: PathBuf,
}

impl Written {
    /// What to tell about it.
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

/// Writes the three scripts into a folder.
///
/// # Errors
///
/// When the folder cannot be written.
pub(crate) fn write(sweep: &Sweep, jobs: &Jobs, folder: &Path) -> Result<Written, CliError> {
    let sample = Sample::of(sweep);
    let resources = Resources::of(sample, jobs.tasks, jobs.threads);
    let scripts = Scripts::of(jobs, sample, resources)?;
    let mut output = OutputFolder::open(folder, "--slurm")?;
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
    /// Paths in them are absolute: a task begins wherever Slurm likes.
    fn of(jobs: &Jobs, sample: Sample, resources: Resources) -> Result<Self, CliError> {
        let absolute = |path: &Path| {
            let found = std::path::absolute(path);
            let found = found.map_err(|error| CliError::failure(format!("{}: {error}", path.display())))?;
            Ok::<_, CliError>(quoted(&found.display().to_string()))
        };
        let command = std::env::current_exe();
        let command = command.map_err(|error| CliError::failure(format!("the path of this command: {error}")))?;
        let (command, file, out) = (absolute(&command)?, absolute(jobs.file)?, absolute(jobs.out)?);
        let sets: String = jobs.sets.iter().map(|set| format!(" --set {}", quoted(set))).collect();
        let Resources { tasks, threads, minutes, megabytes, merge_minutes, merge_megabytes } = resources;
        let Sample { points, mean_s, most_s, most_bytes } = sample;
        let made = format!("# Written by pxpl5 {} (pxpl5 sweep --slurm).", env!("CARGO_PKG_VERSION"));
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
# Exit code {BUSY}: another process writes into the shard. It is this task from before, on a node that was lost and still works.
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

/// A word as a shell takes it.
pub(crate) fn quoted(word: &str) -> String {
    let is_plain = word.chars().all(|c| c.is_alphanumeric() || "-_./=:,".contains(c)) && !word.is_empty();
    if is_plain { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    const SAMPLED: Sample = Sample { points: 20_000, mean_s: 0.9, most_s: 3.0, most_bytes: 40e6 };

    /// 20,000 points of 0.9 s are 18,000 s: on one thread 20 tasks of 900 s; 21 is the next number that 20,000 = 2^5 5^4 has no factor of.
    #[test]
    fn resources_follow_the_formulas() {
        let one = Resources::of(SAMPLED, None, 1);
        // 60 + 5 (18,000 / 21 + 3) = 4,361 s; 2 x 40 MB; 60 + 40e-6 x 20,000 = 60.8 s; 50 + 0.32 + 0.67 MB.
        let expected =
            Resources { tasks: 21, threads: 1, minutes: 73, megabytes: 80, merge_minutes: 2, merge_megabytes: 51 };
        assert_eq!(one, expected);
        // Four threads: 4,500 s of work are 5 tasks, and 7 is the next number; 60 + 5 (4,500 / 7 + 3) = 3,289 s.
        let four = Resources::of(SAMPLED, None, 4);
        assert_eq!((four.tasks, four.minutes, four.megabytes), (7, 55, 320));
        let said = Resources::of(SAMPLED, Some(10), 1);
        // 60 + 5 (1,800 + 3) = 9,075 s.
        assert_eq!((said.tasks, said.minutes), (10, 152));
    }

    #[test]
    fn an_array_is_no_longer_than_slurm_takes_and_no_task_is_empty() {
        let million = Sample { points: 1_000_000, mean_s: 10.0, ..SAMPLED };
        // 11,112 tasks were wanted; 999 is the greatest number below 1,000 without the factors 2 and 5.
        assert_eq!(Resources::of(million, None, 1).tasks, 999);
        assert_eq!(Resources::of(Sample { points: 3, mean_s: 1e4, ..SAMPLED }, None, 1).tasks, 2);
        assert_eq!(Resources::of(Sample { points: 3, ..SAMPLED }, Some(9), 1).tasks, 3);
        assert_eq!(Resources::of(Sample { points: 1, ..SAMPLED }, None, 1).tasks, 1);
    }

    #[test]
    fn sampled_points_are_each_once_and_meet_every_value_of_every_axis_evenly() {
        for points in [1, 2, 7, 300, 301, 4_096, 1_000_000, 9_999_991] {
            let chosen: BTreeSet<u64> = spread(points, SAMPLE).collect();
            assert_eq!(chosen.len() as u64, points.min(SAMPLE), "{points}");
            assert!(chosen.iter().all(|point| *point < points));
        }
        // Axes of 10, the last of which changes fastest.
        for place in [1, 10, 100, 1_000] {
            for value in 0..10 {
                let met = spread(10_000, SAMPLE).filter(|point| point / place % 10 == value).count();
                assert!((24..=36).contains(&met), "{met} of 300 have the value {value} of the axis at {place}");
            }
        }
    }

    #[test]
    fn words_go_through_a_shell_as_they_are() {
        assert_eq!(quoted("a/b-1.toml"), "a/b-1.toml");
        assert_eq!(quoted("it's $HOME"), "'it'\\''s $HOME'");
        assert_eq!(quoted(""), "''");
    }
}
