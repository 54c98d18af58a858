//! Measurements with the pendulum rig, with the photodiode under several lines of the screen.

use super::interpretation::Interpretation;
use super::value::{FigureValue, Result, detail};
use crate::rig::Rig;
use pxpl5_machine::MachineConfig;
use pxpl5_run::Statistics;
use pxpl5_sim::StopFlag;
use std::sync::Arc;
use tracking::rig::{Measurement as RigMeasurement, PendulumRig};
use tracking::tracker::TrackerConfig;

/// Path of the parameter for the line of the screen under the photodiode of the pendulum rig (row 17 of ACCURACY.md).
/// [`FigureSettings::changes`](super::FigureSettings) may change this parameter.
pub const PHOTODIODE_LINE: &str = "tracking.rig.photodiode_line";

/// The measurements of the pendulum rig in one run, with the photodiode under the first, the assumed and the last line
/// of the screen.
#[derive(Clone, Debug)]
pub(super) struct RigLines {
    measured: [(u32, Arc<RigMeasurement>); 3],
}

impl RigLines {
    /// Measures the latency with a pendulum and a photodiode. Also returns true if a backing store was full in the run.
    pub(super) fn measure(
        machine: &MachineConfig,
        interpretation: &Interpretation,
        stop: &StopFlag,
    ) -> Result<(Self, bool)> {
        let lines = photodiode_lines();
        let (measured, met_full_store) = under_lines(machine, (interpretation, stop), lines)?;
        let mut lines = lines.into_iter();
        let measured = measured.map(|measured| (lines.next().unwrap_or_default(), Arc::new(measured)));
        Ok((Self { measured }, met_full_store))
    }

    /// Returns the latency from the pendulum rig (row 17 of ACCURACY.md), with the photodiode on the assumed line. The
    /// paper does not print the photodiode's position. The details therefore also state the latency on the first and on
    /// the last line of the screen.
    pub(super) fn figure(&self) -> FigureValue {
        let [first, assumed, last] = self.measured.each_ref().map(|(_, measured)| rendering(measured));
        let lines =
            [detail("under the first line", first.value, "ms"), detail("under the last line", last.value, "ms")];
        let details = [lines.to_vec(), assumed.details].concat();
        let unprinted = Some([first.value.min(last.value), first.value.max(last.value)]);
        FigureValue { value: assumed.value, details, unprinted }
    }

    pub(super) fn assumed(&self) -> Arc<RigMeasurement> {
        Arc::clone(&self.measured[1].1)
    }

    pub(super) fn under(&self, line: u64) -> Option<Arc<RigMeasurement>> {
        let found = self.measured.iter().find(|(measured, _)| u64::from(*measured) == line);
        found.map(|(_, measured)| Arc::clone(measured))
    }
}

/// Returns the first, the assumed and the last line of the photodiode.
fn photodiode_lines() -> [u32; 3] {
    let assumed = PendulumRig::assumed().photodiode_line;
    let table = crate::tracking_parameters().into_iter().find(|parameter| parameter.path == PHOTODIODE_LINE);
    let range = table.and_then(|parameter| parameter.info.whole_range());
    range.map_or([assumed; 3], |(first, last)| [first as u32, assumed, last as u32])
}

pub(super) fn under_line(
    machine: &MachineConfig,
    of: (&Interpretation, &StopFlag),
    line: u64,
) -> Result<RigMeasurement> {
    let ([measured], _) = under_lines(machine, of, [u32::try_from(line).unwrap_or(u32::MAX)])?;
    Ok(measured)
}

/// Measures the latency with the photodiode under each of several lines in one run. Also returns true if a backing
/// store was full in the run.
fn under_lines<const N: usize>(
    machine: &MachineConfig,
    (interpretation, stop): (&Interpretation, &StopFlag),
    lines: [u32; N],
) -> Result<([RigMeasurement; N], bool)> {
    let rig = Rig::assumed(TrackerConfig::optical_ceiling());
    let (measured, outcome) =
        rig.measure_lines(machine, Arc::new(interpretation.pipeline()), lines, &mut stop.clone())?;
    Ok((measured, outcome.record().met_full_store()))
}

/// Returns the part of the latency from the start of SEND to the light under the photodiode (row 17 of ACCURACY.md).
pub(super) fn rendering(measured: &RigMeasurement) -> FigureValue {
    let Statistics { mean, min, max, .. } = measured.outside.rendering;
    let details = vec![
        detail("least", min * 1e3, "ms"),
        detail("greatest", max * 1e3, "ms"),
        detail("inside, to the swap", measured.inside.rendering.mean * 1e3, "ms"),
    ];
    FigureValue::with(mean * 1e3, details)
}
