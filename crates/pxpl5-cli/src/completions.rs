//! The command `pxpl5 completions`, which prints a completion script for a shell.

use crate::error::CliError;
use crate::terminal::print;
use clap::{Args, CommandFactory};
use clap_complete::Shell;

/// Print a completion script for a shell.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 completions bash > ~/.local/share/bash-completion/completions/pxpl5
  pxpl5 completions zsh > ~/.zfunc/_pxpl5")]
pub(crate) struct CompletionsArgs {
    shell: Shell,
}

pub(crate) fn run(args: CompletionsArgs) -> Result<(), CliError> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut crate::Cli::command(), "pxpl5", &mut script);
    print(&String::from_utf8_lossy(&script))
}
