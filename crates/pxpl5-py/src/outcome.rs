//! Results of a run for Python: numbers, tables, pictures and drawings.

use crate::catalogue::python;
use crate::errors::{failed_run, raised, wrong_setting};
use crate::picture::Picture;
use crate::table::{Column, Table};
use numpy::PyArray3;
use numpy::ndarray::Array3;
use pxpl5::arp::address_recalculation::AddressRecalculationPipeline;
use pxpl5::arp::pictures::cross;
use pxpl5::firmware::{Layout, PictureNumber};
use pxpl5::views::page::{PagePicture, PageRun, html};
use pxpl5::views::png_bytes;
use pxpl5::views::results::{columns, origin, rows};
use pxpl5::views::timeline::{TimelineOptions, svg};
use pxpl5::{ExperimentError, Eye, ObservedEvent, PeriodNumber, QUANTITIES, Record, Report, Results, SurfaceId};
use pxpl5::{Measure, Measured, side_by_side};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::{Mutex, OnceLock, PoisonError};

/// Results of an experiment: the machine's record and the pictures that were shown.
#[pyclass(frozen, module = "pxpl5._native")]
pub(crate) struct Outcome {
    /// Outcome of the run before the results are computed. `results` takes the outcome out and leaves `None`.
    outcome: Mutex<Option<pxpl5::Outcome>>,
    results: OnceLock<Results>,
    measures: Vec<Measure>,
}

impl Outcome {
    pub(crate) fn of(outcome: pxpl5::Outcome, measures: &[Measure]) -> Self {
        Self { outcome: Mutex::new(Some(outcome)), results: OnceLock::new(), measures: measures.to_vec() }
    }

    /// Returns the results, which are computed at the first call. If the scene is too heavy for the machine, this call
    /// also searches for a number of triangles that can be drawn in time.
    fn results(&self, py: Python<'_>) -> PyResult<&Results> {
        py.detach(|| {
            if self.results.get().is_none() {
                // A second caller waits for this lock until the first caller has finished.
                let mut outcome = self.outcome.lock().unwrap_or_else(PoisonError::into_inner);
                if let Some(outcome) = outcome.take() {
                    let _ = self.results.set(Results::of_run(outcome));
                }
            }
        });
        self.results.get().ok_or_else(|| failed_run("a bug of the emulator: an outcome without results"))
    }

    fn run(&self, py: Python<'_>) -> PyResult<(&pxpl5::Outcome, &Report)> {
        let run = self.results(py)?.run.as_ref().map(|(outcome, report)| (outcome, report));
        run.ok_or_else(|| wrong_setting("the analytic level has no events"))
    }

    /// Returns a value that `at` reads from the outcome of the run. Unlike `results`, this method does not compute the
    /// report of the run.
    fn read<T: Send>(&self, py: Python<'_>, at: impl Fn(&pxpl5::Outcome) -> T + Send + Sync) -> PyResult<T> {
        let result = py.detach(|| {
            let outcome = self.outcome.lock().unwrap_or_else(PoisonError::into_inner);
            outcome.as_ref().map(&at)
        });
        match result {
            Some(result) => Ok(result),
            None => Ok(at(self.run(py)?.0)),
        }
    }

    fn surface(&self, py: Python<'_>, name: &str) -> PyResult<SurfaceId> {
        surface_named(self.run(py)?.0.record(), name).map_err(wrong_setting)
    }

    fn texts(&self, py: Python<'_>) -> PyResult<Vec<(&'static str, String)>> {
        Ok(origin(self.run(py)?.1))
    }
}

/// Returns the surface with a label or a number.
pub(crate) fn surface_named(record: &Record, name: &str) -> Result<SurfaceId, String> {
    let all: Vec<(SurfaceId, &str)> = record.surfaces().map(|(id, surface)| (id, surface.label)).collect();
    let found = all.iter().find(|(id, label)| *label == name || id.0.to_string() == name).map(|(id, _)| *id);
    let labels: Vec<&str> = all.iter().map(|(_, label)| *label).collect();
    found.ok_or_else(|| format!("surface: expected {}, found {name}", labels.join(" or ")))
}

pub(crate) fn outcome_of_run(
    py: Python<'_>,
    result: Result<pxpl5::Outcome, Box<ExperimentError>>,
    measures: &[Measure],
) -> PyResult<Outcome> {
    match result {
        Ok(outcome) => Ok(Outcome::of(outcome, measures)),
        Err(error) => Err(exception(py, *error, measures)),
    }
}

