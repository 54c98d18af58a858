//! Compares pipelines behind devices that move pictures to the newest pose, on displays of 1994 and of today.
//!
//! `cargo run --release --example reprojection [FOLDER] [RECORDING]` runs every pipeline in a gallery, under each
//! motion of a head. The tracker is the optical one, with a Kalman filter. A recording of a head is one more motion.
//! The evaluation is that of `compare`. It prints a table for each motion, and writes the figure
//! pictures/reprojection.svg and the table of reprojection.md, by default into docs/.

mod panels;

use panels::{AXIS, Panel};
use pxpl5::{
    Budget, Every, ExperimentFile, EyeReport, Outcome, PixelErrors, Pixels, Reprojection, Showing, Statistics, Warp,
};
use std::error::Error;
use std::fmt::Write;
use std::path::PathBuf;

/// Displays of a pipeline, each with its number of periods in 2.5 s.
type Displays = &'static [(&'static str, i64)];

/// Pipelines with a setting each, and the displays that they can draw for.
const PIPELINES: [(&str, &str, Displays); 5] = [
    ("rendering-control", "mono=true", &[("ntsc", 150), ("oled-90", 225), ("lcd-120", 300)]),
    ("slats", "binning=touched", &[("ntsc", 150)]),
    ("frameless", "", &[("ntsc", 150)]),
    ("jitp-field-racing", "", &[("ntsc", 150)]),
    ("jitp-dual-view-racing", "", &[("ntsc", 150)]),
];

/// Motion whose table the page has.
const WALKING_AND_LOOKING: &str = "walk:1:1";

/// Motions with their descriptions and their names in experiment files.
const MOTIONS: [(&str, &str); 4] = [
    ("rotation, 100 deg/s", "pan:100"),
    ("translation, 1 m/s", "walk:1"),
    ("both, walking and looking", WALKING_AND_LOOKING),
    ("recorded use, synthetic", "synthetic:1"),
];

/// The ways in which pictures are shown to the eye, with their colours in the figure.
fn showings() -> [(&'static str, &'static str, Showing); 4] {
    let device = |by, every| Showing::Reprojected(Reprojection::new(by, every));
    [
        ("plain", "#777777", Showing::Plain),
        ("rotation a field", "#d55e00", device(Warp::Rotation, Every::Field)),
        ("rotation a line", "#0072b2", device(Warp::Rotation, Every::Line)),
        ("depth a line", "#009e73", device(Warp::Depth, Every::Line)),
    ]
}

/// Results of a run whose pictures are shown in one of these ways.
struct Shown {
    mean_px: Option<f64>,
    mean_deg: Option<f64>,
    empty: Option<f64>,
}

/// A run of one pipeline on one display under one motion.
struct Row {
    pipeline: &'static str,
    display: &'static str,
    motion: usize,
    picture_age_ms: f64,
    shown: Vec<Shown>,
    failure: Option<String>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1);
    let folder = arguments.next().map_or_else(|| PathBuf::from("docs"), PathBuf::from);
    let recording = arguments.next().map(|path| path.to_string_lossy().into_owned());
    let mut motions: Vec<(String, String)> =
        MOTIONS.iter().map(|(title, motion)| ((*title).to_owned(), (*motion).to_owned())).collect();
    motions.extend(recording.map(|path| ("the recording".to_owned(), path)));
    let mut rows = Vec::new();
    for (motion, (_, name)) in motions.iter().enumerate() {
        for (pipeline, setting, displays) in PIPELINES {
            for (display, fields) in displays {
                let row = measure((pipeline, setting), (display, *fields), (motion, name))?;
                eprintln!(
                    "{pipeline} {display} {name} {:?}",
                    row.shown.iter().map(|it| it.mean_px).collect::<Vec<_>>()
                );
                rows.push(row);
            }
        }
    }
    let page = folder.join("reprojection.md");
    let text = std::fs::read_to_string(&page)?;
    for (motion, named) in motions.iter().enumerate() {
        let table = table(motion, named, &rows)?;
        println!("{table}");
        if named.1 == WALKING_AND_LOOKING {
            std::fs::write(&page, with_table(&text, &table)?)?;
        }
    }
    std::fs::write(folder.join("pictures/reprojection.svg"), drawing(&motions, &rows)?)?;
    Ok(())
}

/// Marks of the page around the table.
const MARKS: [&str; 2] =
    ["<!-- made by examples/reprojection.rs: begin -->\n", "<!-- made by examples/reprojection.rs: end -->"];

/// Returns a page with a new table between its marks.
fn with_table(page: &str, table: &str) -> Result<String, String> {
    let missing = |mark: &str| format!("expected a page with the mark `{}`, found none", mark.trim());
    let (before, rest) = page.split_once(MARKS[0]).ok_or_else(|| missing(MARKS[0]))?;
    let (_, after) = rest.split_once(MARKS[1]).ok_or_else(|| missing(MARKS[1]))?;
    Ok(format!("{before}{}\n{table}\n{}{after}", MARKS[0], MARKS[1]))
}

