//! The rig finds, from outside, the latencies that were put in.

use tracking::motion::Motion;
use tracking::rig::{Detection, Measurement, PendulumRig, RigError};
use tracking::time::{NTSC_FIELD_PS, PS_PER_MS, PS_PER_S, ntsc_lines_ps, seconds};
use tracking::tracker::{Fault, HostLine, SerialLine, TrackerConfig, TrackerModel};

/// A pipeline of 57 ms (Rendering Control) whose frames wait for the next field.
fn pipeline(start_ps: u64) -> u64 {
    (start_ps + 57 * PS_PER_MS).div_ceil(NTSC_FIELD_PS) * NTSC_FIELD_PS
}

fn noiseless(config: TrackerConfig) -> TrackerConfig {
    TrackerConfig { position_noise_m: 0.0, orientation_noise_deg: 0.0, distortion: None, ..config }
}

fn measure(rig: PendulumRig, config: TrackerConfig) -> Measurement {
    rig.measure(&TrackerModel::new(config).unwrap(), 1, 200, pipeline).unwrap()
}

#[test]
fn the_low_point_is_seen_within_one_report_of_the_optical_tracker_and_33_ms_of_it() {
    let measured = measure(PendulumRig::assumed(), noiseless(TrackerConfig::optical_ceiling()));
    let period_s = 1.0 / 60.0;
    assert!(measured.tracking.least_s >= 0.033 && measured.tracking.greatest_s <= 0.033 + period_s + 1e-9);
    // Low points fall anywhere in a period, so on average half of one is added.
    assert!((measured.tracking.mean_s - 0.033 - period_s / 2.0).abs() < 1.5e-3, "{}", measured.tracking.mean_s);
    assert_eq!(measured.tracking_bound_ps, PS_PER_S / 60);
}

#[test]
fn rendering_is_the_inside_latency_plus_the_photodiodes_place() {
    for photodiode_line in [0, 120, 239] {
        let rig = PendulumRig { photodiode_line, ..PendulumRig::assumed() };
        let measured = measure(rig, noiseless(TrackerConfig::optical_ceiling()));
        let difference = measured.rendering.mean_s - measured.inside_rendering.mean_s;
        assert!((difference - seconds(ntsc_lines_ps(photodiode_line))).abs() < 1e-12);
        // 57 ms and the wait for a field.
        assert!(measured.inside_rendering.least_s >= 0.057 && measured.inside_rendering.greatest_s < 0.074);
    }
}

#[test]
fn outside_and_inside_agree_within_the_bound_for_every_tracker_and_line() {
    let slow_line = Some(SerialLine { baud: 9600, ..SerialLine::fastrak() });
    for config in [
        TrackerConfig::ideal(),
        TrackerConfig::fastrak(),
        TrackerConfig { serial: slow_line, ..TrackerConfig::fastrak() },
        TrackerConfig { host: HostLine::unix(), ..TrackerConfig::fastrak() },
        TrackerConfig::flock_of_birds(),
        TrackerConfig::optical_ceiling(),
        TrackerConfig::polhemus_3space(),
    ] {
        for detection in [Detection::Crossing, Detection::VelocitySign] {
            let rig = PendulumRig { detection, ..PendulumRig::assumed() };
            let measured = measure(rig, noiseless(config.clone()));
            let difference = measured.outside_less_inside_s();
            assert!(difference > 0.0 && difference <= seconds(measured.bound_ps()), "{}", config.name);
            for pass in &measured.passes {
                let late_ps = pass.measured_ps - pass.low_point_ps;
                assert!(late_ps <= measured.tracking_bound_ps + 1, "{} {detection:?}: {late_ps}", config.name);
            }
        }
    }
}

#[test]
fn with_noise_the_mean_still_agrees() {
    for config in [TrackerConfig::fastrak(), TrackerConfig::flock_of_birds(), TrackerConfig::optical_ceiling()] {
        let measured = measure(PendulumRig::assumed(), config.clone());
        let difference = measured.outside_less_inside_s();
        assert!(difference > 0.0 && difference <= seconds(measured.bound_ps()), "{}", config.name);
    }
}

#[test]
fn the_sign_of_the_velocity_fails_with_a_millimetre_of_noise() {
    // Why crossing is the default: around the low point the arc is flat.
    let rig = PendulumRig { detection: Detection::VelocitySign, ..PendulumRig::assumed() };
    let measured = measure(rig, TrackerConfig::fastrak());
    let wrong = measured.passes.iter().filter(|p| p.measured_ps.abs_diff(p.low_point_ps) > 20 * PS_PER_MS).count();
    assert!(wrong > measured.passes.len() / 4, "{wrong}");
}

#[test]
fn every_low_point_is_seen_once_and_frames_alternate() {
    let rig = PendulumRig::assumed();
    let measured = measure(rig, TrackerConfig::fastrak());
    for (n, pass) in measured.passes.iter().enumerate() {
        assert_eq!(pass.low_point_ps, rig.pendulum.low_point_ps(n as u64));
        assert!(measured.low_point.level(pass.low_point_ps));
        assert_eq!(measured.screen.level(pass.light_ps), n % 2 == 0);
        assert_eq!(measured.screen.level(pass.light_ps - 1), n % 2 == 1);
        assert_eq!(measured.dac.level(pass.dac_ps), n % 2 == 0);
    }
}

#[test]
fn the_low_points_pulse_lasts_as_long_as_the_bob_is_in_the_beam() {
    let rig = PendulumRig::assumed();
    let measured = measure(rig, TrackerConfig::ideal());
    let [on, off] = [0, 1].map(|i| measured.low_point.edges()[i].t_ps);
    let width_m = rig.pendulum.pose(on).distance_m(&rig.pendulum.pose(off));
    assert!((width_m - 0.002).abs() < 1e-6);
}

#[test]
fn a_silent_tracker_is_an_error() {
    let faults = vec![Fault::Silence { from_ps: 3 * PS_PER_S }];
    let tracker = TrackerModel::new(TrackerConfig { faults, ..TrackerConfig::fastrak() }).unwrap();
    // Low points at 0.36 s and every 0.71 s: four before the silence.
    let error = PendulumRig::assumed().measure(&tracker, 1, 100, pipeline).unwrap_err();
    assert_eq!(error, RigError::TooFewPasses { expected: 100, found: 4 });
}

#[test]
fn light_before_the_start_is_an_error() {
    let tracker = TrackerModel::new(TrackerConfig::ideal()).unwrap();
    let error = PendulumRig::assumed().measure(&tracker, 1, 1, |t| t - 1).unwrap_err();
    assert!(matches!(error, RigError::LightBeforeStart { started_ps, found_ps } if found_ps + 1 == started_ps));
}
