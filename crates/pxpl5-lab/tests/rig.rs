//! Tests of the pendulum rig in front of the machine. The measurements outside and inside the machine agree, and each
//! measurement reveals faults of the other.

use pphigs::FrameView;
use pxpl5_lab::rig::{Rig, RigQuery};
use pxpl5_lab::{Study, StudyError};
use pxpl5_machine::{Machine, MachineConfig, Record};
use pxpl5_run::{
    PictureRules, PictureTimes, Pipeline, PipelineProperties, PipelineSettings, Registry, RenderingControl, Setup,
    ViewSource,
};
use pxpl5_sim::Time;
use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::ViewNumber;
use std::sync::{Arc, Mutex};
use tracking::Pose;
use tracking::rig::Measurement;
use tracking::tracker::TrackerConfig;

fn noiseless(tracker: TrackerConfig) -> TrackerConfig {
    TrackerConfig { position_noise_m: 0.0, orientation_noise_deg: 0.0, ..tracker }.without_systematic_errors()
}

fn rig(tracker: TrackerConfig, passes: usize) -> Rig {
    Rig { passes, ..Rig::assumed(noiseless(tracker)) }
}

fn on(rig: Rig, machine: MachineConfig, pipeline: Arc<dyn Pipeline>) -> Result<Measurement, StudyError> {
    Ok(RigQuery { rig, machine, pipeline }.run(&mut ())?.measured)
}

fn measure(tracker: TrackerConfig, pipeline: Arc<dyn Pipeline>, passes: usize) -> Result<Measurement, StudyError> {
    on(rig(tracker, passes), MachineConfig::small_hmd(), pipeline)
}

fn named(name: &str) -> Arc<dyn Pipeline> {
    (Registry::of_papers().pipeline(name).expect("listed").build)(&PipelineSettings::default())
}

fn ms(seconds: f64) -> f64 {
    seconds * 1e3
}

#[test]
fn external_and_internal_latencies_differ_at_most_by_a_report_interval_and_the_photodiode_delay() {
    let trackers = [TrackerConfig::ideal(), TrackerConfig::fastrak(), TrackerConfig::optical_ceiling()];
    for pipeline in ["rendering-control", "slats", "jitp-field-racing"] {
        for tracker in &trackers {
            let measured = measure(tracker.clone(), named(pipeline), 6).expect("two triangles");
            assert!(measured.agrees(), "{pipeline} {}", tracker.name);
            let bound_s = measured.bound_ps() as f64 * 1e-12;
            assert!(measured.outside_less_inside_s().abs() <= bound_s, "{pipeline} {}", tracker.name);
        }
    }
}

/// Tests two pipelines that the rig refuses. A display that follows the head's rotation shows the rotation before any
/// frame. Under frameless rendering the light comes from one block of pixels, not from a frame.
#[test]
fn pipelines_without_frames_are_refused_with_the_reason() {
    for (pipeline, reason) in [
        ("arp-full", "turns with the head"),
        ("arp-full-line", "turns with the head"),
        ("arp-ideal-pixel", "turns with the head"),
        ("frameless", "parts of the screen change one by one"),
    ] {
        let Err(refused) = measure(TrackerConfig::ideal(), named(pipeline), 2) else {
            panic!("{pipeline} is measured")
        };
        let message = refused.to_string();
        assert!(matches!(refused, StudyError::Setting(_)) && message.contains(reason), "{message}");
    }
}

