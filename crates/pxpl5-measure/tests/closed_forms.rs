//! Pixel errors of every pipeline, compared with formulas that share only the timing of NTSC with the program.
//!
//! With a perfect tracker and constant velocity, a steady rotation is predicted exactly. The remaining error comes from
//! scan-out: a pixel that is lit at time t and was drawn for time a is rotated by |v| |t - a|. For a sinusoid the
//! prediction itself is wrong: a straight line through two of its points differs from the sinusoid.

use crate::support::{LINE_S, beam, retrace};
use pxpl5_machine::MachineConfig;
use pxpl5_measure::{Measured, PixelErrors, Showing};
use pxpl5_run::{Aim, Cause, Experiment, Head, Outcome, PipelineSettings, Pixels, Registry, SampledPose};
use pxpl5_scene::builtin;
use pxpl5_wire::ViewNumber;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::Arc;
use tracking::motion::{Motion, Pan};
use tracking::predict::{PredictorConfig, PredictorKind};
use tracking::tracker::TrackerConfig;
use tracking::{Pose, SettingSink};

const FIELDS: u64 = 45;

/// Returns the instant that an aim selects within a range of rows.
fn aimed(aim: Aim, (first_field, first_row): (u64, u64), (last_field, last_row): (u64, u64)) -> f64 {
    aimed_between(aim, first_field, beam(first_field, first_row, 0), beam(last_field, last_row, 639))
}

/// Returns the instant that an aim selects between a first and a last pixel of a field.
fn aimed_between(aim: Aim, field: u64, first: f64, last: f64) -> f64 {
    match aim {
        Aim::Middle => (first + last) / 2.0,
        Aim::FirstPixel => first,
        Aim::LastPixel => last,
        Aim::Retrace => retrace(field),
    }
}

/// Returns the pixels that use the same load of the orientation register, with a latch per pixel.
///
/// The host sends nine words per load, one load after the other. The loads start again with each line, which has room
/// for eight loads.
fn of_one_load(x: u64) -> (u64, u64) {
    let pixels = ORIENTATION_S / (LINE_S / 780.0);
    let load = (x as f64 / pixels).floor().min(7.0);
    let last = if load < 7.0 { ((load + 1.0) * pixels).ceil() as u64 - 1 } else { 639 };
    ((load * pixels).ceil() as u64, last)
}

/// Interval of the ideal tracker's reports, which arrive without delay.
///
/// An orientation takes nine words of four bytes at 5 MB/s to the register. The register is latched 26 stages of 25 ns
/// before the first pixel, or 24 stages with one memory.
const REPORT_S: f64 = 1e-3;
const ORIENTATION_S: f64 = 36.0 / 5e6;
const STAGE_S: f64 = 25e-9;

/// Content of a pixel: the newest measurement it uses, and the instant it is drawn for.
struct Content {
    measured: Measurement,
    drawn_for: f64,
}

/// A measurement, identified by the view that uses it or by its time.
enum Measurement {
    Of(ViewNumber),
    At(f64),
}

/// A run and the data that the formulas need.
struct Run {
    pipeline: &'static str,
    aim: Aim,
    outcome: Outcome,
    sampled: BTreeMap<ViewNumber, SampledPose>,
    /// First field that shows each picture, and its view.
    shown: Vec<(u64, ViewNumber)>,
    /// For each block of frameless rendering, the arrivals with their times and updates.
    blocks: BTreeMap<u64, Vec<(f64, ViewNumber)>>,
}

