//! Warning before a run whose scene is so large that no picture will be shown in time.

use crate::numbers::count_of;
use pxpl5::Plan;
use pxpl5::lab::estimate::RunWork;
use pxpl5::scene::Scene;
use std::sync::Arc;

/// Length of a short run in display fields: one second. A pipeline that can show a picture within this time causes no
/// warning, even if the run itself is shorter.
const SHORT_RUN: u64 = 60;

/// Returns a warning if a run of `fields` display fields is expected to show no picture after the warm-up. The
/// expectation comes from the closed form of the pipeline. For a pipeline without a closed form, the function warns if
/// the processors cannot transform all primitives once within the run.
pub(crate) fn too_heavy(plan: &Plan, scene: &Arc<Scene>, fields: u64) -> Option<String> {
    let experiment = plan.experiment(Arc::clone(scene)).fields(fields);
    let work = RunWork::of(&experiment, false);
    let entry = plan.registry.pipeline(plan.pipeline.name()).ok()?;
    // A closed form predicts the first picture; it does not cover tracked heads.
    let longer = ", or simulate more fields";
    let (expected, longer) = match entry.closed_form.filter(|_| plan.head.is_none()) {
        Some(form) => {
            match (form.estimates.fields_needed)(&experiment) {
                Some(needed) if needed <= fields.max(SHORT_RUN) => return None,
                Some(needed) => {
                    let expected =
                        "the analytic level predicts that the first picture with a latency is shown after about";
                    (format!("{expected} {needed} fields"), longer)
                }
                // The closed form covers only some machines and displays. Without a prediction there is no warning.
                None if (form.summary)(&experiment).is_ok_and(|summary| summary.updates_hz.is_none()) => {
                    // All pictures are alike, so a longer run shows none either.
                    ("the analytic level predicts that no picture is shown in time".to_owned(), "")
                }
                None => return None,
            }
        }
        None => {
            // Without a closed form, the time of TRANSFORM is a lower bound.
            let transform = work.fields_of_transform();
            if transform <= fields as f64 {
                return None;
            }
            (format!("the processors take about {transform:.0} fields to transform the whole scene once"), longer)
        }
    };
    Some(format!(
        "TOO HEAVY: {} on {}, and the run has {}: {expected}; draw fewer primitives (--triangles){longer}",
        count_of(work.primitives, "primitive"),
        count_of(work.gps, "graphics processor"),
        count_of(fields, "field")
    ))
}
