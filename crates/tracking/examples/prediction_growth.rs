//! Error of each predictor 50, 100 and 200 ms ahead, on ten minutes of synthetic motion behind a Fastrak.
//!
//! Arguments, both optional: position jerk and orientation jerk of the Kalman filters.

use tracking::motion::Synthetic;
use tracking::predict::{PredictorConfig, PredictorKind, prediction_errors};
use tracking::time::{PS_PER_MS, PS_PER_S};
use tracking::tracker::{TrackerConfig, TrackerModel};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let jerks: Vec<f64> = std::env::args().skip(1).map(|a| a.parse()).collect::<Result<_, _>>()?;
    let horizons = [20, 50, 80, 100, 200].map(|ms| ms * PS_PER_MS);
    println!("tracker  predictor  mean deg at 20/50/80/100/200 ms  x100 x200  mean mm  x100 x200");
    for tracker in [TrackerConfig::ideal(), TrackerConfig::fastrak(), TrackerConfig::optical_ceiling()] {
        for kind in PredictorKind::ALL {
            let mut config = PredictorConfig::for_tracker(kind, &tracker);
            config.position_jerk = jerks.first().copied().unwrap_or(config.position_jerk);
            config.orientation_jerk = jerks.get(1).copied().unwrap_or(config.orientation_jerk);
            let model = TrackerModel::new(tracker.clone())?;
            let span = (PS_PER_S, 600 * PS_PER_S);
            let errors = prediction_errors(&Synthetic::recorded_use(1), &model, &config, 2, &horizons, span)?;
            let degrees: Vec<f64> = errors.iter().map(|e| e.mean_deg).collect();
            let millimetres: Vec<f64> = errors.iter().map(|e| e.mean_m * 1e3).collect();
            let degrees_shown: Vec<String> = degrees.iter().map(|e| format!("{e:.2}")).collect();
            let millimetres_shown: Vec<String> = millimetres.iter().map(|e| format!("{e:.1}")).collect();
            println!(
                "{} {kind:?}: {} deg {}; {} mm {}",
                tracker.name,
                degrees_shown.join(" "),
                growth(&degrees),
                millimetres_shown.join(" "),
                growth(&millimetres)
            );
        }
    }
    Ok(())
}

/// How many times larger the errors 100 and 200 ms ahead are than the one 50 ms ahead.
fn growth(errors: &[f64]) -> String {
    format!("x{:.2} x{:.2}", errors[3] / errors[1], errors[4] / errors[1])
}
