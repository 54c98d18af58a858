//! The figures of the SpatialGL paper and the results of the model as a Markdown document. The text is a
//! Markdown file with marks.

use super::row::{MeasuredScene, VolumeFigures};
use super::shown::ShownStatement;
use crate::settings::VolumeSettings;
use pxpl5_sim::figures::column::NUMBER;
use pxpl5_sim::figures::{Definition, FigureRow, TableColumn, filled, lines, significant, table};
use pxpl5_sim::parameters::{Parameter, PathSettings, Provenance};
use std::fmt::Write as _;

/// Returns the text of docs/volumetric.md. The text has every figure, the definitions, the statements without numbers,
/// the scenes, and the project's assumed numbers with their ranges.
pub fn markdown(figures: &VolumeFigures) -> String {
    let rows = &figures.figures;
    filled(
        include_str!("document.md.in"),
        &[
            ("met", rows.iter().filter(|row| row.is_met).count().to_string()),
            ("rows", rows.len().to_string()),
            ("figures", table(&COLUMNS, rows)),
            ("missed", missed(rows)),
            ("definitions", table(&DEFINITIONS, &figures.definitions)),
            ("shown", lines(figures.shown.iter().map(shown))),
            ("scenes", lines(figures.scenes.iter().map(scene))),
            ("numbers", lines(VolumeSettings::paper().numbers().into_iter().map(setting))),
        ],
    )
}

const COLUMNS: [TableColumn<FigureRow>; 5] = [
    NUMBER,
    ("statement", |row| match &row.scene {
        Some(scene) => format!("{} ({scene})", row.statement),
        None => row.statement.to_string(),
    }),
    ("source", |row| {
        let measured = if row.scene.is_some() { ", measured" } else { "" };
        format!("{}{measured}", source(&row.source, row.origin))
    }),
    ("expected", |row| format!("{} {}", expected(row), row.unit)),
    ("model", |row| number(row.simulated) + if row.is_met { "" } else { " **missed**" }),
];

/// Returns the section of the paper, and states if the number was derived from printed numbers.
fn source(section: &str, provenance: Provenance) -> String {
    match provenance {
        Provenance::Derived if section != "derived" => format!("{section}, derived"),
        _ => section.to_owned(),
    }
}

/// Returns the expected value as text. If the statement of the SpatialGL paper contains "over", "about" or "most", the
/// text includes the interval of accepted values.
fn expected(row: &FigureRow) -> String {
    let ([low, high], value) = (row.accepted, row.published);
    let is_wide = high - low > 0.02 * value.abs().max(1e-12) + 1e-9;
    if is_wide { format!("{} ({} to {})", number(value), number(low), number(high)) } else { number(value) }
}

fn missed(rows: &[FigureRow]) -> String {
    let mut text = String::from("## Missed\n");
    for row in rows.iter().filter(|row| !row.is_met) {
        let scene = row.scene.as_deref().unwrap_or("the model");
        let _ = writeln!(
            text,
            "\n- **{}** {}: {} {}, {scene} has {}. {}",
            row.id,
            row.statement,
            expected(row),
            row.unit,
            number(row.simulated),
            row.cause_or_unknown()
        );
    }
    text
}

const DEFINITIONS: [TableColumn<Definition>; 4] = [
    ("#", |one| one.id.to_owned()),
    ("number", |one| one.statement.to_string()),
    ("source", |one| source(one.source, one.provenance)),
    ("value", |one| format!("{} {}", number(one.value), one.unit)),
];

fn shown(shown: &ShownStatement) -> [String; 2] {
    let holds = if shown.holds { "" } else { "**not shown**: " };
    [shown.statement.to_string(), format!("{holds}{}", shown.evidence)]
}

fn scene(scene: &MeasuredScene) -> [String; 11] {
    let [_, _, sent] = scene.bytes.map(|bytes| format!("{:.1}", bytes as f64 / 1e6));
    let [cpu, gpu, bus] = scene.model_ms.map(|ms| format!("{ms:.0}"));
    let [serial, overlapped] = scene.volumes_hz.map(|hz| format!("{hz:.2}"));
    let [draws, tiles] = [scene.draws_percent, scene.tile_occupancy_percent].map(|percent| format!("{percent:.1} %"));
    let hash = format!("`{}`", scene.volume_hash);
    [scene.scene.clone(), scene.triangles.to_string(), draws, tiles, sent, cpu, gpu, bus, serial, overlapped, hash]
}

fn setting(setting: Parameter) -> [String; 3] {
    let Parameter { path, info, value, .. } = setting;
    // The text above the table says that the paper does not print the numbers with a range.
    let source = info.source.trim_start_matches("the paper gives no value").trim_start_matches("; ");
    let basis = match info.provenance {
        Provenance::Published => format!("published: {source}"),
        _ => format!("{} to {}: {source}", info.range.0, info.range.1).trim_end_matches(": ").to_owned(),
    };
    [format!("`{path}`"), format!("{value} {}", info.unit), basis]
}

/// Formats a number with nine significant digits.
fn number(value: f64) -> String {
    significant(value, 9)
}