impl Run {
    fn new(pipeline: &'static str, aim: Aim, motion: impl Motion + Send + Sync + 'static) -> Self {
        let registry = Registry::of_papers();
        let built = (registry.pipeline(pipeline).expect("listed").build)(&PipelineSettings::default());
        // The closed form needs the baseline of the predictor, so the predictor is not tuned.
        let tracker = TrackerConfig::ideal();
        let predictor = PredictorConfig::for_tracker(PredictorKind::ConstantVelocity, &tracker);
        let head = Head::predicted_by(Arc::new(motion), tracker, predictor, 1);
        let head = head.expect("in range").with_aim(aim);
        let scene = Arc::new(builtin("full-screen:2").expect("built in"));
        let experiment = Experiment::with(MachineConfig::small_hmd(), built, scene).head(head);
        let outcome = experiment.fields(FIELDS).pixels(Pixels::Off).run().expect("two triangles");
        let head = outcome.head().expect("there is one");
        let sampled = head.sampled().into_iter().map(|sampled| (sampled.number, sampled)).collect();
        let field_of = |at_ps: u64| (at_ps as f64 * 1e-12 / retrace(1) + 1e-9).floor() as u64;
        let shown = outcome.pictures().iter().map(|times| (field_of(times.shown_at.0), times.view)).collect();
        let mut blocks: BTreeMap<u64, Vec<(f64, ViewNumber)>> = BTreeMap::new();
        for arrival in &outcome.observation().arrivals {
            let of_block = blocks.entry(arrival.target.region.0.into()).or_default();
            of_block.push((arrival.last_part_at.0 as f64 * 1e-12, ViewNumber::taken_for(arrival.target.picture)));
        }
        Self { pipeline, aim, sampled, shown, blocks, outcome }
    }

    /// Returns the newest picture shown in a field: the field in which it was first shown, and its view.
    fn newest(&self, field: u64) -> (u64, ViewNumber) {
        *self.shown.iter().rev().find(|shown| shown.0 <= field).expect("shown before fields are evaluated")
    }

    fn content(&self, field: u64, row: u64, x: u64) -> Content {
        let all = ((field, 0), (field, 239));
        if self.pipeline.starts_with("arp-") {
            return self.content_of_faces(field, row, x);
        }
        let (view, (first, last)) = match self.pipeline {
            "rendering-control" => {
                let (begun, view) = self.newest(field);
                (view, ((begun, 0), (begun + 1, 239)))
            }
            "slats" => (self.newest(field).1, all),
            "jitp-field" | "jitp-field-racing" => (ViewNumber(field * 256), all),
            "frameless" => return self.content_of_block(field, row, x),
            strips if strips.starts_with("jitp-scanline") => {
                (ViewNumber(field * 256 + row), ((field, row), (field, row)))
            }
            _ => (ViewNumber(field * 256), ((field, row), (field, row))),
        };
        Content { measured: Measurement::Of(view), drawn_for: aimed(self.aim, first, last) }
    }

    /// Returns the content of a pixel that an address recalculation display shows.
    ///
    /// Faces are rotated by the newest orientation in the register. The orientation is predicted for the aim within its
    /// field, line, or group of pixels per load. A load is in the register at the latch of its first pixel, or slightly
    /// earlier.
    fn content_of_faces(&self, field: u64, row: u64, x: u64) -> Content {
        let stages =
            if ["arp-full", "arp-ideal"].iter().any(|one| self.pipeline.starts_with(one)) { 24.0 } else { 26.0 };
        let depth = stages * STAGE_S;
        let (loaded_for, first, last) = match self.pipeline {
            name if name.ends_with("-pixel") => {
                let (first, last) = of_one_load(x);
                let loads = (first as f64 * LINE_S / 780.0 / ORIENTATION_S).floor();
                (beam(field, row, 0) + loads * ORIENTATION_S, beam(field, row, first), beam(field, row, last))
            }
            name if name.ends_with("-line") => (beam(field, row, 0), beam(field, row, 0), beam(field, row, 639)),
            _ => (beam(field, 0, 0), beam(field, 0, 0), beam(field, 239, 639)),
        };
        let measured = ((loaded_for - depth - ORIENTATION_S) / REPORT_S).floor() * REPORT_S;
        let drawn_for = aimed_between(self.aim, field, first, last);
        Content { measured: Measurement::At(measured), drawn_for }
    }

    /// Returns the time of the newest measurement that a pixel's content uses.
    fn measured_at(&self, content: &Content) -> f64 {
        match content.measured {
            Measurement::At(at) => at,
            Measurement::Of(view) => self.sampled[&view].measured_at.expect("reports came").0 as f64 * 1e-12,
        }
    }

