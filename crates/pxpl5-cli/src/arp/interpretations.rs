//! The command `pxpl5 arp interpretations`. Table 1 of the paper on priority rendering can be interpreted in several
//! ways. The command ranks these interpretations.

use crate::error::CliError;
use crate::progress::Progress;
use crate::terminal::{answer, json_text};
use clap::Args;
use pxpl5::arp::figures::interpretations_text;
use pxpl5::lab::walks::WalkInterpretationQuery;

/// Rank the possible answers to the questions that the paper on priority rendering leaves open about its table 1. The
/// questions concern rings, distances, cascade, hall and path. As a check, each update rate of the table is left out in
/// turn.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 arp interpretations
  pxpl5 arp interpretations --json > interpretations.json")]
pub(super) struct InterpretationsArgs {
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// Print nothing but errors and, with --json, the JSON object.
    #[arg(long, short)]
    quiet: bool,
}

pub(super) fn run(args: InterpretationsArgs) -> Result<(), CliError> {
    let all = Progress::new("rules and halls", args.quiet).run(&WalkInterpretationQuery)?;
    answer(args.json, args.quiet, &json_text(&all)?, || interpretations_text(&all).trim_start().to_owned())
}
