//! Compares all pipelines, predictors and devices that move pictures under the recordings of real heads.
//!
//! `cargo run --release --example real_heads [FOLDER]` prints a table for each real head. It writes the first one into
//! reprojection.md in FOLDER, which is docs/ by default, the statistics of motions into guide/motion.md, and errors over
//! time into pictures/real-heads.svg. Each predictor is tuned on the other recording. Each cell of an error is a row of
//! a comparison, so `pxpl5 compare` repeats it.
//!
//! Each of the ten comparisons takes 40 to 50 s of CPU time in the development profile.

use pxpl5::compare::{CompareQuery, Comparison, ComparisonRow, MeanInterval, RowChoice};
use pxpl5::lab::motion;
use pxpl5::tracking::motion::Motion;
use pxpl5::tracking::time::{PS_PER_MS, PS_PER_S};
use pxpl5::views::charts::{ChartAxes, ChartSeries, curve_chart};
use pxpl5::{ExperimentFile, LatencyCurve, Study};
use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// Recordings, each with the one on which its predictors are tuned.
const HEADS: [[&str; 2]; 2] =
    [["recorded:vive-tracked", "recorded:vive-dev"], ["recorded:vive-dev", "recorded:vive-tracked"]];

/// Device and predictor of each column.
const COLUMNS: [[&str; 2]; 5] =
    [["plain", "none"], ["plain", "velocity"], ["plain", "kalman"], ["rotation", "kalman"], ["depth", "kalman"]];

/// Rows, at least one of each family.
const ROWS: [&str; 9] = [
    "rendering-control",
    "slats",
    "ideal",
    "frameless",
    "jitp-field",
    "jitp-scanline-racing",
    "jitp-dual-view-racing",
    "arp-full",
    "arp-ideal",
];

const FIELDS: i64 = 300;

const SEEDS: u64 = 3;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("docs"), PathBuf::from);
    std::fs::write(folder.join("pictures/real-heads.svg"), over_time()?)?;
    replace(&folder.join("guide/motion.md"), &statistics()?)?;
    for head in HEADS {
        let mut all = Vec::new();
        for [raster, predictor] in COLUMNS {
            all.push(compared(head, raster, predictor)?);
            eprintln!("{} {raster} {predictor}", head[0]);
        }
        let table = table(head, &all)?;
        println!("{table}");
        // The errors of the user who stands nearly still are small in every row.
        if head == HEADS[0] {
            replace(&folder.join("reprojection.md"), table.trim())?;
        }
    }
    Ok(())
}

/// Latencies in milliseconds of the two systems of figure 9 of I3D95: Rendering Control and Slats.
const LATENCIES_MS: [u64; 2] = [90, 50];

/// Returns a chart of the error in the middle of the picture over time, which a latency alone causes for a real head
/// (I3D95, figure 9, whose user was not published).
fn over_time() -> Result<String, Box<dyn Error>> {
    let head = motion(HEADS[0][0])?;
    let curves = LATENCIES_MS.map(|ms| {
        let curve = LatencyCurve::of(&head, ms, 29, 1.0);
        ChartSeries::line(&format!("{ms} ms, mean {:.1} px", curve.mean_px()), &curve.points)
    });
    let axes = ChartAxes {
        title: "Error that a latency alone causes for a user who looks around".to_owned(),
        across: "time, s".to_owned(),
        up: "error in the middle of the picture, px".to_owned(),
    };
    Ok(curve_chart(axes, curves.into()))
}

/// Samples of a motion in a second.
const RATE: u64 = 100;

/// Frequencies in hertz between the bands of the spectrum.
const BANDS_HZ: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

