//! `pxpl5 merge`.

use crate::error::CliError;
use crate::numbers::{are, count_of, were};
use crate::terminal::{complain, print};
use clap::Args;
use pxpl5::sweep::{Merged, ROWS_FILE, merge};
use std::path::PathBuf;

/// Join the shards of a sweep.
///
/// The result is the file that the sweep would have written without shards. Missing points are an error; points that
/// are there twice with equal rows are told and kept once; with different rows they are an error.
#[derive(Args, Debug)]
#[command(after_help = "Example:
  pxpl5 merge out/slats-1 out/slats-2 --out out/slats")]
pub(crate) struct MergeArgs {
    /// Folders of shards.
    #[arg(value_name = "DIR", required = true)]
    folders: Vec<PathBuf>,
    /// Where the joined files go.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Join what there is, though points are missing.
    #[arg(long)]
    partial: bool,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

pub(crate) fn run(args: MergeArgs) -> Result<(), CliError> {
    let Merged { points, failed, duplicates, missing } = merge(&args.folders, &args.out, args.partial)?;
    if let Some(first) = duplicates.first() {
        let points = were(duplicates.len() as u64, "point");
        complain(&format!("pxpl5: {points} there more than once, the first of them point {first}\n"));
    }
    if let Some(first) = missing.first() {
        let points = are(missing.len() as u64, "point");
        complain(&format!("pxpl5: {points} missing, the first of them point {first}\n"));
    }
    if args.quiet {
        return Ok(());
    }
    let path = args.out.join(ROWS_FILE);
    let there = points - missing.len() as u64;
    let verb = if there == 1 { "is" } else { "are" };
    print(&format!("{}, {failed} of them failed, {verb} in {}.\n", count_of(there, "point"), path.display()))
}
