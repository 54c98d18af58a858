//! Figures of the paper on just-in-time pixels (JITP, by Mine and Bishop). The figures are errors while the head turns,
//! the duration of a line, the number of transforms, and the pictures of an edge.

use super::measurement::{Measurement, figure};
use super::settings::FigureSettings;
use super::value::{FigureValue, Result, detail};
use crate::compare::{edge_pictures, edge_scene};
use crate::parallel;
use image::RgbImage;
use pxpl5_machine::MachineConfig;
use pxpl5_measure::Registration;
use pxpl5_run::{Experiment, ExperimentError, Head, Jitp, Outcome, Pixels, Viewpoint};
use pxpl5_sim::figures::Basis;
use pxpl5_wire::PeriodNumber;
use pxpl5_wire::display::Aim;
use std::sync::Arc;
use tracking::motion::Pan;
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;

pub(super) const TITLE: &str = "Just-in-time pixels";

pub(super) const ABOUT: &str = "The head turns by 200 degrees a second in front of a tracker without error or delay, and the view is 60 degrees wide \
(JITP). The error of a pixel is the angle between the direction that it shows and the right one when it lights. Here it comes only from the age of \
the pose. As in JITP, a pixel is 0.1 degrees wide, and each angle is scaled to the whole time of a field or line, retrace included.";

/// Degrees per second of a fast turn of the head, published in the paper on just-in-time pixels.
const PAN: f64 = 200.0;

/// Horizontal pixels per degree of the picture, published in the paper on just-in-time pixels.
const PX_PER_DEG: f64 = 10.0;

/// Evaluated field. The number is even, and the field is long after the start of the run.
const FIELD: PeriodNumber = PeriodNumber(40);

/// Evaluated column of the 640 x 480 picture.
const COLUMN: u32 = 320;
/// Middle line of the 640 x 480 picture.
const MIDDLE_LINE: u32 = 240;
/// Last line of an even field in the 640 x 480 picture.
const LAST_LINE: u32 = 478;

const JITP: (&str, &str) = ("JITP", "raster");

const OF_FIELD: &str =
    "jitp-field-racing on small-hmd with an aim at the first pixel: the error of the last line of a field";
const OF_LINE: &str = "jitp-scanline-racing with strips of one line: the error of both ends of the middle line";

const BY_TURN: Basis = Basis::Derived("200 deg/s and the times of NTSC");

/// The figures of just-in-time pixels, in the order of their numbers.
pub(super) const FIGURES: &[Measurement] = &[
    Measurement {
        basis: BY_TURN,
        ..figure(("J1", JITP, 3.3, "deg"), "error of one transform a field", OF_FIELD, error_of_field)
    },
    Measurement {
        basis: BY_TURN,
        ..figure(("J1b", JITP, 33.0, "px"), "the same", OF_FIELD, |settings| in_pixels(error_of_field(settings)?))
    },
    Measurement {
        basis: BY_TURN,
        ..figure(("J2", JITP, 0.013, "deg"), "error of one transform a line", OF_LINE, error_of_line)
    },
    Measurement {
        basis: BY_TURN,
        ..figure(("J2b", JITP, 0.13, "px"), "the same", OF_LINE, |settings| in_pixels(error_of_line(settings)?))
    },
    Measurement {
        range: Some(1.5),
        basis: Basis::Derived("the times of NTSC"),
        ..figure(
            ("J3", JITP, 65.0, "us"),
            "a line takes about",
            "the time between the first pixels of two lines of a field",
            time_of_line,
        )
    },
    Measurement {
        reason: "The paper shows a straight edge, and no rule was chosen to get it",
        ..figure(
            ("J4", JITP, 100.0, "%"),
            "share of the slant of a vertical edge that just-in-time pixels remove: seen straight",
            "an edge by jitp-field and by jitp-scanline, as seen by an eye that turns with the head: the slant of a straight line through all rows",
            slant_removed,
        )
    },
    Measurement {
        basis: Basis::Derived("240 visible lines"),
        cause: "A field has 240 visible lines, and JITP's 256 is a round number",
        ..figure(
            ("J5", JITP, 256.0, "times"),
            "vertices transformed line by line, over those of one transform a field: about",
            "jitp-scanline-racing and jitp-field-racing with one slave, whose software takes no time, so no line is late: vertices transformed in 20 fields",
            transforms,
        )
    },
];

