//! What came of an experiment: numbers, tables, pictures, drawings.

use crate::catalogue::python;
use crate::errors::{failed_run, wrong_setting};
use crate::picture::Picture;
use crate::table::{Column, Table};
use numpy::PyArray3;
use numpy::ndarray::Array3;
use pxpl5::firmware::{Layout, PictureNumber};
use pxpl5::measure::{Measure, Measured, side_by_side};
use pxpl5::results::{columns, origin, rows};
use pxpl5::timeline::{TimelineOptions, svg};
use pxpl5::views::page::{PagePicture, PageRun, html};
use pxpl5::views::png_bytes;
use pxpl5::{PeriodNumber, QUANTITIES, Report, Results, SurfaceId};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::{Mutex, OnceLock, PoisonError};

/// What came of an experiment: the machine's record and the pictures that were shown.
#[pyclass(frozen, module = "pxpl5._native")]
pub(crate) struct Outcome {
    /// As it came, until somebody asks for its numbers.
    outcome: Mutex<Option<pxpl5::Outcome>>,
    results: OnceLock<Results>,
    measures: Vec<Measure>,
}

impl Outcome {
    pub(crate) fn of(outcome: pxpl5::Outcome, measures: &[Measure]) -> Self {
        Self { outcome: Mutex::new(Some(outcome)), results: OnceLock::new(), measures: measures.to_vec() }
    }

