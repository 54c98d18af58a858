//! The pendulum rig in front of the emulated machine.

use pxpl5_run::Outcome;
use pxpl5_sim::Time;
use tracking::rig::{Measurement, PendulumRig, RigError};
use tracking::time::PS_PER_S;
use tracking::tracker::TrackerModel;

/// Measures a run from outside: each low point of the pendulum that the host sees starts the next frame that the run
/// sampled, and the photodiode waits for that frame's light.
///
/// # Errors
///
/// As [`PendulumRig::measure`].
pub fn measure_on(
    outcome: &Outcome,
    rig: &PendulumRig,
    tracker: &TrackerModel,
    seed: u64,
) -> Result<Measurement, RigError> {
    let starts = frames(outcome);
    let run_s = starts.last().map_or(0.0, |(started, _)| started.0 as f64 / PS_PER_S as f64);
    let swing_s = rig.pendulum.period_s() / 2.0;
    // The host sees the last low point in time, whatever the tracker's latency.
    let n_passes = ((run_s - 1.0) / swing_s).max(1.0) as usize;
    rig.measure(tracker, seed, n_passes, |started_ps| {
        let next = starts.partition_point(|(started, _)| started.0 < started_ps);
        starts.get(next).map_or(started_ps, |(_, scanned)| scanned.0)
    })
}

/// When each frame's pose was taken and when its scan began, in order.
fn frames(outcome: &Outcome) -> Vec<(Time, Time)> {
    let display = outcome.record().display();
    let scan = |shown_at| display.first_light(0, display.period_at(shown_at)).unwrap_or(shown_at);
    let frames = outcome.pictures().iter();
    frames.map(|times| (times.sampled_at.unwrap_or(times.transform_at), scan(times.shown_at))).collect()
}