fn head() -> Result<Head> {
    Ok(Head::new(Arc::new(Pan::at(PAN)), TrackerConfig::ideal(), PredictorKind::ConstantVelocity, 1)?)
}

fn run(
    settings: &FigureSettings,
    machine: MachineConfig,
    viewpoint: Viewpoint,
    aim: Aim,
    fields: u64,
) -> Result<Outcome> {
    let jitp = Jitp { strip_rows: 1, ..Jitp::new(viewpoint, true) };
    let experiment = Experiment::new(machine, jitp, edge_scene(0.0)).head(head()?.with_aim(aim));
    Ok(experiment.fields(fields).pixels(Pixels::Off).stopped_by(settings.stop.clone()).run()?)
}

/// Returns the pixel error at one pixel of the evaluated field, in degrees.
fn degrees(outcome: &Outcome, x: u32, y: u32) -> Result<f64> {
    let shown = Registration::of(outcome).and_then(|registration| registration.at(x, y, FIELD));
    let nothing = || ExperimentError::Scene(format!("pixel ({x}, {y}) of field {} shows nothing", FIELD.0));
    Ok(shown.ok_or_else(nothing)?.degrees)
}

/// Returns the time in seconds between the beam's passes over two pixels of a field.
fn beam_s(outcome: &Outcome, from: (u32, u32), to: (u32, u32)) -> f64 {
    let display = outcome.record().display();
    let at_s = |(x, y)| display.lights(0, x, y, FIELD).map_or(f64::NAN, |at| at.0 as f64 / 1e12);
    at_s(to) - at_s(from)
}

fn in_pixels(angle: FigureValue) -> Result<FigureValue> {
    Ok((angle.value * PX_PER_DEG).into())
}

/// Measures row J1 of ACCURACY.md: the head's rotation while the beam draws a field. The rotation is measured from the
/// first pixel to the last line, and scaled to the time between two retraces.
fn error_of_field(settings: &FigureSettings) -> Result<FigureValue> {
    let outcome = run(settings, settings.machine("small-hmd")?, Viewpoint::Field, Aim::FirstPixel, FIELD.0 + 2)?;
    let surface = &outcome.record().display().surfaces()[0];
    let [width, height] = [surface.width, surface.height].map(f64::from);
    let focal_px = width / 2.0 / 30_f64.to_radians().tan();
    // The evaluated pixel lies below the horizon, so a rotation about the vertical axis moves the pixel along a
    // smaller circle.
    let level = focal_px / f64::hypot(focal_px, f64::from(LAST_LINE) + 0.5 - height / 2.0);
    // The measured angle is a chord, so it is converted to a rotation.
    let chord = (degrees(&outcome, COLUMN, LAST_LINE)? / 2.0).to_radians().sin();
    let turn_deg = 2.0 * (chord / level).asin().to_degrees();
    let scan_s = beam_s(&outcome, (0, 0), (COLUMN, LAST_LINE));
    let details = vec![detail("at the last line", turn_deg, "deg")];
    Ok(FigureValue::with(turn_deg / scan_s * outcome.field_ms() / 1e3, details))
}

/// Measures row J2 of ACCURACY.md: the head's rotation while the beam draws a line. The rotation is measured between
/// the first and the last pixel, and scaled to the duration of the whole line.
fn error_of_line(settings: &FigureSettings) -> Result<FigureValue> {
    let outcome = run(settings, settings.machine("small-hmd")?, Viewpoint::Strip, Aim::Middle, FIELD.0 + 2)?;
    let last = outcome.record().display().surfaces()[0].width - 1;
    // The line is drawn for its middle, so the errors of both ends add up.
    let ends_deg = degrees(&outcome, 0, MIDDLE_LINE)? + degrees(&outcome, last, MIDDLE_LINE)?;
    let active_s = beam_s(&outcome, (0, MIDDLE_LINE), (last, MIDDLE_LINE));
    let line_s = beam_s(&outcome, (0, MIDDLE_LINE), (0, MIDDLE_LINE + 2));
    Ok((ends_deg / active_s * line_s).into())
}

