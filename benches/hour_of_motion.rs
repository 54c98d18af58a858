//! An hour of head motion behind a 120 Hz tracker, with a prediction 50 ms ahead for each of its 432,000 reports. The
//! goal is a simulation in under a second.
#![allow(missing_docs, reason = "criterion's macro makes a function without a doc comment")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use tracking::motion::{Motion, Synthetic};
use tracking::predict::{PredictorConfig, PredictorKind};
use tracking::time::{PS_PER_MS, PS_PER_S};
use tracking::tracker::{TrackerConfig, TrackerModel};

const HOUR_PS: u64 = 3600 * PS_PER_S;

fn an_hour(tracker: &TrackerModel, config: &PredictorConfig) -> f64 {
    let motion = Synthetic::recorded_use(1);
    let mut predictor = config.build().expect("the preset is in range");
    let mut sum = 0.0;
    for report in tracker.reports(&motion, 2).take_while(|r| r.measured_ps < HOUR_PS) {
        predictor.observe(&report);
        sum += predictor.predict(report.measured_ps + 50 * PS_PER_MS).position.x;
    }
    sum
}

fn hour_of_motion(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("an hour at 120 Hz");
    group.sample_size(10);
    group.bench_function("motion alone", |b| {
        let motion = Synthetic::recorded_use(1);
        b.iter(|| (0..432_000).map(|i| motion.pose(i * PS_PER_S / 120).position.x).sum::<f64>())
    });
    let tracker = TrackerModel::new(TrackerConfig::fastrak()).expect("the preset is in range");
    for kind in PredictorKind::ALL {
        let config = PredictorConfig::for_tracker(kind, tracker.config());
        group.bench_function(format!("{kind:?}"), |b| b.iter(|| an_hour(black_box(&tracker), &config)));
    }
    group.finish();
}

criterion_group!(benches, hour_of_motion);
criterion_main!(benches);
