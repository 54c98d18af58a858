//! The figures of the SpatialGL paper and the results of the model as a Markdown document.

use super::row::{MeasuredScene, VolumeFigures};
use super::shown::ShownStatement;
use crate::settings::VolumeSettings;
use pxpl5_sim::figures::column::NUMBER;
use pxpl5_sim::figures::{Definition, FigureRow, TableColumn, significant, table};
use pxpl5_sim::parameters::{Parameter, PathSettings};
use std::fmt::Write as _;

/// Returns the text of docs/volumetric.md. The text has every figure, the definitions, the statements without numbers,
/// the scenes, and the project's assumed numbers with their ranges.
pub fn markdown(figures: &VolumeFigures) -> String {
    let mut text = String::new();
    head(&mut text, figures);
    text.push_str(&table(&COLUMNS, &figures.figures));
    missed(&mut text, &figures.figures);
    definitions(&mut text, &figures.definitions);
    shown(&mut text, &figures.shown);
    scenes(&mut text, &figures.scenes);
    pictures(&mut text);
    numbers(&mut text);
    text
}

fn head(text: &mut String, figures: &VolumeFigures) {
    let met = figures.figures.iter().filter(|row| row.is_met).count();
    let _ = write!(
        text,
        "# Volumetric slices: the SpatialGL paper's figures\n\n\
         The model reproduces {met} of the {} rows; the [misses](#missed) depend on the scene. The paper describes how\n\
         Actuality Systems' spinning display Perspecta draws a scene once for every slice, but it prints no times,\n\
         rates or speed-ups. Times therefore come from a model of a computer of 2005: for the Mig, it makes four to six\n\
         volumes a second. What it says without numbers also holds in the model, among others that the bounding prism\n\
         is too bright near the axis and that reading back is the narrow path. You can vary every number that it leaves\n\
         open ([Numbers](#numbers)).\n\n\
         `pxpl5 volume figures --write docs/volumetric.md` generates this page, and a test fails if it is out of date.\n\
         The paper is W.-S. Chun, T. J. Purtell II and O. S. Cossairt, *Technical Introduction to the Basic SpatialGL\n\
         Rendering Pipeline for Perspecta 1.9/2.0*, Actuality Systems, ASI-0110, 2005.\n\n\
         *Published* numbers are printed in it, and *derived* ones follow from them by a formula. *Measured* ones were\n\
         counted in the computed volume of a scene, with the hyperbolic clip and a projection along the normal of each\n\
         slice. Inputs, and what follows from them by arithmetic, are no rows but [definitions](#definitions).\n\n",
        figures.figures.len()
    );
}

const COLUMNS: [TableColumn<FigureRow>; 8] = [
    NUMBER,
    ("statement", |row| match &row.scene {
        Some(scene) => format!("{} ({scene})", row.statement),
        None => row.statement.to_string(),
    }),
    ("source", |row| row.source.to_string()),
    ("provenance", |row| format!("{}{}", row.origin, if row.scene.is_some() { ", measured" } else { "" })),
    ("expected", |row| format!("{} {}", expected(row), row.unit)),
    ("model", |row| number(row.simulated)),
    ("error", |row| row.error_percent.map_or_else(|| "-".to_owned(), |error| format!("{error:+.2} %"))),
    ("", |row| if row.is_met { "met" } else { "**missed**" }.to_owned()),
];

/// Returns the expected value as text. If the statement of the SpatialGL paper contains "over", "about" or "most", the
/// text includes the interval of accepted values.
fn expected(row: &FigureRow) -> String {
    let ([low, high], value) = (row.accepted, row.published);
    let is_wide = high - low > 0.02 * value.abs().max(1e-12) + 1e-9;
    if is_wide { format!("{} ({} to {})", number(value), number(low), number(high)) } else { number(value) }
}

fn missed(text: &mut String, rows: &[FigureRow]) {
    let all: Vec<&FigureRow> = rows.iter().filter(|row| !row.is_met).collect();
    if all.is_empty() {
        return;
    }
    let _ = writeln!(text, "\n## Missed");
    for row in all {
        let scene = row.scene.as_deref().unwrap_or("the model");
        let _ = writeln!(
            text,
            "\n- Row **{}** (\"{}\") is missed: the expected value is {} {}, and the value of {scene} is {}. {}",
            row.id,
            row.statement,
            expected(row),
            row.unit,
            number(row.simulated),
            row.cause_or_unknown()
        );
    }
}

