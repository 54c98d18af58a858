//! Arguments of `pxpl5 figures`.

use crate::terminal::AnswerArgs;
use clap::Args;
use std::path::PathBuf;

/// Simulate every published figure, and compare the result with the published value.
#[derive(Args, Debug, Default)]
#[command(after_help = "Examples:
  pxpl5 figures
  pxpl5 figures --intervals              takes twice as long
  pxpl5 figures --only 4,7,R1            these figures, without their intervals
  pxpl5 figures --group rates            these figures, without their intervals
  pxpl5 figures --json
  pxpl5 figures --write ACCURACY.md --pages docs
  pxpl5 figures --check ACCURACY.md      fails if the file is out of date
  pxpl5 figures --chart errors.svg       errors with their intervals
  pxpl5 figures --group address-recalculation --write docs/address-recalculation.md
  pxpl5 figures --group volumetric --out out/figures    the paper's drawings, redrawn")]
pub(crate) struct FiguresArgs {
    /// Measure only the figures of one topic: rendering-control, slats, head-to-light, rates, jitp, trackers,
    /// address-recalculation or volumetric. The last two have documents and pictures of their own.
    #[arg(long, value_name = "NAME", conflicts_with_all = ["only", "chart", "intervals", "pages"])]
    pub(crate) group: Option<String>,
    /// Write the document with all figures (ACCURACY.md) to this file.
    #[arg(long, value_name = "FILE", conflicts_with = "check")]
    pub(crate) write: Option<PathBuf>,
    /// Fail if this file differs from the document that --write would write.
    #[arg(long, value_name = "FILE")]
    pub(crate) check: Option<PathBuf>,
    /// With --write or --check, write or check also interpretations.md and the chapter "Time" of numerics.md in this
    /// folder.
    #[arg(long, value_name = "DIR")]
    pub(crate) pages: Option<PathBuf>,
    /// Write the pictures of the group into this folder.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print also the interval of each figure while unpublished parameters vary.
    #[arg(long)]
    pub(crate) intervals: bool,
    /// Write a chart of the errors and their intervals (SVG) to this file.
    #[arg(long, value_name = "FILE")]
    pub(crate) chart: Option<PathBuf>,
    /// Measure only these figures, separated by commas. Each row is printed as soon as it is measured.
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',', conflicts_with_all = ["write", "check", "json", "chart", "intervals"])]
    pub(crate) only: Vec<String>,
    #[command(flatten)]
    pub(crate) answer: AnswerArgs,
}

/// Group of the papers on address recalculation.
pub(super) const ADDRESS_RECALCULATION: &str = "address-recalculation";
/// Group of the paper on the volumetric display.
pub(super) const VOLUMETRIC: &str = "volumetric";