    /// The numbers, which may take a while the first time: what a load that is too heavy could be instead is searched for.
    fn results(&self, py: Python<'_>) -> PyResult<&Results> {
        py.detach(|| {
            if self.results.get().is_none() {
                // Whoever comes second waits here, and finds the results made.
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

    /// What can be said of the outcome at once, without its report.
    fn look<T: Send>(&self, py: Python<'_>, at: impl Fn(&pxpl5::Outcome) -> T + Send + Sync) -> PyResult<T> {
        let looked = py.detach(|| {
            let outcome = self.outcome.lock().unwrap_or_else(PoisonError::into_inner);
            outcome.as_ref().map(&at)
        });
        match looked {
            Some(looked) => Ok(looked),
            None => Ok(at(self.run(py)?.0)),
        }
    }

    /// A surface by its label (`left`, `right`) or number.
    fn surface(&self, py: Python<'_>, name: &str) -> PyResult<SurfaceId> {
        let (outcome, _) = self.run(py)?;
        let all: Vec<(SurfaceId, &str)> =
            outcome.record().surfaces().map(|(id, surface)| (id, surface.label)).collect();
        let found = all.iter().find(|(id, label)| *label == name || id.0.to_string() == name).map(|(id, _)| *id);
        let labels: Vec<&str> = all.iter().map(|(_, label)| *label).collect();
        found.ok_or_else(|| wrong_setting(format!("surface: expected {}, found {name}", labels.join(" or "))))
    }

    fn texts(&self, py: Python<'_>) -> PyResult<Vec<(&'static str, String)>> {
        Ok(origin(self.run(py)?.1))
    }
}

#[pymethods]
impl Outcome {
    /// Hash of everything that happened, statistics included: the same as that of the command and of Rust.
    #[getter]
    fn trace_hash(&self, py: Python<'_>) -> PyResult<String> {
        Ok(self.run(py)?.1.trace_hash.clone())
    }

    /// Name of everything on which the trace depends.
    #[getter]
    fn config_hash(&self, py: Python<'_>) -> PyResult<String> {
        self.look(py, |outcome| outcome.experiment().config_hash().to_string())
    }

    /// Names of the pipeline, the machine's preset and the scene.
    fn subject(&self, py: Python<'_>) -> PyResult<(String, String, String)> {
        self.look(py, |outcome| {
            let experiment = outcome.experiment();
            let pipeline = outcome.pipeline().name().to_owned();
            (pipeline, experiment.config().preset.clone(), experiment.scene().name().to_owned())
        })
    }

    /// Everything as numbers: the dictionary of `pxpl5 run --json`.
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        python(py, self.run(py)?.1)
    }

    /// The report as JSON text.
    fn report_json(&self, py: Python<'_>) -> PyResult<String> {
        serde_json::to_string_pretty(self.run(py)?.1).map_err(wrong_setting)
    }

    /// The value of a quantity by its name; None where the run shows none.
    fn quantity(&self, py: Python<'_>, name: &str) -> PyResult<Option<f64>> {
        let measure = Measure::named(name)
            .map_err(|nearest| wrong_setting(format!("there is no quantity `{name}`; did you mean `{nearest}`?")))?;
        Ok(measure.of(self.results(py)?))
    }

    /// All quantities that the run shows, by name.
    fn quantities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for measure in QUANTITIES.iter().filter_map(|quantity| Measure::named(quantity.name).ok()) {
            all.set_item(measure.name(), measure.of(self.results(py)?))?;
        }
        Ok(all)
    }

    /// The quantities that the experiment names in ``measure``, by name.
    fn measured<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        let results = self.results(py)?;
        self.measures.iter().try_for_each(|measure| all.set_item(measure.name(), measure.of(results)))?;
        Ok(all)
    }

    /// A row for each picture that was begun.
    fn pictures(&self, py: Python<'_>) -> PyResult<Table> {
        let (outcome, _) = self.run(py)?;
        let (columns, rows) = py.detach(|| (columns(), rows(outcome)));
        Table::of(columns.iter().enumerate().map(|(i, column)| column_of(i, column, &rows)).collect())
    }

    /// A row for each stage of each picture.
    fn stages(&self, py: Python<'_>) -> PyResult<Table> {
        let (outcome, _) = self.run(py)?;
        let record = outcome.record();
        let stages = outcome.stages();
        let ps = |time: pxpl5::Time| time.0.cast_signed();
        let label = |id: SurfaceId| record.surface(id).map(|surface| surface.label.to_owned());
        Table::of(vec![
            Column::whole(
                "picture",
                "number of the picture in its pipeline's own count",
                numbers(&stages, |s| Some(s.picture.0.cast_signed())),
            ),
            Column::text(
                "stage",
                "SAMPLE to SWAP, in lower case",
                stages.iter().map(|s| Some(format!("{:?}", s.stage).to_lowercase())).collect(),
            ),
            Column::text(
                "surface",
                "the eye, of stages that take one at a time",
                stages.iter().map(|s| s.surface.and_then(label)).collect(),
            ),
            Column::whole(
                "begin_ps",
                "when the first board began, picoseconds",
                numbers(&stages, |s| Some(ps(s.begin))),
            ),
            Column::whole("end_ps", "when the last board ended, picoseconds", numbers(&stages, |s| s.end.map(ps))),
        ])
    }

    /// Labels of the surfaces that somebody looks at, such as left and right.
    fn surfaces(&self, py: Python<'_>) -> PyResult<Vec<&'static str>> {
        Ok(self.run(py)?.0.record().surfaces().map(|(_, surface)| surface.label).collect())
    }

    /// What a viewer of a surface sees at the end; None without pixels, or before anything was shown.
    fn picture(&self, py: Python<'_>, surface: &str) -> PyResult<Option<Picture>> {
        let id = self.surface(py, surface)?;
        let (outcome, _) = self.run(py)?;
        let picture = py.detach(|| outcome.picture(id));
        picture.map(|picture| Picture::of(py, picture, self.texts(py)?)).transpose()
    }

    /// What a viewer of a surface saw at the end of a field; None of one that is no longer remembered, or not over.
    fn seen(&self, py: Python<'_>, surface: &str, field: u64) -> PyResult<Option<Picture>> {
        let id = self.surface(py, surface)?;
        let (outcome, _) = self.run(py)?;
        let picture = py.detach(|| outcome.record().display().seen(id.index(), PeriodNumber(field)));
        picture.map(|picture| Picture::of(py, picture, self.texts(py)?)).transpose()
    }

    /// Both eyes side by side, as at the end; None without pixels.
    fn both(&self, py: Python<'_>) -> PyResult<Option<Picture>> {
        let (outcome, _) = self.run(py)?;
        let pictures = py.detach(|| {
            let ids: Vec<SurfaceId> = outcome.record().surfaces().map(|(id, _)| id).collect();
            ids.into_iter().filter_map(|id| outcome.picture(id)).collect::<Vec<_>>()
        });
        let both = pictures.into_iter().reduce(|left, right| side_by_side(&left, &right));
        both.map(|picture| Picture::of(py, picture, self.texts(py)?)).transpose()
    }

    /// Pixel memory of a renderer at the end: bit planes of shape (208, 128, 128) by bit, row and column, 0 or 1; None of a renderer that
    /// holds nothing, and without pixels. The array is not shared.
    fn pixel_memory<'py>(&self, py: Python<'py>, renderer: usize) -> PyResult<Option<Bound<'py, PyArray3<u8>>>> {
        let renderers = self.run(py)?.0.record().renderers();
        let count = renderers.len();
        let board = renderers.get(renderer);
        let board =
            board.ok_or_else(|| wrong_setting(format!("renderer: expected 0 to {}, found {renderer}", count - 1)))?;
        let planes = py.detach(|| board.pixel_memory().map(|memory| bit_planes(&memory)));
        Ok(planes.map(|planes| PyArray3::from_owned_array(py, planes)))
    }

