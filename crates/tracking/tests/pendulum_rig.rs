//! The pendulum rig measures exactly the latencies that the test has simulated.

use tracking::motion::Motion;
use tracking::rig::{Detection, InsidePass, LowPointReport, Measurement, Oscilloscope, PendulumRig, ScopeTrace};
use tracking::time::{NTSC_FIELD_PS, PS_PER_MS, PS_PER_S, ntsc_lines_ps, seconds};
use tracking::tracker::{SerialLine, SerialRead, TrackerConfig, TrackerFault, TrackerModel};

/// Returns the instant at which a frame is shown. This is the start of the next field after 57 ms from the frame's
/// start (Rendering Control).
fn pipeline(start_ps: u64) -> u64 {
    (start_ps + 57 * PS_PER_MS).div_ceil(NTSC_FIELD_PS) * NTSC_FIELD_PS
}

fn noiseless(config: TrackerConfig) -> TrackerConfig {
    let noiseless = TrackerConfig { position_noise_m: 0.0, orientation_noise_deg: 0.0, ..config };
    noiseless.without_systematic_errors()
}

/// Returns the time from the retrace until the beam passes the photodiode's scanline, without blanking.
fn place_ps(rig: &PendulumRig) -> u64 {
    ntsc_lines_ps(rig.photodiode_line)
}

/// Returns the pendulum's passes as measured by correct time stamps.
fn inside(rig: &PendulumRig, tracker: &TrackerModel, passes: usize) -> Vec<InsidePass> {
    let sightings = rig.sightings(tracker, 1, passes).unwrap();
    let pass = |sighting: LowPointReport| {
        let started_ps = sighting.arrives_ps;
        InsidePass { sighting, started_ps, shown_ps: pipeline(started_ps) }
    };
    sightings.into_iter().map(pass).collect()
}

fn oscilloscope(rig: &PendulumRig, inside: &[InsidePass]) -> Oscilloscope {
    let dac = ScopeTrace::toggling("D/A line", inside.iter().map(|pass| pass.started_ps).collect());
    let light = inside.iter().map(|pass| pass.shown_ps + place_ps(rig));
    Oscilloscope::of(rig, dac, ScopeTrace::toggling("screen", light.collect()))
}

fn measure(rig: PendulumRig, config: TrackerConfig) -> Measurement {
    let tracker = TrackerModel::new(config).unwrap();
    let inside = inside(&rig, &tracker, 200);
    rig.compare(&tracker, place_ps(&rig), &oscilloscope(&rig, &inside), inside).unwrap()
}

#[test]
fn the_optical_tracker_detects_the_low_point_33_ms_to_33_ms_plus_one_report_interval_later() {
    let measured = measure(PendulumRig::assumed(), noiseless(TrackerConfig::optical_ceiling()));
    let period_s = 1.0 / 60.0;
    assert!(measured.outside.tracking.min >= 0.033 && measured.outside.tracking.max <= 0.033 + period_s + 1e-9);
    // Low points fall anywhere in a period, so half a period is added on average.
    assert!(
        (measured.outside.tracking.mean - 0.033 - period_s / 2.0).abs() < 1.5e-3,
        "{}",
        measured.outside.tracking.mean
    );
    assert_eq!(measured.tracking_bound_ps, PS_PER_S / 60);
}

#[test]
fn external_rendering_latency_is_internal_latency_plus_the_delay_of_the_photodiode_line() {
    for photodiode_line in [0, 120, 239] {
        let rig = PendulumRig { photodiode_line, ..PendulumRig::assumed() };
        let measured = measure(rig, noiseless(TrackerConfig::optical_ceiling()));
        let difference = measured.outside.rendering.mean - measured.inside.rendering.mean;
        assert!((difference - seconds(ntsc_lines_ps(photodiode_line))).abs() < 1e-12);
        // The latency is 57 ms plus the wait for a field.
        assert!(measured.inside.rendering.min >= 0.057 && measured.inside.rendering.max < 0.074);
    }
}

