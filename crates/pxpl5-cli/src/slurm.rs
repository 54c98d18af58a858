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
use pxpl5::sweep::{Sweep, TaskResources};
use pxpl5_sim::figures::filled;
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

/// The scripts with marks, which are replaced by values.
const SCRIPTS: [(&str, &str); 3] = [
    ("array.sh", include_str!("slurm/array.sh.in")),
    ("merge.sh", include_str!("slurm/merge.sh.in")),
    ("submit.sh", include_str!("slurm/submit.sh.in")),
];

/// Writes the scripts, all or none. Their paths are absolute, because Slurm chooses the working directory of a task.
pub(crate) fn write(sweep: &Sweep, jobs: &Jobs, folder: &Path) -> Result<Written, CliError> {
    let sample = sweep.sample();
    let resources = TaskResources::of(sample, jobs.tasks, jobs.threads);
    let absolute = |path: &Path| {
        let found = std::path::absolute(path);
        let found = found.map_err(|error| CliError::failure(format!("{}: {error}", path.display())))?;
        Ok::<_, CliError>(quoted(&found.display().to_string()))
    };
    let command = std::env::current_exe();
    let command = command.map_err(|error| CliError::failure(format!("the path of this command: {error}")))?;
    let marks = [
        ("made", format!("# Written by pxpl5 {LONG_VERSION} (pxpl5 sweep --slurm).")),
        ("points", sample.points.to_string()),
        ("mean_s", format!("{:.3}", sample.mean_s)),
        ("most_s", format!("{:.3}", sample.most_s)),
        ("most_mb", format!("{:.0}", sample.most_bytes / 1e6)),
        ("tasks", resources.tasks.to_string()),
        ("threads", resources.threads.to_string()),
        ("minutes", resources.minutes.to_string()),
        ("megabytes", resources.megabytes.to_string()),
        ("merge_minutes", resources.merge_minutes.to_string()),
        ("merge_megabytes", resources.merge_megabytes.to_string()),
        ("busy", BUSY.to_string()),
        // Paths and settings come last, because they may hold marks of their own.
        ("command", absolute(&command)?),
        ("here", absolute(Path::new("."))?),
        ("out", absolute(jobs.out)?),
        ("file", absolute(jobs.file)?),
        ("sets", jobs.sets.iter().map(|set| format!(" --set {}", quoted(set))).collect()),
    ];
    let mut output = OutputFolder::open(folder, "--slurm")?;
    for (name, text) in SCRIPTS {
        output.put(name, filled(text, &marks).as_bytes())?;
    }
    output.commit()?;
    Ok(Written { resources, submit: folder.join("submit.sh") })
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