/// Measures row J3 of ACCURACY.md: the time between two successive lines of a field.
fn time_of_line(settings: &FigureSettings) -> Result<FigureValue> {
    let outcome = run(settings, settings.machine("small-hmd")?, Viewpoint::Field, Aim::FirstPixel, FIELD.0 + 2)?;
    Ok((beam_s(&outcome, (0, 0), (0, 2)) * 1e6).into())
}

/// Measures row J4 of ACCURACY.md: the slant of a vertical edge in a conventional picture, and in a picture of
/// just-in-time pixels.
fn slant_removed(settings: &FigureSettings) -> Result<FigureValue> {
    let plates = edge_pictures(&settings.machine("small-hmd")?, PAN)?;
    let [conventional, just_in_time] = [&plates.conventional_seen, &plates.just_in_time_seen].map(slant);
    let details =
        vec![detail("conventional", conventional, "px a field"), detail("just-in-time", just_in_time, "px a field")];
    Ok(FigureValue::with(100.0 * (1.0 - (just_in_time / conventional).abs()), details))
}

/// Returns the slant of an edge in pixels, from the first row to the last row. A straight line is fitted through the
/// right ends of the white pixels.
fn slant(picture: &RgbImage) -> f64 {
    let end = |row| (0..picture.width()).rev().find(|x| picture.get_pixel(*x, row)[0] > 100).map_or(0, |x| x + 1);
    let rows = f64::from(picture.height());
    // Fit the line by least squares.
    let middle = (rows - 1.0) / 2.0;
    let ends: Vec<f64> = (0..picture.height()).map(|row| f64::from(end(row))).collect();
    let from_middle = |row: usize| row as f64 - middle;
    let up: f64 = ends.iter().enumerate().map(|(row, column)| from_middle(row) * column).sum();
    let down: f64 = (0..ends.len()).map(|row| from_middle(row).powi(2)).sum();
    up / down * (rows - 1.0)
}

/// Measures row J5 of ACCURACY.md from the number of vertex transforms per field, over [`COUNTED`] fields. The
/// transforms before these fields are counted in a run without these fields, and then subtracted.
fn transforms(settings: &FigureSettings) -> Result<FigureValue> {
    let counted = |viewpoint, fields| -> Result<u64> {
        Ok(run(settings, free_slave(settings)?, viewpoint, Aim::Middle, fields)?.record().vertex_transforms())
    };
    // The difference of two runs removes the start.
    let a_field = |viewpoint| -> Result<f64> {
        let before = counted(viewpoint, FIELD.0)?;
        Ok((counted(viewpoint, FIELD.0 + COUNTED)? - before) as f64 / COUNTED as f64)
    };
    let (line, field) = parallel::both(|| a_field(Viewpoint::Strip), || a_field(Viewpoint::Field));
    let (line, field) = (line?, field?);
    let details = vec![
        detail("line by line", line, "vertices a field"),
        detail("one transform a field", field, "vertices a field"),
    ];
    Ok(FigureValue::with(line / field, details))
}

/// Number of display fields over which the transforms of vertices are counted.
const COUNTED: u64 = 20;

/// Returns a machine with one slave. All software takes no simulated time, because only the number of transforms is
/// measured.
fn free_slave(settings: &FigureSettings) -> Result<MachineConfig> {
    let mut machine = MachineConfig { n_gps: 2, code: None, ..settings.machine("small-hmd")? };
    for name in ["message", "triangle", "guard", "bin_entry", "token_entry", "edit", "pass", "structure"] {
        machine.set(&format!("gp.{name}_ns"), 0)?;
    }
    Ok(machine)
}