#[test]
fn external_and_internal_latencies_agree_within_the_bound_for_every_tracker_and_line() {
    let slow_line = Some(SerialLine { baud: 9600, ..SerialLine::fastrak() });
    for config in [
        TrackerConfig::ideal(),
        TrackerConfig::fastrak(),
        TrackerConfig { serial: slow_line, ..TrackerConfig::fastrak() },
        TrackerConfig { host: SerialRead::unix(), ..TrackerConfig::fastrak() },
        TrackerConfig::flock_of_birds(),
        TrackerConfig::optical_ceiling(),
        TrackerConfig::polhemus_3space(),
    ] {
        for detection in [Detection::Crossing, Detection::VelocitySign] {
            let rig = PendulumRig { detection, ..PendulumRig::assumed() };
            let measured = measure(rig, noiseless(config.clone()));
            let difference = measured.outside_less_inside_s();
            let bound = seconds(measured.bound_ps());
            assert!(difference > 0.0 && difference <= bound, "{} {detection:?}: {difference} of {bound}", config.name);
            assert!(measured.agrees(), "{}", config.name);
            for (outside, inside) in measured.outside_passes.iter().zip(&measured.inside_passes) {
                let late_ps = inside.sighting.measured_ps - outside.low_point_ps;
                assert!(late_ps <= measured.tracking_bound_ps + 1, "{} {detection:?}: {late_ps}", config.name);
            }
        }
    }
}

#[test]
fn with_noise_the_mean_latencies_still_agree() {
    for config in [TrackerConfig::fastrak(), TrackerConfig::flock_of_birds(), TrackerConfig::optical_ceiling()] {
        let measured = measure(PendulumRig::assumed(), config.clone());
        let difference = measured.outside_less_inside_s();
        assert!(difference > 0.0 && difference <= seconds(measured.bound_ps()), "{}", config.name);
    }
}

#[test]
fn with_a_millimetre_of_noise_the_sign_of_the_velocity_does_not_detect_the_low_point() {
    // The arc is flat at the low point, so noise changes the sign of the velocity. The default method therefore detects
    // the crossing.
    let rig = PendulumRig { detection: Detection::VelocitySign, ..PendulumRig::assumed() };
    let measured = measure(rig, TrackerConfig::fastrak());
    let passes = measured.outside_passes.iter().zip(&measured.inside_passes);
    let off_ps = passes.map(|(outside, inside)| inside.sighting.measured_ps.abs_diff(outside.low_point_ps));
    let wrong = off_ps.filter(|off| *off > 20 * PS_PER_MS).count();
    assert!(wrong > measured.outside_passes.len() / 4, "{wrong}");
}

#[test]
fn every_low_point_is_detected_once_and_successive_frames_alternate_between_light_and_dark() {
    let rig = PendulumRig::assumed();
    let tracker = TrackerModel::new(TrackerConfig::fastrak()).unwrap();
    let inside = inside(&rig, &tracker, 200);
    let screen = oscilloscope(&rig, &inside);
    for (n, pass) in screen.passes(&rig).unwrap().iter().enumerate() {
        assert_eq!(pass.low_point_ps, rig.pendulum.low_point_ps(n as u64));
        assert!(screen.low_point.level(pass.low_point_ps));
        assert_eq!(screen.screen.level(pass.light_ps), n % 2 == 0);
        assert_eq!(screen.screen.level(pass.light_ps - 1), n % 2 == 1);
        assert_eq!(screen.dac.level(pass.dac_ps), n % 2 == 0);
    }
}

