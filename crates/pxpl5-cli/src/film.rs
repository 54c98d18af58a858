//! The command `pxpl5 film`, which writes an animated PNG of a viewer's picture.

use crate::budget::BudgetArgs;
use crate::error::CliError;
use crate::numbers::{count_of, whole};
use crate::output::OutputFile;
use crate::scenes;
use crate::settings::SettingArgs;
use crate::terminal::{print, warn};
use crate::too_heavy::too_heavy;
use clap::{Args, ValueEnum};
use pxpl5::lab::estimate::RunWork;
use pxpl5::views::{Film, FilmSurfaces};
use pxpl5::{Eye, PeriodNumber, Pixels};
use std::path::PathBuf;

/// Write a viewer's picture as an animated PNG at the true field rate.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 film --pipeline slats --scene mig --triangles 140 --out mig.png
  pxpl5 film --pipeline rendering-control --scene head --eye both --from 20 --length 60 --out head.png

Browsers play the file.")]
pub(crate) struct FilmArgs {
    #[command(flatten)]
    settings: SettingArgs,
    /// The file to write (PNG).
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Eye (left, right or both) whose picture is written.
    #[arg(long, value_enum, default_value_t = Whose::Left)]
    eye: Whose,
    /// Number of the first field in the film.
    #[arg(long, value_name = "FIELD", default_value_t = 12, value_parser = whole::<u64>(0, 10_000_000))]
    from: u64,
    /// Number of fields in the film.
    #[arg(long, value_name = "FIELDS", default_value_t = 60, value_parser = whole::<u64>(1, 10_000))]
    length: u64,
    #[command(flatten)]
    budget: BudgetArgs,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Whose {
    /// The picture of the left eye alone.
    Left,
    /// The picture of the right eye alone.
    Right,
    /// The pictures of both eyes side by side, the left eye's picture on the left.
    Both,
}

pub(crate) fn run(args: FilmArgs) -> Result<(), CliError> {
    let ending = args.out.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    if let Some(other) = ending.filter(|ending| !["png", "apng"].contains(&ending.as_str())) {
        return Err(CliError::usage(format!("--out: expected a name that ends in .png or .apng, found .{other}")));
    }
    let file = args.settings.gather()?;
    if let Some(place) = file.place_of("fields") {
        warn(&[format!("{place}: fields has no effect; --from and --length set the fields of a film")], args.quiet);
    }
    let plan = file.resolve()?;
    warn(&plan.warnings(), args.quiet);
    let eyes = match args.eye {
        Whose::Left => FilmSurfaces::One(Eye::Left.into()),
        Whose::Right => FilmSurfaces::One(Eye::Right.into()),
        Whose::Both => FilmSurfaces::All,
    };
    let file = OutputFile::open(&args.out, "--out")?;
    // The run ends one field after the film, because the last picture is final only then.
    let (scene, fields) = (scenes::load(&plan, args.quiet)?, args.from + args.length + 1);
    warn(too_heavy(&plan, &scene, fields).as_slice(), args.quiet);
    let experiment = plan.experiment(scene).pixels(Pixels::Lazy).fields(fields);
    args.budget.admit(&RunWork::of(&experiment, true))?;
    // The settings are stored in the PNG, so that the film can be reproduced.
    let texts = [("config_hash", experiment.config_hash().to_string()), ("settings", plan.settings().to_string())];
    let mut bytes = Vec::new();
    Film::new(experiment, PeriodNumber(args.from), args.length, eyes)
        .write(&texts, &mut bytes)
        .map_err(CliError::failure)?;
    let silent = args.quiet || file.is_standard_output();
    file.write(&bytes)?;
    if silent {
        return Ok(());
    }
    print(&format!("{}: {} from field {} on.\n", args.out.display(), count_of(args.length, "field"), args.from))
}
