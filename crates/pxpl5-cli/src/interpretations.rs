//! The command `pxpl5 interpretations`, which ranks interpretations of the papers on Rendering Control by their fit to
//! the published figures.

use crate::error::CliError;
use crate::numbers::whole;
use crate::progress::Progress;
use crate::terminal::{AnswerArgs, json_text};
use clap::Args;
use pxpl5::Level;
use pxpl5::figures::FigureSettings;
use pxpl5::interpretations::{ALIKE, Fit, InterpretationQuery, Interpretations, LeaveOneOut};
use std::fmt::Write;

/// Rank all interpretations of the papers' open questions by how well they explain the figures of Rendering Control.
///
/// Every combination of answers is simulated, with one machine for all figures. Some questions concern the measurement:
/// which latency is averaged, how fields were counted, which machine drew the application scenes, and whether back
/// faces were culled. The others concern the firmware: how many finished regions a renderer keeps, and what the master
/// does meanwhile with the renderer.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 interpretations
  pxpl5 interpretations --best 5 --rows 40
  pxpl5 interpretations --json > interpretations.json")]
pub(crate) struct InterpretationsArgs {
    /// Number of the likeliest interpretations that are also simulated at the transaction level.
    #[arg(long, default_value_t = 20, value_name = "N", value_parser = whole::<u64>(0, 256))]
    best: u64,
    /// Number of interpretations printed for each level.
    #[arg(long, default_value_t = 20, value_name = "N")]
    rows: usize,
    /// Number of seeds of figure 7's fly-through; the scene "molecules" uses a third of them, the scene "head" a fifth.
    #[arg(long, default_value_t = 6, value_name = "N", value_parser = whole::<u64>(1, 100))]
    seeds: u64,
    /// Number of frames of each fly-through.
    #[arg(long, default_value_t = 150, value_name = "N", value_parser = whole::<u64>(10, 1_000))]
    frames: u64,
    #[command(flatten)]
    answer: AnswerArgs,
}

pub(crate) fn run(args: InterpretationsArgs) -> Result<(), CliError> {
    let settings = FigureSettings::new(Level::Analytic).with_mig(args.seeds, args.frames);
    let study = InterpretationQuery { settings, best: args.best as usize };
    let progress = Progress::new("interpretations", args.answer.quiet);
    let interpretations = progress.run_within(args.answer.budget, "take fewer --seeds, --frames or --best", &study)?;
    args.answer.print(&json_text(&interpretations)?, || text(&interpretations, args.rows))
}

fn text(interpretations: &Interpretations, rows: usize) -> String {
    let mut text = format!("{} interpretations\n", interpretations.analytic.len());
    for (level, fits) in
        [("analytic level", &interpretations.analytic), ("transaction level", &interpretations.transaction)]
    {
        if let Some(first) = fits.first() {
            let _ = write!(text, "\n{level}, the likeliest first\n{}", header(first));
            fits.iter().take(rows).for_each(|fit| text.push_str(&line(fit)));
        }
    }
    let _ = writeln!(
        text,
        "\nThe figures cannot tell the first {} apart (within a factor of {ALIKE:.1} of the likeliest).",
        interpretations.alike().len()
    );
    let _ = writeln!(text, "\nEach figure, predicted by the interpretation under which the others are likeliest:");
    interpretations.left_out.iter().for_each(|one| text.push_str(&left_out(one)));
    text
}

fn header(fit: &Fit) -> String {
    let figures: String = fit.figures.iter().map(|figure| format!(" {:>8}", figure.id)).collect();
    let published: String = fit.figures.iter().map(|figure| format!(" {:>8.2}", figure.published)).collect();
    format!(
        "{:>7} {:>8} {:>7}{figures}  interpretation\n{:>7} {:>8} {:>7}{published}  published\n",
        "mean %", "worst %", "log L", "", "", ""
    )
}

fn line(fit: &Fit) -> String {
    let values: String = fit.figures.iter().map(|figure| format!(" {:>8.2}", figure.simulated)).collect();
    let sds: Vec<String> =
        fit.figures.iter().filter_map(|figure| Some(format!("{} {:.2}", figure.id, figure.simulated_sd?))).collect();
    format!(
        "{:>7.2} {:>8.2} {:>7.1}{values}  {}; sd {}\n",
        fit.mean_error_percent,
        fit.greatest_error_percent,
        fit.log_likelihood,
        fit.words,
        sds.join(", ")
    )
}

fn left_out(one: &LeaveOneOut) -> String {
    format!("{:<4} {:>+7.1} %  {}\n", one.id, one.error_percent, one.words)
}