    /// Returns the content of a block. The time at which it was drawn comes from the run, because blocks have a random
    /// order.
    fn content_of_block(&self, field: u64, row: u64, x: u64) -> Content {
        let y = 2 * row + field % 2;
        let arrivals = &self.blocks[&(y / 16 * 40 + x / 16)];
        let (_, view) = arrivals.iter().rev().find(|arrival| arrival.0 <= beam(field, row, x)).expect("drawn by now");
        let predicted_for = self.sampled[view].predicted_for.expect("predicted");
        Content { measured: Measurement::Of(*view), drawn_for: predicted_for.0 as f64 * 1e-12 }
    }

    /// Returns the evaluated pixels: five by five in every field of the window, as in [`PixelErrors`].
    ///
    /// For Rendering Control, only pixels of frames shown within the window count.
    fn evaluated(&self) -> impl Iterator<Item = (u64, u64, u64)> + '_ {
        let places = |size: u64| (0..5).map(move |i| (2 * i + 1) * size / 10);
        let in_field = move |field| places(480).flat_map(move |y| places(640).map(move |x| (field, y / 2, x)));
        let window = self.outcome.window().expect("long enough");
        let (first, last) = (window.first_period.0, window.last_period.0);
        assert!(last + 2 >= FIELDS && last < FIELDS, "{last}");
        let frames = self.pipeline == "rendering-control";
        (first..=last).filter(move |field| !frames || self.newest(*field).0 >= first).flat_map(in_field)
    }

    /// Returns the mean expected error in pixels and degrees. `turned_rad` is the rotation of a pixel's content about
    /// the vertical.
    fn expected(&self, turned_rad: impl Fn(&Content, f64) -> f64) -> [f64; 2] {
        let mut sum = [0.0, 0.0];
        let mut n = 0.0;
        for (field, row, x) in self.evaluated() {
            let turned = turned_rad(&self.content(field, row, x), beam(field, row, x));
            let y = (2 * row + field % 2) as f64;
            let [pixels, degrees] = error(x as f64 + 0.5 - 320.0, 240.0 - (y + 0.5), turned);
            sum = [sum[0] + pixels, sum[1] + degrees];
            n += 1.0;
        }
        sum.map(|sum| sum / n)
    }

    fn check(&self, expected: [f64; 2], tolerance: f64) {
        self.check_errors(&self.outcome.pixel_errors().expect("a head"), expected, tolerance);
    }

    fn check_errors(&self, errors: &PixelErrors, expected: [f64; 2], tolerance: f64) {
        let PixelErrors { pixels, degrees, empty, incomplete, .. } = errors;
        assert_eq!((*empty, *incomplete), (0, 0), "{}", self.pipeline);
        let found = [pixels.mean, degrees.mean];
        let off = [found[0] / expected[0] - 1.0, found[1] / expected[1] - 1.0];
        assert!(off.iter().all(|off| off.abs() < tolerance), "{} {}: {off:?}", self.pipeline, self.aim);
    }
}

/// Returns the distance between a picture position and its content after a rotation to the left, in pixels and degrees.
///
/// The position is given relative to the picture's middle.
fn error(right: f64, up: f64, turned_rad: f64) -> [f64; 2] {
    let focal = 320.0 / 30f64.to_radians().tan();
    let (sin, cos) = turned_rad.sin_cos();
    let seen = [right * cos + focal * sin, up, focal * cos - right * sin];
    let place = [seen[0] * focal / seen[2], seen[1] * focal / seen[2]];
    // The point moves on a circle about the vertical. The angle of the error is the angle of the chord.
    let radius = right.hypot(focal);
    let chord = radius / radius.hypot(up) * (turned_rad.abs() / 2.0).sin();
    [(place[0] - right).hypot(place[1] - up), 2.0 * chord.asin().to_degrees()]
}

fn pipelines() -> Vec<&'static str> {
    Registry::of_papers().pipelines().iter().map(|entry| entry.name).collect()
}