fn measure(
    (pipeline, setting): (&'static str, &str),
    (display, fields): (&'static str, i64),
    (motion, name): (usize, &str),
) -> Result<Row, Box<dyn Error>> {
    let mut file = ExperimentFile::new();
    let shared = [
        ("machine.preset", "design-maximum"),
        ("scene", "gallery"),
        ("pipeline", pipeline),
        ("display", display),
        ("head.motion", name),
        ("head.tracker", "optical"),
        ("head.predict", "kalman"),
    ];
    for (key, value) in shared {
        file.set(key, value, "reprojection")?;
    }
    file.set("fields", fields, "reprojection")?;
    if !setting.is_empty() {
        file.set_text(setting, "reprojection")?;
    }
    let plan = file.resolve_for(1)?;
    let blank = Row { pipeline, display, motion, picture_age_ms: f64::NAN, shown: Vec::new(), failure: None };
    Ok(match plan.experiment(plan.load_scene()?).pixels(Pixels::Off).run() {
        Ok(outcome) => of_run(&outcome, blank),
        Err(error) => Row { failure: Some(error.to_string()), ..blank },
    })
}

fn of_run(outcome: &Outcome, blank: Row) -> Row {
    let ages = Budget::totals_ms(outcome);
    let shown = showings().into_iter().map(|(_, _, showing)| {
        let errors = PixelErrors::shown(outcome, showing);
        let device = EyeReport::shown(outcome, showing).and_then(|eye| eye.reprojection);
        let is_known = errors.evaluated > 0;
        Shown {
            mean_px: is_known.then_some(errors.pixels.mean),
            mean_deg: is_known.then_some(errors.degrees.mean),
            empty: device.and_then(|device| device.empty_share),
        }
    });
    Row { picture_age_ms: Statistics::of(ages.into_iter()).mean, shown: shown.collect(), ..blank }
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.filter(|value| value.is_finite()).map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
}

fn table(motion: usize, (title, name): &(String, String), rows: &[Row]) -> Result<String, std::fmt::Error> {
    let mut text = format!("**{title}** (`{name}`)\n\n| pipeline | display | picture age, ms |");
    showings().iter().for_each(|(name, ..)| text += &format!(" {name}, px |"));
    text += " depth a line, deg | empty, % |\n|---|---|---|";
    showings().iter().for_each(|_| text += "---|");
    text += "---|---|\n";
    for row in rows.iter().filter(|row| row.motion == motion) {
        write!(text, "| {} | {} |", row.pipeline, row.display)?;
        if let Some(failure) = &row.failure {
            writeln!(text, " {} |", failure.split(';').next().unwrap_or_default())?;
            continue;
        }
        write!(text, " {} |", number(Some(row.picture_age_ms), 1))?;
        row.shown.iter().for_each(|shown| text += &format!(" {} |", number(shown.mean_px, 2)));
        let empty = number(row.shown[2].empty.map(|share| share * 100.0), 1);
        writeln!(text, " {} | {empty} |", number(row.shown[3].mean_deg, 3))?;
    }
    Ok(text)
}

/// Top of the first rows, and height of a row.
const TOP: f64 = 96.0;
const ROW: f64 = 44.0;
/// Height of the title of a panel.
const TITLE: f64 = 28.0;

fn drawing(motions: &[(String, String)], rows: &[Row]) -> Result<String, std::fmt::Error> {
    let of_first: Vec<&Row> = rows.iter().filter(|row| row.motion == 0).collect();
    let block = ROW * of_first.len() as f64 + AXIS + TITLE;
    let height = TOP - TITLE + block * motions.len().div_ceil(2) as f64;
    let colours = showings().map(|(name, colour, _)| (name, colour));
    let title = "Mean error, plain and behind a device that moves pictures to the newest pose";
    let mut svg = panels::begin(height, title, &colours);
    for (motion, (title, _)) in motions.iter().enumerate() {
        // Two panels stand side by side, and the names of the rows are left of both.
        let panel = Panel {
            title,
            axis: "error, degrees",
            at: [206.0 + 288.0 * (motion % 2) as f64, TOP + block * (motion / 2) as f64],
            length: 244.0,
            ends: [0.01, 10.0],
            marks: &[0.01, 0.1, 1.0, 10.0],
            rows: (of_first.len(), ROW),
        };
        panel.frame(&mut svg)?;
        for (i, row) in rows.iter().filter(|row| row.motion == motion).enumerate() {
            if motion % 2 == 0 {
                panel.name(&mut svg, i, &format!("{}, {}", row.pipeline, row.display))?;
            }
            for (j, (shown, (name, colour, _))) in row.shown.iter().zip(showings()).enumerate() {
                let Some(deg) = shown.mean_deg else { continue };
                let y = panel.middle(i) + 9.0 * (j as f64 - 1.5);
                panel.dot(&mut svg, y, [0.0, deg, deg], colour, &format!("{name}: {deg:.3} degrees"))?;
            }
        }
    }
    svg += "</svg>\n";
    Ok(svg)
}
