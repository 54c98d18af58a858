//! The command `pxpl5 debug`, an interactive debugger that stops a run and shows the state of all boards.

mod command;
mod condition;
mod pixels;
#[cfg(feature = "screen")]
mod screen;
mod session;
mod views;
mod words;

use crate::budget::BudgetArgs;
use crate::error::CliError;
use crate::scenes;
use crate::settings::{SettingArgs, text_of_file};
use crate::terminal::{print, warn};
use crate::too_heavy::too_heavy;
use clap::Args;
use command::split;
use pxpl5::Workstation;
use pxpl5::lab::estimate::RunWork;
use session::Session;
use std::path::PathBuf;

/// Run one experiment step by step and inspect its boards.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 debug --pipeline slats --scene mig --triangles 100
  pxpl5 debug --pipeline slats --scene mig --do help
  pxpl5 debug experiments/figure-07.toml --level cycle --do-file session.txt

docs/guide/debugger.md explains the commands.")]
pub(crate) struct DebugArgs {
    #[command(flatten)]
    settings: SettingArgs,
    /// Execute these debugger commands, separated by semicolons, print their output, and end.
    #[arg(long = "do", value_name = "COMMANDS")]
    commands: Option<String>,
    /// Execute the debugger commands of a file, one command per line, print their output, and end.
    #[arg(long, value_name = "FILE", conflicts_with = "commands")]
    do_file: Option<PathBuf>,
    /// Begin where a board first works on this picture.
    #[arg(long, value_name = "N")]
    picture: Option<u64>,
    #[command(flatten)]
    budget: BudgetArgs,
    /// Print no warnings.
    #[arg(long, short)]
    quiet: bool,
}

pub(crate) fn run(args: DebugArgs) -> Result<(), CliError> {
    let script = script(args.commands, args.do_file)?;
    let plan = args.settings.gather()?.resolve()?;
    warn(&plan.warnings(), args.quiet);
    let scene = scenes::load(&plan, args.quiet)?;
    warn(too_heavy(&plan, &scene, plan.fields).as_slice(), args.quiet);
    let experiment = plan.experiment(scene);
    args.budget.admit(&RunWork::of(&experiment, true))?;
    let experiment = experiment.host(Workstation::new()).record_traffic(true);
    let mut session = Session::new(experiment.stepper()?);
    if let Some(number) = args.picture {
        print(&session.execute_line(&format!("run until picture {number}")).map_err(CliError::failure)?)?;
    }
    match script {
        Some(commands) => scripted(session, &commands),
        None => on_screen(session),
    }
}

/// Returns the debugger commands in `--do` or `--do-file`, or `None` for an interactive session.
fn script(commands: Option<String>, file: Option<PathBuf>) -> Result<Option<Vec<String>>, CliError> {
    let text = file.map_or(Ok(commands), |path| text_of_file(&path).map(Some))?;
    Ok(text.map(|text| split(&text)))
}

/// Executes debugger commands in order. Stops at the first error.
fn scripted(mut session: Session, commands: &[String]) -> Result<(), CliError> {
    for command in commands {
        print(&format!("> {command}\n"))?;
        print(&session.execute_line(command).map_err(CliError::usage)?)?;
        if session.is_over() {
            break;
        }
    }
    Ok(())
}

#[cfg(feature = "screen")]
fn on_screen(session: Session) -> Result<(), CliError> {
    use std::io::IsTerminal;
    if !std::io::stdout().is_terminal() {
        return Err(no_terminal("standard output is not a terminal"));
    }
    screen::run(session).map_err(|error| CliError::failure(format!("the terminal cannot be used: {error}")))
}

#[cfg(not(feature = "screen"))]
fn on_screen(_: Session) -> Result<(), CliError> {
    Err(no_terminal(
        "this command was built without the feature `screen` (cargo build --release -p pxpl5-cli --features screen)",
    ))
}

fn no_terminal(reason: &str) -> CliError {
    CliError::usage(format!("{reason}: expected --do COMMANDS or --do-file FILE"))
}
