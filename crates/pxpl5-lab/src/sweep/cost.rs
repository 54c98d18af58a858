//! What points will cost, before they are run.
//!
//! Seconds on one core:
//! `POINT + runs (FIELD fields + pictures eyes (PICTURE + GP gps) + BLOCK blocks fields) + LOAD eyes primitives + JUDGED_FIELD fields`,
//! where `runs` is [`RUNS_OF_HEAD`] of a tracked head, else 1; `LOAD` counts where pictures come from a closed form, `BLOCK` where a pipeline draws
//! blocks, and `JUDGED_FIELD` of a tracked head.
//!
//! The constants are fitted to 606 points of all pipelines (experiments/sweep-costs.toml and sweep-costs-heads.toml, release build) by logarithms, so that too
//! much and too little count alike. How far single points are off stands in docs/sweeps.md, "What a point costs": what decides besides, above all how
//! much of a scene is in view and how often a view returns, no closed form knows. Whoever hands points out corrects the estimate by what points have taken.

use super::Sweep;
use crate::Plan;
use pxpl5_run::{Experiment, KeyValue, Level};
use std::collections::BTreeMap;

/// A plan, its scene and its row.
const POINT: f64 = 3e-3;
/// A field, with its retrace and the head's samples.
const FIELD: f64 = 3.5e-4;
/// A picture of one eye: its regions, and the messages of each processor for them.
const PICTURE: f64 = 1.8e-4;
const GP: f64 = 1.3e-5;
/// A block of frameless rendering.
const BLOCK: f64 = 5.6e-6;
/// A primitive of an eye: transformed when its view is first drawn.
const LOAD: f64 = 2.8e-5;
/// A primitive of a picture as code of the i860. Assumed, from the speeds of the README.
const PRIMITIVE_AS_CODE: f64 = 2.7e-5;
/// A tracked head: the run is repeated to know when views are seen, and errors are judged in every field.
const RUNS_OF_HEAD: f64 = 2.0;
const JUDGED_FIELD: f64 = 6e-4;

/// A field of NTSC, a word on the ring and the transformation of a primitive on a graphics processor, seconds; words that go along with a block;
/// processors that fill the ring with blocks. Of other displays and machines the same: an estimate needs no more.
const FIELD_S: f64 = 16.683_333e-3;
const WORD_S: f64 = 50e-9;
const TRANSFORM_S: f64 = 21.7e-6;
const BLOCK_WORDS: f64 = 16.0;
const BLOCK_GPS: f64 = 20.0;

impl Sweep {
    /// About how many seconds each of some points will take on one core, by the analytic level where the pipeline has a closed form: how
    /// many pictures there will be. A point that is no experiment costs next to nothing. Points that differ in their seed alone are taken to cost the
    /// same.
    #[must_use]
    pub fn costs(&self, points: &[u64]) -> Vec<f64> {
        let mut known: BTreeMap<String, f64> = BTreeMap::new();
        let mut costs = Vec::with_capacity(points.len());
        for point in points {
            let mut settings = self.space().settings(*point);
            settings.remove("seed");
            let cost = *known.entry(format!("{settings:?}")).or_insert_with(|| self.cost(*point));
            costs.push(cost);
        }
        costs
    }

    fn cost(&self, point: u64) -> f64 {
        let Ok(plan) = self.plan(point) else { return POINT };
        let Ok(scene) = self.scene(&plan) else { return POINT };
        if plan.level == Level::Analytic {
            return POINT;
        }
        let experiment = plan.experiment(scene);
        let primitives = (experiment.scene().triangles().len() + experiment.scene().spheres().len()) as f64;
        let eyes = plan.pipeline.eyes() as f64;
        let fields = plan.fields as f64;
        let by_form = pictures_by_form(&plan, experiment);
        let pictures = by_form.unwrap_or_else(|| pictures_at_most(&plan, primitives * eyes));
        let as_code = if plan.level == Level::Cycle { PRIMITIVE_AS_CODE * primitives } else { 0.0 };
        let picture = eyes * (PICTURE + GP * plan.machine.n_gps as f64 + as_code);
        let run = fields * FIELD + pictures * picture + fields * blocks(&plan) * BLOCK;
        let load = if by_form.is_some() { LOAD * eyes * primitives } else { 0.0 };
        let (runs, judged) = if plan.head.is_some() { (RUNS_OF_HEAD, fields * JUDGED_FIELD) } else { (1.0, 0.0) };
        POINT + runs * run + load + judged
    }
}

/// How many pictures a run shows, by the closed form; `None` where there is none.
fn pictures_by_form(plan: &Plan, experiment: Experiment) -> Option<f64> {
    let entry = plan.registry.pipeline(plan.pipeline.name()).ok()?;
    let form = entry.closed_form.filter(|_| plan.head.is_none())?;
    let summary = (form.summary)(&experiment.level(Level::Analytic)).ok()?;
    let shown = summary.updates_hz? * plan.fields as f64 * summary.field_ms * 1e-3;
    Some(shown).filter(|shown| shown.is_finite())
}

/// One picture a field, or as many as the processors can transform.
fn pictures_at_most(plan: &Plan, primitives: f64) -> f64 {
    let gps = plan.machine.n_gps as f64;
    plan.fields as f64 * (FIELD_S * gps / (TRANSFORM_S * primitives.max(1.0))).min(1.0)
}

/// Blocks of a field; 0 where a pipeline draws none.
fn blocks(plan: &Plan) -> f64 {
    let settings = plan.pipeline.settings();
    let Some((_, KeyValue::Whole(width))) = settings.iter().find(|(name, _)| *name == "block") else { return 0.0 };
    let block_s = WORD_S * ((width * width) as f64 + BLOCK_WORDS);
    FIELD_S / block_s * (plan.machine.n_gps as f64 / BLOCK_GPS).min(1.0)
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
    }
}
