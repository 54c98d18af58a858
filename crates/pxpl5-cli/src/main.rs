//! The command `pxpl5`, with the pipelines and displays of the papers.

use std::process::ExitCode;

fn main() -> ExitCode {
    pxpl5_cli::main(pxpl5::registry())
}