/// Converts an error of the library to an exception, which has the values that were measured until the error.
pub(crate) fn exception(py: Python<'_>, error: ExperimentError, measures: &[Measure]) -> PyErr {
    let text = error.to_string();
    let (name, partial, needed) = match error {
        ExperimentError::TooShort { needed, partial, .. } => ("TooShortError", partial, needed),
        ExperimentError::Run { partial, .. } => ("RunError", partial, None),
        ExperimentError::Stopped(_) => return failed_run(text),
        _ => return wrong_setting(text),
    };
    // The exception carries the partial outcome and the number of fields that a run would need.
    let exception = raised(name, &text);
    let value = exception.value(py);
    let partial = Py::new(py, Outcome::of(*partial, measures));
    let set = partial
        .and_then(|partial| value.setattr("_native", partial))
        .and_then(|()| value.setattr("fields_needed", needed));
    match set {
        Ok(()) => exception,
        Err(error) => error,
    }
}

#[pymethods]
impl Outcome {
    /// Returns the hash of the run's trace, including statistics. The command-line program and the Rust library give
    /// the same hash.
    #[getter]
    fn trace_hash(&self, py: Python<'_>) -> PyResult<String> {
        Ok(self.run(py)?.1.trace_hash.clone())
    }

    /// Returns a hash of all settings and inputs on which the trace depends.
    #[getter]
    fn config_hash(&self, py: Python<'_>) -> PyResult<String> {
        self.read(py, |outcome| outcome.experiment().config_hash().to_string())
    }

    /// Returns the names of the pipeline, the machine's preset and the scene.
    fn subject(&self, py: Python<'_>) -> PyResult<(String, String, String)> {
        self.read(py, |outcome| {
            let experiment = outcome.experiment();
            let pipeline = outcome.pipeline().name().to_owned();
            (pipeline, experiment.config().preset.clone(), experiment.scene().name().to_owned())
        })
    }

