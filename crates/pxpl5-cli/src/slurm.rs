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
//! space ([`TaskResources`]).

use crate::error::{BUSY, CliError};
use crate::numbers::count_of;
use crate::output::OutputFolder;
use crate::version::LONG_VERSION;
use pxpl5::sweep::{PointSample, Sweep, TaskResources};
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

#[derive(Debug)]
pub(crate) struct Written {
    resources: TaskResources,
    submit: PathBuf,
}

impl Written {
    pub(crate) fn text(&self) -> String {
        let TaskResources { tasks, threads, minutes, megabytes, .. } = self.resources;
        format!(
            "{} of {}, each at most {minutes} min and {megabytes} MB. To submit them:\n  bash {}\n",
            count_of(tasks, "task"),
            count_of(threads, "thread"),
            quoted(&self.submit.display().to_string())
        )
    }
}

pub(crate) fn write(sweep: &Sweep, jobs: &Jobs, folder: &Path) -> Result<Written, CliError> {
    let sample = sweep.sample();
    let resources = TaskResources::of(sample, jobs.tasks, jobs.threads);
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
    fn of(jobs: &Jobs, sample: PointSample, resources: TaskResources) -> Result<Self, CliError> {
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
        let TaskResources { tasks, threads, minutes, megabytes, merge_minutes, merge_megabytes } = resources;
        let PointSample { points, mean_s, most_s, most_bytes } = sample;
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

    #[test]
    fn arguments_pass_through_a_shell_unchanged() {
        assert_eq!(quoted("a/b-1.toml"), "a/b-1.toml");
        assert_eq!(quoted("it's $HOME"), "'it'\\''s $HOME'");
        assert_eq!(quoted(""), "''");
    }
}
