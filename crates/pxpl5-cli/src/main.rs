//! The command `pxpl5` with all built-in pipelines and displays.

use std::process::ExitCode;

fn main() -> ExitCode {
    pxpl5_cli::main(pxpl5::registry())
}
