//! Tests of tracker models: measurement times, arrival times and errors of reports.

use glam::DVec3;
use tracking::Pose;
use tracking::config::Tables;
use tracking::motion::{Motion, Pan, Still, Synthetic};
use tracking::time::{PS_PER_MS, PS_PER_S};
use tracking::tracker::{SerialLine, SerialRead, TrackerConfig, TrackerFault, TrackerModel, TrackerReport};

const HEAD: Still = Still(Pose { position: DVec3::new(0.3, 1.7, -0.2), orientation: glam::DQuat::IDENTITY });

fn model(config: TrackerConfig) -> TrackerModel {
    TrackerModel::new(config).unwrap()
}

fn reports(config: TrackerConfig, motion: &dyn Motion, seed: u64, n: usize) -> Vec<TrackerReport> {
    model(config).reports(motion, seed).take(n).collect()
}

fn unbiased(config: TrackerConfig) -> TrackerConfig {
    TrackerConfig { position_bias_m: 0.0, orientation_bias_deg: 0.0, ..config }
}

fn noiseless(config: TrackerConfig) -> TrackerConfig {
    TrackerConfig { position_noise_m: 0.0, orientation_noise_deg: 0.0, ..unbiased(config) }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = values.fold((0.0, 0.0), |(s, n), x| (s + x, n + 1.0));
    sum / n
}

#[test]
fn an_ideal_report_is_exact_and_immediate() {
    let motion = Synthetic::recorded_use(1);
    for report in reports(TrackerConfig::ideal(), &motion, 0, 1000) {
        assert_eq!(report.arrives_ps, report.measured_ps);
        assert_eq!(report.pose, motion.pose(report.measured_ps));
    }
}

#[test]
fn a_fastrak_report_is_3_75_ms_old_at_its_output_and_arrives_one_transfer_later() {
    for report in reports(TrackerConfig::fastrak(), &HEAD, 0, 100) {
        let output_ps = report.solution * PS_PER_S / 120 + 5_500_000_000;
        assert_eq!(report.measured_ps, output_ps - 3_750_000_000);
        assert_eq!(report.arrives_ps, output_ps + 47 * 10 * PS_PER_S / 115_200);
    }
}

/// Returns the apparent latency of a Fastrak with this filter gain, ms. It is the delay of a report's pose behind a
/// slow, steady turn when the first character is sent.
fn apparent_latency_ms(gain: f64) -> f64 {
    let mut tables = Tables::PAPERS;
    tables.fastrak.filter_gain = gain;
    let config = noiseless(TrackerConfig::fastrak_by(&tables));
    let deg_per_s = 2.0;
    let last = reports(config, &Pan::at(deg_per_s), 0, 1_000).pop().unwrap();
    let output_ps = last.solution * PS_PER_S / 120 + 5_500_000_000;
    let now = Pan::at(deg_per_s).pose(output_ps);
    last.pose.angle_deg(&now) / deg_per_s * 1e3
}

/// The manual prints 4.2 and 162 ms. The formula is 3.75 ms + dt (1 - a) / a, with dt = 1/120 s and the filter gain a.
#[test]
fn the_fastraks_filter_has_the_latencies_of_the_manual() {
    for (gain, printed_ms, half_digit_ms) in [(0.95, 4.2, 0.05), (0.05, 162.0, 0.5)] {
        let found = apparent_latency_ms(gain);
        let formula = 3.75 + 1e3 / 120.0 * (1.0 - gain) / gain;
        assert!((found - printed_ms).abs() <= half_digit_ms, "gain {gain}: {found} ms, printed {printed_ms}");
        assert!((found - formula).abs() < 1e-3, "gain {gain}: {found} ms, formula {formula}");
    }
    assert!((apparent_latency_ms(1.0) - 3.75).abs() < 1e-6, "without a filter");
}

