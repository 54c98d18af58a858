//! Estimates of the cost of points before their simulation. The formulas are in [`crate::estimate`]. The closed form of
//! the pipeline gives the number of pictures.
//!
//! Programs that distribute points over computers correct the estimates by the durations of finished points.

use super::Sweep;
use crate::Plan;
use crate::estimate::{Estimate, RunWork};
use crate::limit::LimitQuery;
use crate::study::Study;
use pxpl5_measure::Measure;
use pxpl5_run::{Experiment, Level};
use std::collections::BTreeMap;

/// Seconds to check the settings of a point, to build its scene, and to write its row.
const POINT: f64 = 3e-3;

/// Bytes for a point without a simulation: an invalid point, or a point at the analytic level.
const NO_RUN_BYTES: f64 = 15e6;

impl Sweep {
    /// Estimates the seconds for each point on one core. If the pipeline has a closed form, the closed form gives the
    /// number of pictures. An invalid point costs almost nothing. Points that differ only in their seed get the same
    /// estimate.
    pub fn costs(&self, points: &[u64]) -> Vec<f64> {
        self.estimates(points).into_iter().map(|estimate| estimate.seconds).collect()
    }

    /// Estimates the time in seconds and the memory of each point. The memory includes all observations, which are kept
    /// until the results of the point are measured.
    pub fn estimates(&self, points: &[u64]) -> Vec<Estimate> {
        let mut cached: BTreeMap<String, Estimate> = BTreeMap::new();
        let mut estimates = Vec::with_capacity(points.len());
        for point in points {
            let mut settings = self.space().settings(*point);
            // Points that differ only in their seed share one estimate.
            settings.remove("seed");
            estimates.push(*cached.entry(format!("{settings:?}")).or_insert_with(|| self.estimate(*point)));
        }
        estimates
    }

    fn estimate(&self, point: u64) -> Estimate {
        let nothing = Estimate { bytes: NO_RUN_BYTES, seconds: POINT };
        let Ok(plan) = self.plan(point) else { return nothing };
        let Ok(scene) = self.scene(&plan) else { return nothing };
        let needs_events = plan.measure.iter().any(Measure::needs_events);
        let (experiment, _) = plan.with_chosen_level(scene, needs_events);
        if experiment.level == Level::Analytic {
            return nothing;
        }
        let mut work = RunWork::of(&experiment, true);
        if let Some(pictures_a_field) = pictures_from_closed_form(&plan, experiment) {
            work = RunWork { pictures_a_field, uses_closed_form: true, ..work };
        }
        let search = if plan.measure.iter().any(|measure| measure.name() == Measure::TRIANGLES) {
            LimitQuery::of_scene(&plan).map_or(Estimate::NOTHING, |query| query.estimate(1))
        } else {
            Estimate::NOTHING
        };
        Estimate { bytes: work.bytes().max(search.bytes), seconds: POINT + work.core_seconds() + search.seconds }
    }
}

/// Returns the number of pictures per field from the pipeline's closed form, if it has one.
fn pictures_from_closed_form(plan: &Plan, experiment: Experiment) -> Option<f64> {
    let entry = plan.registry.pipeline(plan.pipeline.name()).ok()?;
    let form = entry.closed_form.filter(|_| plan.head.is_none())?;
    let summary = (form.summary)(&experiment.level(Level::Analytic)).ok()?;
    let shown = summary.updates_hz? * summary.field_ms * 1e-3;
    Some(shown).filter(|shown| shown.is_finite())
}

#[cfg(test)]
mod tests {
    use crate::ExperimentFile;
    use crate::sweep::Sweep;

    fn sweep(text: &str) -> Sweep {
        Sweep::new(ExperimentFile::parse(text, "test").expect("settings")).expect("a space")
    }

    #[test]
    fn costs_grow_with_fields_and_primitives_and_not_with_seeds() {
        let text = "pipeline = \"rendering-control\"\nscene = \"typical:2000\"\n[sweep]\nseeds = 2\n[sweep.grid]\n\
                    fields = [60, 600]\ntriangles = [20, 2000]\n";
        let costs = sweep(text).costs(&(0..8).collect::<Vec<_>>());
        let [a, same, heavy, _, long, _, both, _] = costs[..] else { panic!("8 points, found {}", costs.len()) };
        assert!(a == same && a < heavy && a < long && heavy < both && long < both, "{costs:?}");
        let searched = sweep(&format!("measure = [\"triangles_possible\"]\n{text}")).costs(&[0]);
        assert!(searched[0] > 2.0 * a, "a search runs many sizes: {searched:?}");
    }
}