    /// Returns the report of the run as the same dictionary that `pxpl5 run --json` prints.
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        python(py, self.run(py)?.1)
    }

    /// Returns the report as JSON text.
    fn report_json(&self, py: Python<'_>) -> PyResult<String> {
        serde_json::to_string_pretty(self.run(py)?.1).map_err(wrong_setting)
    }

    /// Returns the value of a measured quantity by its name, or None if the run does not define the quantity.
    fn quantity(&self, py: Python<'_>, name: &str) -> PyResult<Option<f64>> {
        let measure = Measure::named(name).map_err(wrong_setting)?;
        Ok(measure.of(self.results(py)?))
    }

    /// Returns true if old records of the run were discarded, so that tables have only the last pictures.
    fn has_discarded_records(&self, py: Python<'_>) -> PyResult<bool> {
        self.read(py, |outcome| {
            let kept = outcome.pictures().len() as u64;
            outcome.has_discarded_records() || kept < outcome.tally().pictures
        })
    }

    /// Returns the advice of the library if the machine was too slow for its scene, or if no picture was complete in
    /// time. Returns None otherwise.
    fn advice(&self, py: Python<'_>) -> PyResult<Option<String>> {
        let (outcome, report) = self.run(py)?;
        if let Some(too_heavy) = &report.too_heavy {
            return Ok(Some(too_heavy.to_string()));
        }
        let is_empty = outcome.tally().complete == 0;
        Ok(is_empty.then(|| "no picture was complete in time; the run has no latency".to_owned()))
    }

    /// Returns the six cube faces that an eye's display memory shows at the end of the run, unfolded into a cross of 4
    /// x 3 faces. Returns None for a display without such memories.
    ///
    /// Raises :class:`pxpl5.SettingError` for an eye or a memory that does not exist.
    fn face(&self, py: Python<'_>, eye: &str, memory: usize) -> PyResult<Option<Picture>> {
        let eye = match eye {
            "left" => Eye::Left,
            "right" => Eye::Right,
            _ => return Err(wrong_setting(format!("eye: expected left or right, found {eye}"))),
        };
        let (outcome, _) = self.run(py)?;
        let Some(display) = outcome.record().display_of_kind::<AddressRecalculationPipeline>() else {
            return Ok(None);
        };
        let memories = display.memories(eye);
        let Some(memory) = memories.get(memory) else {
            let last = memories.len().saturating_sub(1);
            return Err(wrong_setting(format!("memory: expected 0 to {last}, found {memory}")));
        };
        let picture = py.detach(|| cross(&memory.shown_faces(), 0));
        Picture::of(py, picture, self.texts(py)?).map(Some)
    }

    /// Returns all measured quantities by name. The value is None for a quantity that the run does not define.
    fn quantities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for measure in QUANTITIES.iter().filter_map(|quantity| Measure::named(quantity.name).ok()) {
            all.set_item(measure.name(), measure.of(self.results(py)?))?;
        }
        Ok(all)
    }

    /// Returns the quantities that the experiment's setting ``measure`` lists, by name.
    fn measured<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        let results = self.results(py)?;
        self.measures.iter().try_for_each(|measure| all.set_item(measure.name(), measure.of(results)))?;
        Ok(all)
    }

    /// Returns a table with one row for each picture that the run has begun.
    fn pictures(&self, py: Python<'_>) -> PyResult<Table> {
        let (outcome, _) = self.run(py)?;
        let (columns, rows) = py.detach(|| (columns(), rows(outcome)));
        let values = |i: usize| rows.iter().map(move |row| row[i].map(u64::cast_signed));
        let column =
            |(i, of): (usize, &pxpl5::views::results::Column)| Column::whole(&of.name, &of.definition, values(i));
        Table::of(columns.iter().enumerate().map(column).collect())
    }

    /// Returns a table with one row for each processing stage of each picture.
    fn stages(&self, py: Python<'_>) -> PyResult<Table> {
        let (outcome, _) = self.run(py)?;
        let stages = outcome.stages();
        // A stage that belongs to all surfaces has no surface label.
        let label = |id: SurfaceId| outcome.record().surface(id).map(|surface| surface.label.to_owned());
        Table::of(vec![
            Column::whole("picture", PICTURE, stages.iter().map(|stage| Some(stage.picture.0.cast_signed()))),
            Column::text(
                "stage",
                "SAMPLE to SWAP, in lower case",
                stages.iter().map(|stage| Some(format!("{:?}", stage.stage).to_lowercase())),
            ),
            Column::text(
                "surface",
                "the eye, of stages that take one at a time",
                stages.iter().map(|stage| stage.surface.and_then(label)),
            ),
            Column::whole(
                "begin_ps",
                "when the first board began, picoseconds",
                stages.iter().map(|s| Some(ps(s.begin))),
            ),
            Column::whole("end_ps", "when the last board ended, picoseconds", stages.iter().map(|s| s.end.map(ps))),
        ])
    }

    /// Returns a table with one row for each observed event, in the order of time. The events are stages of programs,
    /// regions that renderers copied, regions that arrived at displays, and swaps.
    fn events(&self, py: Python<'_>) -> PyResult<Table> {
        let (outcome, _) = self.run(py)?;
        let events: Vec<ObservedEvent> = py.detach(|| outcome.events().collect());
        Table::of(vec![
            Column::whole("time_ps", "when the event happened, picoseconds", events.iter().map(|e| Some(ps(e.time)))),
            Column::text("board", "name of the board", events.iter().map(|event| Some(event.board.to_string()))),
            Column::whole(
                "picture",
                PICTURE,
                events.iter().map(|event| event.kind.picture().map(|number| number.0.cast_signed())),
            ),
            Column::text("event", "the event in words", events.iter().map(|event| Some(event.kind.to_string()))),
        ])
    }

    /// Returns the labels of the surfaces that a viewer sees, such as left and right.
    fn surfaces(&self, py: Python<'_>) -> PyResult<Vec<&'static str>> {
        Ok(self.run(py)?.0.record().surfaces().map(|(_, surface)| surface.label).collect())
    }

    /// Returns the picture on a surface at the end of the run. Returns None if the run computed no pixels, or showed no
    /// picture.
    fn picture(&self, py: Python<'_>, surface: &str) -> PyResult<Option<Picture>> {
        let id = self.surface(py, surface)?;
        let (outcome, _) = self.run(py)?;
        let picture = py.detach(|| outcome.picture(id));
        picture.map(|picture| Picture::of(py, picture, self.texts(py)?)).transpose()
    }

    /// Returns the picture that a viewer has seen on a surface at the end of a field. Returns None if the field is not
    /// finished, or if the record of the field was discarded.
    fn seen(&self, py: Python<'_>, surface: &str, field: u64) -> PyResult<Option<Picture>> {
        let id = self.surface(py, surface)?;
        let (outcome, _) = self.run(py)?;
        let picture = py.detach(|| outcome.record().display().seen(id.index(), PeriodNumber(field)));
        picture.map(|picture| Picture::of(py, picture, self.texts(py)?)).transpose()
    }

    /// Returns the pictures of both eyes side by side at the end of the run, or None if the run computed no pixels.
    fn both(&self, py: Python<'_>) -> PyResult<Option<Picture>> {
        let (outcome, _) = self.run(py)?;
        let pictures = py.detach(|| {
            let ids: Vec<SurfaceId> = outcome.record().surfaces().map(|(id, _)| id).collect();
            ids.into_iter().filter_map(|id| outcome.picture(id)).collect::<Vec<_>>()
        });
        let both = pictures.into_iter().reduce(|left, right| side_by_side(&left, &right));
        both.map(|picture| Picture::of(py, picture, self.texts(py)?)).transpose()
    }

    /// Returns a copy of a renderer's pixel memory at the end of the run. The array has shape (208, 128, 128) by bit,
    /// row and column, with values 0 or 1. Returns None if the run computed no pixels, or if the renderer has no
    /// pixels.
    fn pixel_memory<'py>(&self, py: Python<'py>, renderer: usize) -> PyResult<Option<Bound<'py, PyArray3<u8>>>> {
        let renderers = self.run(py)?.0.record().renderers();
        let count = renderers.len();
        let board = renderers.get(renderer);
        let board =
            board.ok_or_else(|| wrong_setting(format!("renderer: expected 0 to {}, found {renderer}", count - 1)))?;
        let planes = py.detach(|| board.pixel_memory().map(|memory| bit_planes(&memory)));
        Ok(planes.map(|planes| PyArray3::from_owned_array(py, planes)))
    }

    /// Returns the parts of a pixel's memory, such as colour and depth. Each part has a name, a first bit and a width
    /// in bits.
    fn pixel_memory_fields(&self, py: Python<'_>) -> PyResult<Vec<(String, u32, u32)>> {
        let layout: Layout = self.run(py)?.0.pipeline().properties().layout;
        Ok(layout.ranges().into_iter().map(|range| (range.name, range.first, range.width)).collect())
    }

    /// Returns a timeline of the run as SVG. The dependencies of one ``picture`` are drawn, by default of the first
    /// picture after the warm-up. The other arguments give the first field and the number of fields.
    #[pyo3(signature = (picture = None, first_field = None, fields = None, title = None))]
    fn timeline(
        &self,
        py: Python<'_>,
        picture: Option<u64>,
        first_field: Option<u64>,
        fields: Option<u64>,
        title: Option<String>,
    ) -> PyResult<String> {
        let picture = picture.map(PictureNumber);
        let first_field = first_field.map(PeriodNumber);
        let options = TimelineOptions { picture, first_field, fields, title, ..TimelineOptions::default() };
        let (outcome, _) = self.run(py)?;
        Ok(py.detach(|| svg(outcome, &options)))
    }

    /// Returns an HTML page with the pictures and a timeline of the run.
    fn page(&self, py: Python<'_>, name: &str) -> PyResult<String> {
        let (outcome, report) = self.run(py)?;
        let mut run = PageRun { name: name.to_owned(), ..PageRun::default() };
        run.report = serde_json::to_value(report).map_err(wrong_setting)?;
        run.timeline = Some(self.timeline(py, None, None, None, None)?.into_bytes());
        run.latencies_ms =
            outcome.complete_pictures().map(|times| times.shown_at.since(times.transform_at).as_ms()).collect();
        // Surfaces without pixels have no picture on the page.
        for (id, surface) in outcome.record().surfaces() {
            if let Some(picture) = py.detach(|| outcome.picture(id)) {
                let png = png_bytes(&picture, &[]).map_err(wrong_setting)?;
                run.pictures.push(PagePicture { label: surface.legend(), png });
            }
        }
        Ok(html(&[run]))
    }

    /// Returns the pixel errors of each field and their totals, or None for a run without a tracked head.
    fn pixel_errors<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let (outcome, _) = self.run(py)?;
        let errors = py.detach(|| outcome.pixel_errors());
        errors.map(|errors| python(py, &errors)).transpose()
    }
}

const PICTURE: &str = "number of the picture in its pipeline's own count";

const fn ps(time: pxpl5::Time) -> i64 {
    time.0.cast_signed()
}

const BITS: usize = 208;

const SIDE: usize = 128;

/// Returns all bits of a renderer's pixel memory, each as one byte.
fn bit_planes(memory: &impl pxpl5::firmware::PixelArray) -> Array3<u8> {
    let mut planes = Array3::zeros((BITS, SIDE, SIDE));
    for bit in 0..BITS {
        let plane = memory.plane(bit);
        for y in 0..SIDE {
            for x in 0..SIDE {
                planes[[bit, y, x]] = (plane[2 * y + x / 64] >> (x % 64) & 1) as u8;
            }
        }
    }
    planes
}