/// Every serial tracker exists with a host that polls and with a patched host that does not. `host.poll` affects only
/// the host that polls.
#[test]
fn polling_only_adds_the_wait_for_the_next_poll() {
    let mut slow = Tables::PAPERS;
    slow.host.poll = 60.0;
    for by in [TrackerConfig::fastrak_by, TrackerConfig::flock_of_birds_by, TrackerConfig::polhemus_3space_by] {
        let patched = by(&Tables::PAPERS).without_polling();
        // The Flock's reports are 10 ms apart and the polls 30 ms, so a run with one seed has only three different
        // waits.
        let greatest_wait_ms = |tables: &Tables| {
            let waits = (0..60).flat_map(|seed| {
                let polled = reports(by(tables).with_polling_by(tables), &HEAD, seed, 40);
                let at_once = reports(patched.clone(), &HEAD, seed, 40);
                let pairs = polled.into_iter().zip(at_once);
                pairs.map(|(late, early)| {
                    assert_eq!((late.solution, late.measured_ps), (early.solution, early.measured_ps));
                    (late.arrives_ps - early.arrives_ps) as f64 / PS_PER_MS as f64
                })
            });
            waits.fold(0.0, f64::max)
        };
        let [usual, longer] = [&Tables::PAPERS, &slow].map(greatest_wait_ms);
        assert!(usual > 28.5 && usual < 30.0, "{}: {usual} ms of 30", patched.name);
        assert!(longer > 57.0 && longer < 60.0, "{}: {longer} ms of 60", patched.name);
    }
}

#[test]
fn two_receivers_halve_the_rate() {
    let config = TrackerConfig { receivers: 2, ..TrackerConfig::fastrak() };
    let all = reports(config, &HEAD, 0, 61);
    assert_eq!(all[60].measured_ps - all[0].measured_ps, PS_PER_S);
}

#[test]
fn at_9600_baud_five_of_six_fastrak_solutions_are_dropped_and_at_115200_none() {
    // At 9600 baud, the transfer of 48.96 ms takes 5.88 periods of 8.33 ms, so the next ready solution is the sixth.
    for (baud, apart) in [(115_200, 1), (9_600, 6)] {
        let serial = Some(SerialLine { baud, ..SerialLine::fastrak() });
        let all = reports(TrackerConfig { serial, ..TrackerConfig::fastrak() }, &HEAD, 0, 100);
        assert!(all.windows(2).all(|w| w[1].solution - w[0].solution == apart), "{baud} baud");
    }
}

#[test]
fn the_flocks_position_is_5_5_ms_older_than_its_orientation() {
    let motion = Synthetic::recorded_use(4);
    for report in reports(noiseless(TrackerConfig::flock_of_birds()), &motion, 0, 50) {
        assert_eq!(report.measured_ps - report.position_measured_ps, 5_500_000_000);
        assert_eq!(report.pose.position, motion.pose(report.position_measured_ps).position);
        assert_eq!(report.pose.orientation, motion.pose(report.measured_ps).orientation);
    }
}

#[test]
fn the_reports_of_the_optical_tracker_are_33_ms_late() {
    for report in reports(TrackerConfig::optical_ceiling(), &HEAD, 0, 50) {
        assert_eq!(report.arrives_ps - report.measured_ps, 33 * PS_PER_MS);
    }
}

#[test]
fn a_polled_line_adds_0_to_30_ms_uniformly_over_seeds() {
    let polled = TrackerConfig { host: SerialRead::unix(), ..TrackerConfig::optical_ceiling() };
    let tracker = model(polled);
    let waits: Vec<f64> = (0..3000)
        .map(|seed| tracker.reports(&HEAD, seed).next().unwrap())
        .map(|r| (r.arrives_ps - r.measured_ps - 33 * PS_PER_MS) as f64 / PS_PER_MS as f64)
        .collect();
    assert!(waits.iter().all(|wait| (0.0..30.0).contains(wait)));
    // The standard error of the mean is 8.66 ms / sqrt 3000 = 0.16 ms. The standard error of a count of 300 in 3000 is
    // 16.
    assert!((mean(waits.iter().copied()) - 15.0).abs() < 0.65);
    for tenth in 0..10 {
        let n = waits.iter().filter(|w| (**w / 3.0) as i32 == tenth).count();
        assert!((230..370).contains(&n), "tenth {tenth}: {n} of 300 +- 16");
    }
}

