//! The command `pxpl5 arp figures`, which compares figures of the papers on address recalculation with an ideal
//! renderer.

use super::settings::put;
use crate::error::CliError;
use crate::figures::{fresh, rows_text};
use crate::output::{OutputFile, OutputFolder};
use crate::terminal::{answer, progress};
use clap::Args;
use pxpl5::arp::{figures, pictures};
use serde_json::json;
use std::path::PathBuf;

/// Compare the figures of the papers with an ideal renderer, and draw the pictures of the papers.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 arp figures
  pxpl5 arp figures --json
  pxpl5 arp figures --out out/arp                               all pictures
  pxpl5 arp figures --write docs/address-recalculation.md
  pxpl5 arp figures --check docs/address-recalculation.md       fails if the file is out of date")]
pub(super) struct FiguresArgs {
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Write the document with all figures to this file.
    #[arg(long, value_name = "FILE", conflicts_with = "check")]
    write: Option<PathBuf>,
    /// Fail if this file differs from the document that --write would write.
    #[arg(long, value_name = "FILE")]
    check: Option<PathBuf>,
    /// Write all pictures into this folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print nothing but errors and, with --json, the JSON object.
    #[arg(long, short)]
    quiet: bool,
}

pub(super) fn run(args: FiguresArgs) -> Result<(), CliError> {
    // Open all outputs before the walks, so that a bad path fails at once.
    let document = args.write.as_deref().map(|path| OutputFile::open(path, "--write")).transpose()?;
    let folder = args.out.as_deref().map(|out| OutputFolder::of_run(out, "arp figures")).transpose()?;
    let bar = progress(2, "walks and pictures", args.quiet);
    let (experiments, rows) = figures::all()?;
    bar.add_one();
    let markdown = figures::markdown(&experiments, &rows);
    document.map(|document| document.write(markdown.as_bytes())).transpose()?;
    if let Some(mut folder) = folder {
        let origin = [("scene", "gallery".to_owned()), ("about", "figures of address recalculation".to_owned())];
        put(&mut folder, &pictures::all(&experiments)?, &origin)?;
        folder.commit()?;
    }
    bar.clear();
    // `--check` fails if the document in the repository differs from the new document.
    if let Some(path) = &args.check {
        fresh(path, &markdown, "arp figures")?;
    }
    answer(
        args.json,
        args.quiet,
        &format!("{:#}\n", json!({ "schema": "pxpl5-arp-figures/2", "figures": rows })),
        || rows_text(&rows),
    )
}