    /// How the pipeline divides pixel memory: name, first bit and bits of each field.
    fn pixel_memory_fields(&self, py: Python<'_>) -> PyResult<Vec<(String, u32, u32)>> {
        let layout: Layout = self.run(py)?.0.pipeline().layout();
        Ok(layout.ranges().into_iter().map(|range| (range.name, range.first, range.width)).collect())
    }

    /// A timeline as SVG: of a picture, or the first after the warm-up; from a field on, so many fields.
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

    /// The run as one page of HTML, with its pictures and its timeline.
    fn page(&self, py: Python<'_>, name: &str) -> PyResult<String> {
        let (outcome, report) = self.run(py)?;
        let mut run = PageRun { name: name.to_owned(), ..PageRun::default() };
        run.report = serde_json::to_value(report).map_err(wrong_setting)?;
        run.timeline = Some(self.timeline(py, None, None, None, None)?.into_bytes());
        run.latencies_ms =
            outcome.complete_pictures().map(|times| times.shown_at.since(times.transform_at).as_ms()).collect();
        for (id, surface) in outcome.record().surfaces() {
            if let Some(picture) = py.detach(|| outcome.picture(id)) {
                let png = png_bytes(&picture, &[]).map_err(wrong_setting)?;
                run.pictures.push(PagePicture { label: surface.legend(), png });
            }
        }
        Ok(html(&[run]))
    }

    /// Pixel errors field by field, and over what; None of a run without a tracked head.
    fn pixel_errors<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let (outcome, _) = self.run(py)?;
        let errors = py.detach(|| outcome.pixel_errors());
        errors.map(|errors| python(py, &errors)).transpose()
    }
}

/// A column of the table of pictures.
fn column_of(i: usize, column: &pxpl5::results::Column, rows: &[Vec<Option<u64>>]) -> Column {
    let values = rows.iter().map(|row| row[i].map(u64::cast_signed)).collect();
    Column::whole(&column.name, &column.definition, values)
}

fn numbers(stages: &[pxpl5::StageSpan], of: impl Fn(&pxpl5::StageSpan) -> Option<i64>) -> Vec<Option<i64>> {
    stages.iter().map(of).collect()
}

/// Bits of pixel memory.
const BITS: usize = 208;

/// Columns and rows of the array.
const SIDE: usize = 128;

/// All bits, one byte each.
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
