//! The length of each run of a comparison, if the head replays a recorded motion.

use super::query::CompareQuery;
use crate::error::StudyError;
use crate::experiment_file::Plan;
use pxpl5_sim::Time;

/// Length of the runs if the head replays a recorded motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordedLength {
    /// Number of whole display periods that the recording covers, which is the length of each run.
    pub fields: u64,
    /// Number of fields in the settings, which is larger than `fields`. `None` if the settings state no number.
    pub asked: Option<u64>,
}

/// Number of fields of each run if neither the settings nor a recording give a length: five seconds.
const USUAL_FIELDS: i64 = 300;

impl CompareQuery {
    /// Sets the number of fields of the runs. The settings may state this number. Otherwise the number comes from the
    /// recording that the head replays, or covers five seconds.
    ///
    /// If the stated number is larger than the recording, the length of the recording replaces it. The stated number
    /// stays valid if the head stands still after the last sample, and if the recording is repeated without end.
    ///
    /// Returns the length if a recording has determined the number of fields.
    ///
    /// # Errors
    ///
    /// Fails if a setting is invalid, or if the registry has no compared pipeline.
    pub fn set_length(&mut self) -> Result<Option<RecordedLength>, StudyError> {
        let plan = self.first_plan()?;
        let asked = self.shared.place_of("fields").map(|_| plan.fields);
        let may_pass_the_end = plan.head.as_ref().is_some_and(|head| head.head().motion().ends_ps().is_none());
        let is_covered = |fields: &u64| asked.is_some_and(|asked| asked <= *fields || may_pass_the_end);
        let recorded = recorded_fields(&plan).filter(|fields| !is_covered(fields));
        if let Some(fields) = recorded {
            self.shared.set("fields", i64::try_from(fields).unwrap_or(i64::MAX), "the length of the recording")?;
        } else if asked.is_none() {
            self.shared.set("fields", USUAL_FIELDS, "compare")?;
        }
        Ok(recorded.map(|fields| RecordedLength { fields, asked }))
    }
}

/// Returns the number of whole display periods in the recording that moves the head. Returns `None` if the motion is
/// not a recording, if the recording is repeated without end, or if the display cannot be built.
fn recorded_fields(plan: &Plan) -> Option<u64> {
    let until_ps = plan.head.as_ref()?.head().motion().moves_until_ps()?;
    // A period that begins when the recording ends is the first that is not simulated.
    plan.display_periods(Time(until_ps))
}
