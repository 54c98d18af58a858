//! Draws the pipeline figures of the papers from simulated runs: `cargo run --release --example figures [FOLDER]`, by
//! default into `docs/figures/`. The test `tests/timeline.rs` compares the files with its own drawings.

#[path = "figures/list.rs"]
mod list;

use list::PIPELINE_FIGURES;
use pxpl5::views::timeline::{TimelineOptions, svg};
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let default = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/figures"));
    let folder = std::env::args_os().nth(1).map_or_else(default, PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    for figure in PIPELINE_FIGURES {
        let options =
            TimelineOptions { title: Some(figure.title()), fields: figure.fields, ..TimelineOptions::default() };
        let drawing = svg(&figure.run()?, &options);
        assert!(drawing.starts_with("<svg ") && drawing.ends_with("</svg>\n"), "{} is no drawing", figure.name);
        std::fs::write(folder.join(figure.name).with_extension("svg"), drawing)?;
    }
    Ok(())
}
