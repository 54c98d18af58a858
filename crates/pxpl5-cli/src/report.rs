//! `pxpl5 report`: a results folder as one page.

mod load;

use crate::error::CliError;
use crate::output::OutputFolder;
use crate::terminal::print;
use clap::Args;
use pxpl5::views::page;
use std::path::PathBuf;

/// Make one self-contained HTML page of a results folder.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 run --pipeline slats --scene mig --triangles 140 --out out/mig
  pxpl5 report out/mig                 writes out/mig/report.html
  pxpl5 report out --write page.html   of what pxpl5 demo wrote

The page needs no network, fits a phone and can be printed.")]
pub(crate) struct ReportArgs {
    /// What `pxpl5 run --out` or `pxpl5 demo` wrote.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// The file to write; default: report.html in the folder.
    #[arg(long, value_name = "FILE")]
    write: Option<PathBuf>,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

pub(crate) fn run(args: ReportArgs) -> Result<(), CliError> {
    let runs = load::runs(&args.folder)?;
    let path = args.write.unwrap_or_else(|| args.folder.join("report.html"));
    let (mut folder, name) = OutputFolder::of_file(&path)?;
    folder.put(&name, page::html(&runs).as_bytes())?;
    folder.commit()?;
    if args.quiet {
        return Ok(());
    }
    print(&format!("Written to {}.\n", path.display()))
}