fn definitions(text: &mut String, all: &[Definition]) {
    let columns: [TableColumn<Definition>; 5] = [
        ("#", |one| one.id.to_owned()),
        ("number", |one| one.statement.to_string()),
        ("source", |one| one.source.to_owned()),
        ("provenance", |one| one.provenance.to_string()),
        ("value", |one| format!("{} {}", number(one.value), one.unit)),
    ];
    let _ = write!(
        text,
        "\n\
         ## Definitions\n\n\
         These are inputs that the paper prints, and numbers that follow from them by arithmetic. No simulation could\n\
         change them.\n\n\
         {}",
        table(&columns, all)
    );
}

fn shown(text: &mut String, all: &[ShownStatement]) {
    let _ = write!(text, "\n## Statements without numbers\n\n| the paper says | the model | |\n|---|---|---|\n");
    for ShownStatement { statement, evidence, holds } in all {
        let _ = writeln!(text, "| {statement} | {evidence} | {} |", if *holds { "shown" } else { "**not shown**" });
    }
}

fn scenes(text: &mut String, all: &[MeasuredScene]) {
    let _ = write!(
        text,
        "\n\
         ## Scenes\n\n\
         A volume has 396 slices of 768 x 768 pixels, with the hyperbolic clip (0.25 px^2) and a projection along the\n\
         normal of each slice. All planes between slices sort triangles into bins. Tiles of 32 px with lit pixels are\n\
         found for 4 slices together. Times are those of the modelled computer `geforce-6800`.\n\n\
         | scene | triangles | draws left | tiles occupied | MB unpacked | packed | sent | CPU ms | GPU ms | bus ms | volumes/s serial | overlapped | hash |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|---|\n"
    );
    for scene in all {
        let [unpacked, packed, sent] = scene.bytes.map(|bytes| format!("{:.1}", bytes as f64 / 1e6));
        let [cpu, gpu, bus] = scene.model_ms.map(|ms| format!("{ms:.0}"));
        let _ = writeln!(
            text,
            "| {} | {} | {:.1} % | {:.1} % | {unpacked} | {packed} | {sent} | {cpu} | {gpu} | {bus} | {:.2} | {:.2} | `{}` |",
            scene.scene,
            scene.triangles,
            scene.draws_percent,
            scene.tile_occupancy_percent,
            scene.volumes_hz[0],
            scene.volumes_hz[1],
            scene.volume_hash
        );
    }
}

fn pictures(text: &mut String) {
    text.push_str(
        "\n\
         ## Pictures\n\n\
         ![Figures 4 to 12](pictures/volumetric-figures.png)\n\n\
         These are the paper's figures 4 to 12, row by row (it has no figures 1 to 3). `pxpl5 volume figures --out DIR`\n\
         draws them from values that the model computes for every pixel. First comes a slice volume with its\n\
         orientation and a tapered clip. The second row shows a clip whose planes are moved outwards, the clip\n\
         hyperbola, and a wall near the axis in several slices. In the third you see the planes between bins, the codes\n\
         that sort triangles into bins, and a tile query.\n\n\
         ![Clips and projections](pictures/volumetric-variants.png)\n\n\
         `pxpl5 volume compare --scene mig --out DIR` draws the Mig for a viewer 40 degrees to the right and 25 degrees\n\
         above, always with the same exposure. From top to bottom, the clips are prism, user planes, exact, tapered,\n\
         parallel and hyperbola. From left to right, the projection is along the normal of each slice, for one eye\n\
         position in all slices, and jittered.\n",
    );
}

fn numbers(text: &mut String) {
    let _ = write!(
        text,
        "\n\
         ## Numbers\n\n\
         You can change each of these with `--set PATH=VALUE`. An assumed number has a range, because the paper does\n\
         not print it.\n\n\
         | path | value | unit | provenance | range | source |\n|---|---|---|---|---|---|\n"
    );
    for Parameter { path, info, value, .. } in VolumeSettings::paper().numbers() {
        let (low, high) = info.range;
        let _ = writeln!(
            text,
            "| `{path}` | {value} | {} | {} | {low} to {high} | {} |",
            info.unit, info.provenance, info.source
        );
    }
}

/// Formats a number with nine significant digits.
fn number(value: f64) -> String {
    significant(value, 9)
}