/// Returns a table of the speeds and spectra of the recordings and of the synthetic motion.
fn statistics() -> Result<String, Box<dyn Error>> {
    let mut text = "| motion | turn, deg/s: mean, 95 % | walk, m/s: mean, 95 % | turn, deg/s^2: rms |".to_owned();
    let edges: Vec<String> = BANDS_HZ.iter().map(f64::to_string).collect();
    text += &format!(" power of the turn, %: bands up to {} Hz, and above |", edges.join(", "));
    text += " error at 90 ms / at 50 ms |\n|---|---|---|---|---|---|\n";
    for (name, seconds) in [(HEADS[0][0], 29), (HEADS[1][0], 9), ("synthetic:1", 120), ("synthetic:2", 120)] {
        let head = motion(name)?;
        let times = (1..seconds * RATE).map(|n| n * PS_PER_S / RATE);
        // An angular velocity over 50 ms, because recordings have steps and noise.
        let turns: Vec<[f64; 3]> = times.clone().map(|t| turn(&head, t).map(f64::to_degrees)).collect();
        let walks = times.map(|t| head.velocity(t).length()).collect::<Vec<_>>();
        let speeds = turns.iter().map(|turn| length(*turn)).collect();
        let differences = turns.windows(2).map(|pair| std::array::from_fn(|i| pair[1][i] - pair[0][i]));
        let squares: f64 = differences.map(|by| (length(by) * RATE as f64).powi(2)).sum();
        let rms = (squares / turns.len() as f64).sqrt();
        let power: Vec<String> = spectrum(&turns).iter().map(|share| format!("{:.0}", share * 100.0)).collect();
        let [slow, fast] = LATENCIES_MS.map(|ms| LatencyCurve::of(&head, ms, seconds, 1.0).mean_px());
        let [turn, walk] = [speeds, walks].map(mean_and_95);
        writeln!(
            text,
            "| `{name}` | {:.0}, {:.0} | {:.2}, {:.2} | {rms:.0} | {} | {:.2} |",
            turn[0],
            turn[1],
            walk[0],
            walk[1],
            power.join(", "),
            slow / fast
        )?;
    }
    Ok(text.trim_end().to_owned())
}

/// Returns the mean angular velocity over 50 ms around a time, in radians per second.
fn turn(head: &dyn Motion, t: u64) -> [f64; 3] {
    let half = 25 * PS_PER_MS;
    let [from, to] = [t.saturating_sub(half), t + half].map(|t| head.pose(t).orientation);
    let seconds = (t + half - t.saturating_sub(half)) as f64 / PS_PER_S as f64;
    pxpl5::tracking::rotation::difference(from, to).to_array().map(|angle| angle / seconds)
}

fn length(of: [f64; 3]) -> f64 {
    of.iter().map(|part| part * part).sum::<f64>().sqrt()
}

fn mean_and_95(mut values: Vec<f64>) -> [f64; 2] {
    values.sort_by(f64::total_cmp);
    [values.iter().sum::<f64>() / values.len() as f64, values[values.len() * 95 / 100]]
}

/// Returns the share of each band in the power of a signal, without its mean.
fn spectrum(of: &[[f64; 3]]) -> Vec<f64> {
    let n = of.len();
    let mut bands = vec![0.0; BANDS_HZ.len() + 1];
    for k in 1..n / 2 {
        let hz = k as f64 * RATE as f64 / n as f64;
        let band = BANDS_HZ.partition_point(|edge| *edge <= hz);
        // Above 20 Hz, a mean over 50 ms leaves nothing.
        if hz > 20.0 {
            break;
        }
        for axis in 0..3 {
            let part = |turned: fn(f64) -> f64| -> f64 {
                of.iter().enumerate().map(|(i, value)| value[axis] * turned(TAU * (i * k % n) as f64 / n as f64)).sum()
            };
            bands[band] += part(f64::cos).powi(2) + part(f64::sin).powi(2);
        }
    }
    let all: f64 = bands.iter().sum();
    bands.into_iter().map(|band| band / all).collect()
}