#[test]
fn polling_never_changes_the_order_of_reports() {
    let config = TrackerConfig { host: SerialRead::unix(), ..TrackerConfig::fastrak() };
    let all = reports(config, &HEAD, 7, 2000);
    assert!(all.windows(2).all(|w| w[0].arrives_ps <= w[1].arrives_ps));
}

#[test]
fn noise_has_the_configured_deviation_on_each_axis() {
    // 20,000 reports: the standard error of a deviation is 0.5 %.
    let noise = TrackerConfig { position_noise_m: 0.8e-3, orientation_noise_deg: 0.15, ..TrackerConfig::fastrak() };
    let all = reports(noise.without_systematic_errors(), &HEAD, 3, 20_000);
    for axis in 0..3 {
        let place = mean(all.iter().map(|r| (r.pose.position - HEAD.0.position)[axis].powi(2))).sqrt();
        assert!((place / 0.8e-3 - 1.0).abs() < 0.025, "{place}");
        let turn = mean(all.iter().map(|r| tracking::rotation::log(r.pose.orientation)[axis].powi(2))).sqrt();
        assert!((turn.to_degrees() / 0.15 - 1.0).abs() < 0.025, "{turn}");
    }
}

#[test]
fn static_accuracy_is_a_constant_bias_of_each_installation() {
    let noiseless = TrackerConfig { position_noise_m: 0.0, orientation_noise_deg: 0.0, ..TrackerConfig::fastrak() };
    let config = TrackerConfig { distortion: None, ..noiseless };
    let of_seed = |seed| {
        let all = reports(config.clone(), &HEAD, seed, 50);
        assert!(all.iter().all(|r| r.pose == all[0].pose), "seed {seed}");
        all[0].pose
    };
    // 4,000 installations: the standard error of a deviation is 1.1 %.
    let poses: Vec<Pose> = (0..4_000).map(of_seed).collect();
    for axis in 0..3 {
        let place = mean(poses.iter().map(|p| (p.position - HEAD.0.position)[axis].powi(2))).sqrt();
        assert!((place / 0.8e-3 - 1.0).abs() < 0.05, "{place}");
        let turn = mean(poses.iter().map(|p| tracking::rotation::log(p.orientation)[axis].powi(2))).sqrt();
        assert!((turn.to_degrees() / 0.15 - 1.0).abs() < 0.05, "{turn}");
    }
}

#[test]
fn noise_depends_on_the_seed() {
    let [first, again, other] = [1, 1, 2].map(|seed| reports(TrackerConfig::fastrak(), &HEAD, seed, 10));
    assert_eq!(first, again);
    assert_ne!(first[0].pose, other[0].pose);
}

#[test]
fn the_filter_lags_a_pan_by_dt_times_1_minus_a_over_a() {
    for gain in [0.2, 0.5, 0.8] {
        let config = TrackerConfig { filter_gain: gain, ..noiseless(TrackerConfig::fastrak()) };
        let tracker = model(config);
        let pan = Pan::at(200.0);
        let settled = tracker.reports(&pan, 0).nth(400).unwrap();
        let lag_s = settled.pose.angle_deg(&pan.pose(settled.measured_ps)) / 200.0;
        assert!((lag_s - (1.0 - gain) / gain / 120.0).abs() < 1e-9, "{gain}: {lag_s}");
        assert!((lag_s - tracking::time::seconds(tracker.filter_delay_ps())).abs() < 1e-9);
    }
}

#[test]
fn the_filter_cuts_white_noise_by_the_root_of_a_over_2_minus_a() {
    let config = TrackerConfig { filter_gain: 0.2, position_noise_m: 0.8e-3, ..unbiased(TrackerConfig::fastrak()) };
    let all = reports(config, &HEAD, 3, 40_000);
    let place = mean(all.iter().skip(100).map(|r| (r.pose.position.x - 0.3).powi(2))).sqrt();
    assert!((place / (0.8e-3 * (0.2f64 / 1.8).sqrt()) - 1.0).abs() < 0.04, "{place}");
}

