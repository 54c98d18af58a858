//! Sweeps, which run an experiment at many points of a space of settings, and the folder with their rows.

use crate::background::in_background;
use crate::catalogue::python;
use crate::errors::{failed_sweep, wrong_setting};
use crate::settings::Settings;
use pxpl5::Study;
use pxpl5::sweep::{RunOptions, Shard, Store as NativeStore, Sweep as NativeSweep, SweepQuery, SweepRow};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// A sweep: the same experiment at every point of a space of settings.
#[pyclass(frozen, module = "pxpl5._native")]
pub(crate) struct Sweep {
    sweep: Arc<NativeSweep>,
}

#[pymethods]
impl Sweep {
    /// Creates a sweep from settings that define a space of points.
    ///
    /// Raises :class:`pxpl5.SettingError` for an invalid space.
    #[new]
    fn new(settings: &Settings) -> PyResult<Self> {
        let sweep = NativeSweep::new(settings.file.clone()).map_err(wrong_setting)?;
        Ok(Self { sweep: Arc::new(sweep) })
    }

    /// Returns the number of points at which the sweep runs the experiment.
    #[getter]
    fn points(&self) -> u64 {
        self.sweep.space().points()
    }

    /// Returns the values that all rows of the sweep have in common: schema, version, machine, quantities with their
    /// definitions, and axes of the space.
    ///
    /// Raises :class:`pxpl5.SettingError` if no point is a valid experiment.
    fn header<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let header = py.detach(|| self.sweep.header()).map_err(wrong_setting)?;
        python(py, &header)
    }

    /// Simulates some of the points on one thread. After ``seconds`` no further point is started, but the first point
    /// is always simulated. Returns, for each simulated point, its row as a line of JSON and the seconds that its
    /// simulation took.
    fn rows(&self, py: Python<'_>, points: Vec<u64>, seconds: f64) -> PyResult<Vec<(String, f64)>> {
        let sweep = Arc::clone(&self.sweep);
        let at_most = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
        let rows = in_background(py, None, false, move |_| sweep.rows(&points, at_most))?;
        Ok(rows.into_iter().map(|(row, seconds)| (line(&row), seconds)).collect())
    }

    /// Estimates the time in seconds that each point takes to simulate. The estimate uses the analytic level of
    /// modelling.
    fn costs(&self, py: Python<'_>, points: Vec<u64>) -> PyResult<Vec<f64>> {
        let sweep = Arc::clone(&self.sweep);
        in_background(py, None, false, move |_| sweep.costs(&points))
    }
}

fn line(row: &SweepRow) -> String {
    serde_json::to_string(row).unwrap_or_default()
}

/// The rows of a sweep in a folder, in the files rows.jsonl and times.jsonl. The file results.csv is added at the end.
#[pyclass(module = "pxpl5._native")]
pub(crate) struct Store {
    sweep: Arc<NativeSweep>,
    store: Option<NativeStore>,
}

impl Store {
    fn open_store(&mut self) -> PyResult<&mut NativeStore> {
        self.store.as_mut().ok_or_else(|| failed_sweep("the store is closed"))
    }
}

#[pymethods]
impl Store {
    /// Opens or creates the folder for a sweep. If ``resume`` is true, the rows of finished points are kept.
    ///
    /// Raises :class:`pxpl5.SweepError` if the folder cannot be used, is in use, or contains another sweep.
    #[new]
    fn new(sweep: &Sweep, folder: PathBuf, resume: bool) -> PyResult<Self> {
        let header = sweep.sweep.header().map_err(wrong_setting)?;
        let store = NativeStore::open(&folder, header, resume).map_err(failed_sweep)?;
        Ok(Self { sweep: Arc::clone(&sweep.sweep), store: Some(store) })
    }

    /// Returns the indices of the points that have no row yet, in ascending order.
    fn missing(&mut self) -> PyResult<Vec<u64>> {
        let points = self.sweep.space().points();
        let store = self.open_store()?;
        Ok((0..points).filter(|point| !store.holds(*point)).collect())
    }

    /// Stores a row (a line of JSON) and the time in seconds that its point took. Returns the index of the point. If
    /// the point already has a row, the existing row is kept.
    ///
    /// Raises :class:`pxpl5.SweepError` for an invalid line, and if the row cannot be written.
    fn append(&mut self, line: &str, seconds: f64) -> PyResult<u64> {
        let row: SweepRow = serde_json::from_str(line).map_err(failed_sweep)?;
        let points = self.sweep.space().points();
        if row.point >= points {
            return Err(failed_sweep(format!("expected a point below {points}, found {}", row.point)));
        }
        let store = self.open_store()?;
        if !store.holds(row.point) {
            store.append(&row, seconds).map_err(failed_sweep)?;
        }
        Ok(row.point)
    }

    /// Simulates all points that have no row yet, on ``threads`` threads of this computer. Ctrl-C ends the points in
    /// progress, which get no row. The rows of finished points are in the folder.
    ///
    /// Raises :class:`pxpl5.SweepError` if a row cannot be stored, and KeyboardInterrupt after Ctrl-C.
    #[pyo3(signature = (threads, progress = None))]
    fn run(&mut self, py: Python<'_>, threads: usize, progress: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let mut store = self.store.take().ok_or_else(|| failed_sweep("the store is closed"))?;
        let sweep = Arc::clone(&self.sweep);
        let (store, result) = in_background(py, progress, true, move |watch| {
            let options = RunOptions { shard: Shard::ALL, threads };
            let result = SweepQuery::new(&*sweep, &mut store, options).run(&mut &*watch);
            (store, result)
        })?;
        self.store = Some(store);
        result.map(drop).map_err(failed_sweep)
    }

    /// Returns all rows in the order of their points, each as a line of JSON.
    ///
    /// Raises :class:`pxpl5.SweepError` if the rows cannot be read.
    fn lines(&mut self) -> PyResult<Vec<String>> {
        let points = self.sweep.space().points();
        let store = self.open_store()?;
        let rows = (0..points).filter_map(|point| store.row(point).transpose());
        rows.map(|row| Ok(line(&row.map_err(failed_sweep)?))).collect()
    }

    /// Sorts the rows by point, writes results.csv and closes the folder.
    ///
    /// Raises :class:`pxpl5.SweepError` if the files cannot be written.
    fn finish(&mut self) -> PyResult<()> {
        let store = self.store.take().ok_or_else(|| failed_sweep("the store is closed"))?;
        store.finish().map_err(failed_sweep)
    }
}
