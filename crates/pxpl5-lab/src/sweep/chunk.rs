//! Simulates some points of a sweep within a time limit, for programs that distribute the points over computers.

use super::point::row;
use super::{Status, Sweep, SweepRow};
use pxpl5_sim::StopFlag;
use std::time::{Duration, Instant};

impl Sweep {
    /// Simulates `points` one after the other on the calling thread, until the time `at_most` has passed. Returns each
    /// row with the seconds of its simulation.
    ///
    /// The first point is always simulated, and no point is interrupted. Repeated calls with the remaining points
    /// therefore reach the end. A row depends only on the file and the point. An error of a point, even a panic, is
    /// stored in the row.
    pub fn rows(&self, points: &[u64], at_most: Duration) -> Vec<(SweepRow, f64)> {
        let begin = Instant::now();
        let mut rows = Vec::new();
        for point in points {
            let start = Instant::now();
            let row = row(self, *point, &StopFlag::default());
            rows.push((row, start.elapsed().as_secs_f64()));
            if begin.elapsed() >= at_most {
                break;
            }
        }
        rows
    }
}

impl SweepRow {
    /// Returns true if the point of this row was simulated.
    pub fn is_done(&self) -> bool {
        self.status == Status::Done
    }
}

#[cfg(test)]
mod tests {
    use crate::ExperimentFile;
    use crate::study::Study;
    use crate::sweep::{RunOptions, Shard, Store, Sweep, SweepQuery};
    use std::time::Duration;

    fn sweep(text: &str) -> Sweep {
        Sweep::new(ExperimentFile::parse(text, "test").expect("settings")).expect("a space")
    }

    const SPACE: &str =
        "pipeline = \"slats\"\nscene = \"typical:60\"\nfields = 20\n[sweep.grid]\ntriangles = [20, 40, 0]\n";

    #[test]
    fn rows_of_selected_points_equal_the_rows_of_the_whole_sweep() {
        let sweep = sweep(SPACE);
        let folder = tempfile::tempdir().expect("a folder");
        let mut store = Store::open(folder.path(), sweep.header().expect("a header"), true).expect("a folder");
        let options = RunOptions { shard: Shard::ALL, threads: 2 };
        SweepQuery::new(&sweep, &mut store, options).run(&mut ()).expect("it can be written");
        for (row, seconds) in sweep.rows(&[2, 0, 1], Duration::MAX) {
            assert_eq!(store.row(row.point).expect("readable"), Some(row.clone()));
            assert!(seconds >= 0.0 && row.is_done() == (row.point != 2), "{row:?}");
        }
    }

    #[test]
    fn with_no_time_left_one_point_is_simulated_and_the_others_remain() {
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

    /// Tests that the rows are the same if the points are run in the opposite order. The two points share a scene, once
    /// with and once without its back faces.
    #[test]
    fn a_row_does_not_depend_on_the_points_before_it() {
        // Half of a sphere's triangles face away from the eye.
        let text = "pipeline = \"rendering-control\"\nscene = \"sphere:400\"\nfields = 20\n[sweep.grid]\ncull = [false, true]\n";
        let rows = |points: &[u64]| {
            let mut rows = sweep(text).rows(points, Duration::MAX);
            rows.sort_by_key(|(row, _)| row.point);
            rows.into_iter().map(|(row, _)| row).collect::<Vec<_>>()
        };
        let in_order = rows(&[0, 1]);
        assert_ne!(in_order[0].trace_hash, in_order[1].trace_hash);
        assert_eq!(rows(&[1, 0]), in_order);
    }
}
