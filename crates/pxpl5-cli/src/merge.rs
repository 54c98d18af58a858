//! The command `pxpl5 merge`, which merges the shards of a sweep. A shard is a part that a separate process computes.

use crate::error::CliError;
use crate::numbers::{are, count_of, were};
use crate::terminal::{print, print_error};
use clap::Args;
use pxpl5::sweep::{Merged, ROWS_FILE, merge};
use std::path::PathBuf;

/// Join the shards (parts) of a sweep.
///
/// The result is the file that the sweep would have written without shards. Missing points are an error. A point that
/// occurs twice with equal rows is reported and kept once. A point with different rows is an error.
#[derive(Args, Debug)]
#[command(after_help = "Example:
  pxpl5 merge out/slats-1 out/slats-2 --out out/slats")]
pub(crate) struct MergeArgs {
    /// Folders of the shards.
    #[arg(value_name = "DIR", required = true)]
    folders: Vec<PathBuf>,
    /// Folder for the joined files.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Join the existing points even if others are missing.
    #[arg(long)]
    partial: bool,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

pub(crate) fn run(args: MergeArgs) -> Result<(), CliError> {
    let Merged { points, failed, duplicates, missing } = merge(&args.folders, &args.out, args.partial)?;
    // Duplicates and missing points are warnings; other problems have ended the command by now.
    if let Some(first) = duplicates.first() {
        let points = were(duplicates.len() as u64, "point");
        print_error(&format!("pxpl5: {points} found more than once; the first is point {first}\n"));
    }
    if let Some(first) = missing.first() {
        let points = are(missing.len() as u64, "point");
        print_error(&format!("pxpl5: {points} missing; the first is point {first}\n"));
    }
    if args.quiet {
        return Ok(());
    }
    let path = args.out.join(ROWS_FILE);
    let there = points - missing.len() as u64;
    let verb = if there == 1 { "is" } else { "are" };
    print(&format!("{}, {failed} of them failed, {verb} in {}.\n", count_of(there, "point"), path.display()))
}
