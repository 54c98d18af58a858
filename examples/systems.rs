//! Compares systems by pixel error and cost: rotation, translation and both, in a gallery.
//!
//! `cargo run --release --example systems [FOLDER]` runs every system under three motions of a head with the optical
//! tracker and a Kalman filter. The evaluation is that of `compare`. The files systems.svg and systems.md are written
//! into docs/ by default.

use pxpl5::display::Coverage;
use pxpl5::{ExperimentFile, Measured, Outcome, Pixels};
use std::collections::BTreeSet;
use std::error::Error;
use std::fmt::Write;
use std::path::PathBuf;

/// Pipelines with one setting each, in the order of the figure.
const SYSTEMS: [(&str, Option<(&str, &str)>); 17] = [
    ("rendering-control", Some(("mono", "true"))),
    ("slats", Some(("binning", "touched"))),
    ("frameless", None),
    ("jitp-field-racing", None),
    ("jitp-scanline-racing", None),
    ("jitp-dual-view-racing", None),
    ("arp-full", None),
    ("arp-full-line", None),
    ("arp-full-pixel", None),
    ("arp-priority", None),
    ("arp-priority-line", None),
    ("arp-cells", None),
    ("arp-cells-line", None),
    ("arp-cells-warp", None),
    ("arp-cells-warp-line", None),
    ("arp-ideal", None),
    ("arp-ideal-line", None),
];

/// Motions with their descriptions and their names in experiment files.
const MOTIONS: [(&str, &str); 3] =
    [("rotation, 100 deg/s", "pan:100"), ("translation, 1 m/s", "walk:1"), ("both, walking and looking", "walk:1:1")];

const FIELDS: i64 = 150;

/// Results of a system under a motion.
struct Found {
    /// Mean distance, in pixels, of content from its ideal position. `None` if no pixel was evaluated.
    mean_px: Option<f64>,
    /// Triangles a second that go through TRANSFORM. A triangle counts once for each view or update that contains it.
    triangles_per_s: f64,
    /// Bytes a second of pixels, including depths, that displays receive.
    bytes_per_s: f64,
    /// Reason for a missing result.
    failure: Option<String>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("docs"), PathBuf::from);
    let mut rows = Vec::new();
    for (system, setting) in SYSTEMS {
        let mut found = Vec::new();
        for (_, motion) in MOTIONS {
            found.push(measure(system, setting, motion)?);
            eprintln!("{system} {motion} {:?}", found.last().and_then(|found| found.mean_px));
        }
        rows.push((system, found));
    }
    std::fs::write(folder.join("systems.svg"), drawing(&rows)?)?;
    std::fs::write(folder.join("systems.md"), table(&rows)?)?;
    Ok(())
}

fn measure(system: &str, setting: Option<(&str, &str)>, motion: &str) -> Result<Found, Box<dyn Error>> {
    let mut file = ExperimentFile::new();
    let shared = [
        ("machine.preset", "design-maximum"),
        ("scene", "gallery"),
        ("pipeline", system),
        ("head.motion", motion),
        ("head.tracker", "optical"),
        ("head.predict", "kalman"),
    ];
    for (key, value) in shared {
        file.set(key, value, "systems")?;
    }
    file.set("fields", FIELDS, "systems")?;
    if let Some((key, value)) = setting {
        file.set_text(&format!("{key}={value}"), "systems")?;
    }
    let plan = file.resolve_for(1)?;
    match plan.experiment(plan.load_scene()?).pixels(Pixels::Off).run() {
        Ok(outcome) => Ok(of_run(&outcome)),
        Err(error) => Ok(Found {
            mean_px: None,
            triangles_per_s: f64::NAN,
            bytes_per_s: f64::NAN,
            failure: Some(error.to_string()),
        }),
    }
}

fn of_run(outcome: &Outcome) -> Found {
    let seconds = outcome.fields() as f64 * outcome.field_ms() * 1e-3;
    let has_faces = outcome.pipeline().coverage() == Coverage::Surroundings;
    let errors = outcome.pixel_errors().filter(|errors| errors.evaluated > 0);
    let arrivals = outcome.observation().arrivals.iter();
    let texels = arrivals.map(|arrival| {
        let [_, _, width, height] = arrival.target.grid.rectangle(arrival.target.region);
        u64::from(width * height)
    });
    let bytes_of_texel = if has_faces { 8 } else { 4 };
    Found {
        mean_px: errors.map(|errors| errors.pixels.mean),
        triangles_per_s: triangles(outcome) as f64 / seconds,
        bytes_per_s: (texels.sum::<u64>() * bytes_of_texel) as f64 / seconds,
        failure: None,
    }
}

/// Returns the number of triangles that went through TRANSFORM.
fn triangles(outcome: &Outcome) -> u64 {
    let notes = outcome.requested_updates();
    let Some(head) = outcome.head() else { return 0 };
    let scene = head.scene();
    if outcome.pipeline().coverage() == Coverage::View {
        let views: BTreeSet<_> = head.sampled().into_iter().map(|sampled| sampled.number).collect();
        return (views.len() * outcome.pipeline().eyes() * scene.triangles().len()) as u64;
    }
    let of_structures = scene.structures().iter().map(|structure| structure.triangles.len() as u64);
    let of_structures: Vec<u64> = of_structures.collect();
    let held = |structures: &[bool]| {
        of_structures.iter().zip(structures).filter(|(_, held)| **held).map(|(n, _)| *n).sum::<u64>()
    };
    notes.iter().map(|note| held(&note.structures)).sum::<u64>()
}