#[test]
fn a_still_head_near_metal_is_misplaced_by_3space() {
    let all = reports(noiseless(TrackerConfig::polhemus_3space()), &HEAD, 0, 3);
    assert!(all[0].pose.distance_m(&HEAD.0) > 0.01);
    assert_eq!(all[0].pose, all[2].pose);
}

#[test]
fn a_dropout_leaves_no_report_between_its_ends() {
    let from_ps = PS_PER_S;
    let to_ps = PS_PER_S + 300 * PS_PER_MS;
    let config = TrackerConfig { faults: vec![TrackerFault::Dropout { from_ps, to_ps }], ..TrackerConfig::ideal() };
    let all = reports(config, &HEAD, 0, 1500);
    assert!(all.iter().all(|r| !(from_ps..to_ps).contains(&r.measured_ps)));
    assert!(all.iter().any(|r| r.measured_ps == to_ps) && all.iter().any(|r| r.measured_ps == from_ps - PS_PER_MS));
}

#[test]
fn an_endless_dropout_ends_the_reports() {
    let faults = vec![TrackerFault::Dropout { from_ps: 0, to_ps: u64::MAX }];
    assert_eq!(reports(TrackerConfig { faults, ..TrackerConfig::fastrak() }, &HEAD, 0, 1), []);
}

fn ideal_but_for(fault: TrackerFault) -> TrackerConfig {
    TrackerConfig { faults: vec![fault], ..TrackerConfig::ideal() }
}

/// Returns true if `found` is a tenth of 20,000 within five standard errors of 0.002 each.
fn is_a_tenth_of_20_000(found: usize) -> bool {
    (found as f64 / 20_000.0 - 0.1).abs() < 0.011
}

#[test]
fn random_faults_occur_at_the_stated_rate() {
    let lost = reports(ideal_but_for(TrackerFault::RandomDropout { probability: 0.1 }), &HEAD, 1, 18_000);
    assert!((lost.last().unwrap().solution as f64 - 20_000.0).abs() < 250.0);
    let nan = reports(ideal_but_for(TrackerFault::NotANumber { probability: 0.1 }), &HEAD, 1, 20_000);
    assert!(is_a_tenth_of_20_000(nan.iter().filter(|r| !r.pose.is_finite()).count()));
    let jump = TrackerFault::Jump { probability: 0.1, distance_m: 0.5, angle_deg: 40.0 };
    let jumped = reports(ideal_but_for(jump), &HEAD, 1, 20_000);
    let off = jumped
        .iter()
        .filter(|r| (r.pose.distance_m(&HEAD.0) - 0.5).abs() < 1e-9 && (r.pose.angle_deg(&HEAD.0) - 40.0).abs() < 1e-9);
    assert!(is_a_tenth_of_20_000(off.count()));
}

#[test]
fn a_silent_tracker_sends_no_reports_from_the_stated_time() {
    let faults = vec![TrackerFault::Silence { from_ps: PS_PER_S }];
    let all = reports(TrackerConfig { faults, ..TrackerConfig::ideal() }, &HEAD, 0, 5000);
    assert_eq!(all.len(), 1000);
    assert_eq!(all[999].arrives_ps, 999 * PS_PER_MS);
}

#[test]
fn the_patched_host_crashes_only_with_the_flock() {
    let all = reports(TrackerConfig::flock_of_birds_on_patched_host(), &HEAD, 0, 5000);
    assert!(all.len() < 5000);
    let first = all[0].arrives_ps;
    let last = all[all.len() - 1].arrives_ps;
    assert!(last < first + PS_PER_S && last >= first + PS_PER_S - 10 * PS_PER_MS);
    assert_eq!(reports(TrackerConfig::flock_of_birds(), &HEAD, 0, 5000).len(), 5000);
    assert_eq!(reports(TrackerConfig::fastrak(), &HEAD, 0, 5000).len(), 5000);
}

#[test]
fn after_an_hour_the_report_times_are_still_exact_multiples_of_the_report_interval() {
    let tracker = model(TrackerConfig::fastrak());
    let report = tracker.reports(&HEAD, 0).nth(432_000).unwrap();
    assert_eq!(report.measured_ps, 3600 * PS_PER_S + 1_750_000_000);
}
