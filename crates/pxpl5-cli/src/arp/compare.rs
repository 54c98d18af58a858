//! The command `pxpl5 arp compare`, which compares all policies and warps on one walk of a viewer through a scene. A
//! policy decides which parts of the scene are drawn when. A warp closes gaps between display memories.

use super::run::widths;
use super::settings::{FEWER_FRAMES, WalkArgs};
use crate::error::CliError;
use crate::interrupt;
use crate::numbers::count_of;
use crate::output::OutputFolder;
use crate::progress::Progress;
use crate::terminal::{Column, answer, columns_text, json_text, print_error};
use clap::Args;
use pxpl5::arp::{ArpComparison, ComparedRow, variant_count};
use pxpl5::lab::walks::{WalkComparisonQuery, WalkQuery};
use pxpl5::views::results::csv_of;
use std::path::PathBuf;

/// Compare all policies and warps on one walk through a scene. Print update rates, drawn objects and triangles, the
/// widths of gaps at cuts, and the angles by which warps move vertices.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 arp compare
  pxpl5 arp compare --scene gallery:full --set walk.m_per_s=2 --out out/policies --json

The options for policy, segments and warping have no effect, because the command walks every variant. If a variant fails, the command
names it and keeps the results of the others.")]
pub(super) struct CompareArgs {
    #[command(flatten)]
    walk: WalkArgs,
    /// Write comparison.json and rows.csv into this folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print JSON: an object whose `rows` lists the variants.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: CompareArgs) -> Result<(), CliError> {
    let folder = args.out.as_deref().map(|out| OutputFolder::of_run(out, "arp compare")).transpose()?;
    let (scene, plan) = args.walk.gather()?;
    // Walk once for each variant, then write files before anything is printed.
    let study = WalkComparisonQuery(WalkQuery { scene, plan, has_pictures: false });
    let comparison = Progress::new("walks", args.walk.quiet).run_within(args.walk.budget, FEWER_FRAMES, &study)?;
    let json = json_text(&comparison)?;
    // A part of the walks does not replace the files of a whole comparison.
    if let Some(mut folder) = folder.filter(|_| !interrupt::flag().is_stopped()) {
        folder.put("comparison.json", json.as_bytes())?;
        folder.put("rows.csv", csv_of(&comparison.rows).as_bytes())?;
        folder.commit()?;
    }
    answer(args.json, args.walk.quiet, &json, || text(&comparison))?;
    // The command names each variant whose walk failed, and fails after all walks.
    for (variant, reason) in &comparison.failed {
        print_error(&format!("pxpl5: {variant}: {reason}\n"));
    }
    match comparison.failed.len() {
        0 => Ok(()),
        failed => Err(CliError::failure(format!("{failed} of {} variants could not be walked", variant_count()))),
    }
}

const COLUMNS: [Column<ComparedRow>; 10] = [
    ("variant", |row| row.variant.to_owned()),
    ("rates, Hz", |row| row.rates_hz.iter().map(|rate| format!("{rate:.1}")).collect::<Vec<_>>().join(" ")),
    ("draws/s", |row| format!("{:.0}", row.draws_per_s)),
    ("triangles/s", |row| format!("{:.0}", row.triangles_per_s)),
    ("saved, %", |row| format!("{:.1}", row.saved_percent)),
    ("eye age, mm", |row| format!("{:.2}", row.eye_age_mm)),
    ("tears, texels", |row| widths(row.tears)),
    ("stretch, texels", |row| widths(row.stretch)),
    ("changes", |row| row.changes.to_string()),
    ("missed", |row| row.missed.to_string()),
];

fn text(comparison: &ArpComparison) -> String {
    let mut text =
        format!("{}: {} at {} m/s\n\n", comparison.scene, count_of(comparison.frames, "frame"), comparison.m_per_s);
    text.push_str(&columns_text(&COLUMNS, &comparison.rows, usize::MAX));
    text.push_str(
        "\ntears: angles between the two directions in which two memories draw a shared vertex (median, 95 %, widest), in texels (90 degrees\n\
         divided by the texels of a face's edge); stretch: angles by which warping moves vertices; eye age: mean distance from the position\n\
         for which a memory was drawn; changes: new assignments of cells, or objects that changed their memory.\n",
    );
    text
}
