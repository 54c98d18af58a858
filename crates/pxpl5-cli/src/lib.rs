//! The command `pxpl5`, which runs experiments on the emulated Pixel-Planes 5 and reports the results.
//!
//! A binary with its own pipelines or displays calls [`main`] with a registry of its own. `docs/guide/own-pipeline.md`
//! has a complete example.
//!
//! Exit codes:
//!
//! - 0: success
//! - 1: failure
//! - 2: wrong command line or file
//! - 75: another process is writing into the folder of a sweep
//!
//! Results go to standard output, all other messages to standard error.

mod arp;
mod budget;
mod check;
mod cite;
mod compare;
mod completions;
mod debug;
mod demo;
mod diff;
mod error;
mod figures;
mod film;
mod i860;
mod interpretations;
mod interrupt;
mod levels;
mod limit;
mod machines;
mod merge;
mod numbers;
mod one_picture;
mod options;
mod output;
mod plot;
mod progress;
mod report;
mod rig;
mod rows;
mod run;
mod scenes;
mod settings;
mod simulate;
mod slurm;
mod sweep;
mod table;
mod terminal;
mod too_heavy;
mod trace;
mod version;
mod volume;

/// The emulator, re-exported so that a crate with its own pipelines needs no other dependency.
pub use pxpl5;

pub use error::CliError as CommandError;

use clap::{Parser, Subcommand};
use error::CliError;
use pxpl5::Registry;
use std::ffi::OsString;
use std::process::ExitCode;
use std::sync::Arc;

/// Emulator of Pixel-Planes 5 and its low-latency rendering pipelines.
///
/// Without a command, pxpl5 runs `pxpl5 demo`.
#[derive(Parser, Debug)]
#[command(name = "pxpl5", version = version::LONG_VERSION, propagate_version = true, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

const EXAMPLES: &str = "Examples:
  pxpl5                                                     Rendering Control and Slats, pictures in out/
  pxpl5 run --pipeline slats --scene mig --triangles 140    one experiment
  pxpl5 run --pipeline rendering-control --scene bunny.ply --gps 24 --out out/bunny
  pxpl5 run experiments/figure-04.toml --set seed=7 --json

Exit codes: 0 success, 1 failure, 2 wrong command line or file, 75 another process writes to the folder,\n130 Ctrl-C.";

#[derive(Subcommand, Debug)]
enum Command {
    /// Show Rendering Control and Slats on built-in scenes: a table, pictures, timelines and report.json.
    Demo(demo::DemoArgs),
    /// Run one experiment and print its report.
    Run(run::RunArgs),
    /// Print the effective configuration of an experiment.
    Check(check::CheckArgs),
    /// Compare the pixel errors of all pipelines for one scene, head motion and tracker.
    Compare(compare::CompareArgs),
    /// Simulate every published figure, and compare the result with the published value.
    Figures(figures::FiguresArgs),
    Interpretations(interpretations::InterpretationsArgs),
    /// Find the largest number of triangles that a pipeline draws in time.
    Limit(limit::LimitArgs),
    /// Compare the levels of modelling: speed against error.
    Levels(levels::LevelsArgs),
    /// List the built-in scenes.
    Scenes(scenes::ScenesArgs),
    /// List the built-in machines.
    Machines(machines::MachinesArgs),
    /// Run an experiment at every point of a parameter space.
    Sweep(sweep::SweepArgs),
    /// Join the shards of a sweep.
    Merge(merge::MergeArgs),
    /// Plot the results of a sweep or a comparison with intervals: SVG, PNG or PDF, and the numbers as CSV.
    Plot(plot::PlotArgs),
    /// Measure the latency of a pipeline from outside with a pendulum and photodiodes.
    Rig(rig::RigArgs),
    /// Compare two results: settings, numbers and pictures.
    Diff(diff::DiffArgs),
    /// Write one HTML page with the results of a folder.
    Report(report::ReportArgs),
    /// Run one experiment and write a trace of all events.
    Trace(trace::TraceArgs),
    /// Run one experiment step by step and inspect its boards.
    Debug(debug::DebugArgs),
    /// Write a viewer's picture as an animated PNG.
    Film(film::FilmArgs),
    /// Draw a scene as slices of a spinning volumetric display.
    Volume(volume::VolumeArgs),
    /// Walk through a scene with a display that follows the head's rotation.
    Arp(arp::ArpArgs),
    /// Assemble, disassemble and run programs of the graphics processor's CPU.
    I860(i860::I860Args),
    /// Print how to cite this software, and the papers about the machine and its pipelines.
    Cite(cite::CiteArgs),
    /// Print a completion script for a shell.
    Completions(completions::CompletionsArgs),
}

/// Runs the command line of this process with the pipelines and displays of `registry`, and returns the exit code.
pub fn main(registry: Arc<Registry>) -> ExitCode {
    ExitCode::from(run_arguments(registry, std::env::args_os()))
}

/// Runs a command line with the pipelines and displays of `registry`, and returns the exit code. The first argument is
/// the name of the program.
///
/// The first call in a process determines the registry for all later calls.
pub fn run_arguments(registry: Arc<Registry>, arguments: impl IntoIterator<Item = OsString>) -> u8 {
    version::state_commit();
    // The options of pipelines must be known before clap builds the command line.
    options::know(registry);
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(error) => return error::usage(&error),
    };
    interrupt::listen();
    match run(cli.command) {
        // A study that was interrupted printed the finished part of its result.
        Ok(()) if interrupt::flag().is_stopped() => error::INTERRUPTED,
        Ok(()) => 0,
        Err(error) => {
            terminal::print_error(&format!("pxpl5: {}\n", error.message()));
            error.exit_code()
        }
    }
}

