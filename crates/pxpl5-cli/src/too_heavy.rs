//! What is known of a scene before it is run: that it is too heavy to be shown.

use crate::estimate::Work;
use crate::numbers::count_of;
use pxpl5::Plan;
use pxpl5::scene::Scene;
use std::sync::Arc;

/// Share of a run that TRANSFORM of all primitives must take before a closed form is asked: it takes time itself.
const HEAVY: f64 = 0.125;

/// Says that a run of so many fields is expected to show nothing behind the warm-up: by the closed form of its pipeline, or, without one, where
/// its processors cannot even transform all primitives once.
pub(crate) fn too_heavy(plan: &Plan, scene: &Arc<Scene>, fields: u64) -> Option<String> {
    let work = Work::of(plan, scene, false);
    let transform = work.fields_of_transform();
    if transform < HEAVY * fields as f64 {
        return None;
    }
    let entry = plan.registry.pipeline(plan.pipeline.name()).ok()?;
    let expected = match entry.closed_form.filter(|_| plan.head.is_none()) {
        Some(form) => {
            let needed = (form.estimates.fields_needed)(&plan.experiment(Arc::clone(scene)).fields(fields));
            match needed {
                Some(needed) if needed <= fields => return None,
                Some(needed) => format!("the first picture with a latency is expected after about {needed} fields"),
                None => "no picture is expected in time".to_owned(),
            }
        }
        None if transform > fields as f64 => {
            format!("processors take about {transform:.0} fields to transform all of it once")
        }
        None => return None,
    };
    Some(format!(
        "TOO HEAVY: {} on {}, and the run has {}: {expected}; draw fewer primitives (--triangles), or simulate more fields",
        count_of(work.primitives, "primitive"),
        count_of(work.gps, "graphics processor"),
        count_of(fields, "field")
    ))
}
