//! The command `pxpl5`: runs experiments on the emulated Pixel-Planes 5, and prints and writes what came of them.
//!
//! Exit codes: 0 when all went well, 1 when something failed, 2 when the command line or an experiment file is wrong.
//! Results go to standard output, everything else to standard error.

#![allow(unreachable_pub, reason = "every module of this binary is a command that may one day be called from outside")]

mod check;
mod compare;
mod completions;
mod demo;
mod error;
mod i860;
mod machines;
mod output;
mod run;
mod scenes;
mod settings;
mod table;
mod terminal;

use clap::{Parser, Subcommand};
use error::CliError;
use std::process::ExitCode;

/// Emulator of Pixel-Planes 5 and its low-latency rendering pipelines.
///
/// Without a command it does what `pxpl5 demo` does.
#[derive(Parser, Debug)]
#[command(name = "pxpl5", version, propagate_version = true, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

const EXAMPLES: &str = "Examples:
  pxpl5                                                     both pipelines at work, pictures in out/
  pxpl5 run --pipeline slats --scene mig --triangles 140    one experiment
  pxpl5 run --pipeline rendering-control --scene bunny.ply --gps 24 --out out/bunny
  pxpl5 run experiments/figure-04.toml --set seed=7 --json

Exit codes: 0 all went well, 1 something failed, 2 the command line or an experiment file is wrong.";

#[derive(Subcommand, Debug)]
enum Command {
    /// Show both pipelines at work on built-in scenes: a table, pictures and report.json.
    Demo(demo::DemoArgs),
    /// Run one experiment.
    Run(run::RunArgs),
    /// Print the effective configuration of an experiment.
    Check(check::CheckArgs),
    /// Compare every way to fight latency in pixels: one scene, head motion and tracker for all pipelines.
    Compare(compare::CompareArgs),
    /// List the built-in scenes.
    Scenes(scenes::ScenesArgs),
    /// List the machines that are built in.
    Machines(machines::MachinesArgs),
    /// Work with programs of the graphics processor's CPU.
    I860(i860::I860Args),
    /// Print a completion script for a shell.
    Completions(completions::CompletionsArgs),
}

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return error::usage(&error),
    };
    match run(cli.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => error.report(),
    }
}

fn run(command: Option<Command>) -> Result<(), CliError> {
    match command {
        None => demo::run(demo::DemoArgs::default()),
        Some(Command::Demo(args)) => demo::run(args),
        Some(Command::Run(args)) => run::run(args),
        Some(Command::Check(args)) => check::run(args),
        Some(Command::Compare(args)) => compare::run(args),
        Some(Command::Scenes(args)) => scenes::run(args),
        Some(Command::Machines(args)) => machines::run(args),
        Some(Command::I860(args)) => i860::run(args).map_err(CliError::failure),
        Some(Command::Completions(args)) => completions::run(args),
    }
}