fn compared([head, train]: [&str; 2], raster: &str, predictor: &str) -> Result<Comparison, Box<dyn Error>> {
    let mut file = ExperimentFile::new();
    let shared = [
        ("machine.preset", "small-hmd"),
        ("scene", "room"),
        ("head.motion", head),
        ("head.train", train),
        ("head.tracker", "optical"),
        ("head.predict", predictor),
        ("head.raster", raster),
    ];
    for (key, value) in shared {
        file.set(key, value, "real_heads")?;
    }
    if raster != "plain" {
        file.set("head.reprojection.every", "line", "real_heads")?;
    }
    file.set("fields", FIELDS, "real_heads")?;
    let only = RowChoice::Named(ROWS.map(str::to_owned).to_vec());
    let query = CompareQuery { only, seeds: (1..=SEEDS).collect(), ..CompareQuery::new(file) };
    Ok(query.run(&mut ())?)
}

/// Marks of the page around the tables.
const MARKS: [&str; 2] =
    ["<!-- made by examples/real_heads.rs: begin -->\n", "<!-- made by examples/real_heads.rs: end -->"];

/// Replaces the text between the marks of a page.
fn replace(page: &Path, text: &str) -> Result<(), Box<dyn Error>> {
    let before = std::fs::read_to_string(page)?;
    let missing = |mark: &str| format!("{}: expected the mark `{}`, found none", page.display(), mark.trim());
    let (begin, rest) = before.split_once(MARKS[0]).ok_or_else(|| missing(MARKS[0]))?;
    let (_, end) = rest.split_once(MARKS[1]).ok_or_else(|| missing(MARKS[1]))?;
    Ok(std::fs::write(page, format!("{begin}{}\n{text}\n\n{}{end}", MARKS[0], MARKS[1]))?)
}

/// Returns a table with a row for each pipeline, and a column for each device and predictor.
fn table([head, train]: [&str; 2], all: &[Comparison]) -> Result<String, std::fmt::Error> {
    let mut text = format!("\n**{head}**, predictors tuned on {train}: mean error in pixels\n\n| row | to light, ms |");
    COLUMNS.iter().for_each(|[raster, predictor]| text += &format!(" {raster}, {predictor} |"));
    text += " rotation, kalman, above best |\n";
    writeln!(text, "|---|---|{}", "---|".repeat(all.len() + 1))?;
    // Rows that cannot draw the scene are listed below the table.
    let [plain, rotation] = [2, 3].map(|column| &all[column]);
    let (shown, failed): (Vec<&ComparisonRow>, Vec<&ComparisonRow>) =
        plain.pipelines.iter().partition(|row| row.failure.is_none() && row.error.n > 0);
    for row in shown {
        let name = &row.pipeline;
        let mark = if row.shows_all() { "" } else { " !" };
        let to_light = row.head_to_light_ms.mean;
        let to_light = if to_light.is_finite() { format!("{to_light:.1}") } else { "-".to_owned() };
        write!(text, "| {name}{mark} | {to_light} |")?;
        for comparison in all {
            let of_row = comparison.row(name).filter(|row| row.failure.is_none());
            write!(text, " {} |", of_row.map_or_else(|| "-".to_owned(), |row| mean(&row.error.mean_px)))?;
        }
        let above = rotation.row(name).and_then(|row| row.above_best_px);
        let above = above.map_or_else(
            || "-".to_owned(),
            |above| if above.mean == 0.0 { "best".to_owned() } else { format!("+{}", mean(&above)) },
        );
        writeln!(text, " {above} |")?;
    }
    let names: Vec<&str> = failed.iter().map(|row| row.pipeline.as_str()).collect();
    if !names.is_empty() {
        writeln!(text, "\nToo slow for `room`: {}.", names.join(", "))?;
    }
    Ok(text)
}

/// Returns a mean with half of its interval.
fn mean(of: &MeanInterval) -> String {
    if of.high.is_finite() {
        format!("{:.1} ± {:.1}", of.mean, (of.high - of.low) / 2.0)
    } else {
        format!("{:.1}", of.mean)
    }
}
