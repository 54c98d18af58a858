//! Compares pipelines behind devices that move pictures to the newest pose, on displays of 1994 and of today.
//!
//! `cargo run --release --example reprojection [FOLDER] [RECORDING]` runs every pipeline in a gallery, under each
//! motion of a head. The tracker is the optical one, with a Kalman filter. A recording of a head is one more motion.
//! The evaluation is that of `compare`. The figure pictures/reprojection.svg and the tables of reprojection.md are
//! written into docs/ by default.

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

/// Motions with their descriptions and their names in experiment files.
const MOTIONS: [(&str, &str); 4] = [
    ("rotation, 100 deg/s", "pan:100"),
    ("translation, 1 m/s", "walk:1"),
    ("both, walking and looking", "walk:1:1"),
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
    disoccluded: Option<f64>,
    pose_age_ms: Option<f64>,
}

/// A run of one pipeline on one display under one motion.
struct Row {
    pipeline: &'static str,
    display: &'static str,
    motion: usize,
    picture_age_ms: f64,
    triangles_per_s: f64,
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
    std::fs::write(page, with_tables(&text, &table(&motions, &rows)?)?)?;
    std::fs::write(folder.join("pictures/reprojection.svg"), drawing(&motions, &rows)?)?;
    Ok(())
}

/// Marks of the page around the tables.
const MARKS: [&str; 2] =
    ["<!-- made by examples/reprojection.rs: begin -->\n", "<!-- made by examples/reprojection.rs: end -->"];

/// Returns a page with new tables between its marks.
fn with_tables(page: &str, tables: &str) -> Result<String, String> {
    let missing = |mark: &str| format!("expected a page with the mark `{}`, found none", mark.trim());
    let (before, rest) = page.split_once(MARKS[0]).ok_or_else(|| missing(MARKS[0]))?;
    let (_, after) = rest.split_once(MARKS[1]).ok_or_else(|| missing(MARKS[1]))?;
    Ok(format!("{before}{}\n{tables}\n{}{after}", MARKS[0], MARKS[1]))
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
    let blank = Row {
        pipeline,
        display,
        motion,
        picture_age_ms: f64::NAN,
        triangles_per_s: f64::NAN,
        shown: Vec::new(),
        failure: None,
    };
    Ok(match plan.experiment(plan.load_scene()?).pixels(Pixels::Off).run() {
        Ok(outcome) => of_run(&outcome, blank),
        Err(error) => Row { failure: Some(error.to_string()), ..blank },
    })
}

fn of_run(outcome: &Outcome, blank: Row) -> Row {
    let seconds = outcome.fields() as f64 * outcome.field_ms() * 1e-3;
    let Some(head) = outcome.head() else { return blank };
    // A pipeline takes a view for each picture that it begins.
    let views = head.sampled().len() * outcome.pipeline().eyes();
    let triangles = views * head.scene().triangles().len();
    let ages = Budget::totals_ms(outcome);
    let shown = showings().into_iter().map(|(_, _, showing)| {
        let errors = PixelErrors::shown(outcome, showing);
        let device = EyeReport::shown(outcome, showing).and_then(|eye| eye.reprojection);
        let is_known = errors.evaluated > 0;
        Shown {
            mean_px: is_known.then_some(errors.pixels.mean),
            mean_deg: is_known.then_some(errors.degrees.mean),
            empty: device.as_ref().and_then(|device| device.empty_share),
            disoccluded: device.as_ref().and_then(|device| device.disoccluded_share),
            pose_age_ms: device.map(|device| device.pose_age_ms.mean),
        }
    });
    Row {
        picture_age_ms: Statistics::of(ages.into_iter()).mean,
        triangles_per_s: triangles as f64 / seconds,
        shown: shown.collect(),
        ..blank
    }
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.filter(|value| value.is_finite()).map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
}

fn table(motions: &[(String, String)], rows: &[Row]) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    for (motion, (title, name)) in motions.iter().enumerate() {
        writeln!(text, "\n**{title}** (`{name}`)\n")?;
        text += "| pipeline | display | picture age, ms | triangles/s |";
        showings().iter().for_each(|(name, ..)| text += &format!(" {name}, px |"));
        text += " plain, deg | depth a line, deg | empty, % | hidden, % | pose age, ms |\n|---|---|---|---|";
        showings().iter().for_each(|_| text += "---|");
        text += "---|---|---|---|---|\n";
        for row in rows.iter().filter(|row| row.motion == motion) {
            write!(text, "| {} | {} |", row.pipeline, row.display)?;
            if let Some(failure) = &row.failure {
                writeln!(text, " {} |", failure.split(';').next().unwrap_or_default())?;
                continue;
            }
            write!(text, " {} | {:.0} |", number(Some(row.picture_age_ms), 1), row.triangles_per_s)?;
            row.shown.iter().for_each(|shown| text += &format!(" {} |", number(shown.mean_px, 2)));
            let [plain, turned, moved] = [&row.shown[0], &row.shown[2], &row.shown[3]];
            let percent = |share: Option<f64>| number(share.map(|share| share * 100.0), 1);
            writeln!(
                text,
                " {} | {} | {} | {} | {} |",
                number(plain.mean_deg, 3),
                number(moved.mean_deg, 3),
                percent(turned.empty),
                percent(moved.disoccluded),
                number(turned.pose_age_ms, 1)
            )?;
        }
    }
    Ok(text.trim_start().to_owned())
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