fn table(rows: &[(&str, Vec<Found>)]) -> Result<String, std::fmt::Error> {
    let mut text = String::from("| system |");
    MOTIONS.iter().for_each(|(title, _)| text += &format!(" {title}: px | triangles/s | MB/s |"));
    text += "\n|---|";
    MOTIONS.iter().for_each(|_| text += "---|---|---|");
    text.push('\n');
    for (system, found) in rows {
        write!(text, "| {system} |")?;
        for one in found {
            match &one.failure {
                Some(failure) => write!(text, " {} | - | - |", failure.split(';').next().unwrap_or_default())?,
                None => {
                    let px = one.mean_px.map_or_else(|| "-".to_owned(), |px| format!("{px:.2}"));
                    write!(text, " {px} | {:.0} | {:.1} |", one.triangles_per_s, one.bytes_per_s * 1e-6)?;
                }
            }
        }
        text.push('\n');
    }
    Ok(text)
}

const WIDTH: f64 = 1240.0;
const NAMES: f64 = 190.0;
const PANEL: f64 = 340.0;
const PLOT: f64 = 190.0;
const ROW: f64 = 26.0;
const TOP: f64 = 74.0;

/// Returns the horizontal position of an error in a panel, on a scale of decades from 0.1 to 100 px.
fn across(px: f64) -> f64 {
    (px.clamp(0.1, 100.0).log10() + 1.0) / 3.0 * PLOT
}

fn drawing(rows: &[(&str, Vec<Found>)]) -> Result<String, std::fmt::Error> {
    let height = TOP + ROW * rows.len() as f64 + 44.0;
    let mut svg = String::new();
    writeln!(
        svg,
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}">"#
    )?;
    writeln!(svg, r#"<rect width="100%" height="100%" fill="white"/>"#)?;
    writeln!(svg, r#"<g font-family="sans-serif" font-size="12" fill="rgb(30,30,30)">"#)?;
    writeln!(svg, r#"<text x="12" y="22" font-size="15">Mean pixel error of each system, and what it costs</text>"#)?;
    for (row, (system, _)) in rows.iter().enumerate() {
        let y = TOP + ROW * (row as f64 + 0.5);
        writeln!(svg, r#"<text x="{}" y="{}" text-anchor="end">{system}</text>"#, NAMES - 10.0, y + 4.0)?;
        writeln!(svg, r#"<line x1="{NAMES}" x2="{WIDTH}" y1="{y}" y2="{y}" stroke="rgb(238,238,238)"/>"#)?;
    }
    for (panel, (title, _)) in MOTIONS.iter().enumerate() {
        let left = NAMES + PANEL * panel as f64 + 8.0;
        axis(&mut svg, title, left, rows.len())?;
        for (row, (system, found)) in rows.iter().enumerate() {
            point(&mut svg, &found[panel], system, [left, TOP + ROW * (row as f64 + 0.5)])?;
        }
    }
    svg += "</g>\n</svg>\n";
    Ok(svg)
}

fn axis(svg: &mut String, title: &str, left: f64, rows: usize) -> std::fmt::Result {
    let bottom = TOP + ROW * rows as f64;
    writeln!(svg, r#"<text x="{left}" y="46" font-size="13">{title}</text>"#)?;
    let numbers = left + PLOT + 14.0;
    writeln!(svg, r#"<text x="{numbers}" y="{}" fill="rgb(110,110,110)">triangles/s</text>"#, TOP - 8.0)?;
    writeln!(svg, r#"<text x="{}" y="{}" fill="rgb(110,110,110)">MB/s</text>"#, numbers + 80.0, TOP - 8.0)?;
    for px in [0.1, 1.0, 10.0, 100.0] {
        let x = left + across(px);
        writeln!(svg, r#"<line x1="{x}" x2="{x}" y1="{TOP}" y2="{bottom}" stroke="rgb(205,205,205)"/>"#)?;
        writeln!(
            svg,
            r#"<text x="{x}" y="{}" text-anchor="middle" fill="rgb(110,110,110)">{px}</text>"#,
            bottom + 16.0
        )?;
    }
    writeln!(svg, r#"<text x="{}" y="{}" text-anchor="middle">error, px</text>"#, left + PLOT / 2.0, bottom + 34.0)
}

fn point(svg: &mut String, found: &Found, system: &str, [left, y]: [f64; 2]) -> std::fmt::Result {
    let Some(px) = found.mean_px else {
        return writeln!(svg, r#"<text x="{left}" y="{}" fill="rgb(150,60,60)">nothing shown in time</text>"#, y + 4.0);
    };
    let colour = if system.starts_with("arp") { "rgb(30,110,180)" } else { "rgb(210,110,30)" };
    let x = left + across(px);
    writeln!(svg, r#"<line x1="{left}" x2="{x}" y1="{y}" y2="{y}" stroke="{colour}" stroke-width="2"/>"#)?;
    writeln!(svg, r#"<circle cx="{x}" cy="{y}" r="4" fill="{colour}"><title>{px:.2} px</title></circle>"#)?;
    let numbers = left + PLOT + 14.0;
    writeln!(svg, r#"<text x="{numbers}" y="{}">{:.0}</text>"#, y + 4.0, found.triangles_per_s)?;
    writeln!(svg, r#"<text x="{}" y="{}">{:.1}</text>"#, numbers + 80.0, y + 4.0, found.bytes_per_s * 1e-6)
}