#[test]
fn the_external_latency_of_slats_is_a_field_plus_the_delay_of_the_photodiode_line() {
    // One processor begins TRANSFORM at the retrace. Several processors would need a message first.
    let measured = on(rig(TrackerConfig::fastrak(), 6), MachineConfig::slats(), named("slats"));
    let measured = measured.expect("two triangles");
    let line_ms = 4.004 / 63.0;
    // One field has 262.5 lines. Line 120 is 142 lines after the retrace, half a line more in odd fields. The middle
    // of a line is 460 of 780 pixel periods after its start.
    let least = (262.5 + 142.0 + 460.0 / 780.0) * line_ms;
    let found = measured.outside.rendering;
    assert!((ms(found.min) - least).abs() < 1e-3 || (ms(found.min) - least - line_ms / 2.0).abs() < 1e-3, "{found:?}");
    assert!(ms(found.max) < least + line_ms / 2.0 + 1e-3, "{found:?}");
}

/// The pipeline Rendering Control with an injected fault.
#[derive(Debug)]
struct Faulty {
    inner: RenderingControl,
    fault: Fault,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    /// The time stamps of pictures are one field too early, so that the inside measurement is wrong.
    EarlyStamps,
    /// Frames show the pose of the previous frame. Their light comes one frame late, while the time stamps stay the
    /// same.
    StaleViews,
}

/// Head poses that lag behind by one pose.
#[derive(Debug)]
struct Stale {
    views: Arc<dyn ViewSource>,
    last: Mutex<Option<FrameView>>,
}

impl ViewSource for Stale {
    fn newest(&self, number: ViewNumber, now: Time) -> FrameView {
        let fresh = self.views.newest(number, now);
        let shown = self.last.lock().expect("one thread").replace(fresh.clone()).unwrap_or_else(|| fresh.clone());
        FrameView { number: fresh.number, ..shown }
    }

    fn view_at(&self, number: ViewNumber, now: Time, shown_at: Time) -> FrameView {
        self.views.view_at(number, now, shown_at)
    }

    fn pose_at(&self, now: Time, at: Time) -> Pose {
        self.views.pose_at(now, at)
    }

    fn report_from(&self, instant: Time) -> Option<Time> {
        self.views.report_from(instant)
    }
}

impl Pipeline for Faulty {
    fn name(&self) -> &'static str {
        "faulty"
    }

    fn properties(&self) -> PipelineProperties {
        self.inner.properties()
    }

    fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), SettingError> {
        let mut views = Arc::clone(&setup.views);
        if self.fault == Fault::StaleViews {
            views = Arc::new(Stale { views, last: Mutex::default() });
        }
        self.inner.load(machine, &Setup { views, ..setup.clone() })
    }
}

impl PictureRules for Faulty {
    fn pictures(&self, record: &Record, end: Time) -> Vec<PictureTimes> {
        let early = if self.fault == Fault::EarlyStamps { 16_683_333_333 } else { 0 };
        let pictures = self.inner.pictures(record, end).into_iter();
        pictures.map(|times| PictureTimes { shown_at: Time(times.shown_at.0 - early), ..times }).collect()
    }

    fn periods_a_picture(&self, record: &Record) -> Option<u64> {
        self.inner.periods_a_picture(record)
    }
}

#[test]
fn each_measurement_detects_errors_of_the_other_measurement() {
    let with = |fault| {
        let faulty = Faulty { inner: RenderingControl::stereo(), fault };
        measure(TrackerConfig::fastrak(), Arc::new(faulty), 4)
    };
    let early = with(Fault::EarlyStamps).expect("light comes");
    assert!(!early.agrees(), "{early:?}");
    // The light of the last frame never appears. The rig either reports so, or the latencies disagree.
    match with(Fault::StaleViews) {
        Ok(stale) => assert!(!stale.agrees(), "{stale:?}"),
        Err(error) => assert!(matches!(error, StudyError::Setting(_)), "{error}"),
    }
}

#[test]
fn a_photodiode_below_the_screen_is_refused() {
    let mut rig = Rig::assumed(TrackerConfig::ideal());
    rig.rig.photodiode_line = 240;
    let error = on(rig, MachineConfig::small_hmd(), named("slats")).expect_err("there are 240 lines");
    assert!(error.to_string().contains("from 0 to 239, found 240"), "{error}");
}