#[test]
fn the_low_points_pulse_lasts_as_long_as_the_bob_is_in_the_beam() {
    let rig = PendulumRig::assumed();
    let tracker = TrackerModel::new(TrackerConfig::ideal()).unwrap();
    let low_point = oscilloscope(&rig, &inside(&rig, &tracker, 1)).low_point;
    let [on, off] = [0, 1].map(|i| low_point.edges()[i].t_ps);
    let width_m = rig.pendulum.pose(on).distance_m(&rig.pendulum.pose(off));
    assert!((width_m - 0.002).abs() < 1e-6);
}

#[test]
fn a_silent_tracker_is_an_error() {
    let faults = vec![TrackerFault::Silence { from_ps: 3 * PS_PER_S }];
    let tracker = TrackerModel::new(TrackerConfig { faults, ..TrackerConfig::fastrak() }).unwrap();
    // Low points come at 0.36 s and every 0.71 s. Four of them come before the tracker falls silent.
    let error = PendulumRig::assumed().sightings(&tracker, 1, 100).unwrap_err();
    assert_eq!(error.to_string(), "expected 100 low points, the host detected 4");
}

#[test]
fn a_frame_that_never_lights_is_an_error() {
    let rig = PendulumRig::assumed();
    let tracker = TrackerModel::new(TrackerConfig::ideal()).unwrap();
    let inside = inside(&rig, &tracker, 3);
    let oscilloscope = oscilloscope(&rig, &inside[..2]);
    let dac = ScopeTrace::toggling("D/A line", inside.iter().map(|pass| pass.started_ps).collect());
    let dark = Oscilloscope { dac, ..oscilloscope };
    let error = rig.compare(&tracker, 0, &dark, inside).unwrap_err();
    assert_eq!(
        error.to_string(),
        "expected the photodiode on the screen to change for each of 3 frames, found 2 changes"
    );
}

/// Each measurement detects errors of the other. They disagree if they differ by more than the limits, 8.3 and 7.6 ms
/// here.
#[test]
fn each_measurement_detects_errors_of_the_other_measurement() {
    let rig = PendulumRig::assumed();
    let tracker = TrackerModel::new(noiseless(TrackerConfig::fastrak())).unwrap();
    let truth = inside(&rig, &tracker, 50);
    let scope = oscilloscope(&rig, &truth);
    let agree = |scope: &Oscilloscope, inside: Vec<InsidePass>| {
        rig.compare(&tracker, place_ps(&rig), scope, inside).unwrap().agrees()
    };
    let shifted = |by_ps: i64| -> Vec<InsidePass> {
        let shift = |pass: &InsidePass| InsidePass { shown_ps: pass.shown_ps.strict_add_signed(by_ps), ..*pass };
        truth.iter().map(shift).collect()
    };
    assert!(agree(&scope, truth.clone()));
    // The light comes before the pipeline shows the frame, by less than the photodiode's delay of 7.6 ms. This is
    // possible only if the pipeline counts frames inside the scan.
    let place_too_late = place_ps(&rig) as i64 + 6 * PS_PER_MS as i64;
    assert!(!agree(&scope, shifted(place_too_late)));
    let measured = rig.compare(&tracker, place_ps(&rig), &scope, shifted(place_too_late)).unwrap();
    assert!(measured.with_frames_counted_in_scan(place_ps(&rig) + 6 * PS_PER_MS).agrees());
    // The pipeline counts a field too few, or its time stamp of the start is 20 ms late.
    assert!(!agree(&scope, shifted(-(NTSC_FIELD_PS as i64))));
    let late_stamp = |pass: &InsidePass| InsidePass { started_ps: pass.started_ps + 20 * PS_PER_MS, ..*pass };
    assert!(!agree(&scope, truth.iter().map(late_stamp).collect()));
    // The signal of the photodiode is a field late, or the light comes from the previous frame.
    let late = truth.iter().map(|pass| pass.shown_ps + place_ps(&rig) + NTSC_FIELD_PS);
    let late = Oscilloscope { screen: ScopeTrace::toggling("screen", late.collect()), ..scope };
    assert!(!agree(&late, truth.clone()));
}
