//! The length of a comparison along a recording.

use super::query::{CompareError, CompareQuery};
use crate::experiment_file::Plan;
use pxpl5_sim::Time;
use pxpl5_wire::NodeId;

/// Length of the runs along a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordedLength {
    /// Number of whole display periods in the recording, which is the length of each run.
    pub fields: u64,
    /// Larger number of fields in the settings, which the recording does not cover. `None` if the settings have none.
    pub asked: Option<u64>,
}

impl CompareQuery {
    /// Sets the length of the runs to the length of the recording that the head replays.
    ///
    /// Does nothing and returns `None` in these cases: the motion is no recording, the recording is repeated without end,
    /// the settings ask for fewer fields, or the settings ask for more fields and say that the head stands still behind
    /// the recording's end.
    ///
    /// # Errors
    ///
    /// Fails if a setting is invalid, or if the registry has no compared pipeline.
    pub fn limit_to_recording(&mut self) -> Result<Option<RecordedLength>, CompareError> {
        let plan = self.first_plan()?;
        let Some(fields) = recorded_fields(&plan) else { return Ok(None) };
        let asked = self.shared.place_of("fields").map(|_| plan.fields);
        let may_pass_the_end = plan.head.as_ref().is_some_and(|head| head.head().motion().ends_ps().is_none());
        if asked.is_some_and(|asked| asked <= fields || may_pass_the_end) {
            return Ok(None);
        }
        self.shared.set("fields", i64::try_from(fields).unwrap_or(i64::MAX), "the length of the recording")?;
        Ok(Some(RecordedLength { fields, asked }))
    }
}

/// Returns the number of whole display periods in the recording of a plan's head. Returns `None` if the motion is not a
/// recording, if the recording is repeated without end, or if the display cannot be built.
fn recorded_fields(plan: &Plan) -> Option<u64> {
    let head = plan.head.as_ref().filter(|head| head.is_recording())?.head();
    let ends = Time(head.motion().moves_until_ps()?);
    let config = plan.machine.displays.first()?;
    let ports = config.ports(plan.pipeline.eyes());
    let nodes: Vec<NodeId> = (0..ports).filter_map(|n| Some(NodeId(n.try_into().ok()?))).collect();
    // A period that begins when the recording ends is the first that is not simulated.
    Some(config.build(&nodes).ok()?.period_at(ends).0)
}
