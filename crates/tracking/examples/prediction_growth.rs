//! Growth of prediction errors with the interval, on synthetic motion behind the optical ceiling tracker. The example
//! compares several noise levels. The comparison supports the noise that the preset of this tracker assumes.
//!
//! Published values (Azuma and Bishop 1995, on this tracker): below 80 ms the error is 2 to 3 times smaller than
//! without prediction. At 100 and 200 ms the error is 2.3 and 9 times the error at 50 ms.

use tracking::motion::Synthetic;
use tracking::predict::{PredictorConfig, PredictorKind, prediction_errors, tune};
use tracking::time::{PS_PER_MS, PS_PER_S};
use tracking::tracker::{TrackerConfig, TrackerModel};

/// Seed of the noise and of the motion with which predictors are evaluated.
const EVALUATION_SEED: u64 = 2;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let intervals = [20, 50, 80, 100, 200].map(|ms| ms * PS_PER_MS);
    println!(
        "noise deg, mm; filter: mean deg at 20/50/80/100/200 ms; growth to 100 and 200 ms; none over it at 20/50/80 ms"
    );
    for (degrees, millimetres) in [(0.03, 0.3), (0.06, 0.6), (0.1, 1.0), (0.15, 1.5), (0.2, 2.0)] {
        let tracker = TrackerConfig {
            orientation_noise_deg: degrees,
            position_noise_m: millimetres / 1e3,
            ..TrackerConfig::optical_ceiling()
        };
        let model = TrackerModel::new(tracker)?;
        let motion = Synthetic::recorded_use(EVALUATION_SEED);
        let mean = |config: &PredictorConfig, interval: u64| -> Result<f64, pxpl5_sim::parameters::SettingError> {
            let span = (PS_PER_S, 300 * PS_PER_S);
            Ok(prediction_errors(&motion, &model, config, EVALUATION_SEED, &[interval], span)?[0].mean_deg)
        };
        let base = |kind| PredictorConfig::for_tracker(kind, model.config());
        let tuned =
            |kind, interval| tune(&motion, &model, interval, &base(kind), EVALUATION_SEED).map(|tuned| tuned.config);
        let once = tuned(PredictorKind::Kalman, 50 * PS_PER_MS)?;
        let mut rows: Vec<(&str, Vec<f64>)> = Vec::new();
        let all = |config: PredictorConfig| intervals.map(|at| mean(&config, at)).into_iter().collect::<Result<_, _>>();
        rows.push(("none", all(base(PredictorKind::None))?));
        rows.push(("Kalman tuned for 50 ms", all(once)?));
        let each = intervals.map(|at| mean(&tuned(PredictorKind::Kalman, at)?, at));
        rows.push(("Kalman tuned for each", each.into_iter().collect::<Result<_, _>>()?));
        let none = rows[0].1.clone();
        for (name, errors) in rows {
            let shown: Vec<String> = errors.iter().map(|e| format!("{e:.3}")).collect();
            let cut: Vec<String> = (0..3).map(|i| format!("{:.2}", none[i] / errors[i])).collect();
            println!(
                "{degrees}, {millimetres}; {name}: {}; {:.2} {:.2}; {}",
                shown.join(" "),
                errors[3] / errors[1],
                errors[4] / errors[1],
                cut.join(" ")
            );
        }
    }
    Ok(())
}
