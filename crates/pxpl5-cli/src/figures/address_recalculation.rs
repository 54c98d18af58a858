//! The figures of the papers on address recalculation with an ideal renderer, as a table, a document and pictures.

use super::args::FiguresArgs;
use super::table::{fresh, rows_text};
use crate::arp::settings::put;
use crate::error::CliError;
use crate::output::{OutputFile, OutputFolder};
use crate::progress::Bar;
use crate::terminal::answer;
use pxpl5::arp::{figures, pictures};
use serde_json::json;

/// Measures the group of address recalculation: `pxpl5 figures --group address-recalculation`.
pub(super) fn run(args: &FiguresArgs) -> Result<(), CliError> {
    // Open all outputs before the walks, so that a bad path fails at once.
    let document = args.write.as_deref().map(|path| OutputFile::open(path, "--write")).transpose()?;
    let folder = args.out.as_deref().map(|out| OutputFolder::of_run(out, "figures")).transpose()?;
    let mut bar = Bar::new("walks and pictures", args.quiet);
    let (experiments, rows) = figures::all()?;
    bar.advance(1, 2);
    bar.check("nothing was written")?;
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
        fresh(path, &markdown, "figures --group address-recalculation")?;
    }
    answer(
        args.json,
        args.quiet,
        &format!("{:#}\n", json!({ "schema": "pxpl5-arp-figures/2", "figures": rows })),
        || rows_text(&rows),
    )
}