/// Runs a command line like [`run_arguments`], but returns an error instead of printing it to standard error.
///
/// # Errors
///
/// Returns [`CommandError`] for a wrong command line, and for a command that fails.
pub fn try_arguments(
    registry: Arc<Registry>,
    arguments: impl IntoIterator<Item = OsString>,
) -> Result<(), CommandError> {
    options::know(registry);
    let cli = Cli::try_parse_from(arguments).map_err(CliError::usage)?;
    run(cli.command)
}

fn run(command: Option<Command>) -> Result<(), CliError> {
    // Each subcommand is a module with its own arguments.
    match command {
        None => demo::run(demo::DemoArgs::default()),
        Some(Command::Demo(args)) => demo::run(args),
        Some(Command::Run(args)) => run::run(args),
        Some(Command::Check(args)) => check::run(args),
        Some(Command::Compare(args)) => compare::run(args),
        Some(Command::Figures(args)) => figures::run(args),
        Some(Command::Interpretations(args)) => interpretations::run(args),
        Some(Command::Limit(args)) => limit::run(args),
        Some(Command::Levels(args)) => levels::run(args),
        Some(Command::Scenes(args)) => scenes::run(args),
        Some(Command::Machines(args)) => machines::run(args),
        Some(Command::Sweep(args)) => sweep::run(args),
        Some(Command::Merge(args)) => merge::run(args),
        Some(Command::Plot(args)) => plot::run(args),
        Some(Command::Rig(args)) => rig::run(args),
        Some(Command::Diff(args)) => diff::run(args),
        Some(Command::Report(args)) => report::run(args),
        Some(Command::Trace(args)) => trace::run(args),
        Some(Command::Debug(args)) => debug::run(args),
        Some(Command::Film(args)) => film::run(args),
        Some(Command::Volume(args)) => volume::run(args),
        Some(Command::Arp(args)) => arp::run(args),
        Some(Command::I860(args)) => i860::run(args),
        Some(Command::Cite(args)) => cite::run(args),
        Some(Command::Completions(args)) => completions::run(args),
    }
}

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    /// Returns the command lines in a text that begin with `pxpl5`, also after a prompt, each split into words. A
    /// backslash at the end of a line joins the line with the next line.
    fn commands(text: &str) -> Vec<Vec<String>> {
        let joined = text.split("\\\n").map(str::trim).collect::<Vec<_>>().join(" ");
        let lines = joined.lines().map(|line| line.trim().trim_start_matches("$ "));
        lines.filter(|line| line.starts_with("pxpl5 ")).map(words).collect()
    }

    /// Splits a command line into words. Removes quotes, comments, redirections, and an explanation after three spaces.
    fn words(line: &str) -> Vec<String> {
        let line = line.split(['#', '>']).next().unwrap_or_default();
        // Help texts separate an explanation by three spaces.
        let line = line.split("   ").next().unwrap_or_default().replace("$SLURM_ARRAY_TASK_ID", "1");
        let mut is_quoted = false;
        let ends = |sign: char| {
            is_quoted ^= sign == '"' || sign == '\'';
            sign == ' ' && !is_quoted
        };
        line.split(ends).map(|word| word.replace(['"', '\''], "")).filter(|word| !word.is_empty()).collect()
    }

    fn parses(text: &str) -> usize {
        let commands = commands(text);
        for words in &commands {
            if let Err(error) = Cli::try_parse_from(words) {
                assert_eq!(error.kind(), clap::error::ErrorKind::DisplayHelp, "{words:?}: {error}");
            }
        }
        commands.len()
    }

    #[test]
    fn every_command_in_the_help_texts_is_accepted() {
        let mut command = Cli::command();
        let mut found = parses(&command.render_long_help().to_string());
        for sub in command.get_subcommands_mut() {
            found += parses(&sub.render_long_help().to_string());
        }
        assert!(found > 20, "found {found}");
    }

    /// Documents whose commands are checked, each with at least one.
    const DOCUMENTS: &str = "README.md docs/decisions.md docs/faces.md docs/reprojection.md docs/results.md \
        docs/sweeps.md docs/volumetric-variants.md docs/guide/address-recalculation.md \
        docs/guide/assembler.md docs/guide/clusters.md docs/guide/compare.md docs/guide/counted-pictures.md \
        docs/guide/experiment-files.md docs/guide/figures.md docs/guide/first-run.md docs/guide/head-to-light.md \
        docs/guide/latency.md docs/guide/machine.md docs/guide/motion.md docs/guide/own-display.md \
        docs/guide/own-model.md docs/guide/pipelines.md docs/guide/trackers.md";

    #[test]
    fn every_command_in_the_documents_is_accepted() {
        let read = |name| std::fs::read_to_string(format!("{}/../../{name}", env!("CARGO_MANIFEST_DIR"))).expect(name);
        let found: Vec<usize> = DOCUMENTS.split_whitespace().map(|name| parses(&read(name))).collect();
        assert!(found.iter().all(|count| *count > 0) && found.iter().sum::<usize>() > 50, "found {found:?}");
    }

    #[test]
    fn the_definition_of_the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
