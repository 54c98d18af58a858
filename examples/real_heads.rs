//! Compares pipelines, predictors and devices that move pictures under the recordings of real heads.
//!
//! `cargo run --release --example real_heads [FOLDER]` writes the tables of real heads into reprojection.md in FOLDER,
//! which is docs/ by default. All runs have the scene `room`, which is in view in every direction, the machine
//! `small-hmd` and the optical tracker. Each mean is over three seeds of the tracker's noise, with its interval of 95 %.

use pxpl5::compare::MeanInterval;
use pxpl5::{Budget, Every, ExperimentFile, PixelErrors, Pixels, Reprojection, Showing, Statistics, Warp};
use std::error::Error;
use std::fmt::Write;
use std::path::PathBuf;

/// Pipelines, each with a setting that distinguishes the row.
const ROWS: [(&str, &str, &str); 7] = [
    ("rendering-control", "rendering-control", ""),
    ("slats", "slats", ""),
    ("slats-touched", "slats", "binning=touched"),
    ("frameless", "frameless", ""),
    ("jitp-field-racing", "jitp-field-racing", ""),
    ("jitp-scanline-racing", "jitp-scanline-racing", ""),
    ("arp-full", "arp-full", ""),
];

/// Recordings with the number of fields that they cover, at most 10 s.
const HEADS: [(&str, i64); 2] = [("recorded:vive-tracked", 600), ("recorded:vive-dev", 540)];

const PREDICTORS: [&str; 3] = ["none", "velocity", "kalman"];

const SEEDS: u64 = 3;

const CONFIDENCE: f64 = 0.95;

/// Mean errors in pixels, one for each seed: plain, moved by rotation, moved by depth, and the ideal picture.
type Means = [Vec<f64>; 4];

struct Row {
    name: &'static str,
    to_light_ms: f64,
    /// The means with each predictor.
    means: [Means; 3],
    degrees: f64,
}

fn showings() -> [Showing; 4] {
    let device = |by| Showing::Reprojected(Reprojection::new(by, Every::Line));
    [Showing::Plain, device(Warp::Rotation), device(Warp::Depth), Showing::Ideal]
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("docs"), PathBuf::from);
    let mut text = String::new();
    for (head, fields) in HEADS {
        let mut rows = Vec::new();
        for row in ROWS {
            rows.push(measure(row, head, fields)?);
            eprintln!("{head} {}", row.0);
        }
        text += &table(head, &rows)?;
    }
    let page = folder.join("reprojection.md");
    let before = std::fs::read_to_string(&page)?;
    std::fs::write(page, with_tables(&before, text.trim())?)?;
    Ok(())
}

/// Marks of the page around the tables.
const MARKS: [&str; 2] =
    ["<!-- made by examples/real_heads.rs: begin -->\n", "<!-- made by examples/real_heads.rs: end -->"];

fn with_tables(page: &str, tables: &str) -> Result<String, String> {
    let missing = |mark: &str| format!("expected a page with the mark `{}`, found none", mark.trim());
    let (before, rest) = page.split_once(MARKS[0]).ok_or_else(|| missing(MARKS[0]))?;
    let (_, after) = rest.split_once(MARKS[1]).ok_or_else(|| missing(MARKS[1]))?;
    Ok(format!("{before}{}\n{tables}\n\n{}{after}", MARKS[0], MARKS[1]))
}

fn measure(
    (name, pipeline, setting): (&'static str, &str, &str),
    head: &str,
    fields: i64,
) -> Result<Row, Box<dyn Error>> {
    let mut row = Row { name, to_light_ms: f64::NAN, means: Default::default(), degrees: f64::NAN };
    for (predictor, means) in PREDICTORS.into_iter().zip(&mut row.means) {
        for seed in 1..=SEEDS {
            let mut file = ExperimentFile::new();
            let shared = [
                ("machine.preset", "small-hmd"),
                ("scene", "room"),
                ("pipeline", pipeline),
                ("head.motion", head),
                ("head.tracker", "optical"),
                ("head.predict", predictor),
            ];
            for (key, value) in shared {
                file.set(key, value, "real_heads")?;
            }
            file.set("fields", fields, "real_heads")?;
            if !setting.is_empty() {
                file.set_text(setting, "real_heads")?;
            }
            let plan = file.resolve_for(seed)?;
            let outcome = plan.experiment(plan.load_scene()?).pixels(Pixels::Off).run()?;
            for (showing, means) in showings().into_iter().zip(means.iter_mut()) {
                let errors = PixelErrors::shown(&outcome, showing);
                means.push(errors.pixels.mean);
                if showing == Showing::Plain {
                    row.degrees = errors.degrees.mean;
                }
            }
            row.to_light_ms = Statistics::of(Budget::totals_ms(&outcome).into_iter()).mean;
        }
    }
    Ok(row)
}

/// Returns a mean with half of its interval.
fn mean(values: &[f64]) -> String {
    let MeanInterval { mean, high, .. } = MeanInterval::of_signed(values, CONFIDENCE);
    if mean.is_finite() { format!("{mean:.1} ± {:.1}", high - mean) } else { "-".to_owned() }
}

/// Returns the difference of two means over the same motion and the same noise.
fn difference(one: &[f64], other: &[f64]) -> String {
    let pairs: Vec<f64> = one.iter().zip(other).map(|(one, other)| one - other).collect();
    if pairs.iter().all(|px| *px == 0.0) { "best".to_owned() } else { format!("+{}", mean(&pairs)) }
}

fn table(head: &str, rows: &[Row]) -> Result<String, std::fmt::Error> {
    let mut text = format!("\n**{head}**: mean error in pixels\n\n");
    text += "| pipeline | to light, ms | none | velocity | kalman | above best | kalman, degrees | kalman, rotation | kalman, depth |\n";
    text += "|---|---|---|---|---|---|---|---|---|\n";
    let average = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let plain = |row: &Row| average(&row.means[2][0]);
    let Some(best) = rows.iter().min_by(|one, other| plain(one).total_cmp(&plain(other))) else { return Ok(text) };
    for row in rows {
        let [none, velocity, kalman] = &row.means;
        let above = difference(&kalman[0], &best.means[2][0]);
        writeln!(
            text,
            "| {} | {:.1} | {} | {} | {} | {above} | {:.2} | {} | {} |",
            row.name,
            row.to_light_ms,
            mean(&none[0]),
            mean(&velocity[0]),
            mean(&kalman[0]),
            row.degrees,
            mean(&kalman[1]),
            mean(&kalman[2])
        )?;
    }
    // The ideal picture is the same for every pipeline that draws the view.
    let [none, velocity, kalman] = &rows[0].means;
    writeln!(text, "| ideal | 0 | {} | {} | {} | | | | |", mean(&none[3]), mean(&velocity[3]), mean(&kalman[3]))?;
    Ok(text)
}
