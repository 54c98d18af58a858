//! The command `pxpl5 report`, which writes one HTML page of a results folder.

pub(crate) mod files;
mod load;
mod tables;

use crate::error::CliError;
use crate::output::OutputFile;
use crate::rows::folder_of;
use crate::terminal::print;
use clap::Args;
use files::Files;
use pxpl5::views::page;
use std::path::PathBuf;

/// Write one self-contained HTML page with the results of a folder.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 run --pipeline slats --scene mig --triangles 140 --out out/mig
  pxpl5 report out/mig                 writes out/mig/report.html
  pxpl5 report out --write page.html   a report of the folder that pxpl5 demo wrote
  pxpl5 report out/slats               a report of a sweep or a comparison

The page works without a network and on a phone, and it can be printed.")]
pub(crate) struct ReportArgs {
    /// Results of `pxpl5 run --out`, `pxpl5 demo`, `pxpl5 sweep --out` or `pxpl5 compare --out`: the folder, or its
    /// report.json, rows.jsonl or comparison.json.
    #[arg(value_name = "DIR|FILE")]
    results: PathBuf,
    /// The file to write; default: report.html in the folder.
    #[arg(long, value_name = "FILE")]
    write: Option<PathBuf>,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

pub(crate) fn run(args: ReportArgs) -> Result<(), CliError> {
    let folder = folder_of(&args.results);
    let files = Files::of(folder, args.quiet)?;
    let page = match tables::of(&files)? {
        Some(tables) => page::html_of_tables(&tables),
        None => page::html(&load::runs(&files)?),
    };
    let path = args.write.unwrap_or_else(|| folder.join("report.html"));
    let file = OutputFile::of_results(&path, "--write", folder)?;
    let silent = args.quiet || file.is_standard_output();
    file.write(page.as_bytes())?;
    if silent {
        return Ok(());
    }
    print(&format!("Written to {}.\n", path.display()))
}
