//! Some points of a sweep at a time, for whoever hands them out: their rows, and what they will cost.

use super::{Status, Sweep, SweepRow};
use pxpl5_run::{Experiment, Level};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// What an experiment costs on a host of about 3 GHz, in seconds; only ratios matter, since they size chunks. Assumed, from the
/// speeds of the README.
mod cost {
    /// A plan, its scene and its row, and the closed form.
    pub(super) const POINT: f64 = 3e-4;
    /// A field in which nothing happens.
    pub(super) const FIELD: f64 = 1e-6;
    /// A picture of one eye without primitives: its regions and messages.
    pub(super) const PICTURE: f64 = 1e-4;
    /// A primitive in it, by the table of times.
    pub(super) const PRIMITIVE: f64 = 6e-8;
    /// The same, as code of the i860.
    pub(super) const PRIMITIVE_AS_CODE: f64 = 2.7e-5;
    /// A tracked head: the run is repeated to know when views are seen, and errors are judged in every field.
    pub(super) const HEAD: f64 = 2.0;
    pub(super) const JUDGED_FIELD: f64 = 3e-4;
}

impl Sweep {
    /// Simulates some points, one after the other on this thread, until so much time is over; each row comes with the seconds that
    /// it took. The first point is always simulated, and none is broken off: so whoever asks for the rest again gets to the end.
    ///
    /// A row depends on the file and the point alone; what is wrong with a point, even a panic, becomes its row.
    #[must_use]
    pub fn rows(&self, points: &[u64], at_most: Duration) -> Vec<(SweepRow, f64)> {
        let begin = Instant::now();
        let mut rows = Vec::new();
        for point in points {
            rows.push(timed(|| self.row(*point)));
            if begin.elapsed() >= at_most {
                break;
            }
        }
        rows
    }

    /// About how many seconds each of some points will take, by the analytic level where the pipeline has a closed form: how many
    /// pictures there will be, of how many primitives. A point that is no experiment costs next to nothing. Points that differ in
    /// their seed alone are taken to cost the same.
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
        let Ok(plan) = self.plan(point) else { return cost::POINT };
        let Ok(scene) = self.scenes.scene_of(&plan) else { return cost::POINT };
        if plan.level == Level::Analytic {
            return cost::POINT;
        }
        let experiment = plan.experiment(scene);
        let primitives = (experiment.scene().triangles().len() + experiment.scene().spheres().len()) as f64;
        let a_primitive = if plan.level == Level::Cycle { cost::PRIMITIVE_AS_CODE } else { cost::PRIMITIVE };
        let a_picture = plan.pipeline.eyes() as f64 * (cost::PICTURE + primitives * a_primitive);
        let fields = plan.fields as f64;
        let run = fields * cost::FIELD + pictures(&plan, experiment) * a_picture;
        let of_head = if plan.head.is_some() { run * (cost::HEAD - 1.0) + fields * cost::JUDGED_FIELD } else { 0.0 };
        cost::POINT + run + of_head
    }
}

/// How many pictures a run shows, by the closed form; one a field where there is none.
fn pictures(plan: &crate::Plan, experiment: Experiment) -> f64 {
    let every_field = plan.fields as f64;
    let entry = plan.registry.pipeline(plan.pipeline.name()).ok();
    let Some(form) = entry.and_then(|entry| entry.closed_form).filter(|_| plan.head.is_none()) else {
        return every_field;
    };
    let summary = (form.summary)(&experiment.level(Level::Analytic)).ok();
    let shown = summary.and_then(|summary| Some(summary.updates_hz? * every_field * summary.field_ms * 1e-3));
    shown.filter(|shown| shown.is_finite()).unwrap_or(every_field)
}

fn timed(row: impl FnOnce() -> SweepRow) -> (SweepRow, f64) {
    let begin = Instant::now();
    let row = row();
    (row, begin.elapsed().as_secs_f64())
}

impl SweepRow {
    /// Whether its point could be simulated.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.status == Status::Done
    }
}

#[cfg(test)]
mod tests {
    use crate::ExperimentFile;
    use crate::sweep::{RunOptions, Shard, Store, Sweep, run};
    use std::time::Duration;

    fn sweep(text: &str) -> Sweep {
        Sweep::new(ExperimentFile::parse(text, "test").expect("settings")).expect("a space")
    }

    const SPACE: &str =
        "pipeline = \"slats\"\nscene = \"typical:60\"\nfields = 20\n[sweep.grid]\ntriangles = [20, 40, 0]\n";

    #[test]
    fn rows_of_some_points_are_those_of_the_whole_sweep() {
        let sweep = sweep(SPACE);
        let folder = std::env::temp_dir().join(format!("pxpl5-chunk-{}", std::process::id()));
        let mut store = Store::open(&folder, sweep.header().expect("a header"), true).expect("a folder");
        run(&sweep, &mut store, RunOptions { shard: Shard::ALL, threads: 2 }, |_| {}).expect("it can be written");
        for (row, seconds) in sweep.rows(&[2, 0, 1], Duration::MAX) {
            assert_eq!(store.row(row.point).expect("readable"), Some(row.clone()));
            assert!(seconds >= 0.0 && row.is_done() == (row.point != 2), "{row:?}");
        }
        drop(store);
        std::fs::remove_dir_all(folder).expect("it is ours");
    }

    #[test]
    fn without_time_one_point_is_simulated_and_the_rest_can_be_asked_for() {
        let sweep = sweep(SPACE);
        let mut left: &[u64] = &[1, 0, 2];
        let mut found = Vec::new();
        while !left.is_empty() {
            let rows = sweep.rows(left, Duration::ZERO);
            assert_eq!(rows.len(), 1);
            found.extend(rows.into_iter().map(|(row, _)| row));
            left = &left[1..];
        }
        let at_once: Vec<_> = sweep.rows(&[1, 0, 2], Duration::MAX).into_iter().map(|(row, _)| row).collect();
        assert_eq!(found, at_once);
    }

    /// Whichever point loads the scene first: with and without its back faces it is not the same.
    #[test]
    fn a_row_does_not_depend_on_the_points_before_it() {
        let text =
            "pipeline = \"slats\"\nscene = \"mig\"\ntriangles = 100\nfields = 20\n[sweep.grid]\ncull = [false, true]\n";
        let rows = |points: &[u64]| {
            let mut rows = sweep(text).rows(points, Duration::MAX);
            rows.sort_by_key(|(row, _)| row.point);
            rows.into_iter().map(|(row, _)| row).collect::<Vec<_>>()
        };
        let in_order = rows(&[0, 1]);
        assert_ne!(in_order[0].trace_hash, in_order[1].trace_hash);
        assert_eq!(rows(&[1, 0]), in_order);
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
