//! Compares systems by pixel error and cost: rotation, translation and both, in a gallery.
//!
//! `cargo run --release --example systems [FOLDER]` runs every system under three motions of a head with the optical
//! tracker and a Kalman filter. The evaluation is that of `compare`. The files pictures/systems.svg, with the errors, and
//! systems.md, with errors and costs, are written into docs/ by default.

mod panels;

use panels::{AXIS, Panel};
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
    [("rotation, 100 deg/s", "pan:100"), ("translation, 1 m/s", "walk:1"), ("walking and looking", "walk:1:1")];

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
    std::fs::write(folder.join("pictures/systems.svg"), drawing(&rows)?)?;
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
    let has_faces = outcome.pipeline().properties().coverage == Coverage::Surroundings;
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
    if outcome.pipeline().properties().coverage == Coverage::View {
        let views: BTreeSet<_> = head.sampled().into_iter().map(|sampled| sampled.number).collect();
        return (views.len() * outcome.pipeline().properties().eyes * scene.triangles().len()) as u64;
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

/// Colours of systems that draw what the eye sees, and of systems that draw six faces around the eye.
const KINDS: [(&str, &str); 2] =
    [("draws what the eye sees", "#d55e00"), ("draws six faces around the eye (arp)", "#0072b2")];

fn drawing(rows: &[(&str, Vec<Found>)]) -> Result<String, std::fmt::Error> {
    let panels = MOTIONS.iter().enumerate().map(|(n, (title, _))| Panel {
        title,
        axis: "error, px",
        at: [176.0 + 194.0 * n as f64, 92.0],
        length: 142.0,
        ends: [0.1, 100.0],
        marks: &[0.1, 1.0, 10.0, 100.0],
        rows: (rows.len(), 24.0),
    });
    let panels: Vec<Panel<'_>> = panels.collect();
    let mut svg = panels::begin(panels[0].bottom() + AXIS, "Mean pixel error of each system", &KINDS);
    for (n, panel) in panels.iter().enumerate() {
        panel.frame(&mut svg)?;
        for (row, (system, found)) in rows.iter().enumerate() {
            if n == 0 {
                panel.name(&mut svg, row, system)?;
            }
            point(&mut svg, panel, row, &found[n], system)?;
        }
    }
    svg += "</svg>\n";
    Ok(svg)
}

fn point(svg: &mut String, panel: &Panel<'_>, row: usize, found: &Found, system: &str) -> std::fmt::Result {
    let (left, y) = (panel.at[0], panel.middle(row));
    let Some(px) = found.mean_px else {
        return writeln!(svg, r##"<text x="{left}" y="{}" fill="#a01212">nothing in time</text>"##, y + 5.0);
    };
    let (_, colour) = KINDS[usize::from(system.starts_with("arp"))];
    panel.dot(svg, y, [0.0, px, px], colour, &format!("{px:.2} px"))?;
    writeln!(svg, r#"<text x="{:.1}" y="{}">{px:.1}</text>"#, panel.across(px) + 9.0, y + 5.0)
}
