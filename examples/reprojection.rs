//! Compares pipelines behind devices that move pictures to the newest pose, on displays of 1994 and of today.
//!
//! `cargo run --release --example reprojection [FOLDER] [RECORDING]` runs every pipeline in a gallery, under each
//! motion of a head. The tracker is the optical one, with a Kalman filter. A recording of a head is one more motion.
//! The evaluation is that of `compare`. It prints a table for each motion, and writes the figure
//! pictures/reprojection.svg and the table of reprojection.md, by default into docs/.

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
        ("plain", "rgb(120,120,120)", Showing::Plain),
        ("rotation a field", "rgb(210,110,30)", device(Warp::Rotation, Every::Field)),
        ("rotation a line", "rgb(30,110,180)", device(Warp::Rotation, Every::Line)),
        ("depth a line", "rgb(40,140,60)", device(Warp::Depth, Every::Line)),
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

const NAMES: f64 = 210.0;
const PANEL: f64 = 300.0;
const PLOT: f64 = 250.0;
const ROW: f64 = 40.0;
const TOP: f64 = 92.0;

/// Returns the horizontal position of an error in a panel, on a scale of decades from 0.01 to 10 degrees.
fn across(deg: f64) -> f64 {
    (deg.clamp(0.01, 10.0).log10() + 2.0) / 3.0 * PLOT
}

fn drawing(motions: &[(String, String)], rows: &[Row]) -> Result<String, std::fmt::Error> {
    let of_first: Vec<&Row> = rows.iter().filter(|row| row.motion == 0).collect();
    let (width, height) = (NAMES + PANEL * motions.len() as f64 + 12.0, TOP + ROW * of_first.len() as f64 + 48.0);
    let mut svg = String::new();
    writeln!(
        svg,
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}">"#
    )?;
    writeln!(svg, r#"<rect width="100%" height="100%" fill="white"/>"#)?;
    writeln!(svg, r#"<g font-family="sans-serif" font-size="12" fill="rgb(30,30,30)">"#)?;
    writeln!(
        svg,
        r#"<text x="12" y="22" font-size="15">Mean error of each pipeline, plain and behind a device that moves its pictures to the newest pose</text>"#
    )?;
    for (i, (name, colour, _)) in showings().into_iter().enumerate() {
        let x = 16.0 + 150.0 * i as f64;
        writeln!(
            svg,
            r#"<circle cx="{x}" cy="42" r="4" fill="{colour}"/><text x="{}" y="46">{name}</text>"#,
            x + 10.0
        )?;
    }
    for (i, row) in of_first.iter().enumerate() {
        let y = TOP + ROW * (i as f64 + 0.5);
        writeln!(
            svg,
            r#"<text x="{}" y="{}" text-anchor="end">{}, {}</text>"#,
            NAMES - 10.0,
            y + 4.0,
            row.pipeline,
            row.display
        )?;
    }
    for (motion, (title, _)) in motions.iter().enumerate() {
        let left = NAMES + PANEL * motion as f64 + 8.0;
        axis(&mut svg, title, left, of_first.len())?;
        for (i, row) in rows.iter().filter(|row| row.motion == motion).enumerate() {
            for (j, (shown, (name, colour, _))) in row.shown.iter().zip(showings()).enumerate() {
                let y = TOP + ROW * i as f64 + 8.0 * (j as f64 + 1.0);
                let Some(deg) = shown.mean_deg else { continue };
                let x = left + across(deg);
                writeln!(svg, r#"<line x1="{left}" x2="{x}" y1="{y}" y2="{y}" stroke="{colour}" stroke-width="2"/>"#)?;
                writeln!(
                    svg,
                    r#"<circle cx="{x}" cy="{y}" r="3.5" fill="{colour}"><title>{name}: {deg:.3} degrees</title></circle>"#
                )?;
            }
        }
    }
    svg += "</g>\n</svg>\n";
    Ok(svg)
}

fn axis(svg: &mut String, title: &str, left: f64, rows: usize) -> std::fmt::Result {
    let bottom = TOP + ROW * rows as f64;
    writeln!(svg, r#"<text x="{left}" y="76" font-size="13">{title}</text>"#)?;
    for deg in [0.01, 0.1, 1.0, 10.0] {
        let x = left + across(deg);
        writeln!(svg, r#"<line x1="{x}" x2="{x}" y1="{TOP}" y2="{bottom}" stroke="rgb(205,205,205)"/>"#)?;
        writeln!(
            svg,
            r#"<text x="{x}" y="{}" text-anchor="middle" fill="rgb(110,110,110)">{deg}</text>"#,
            bottom + 16.0
        )?;
    }
    writeln!(svg, r#"<text x="{}" y="{}" text-anchor="middle">error, degrees</text>"#, left + PLOT / 2.0, bottom + 36.0)
}