/// Runs every pipeline with two of the four aims. `PXPL5_ALL_CASES=1` runs every pipeline with all aims.
#[test]
fn with_ideal_prediction_a_pan_leaves_only_the_scan_out_error_in_every_pipeline() {
    // At this low speed, the error of interpolation on the screen is negligible relative to the scan-out of a line. The
    // interpolation error grows with the square of the speed and is 0.34 px at 200 deg/s.
    const DEG_PER_S: f64 = 0.02;
    let all = std::env::var_os("PXPL5_ALL_CASES").is_some();
    pipelines().par_iter().enumerate().for_each(|(number, pipeline)| {
        for (_, (_, aim)) in Aim::ALL.into_iter().enumerate().filter(|(of_aim, _)| all || of_aim % 2 == number % 2) {
            let run = Run::new(pipeline, aim, Pan::at(DEG_PER_S));
            let turned = |content: &Content, at: f64| DEG_PER_S.to_radians() * (at - content.drawn_for);
            run.check(run.expected(turned), 1e-3);
        }
    });
}

#[test]
fn a_fast_pan_leaves_only_the_scan_out_error_of_pictures_drawn_for_one_instant() {
    const DEG_PER_S: f64 = 200.0;
    pipelines().par_iter().filter(|name| !name.contains("dual")).for_each(|pipeline| {
        let run = Run::new(pipeline, Aim::Middle, Pan::at(DEG_PER_S));
        let turned = |content: &Content, at: f64| DEG_PER_S.to_radians() * (at - content.drawn_for);
        run.check(run.expected(turned), 1e-3);
    });
}

/// A head that oscillates about the vertical.
#[derive(Clone, Copy, Debug)]
struct Shaking;

/// Amplitude so small that the square of the speed is negligible.
const AMPLITUDE_DEG: f64 = 0.1;
const HZ: f64 = 0.5;

fn yaw(at_s: f64) -> f64 {
    (AMPLITUDE_DEG * (TAU * HZ * at_s).sin()).to_radians()
}

impl Motion for Shaking {
    fn pose(&self, t_ps: u64) -> Pose {
        Pose::facing(glam::DQuat::from_rotation_y(yaw(t_ps as f64 * 1e-12)))
    }
    fn identify(&self, settings: &mut SettingSink) {
        settings("motion", &"shaking");
    }
    fn velocity(&self, _: u64) -> glam::DVec3 {
        glam::DVec3::ZERO
    }
    fn angular_velocity(&self, t_ps: u64) -> glam::DVec3 {
        let rate = AMPLITUDE_DEG.to_radians() * TAU * HZ * (TAU * HZ * t_ps as f64 * 1e-12).cos();
        glam::DVec3::Y * rate
    }
}

#[test]
fn the_error_of_a_sinusoid_is_its_distance_from_a_straight_line_plus_scan_out() {
    // The predictor's line passes through the newest report and the fourth report before it, 4 ms apart.
    const BASELINE_S: f64 = 0.004;
    for pipeline in pipelines() {
        let run = Run::new(pipeline, Aim::Middle, Shaking);
        let turned = |content: &Content, at: f64| {
            let measured_at = run.measured_at(content);
            let slope = (yaw(measured_at) - yaw(measured_at - BASELINE_S)) / BASELINE_S;
            yaw(at) - (yaw(measured_at) + slope * (content.drawn_for - measured_at))
        };
        run.check(run.expected(turned), 1e-3);
        if pipeline.contains("dual") {
            continue;
        }
        // If prediction is removed as a cause of the error, the exact motion replaces it. Between two views the motion
        // is not a straight line.
        let scanned = |content: &Content, at: f64| yaw(at) - yaw(content.drawn_for);
        let errors = PixelErrors::without(&run.outcome, Showing::Plain, Cause::Prediction);
        run.check_errors(&errors, run.expected(scanned), 1e-3);
    }
}

#[test]
fn frameless_rendering_draws_blocks_for_the_middle_of_their_display_time() {
    let run = Run::new("frameless", Aim::Middle, Pan::at(20.0));
    let pass_s = 1.0 / run.outcome.report().updates_hz.expect("two passes");
    let early = |(field, row, x)| beam(field, row, x) - run.content(field, row, x).drawn_for;
    let all: Vec<f64> = run.evaluated().map(early).collect();
    let mean_s = all.iter().sum::<f64>() / all.len() as f64;
    assert!(mean_s.abs() < pass_s * 0.1, "{mean_s} {pass_s}");
}
