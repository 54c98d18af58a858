//! Rows: typed columns that leave through the Arrow PyCapsule interface.

use crate::errors::wrong_setting;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{
    Array, ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, RecordBatchIterator, StringArray,
};
use arrow_schema::{DataType, Field, Schema};
use numpy::PyArray1;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict, PyList};
use pythonize::pythonize;
use serde_json::{Map, Value};
use std::collections::HashMap;
use std::sync::Arc;

/// A column: what it is called, what it is, and its values.
pub(crate) struct Column {
    pub(crate) name: String,
    /// What its values are, with their unit; it becomes the field's metadata `about`.
    pub(crate) about: String,
    pub(crate) values: ArrayRef,
}

impl Column {
    pub(crate) fn whole(name: &str, about: &str, values: Vec<Option<i64>>) -> Self {
        Self { name: name.to_owned(), about: about.to_owned(), values: Arc::new(Int64Array::from(values)) }
    }

    pub(crate) fn text(name: &str, about: &str, values: Vec<Option<String>>) -> Self {
        Self { name: name.to_owned(), about: about.to_owned(), values: Arc::new(StringArray::from(values)) }
    }
}

/// Rows of named, typed columns.
///
/// pandas, polars, pyarrow and DuckDB take it as it is, through ``__arrow_c_stream__``, without a copy of the columns:
/// ``pyarrow.table(table)``, ``polars.DataFrame(table)``, ``pandas.DataFrame.from_arrow(table)``. A column is of whole numbers
/// (int64), real numbers (float64), truth values or text; a missing value is null. Each column says what it is, and its unit, in
/// :attr:`definitions`, and in the metadata ``about`` of its Arrow field.
#[pyclass(frozen, module = "pxpl5")]
pub(crate) struct Table {
    batch: RecordBatch,
}

impl Table {
    /// Of columns that are all as long.
    pub(crate) fn of(columns: Vec<Column>) -> PyResult<Self> {
        let fields = columns.iter().map(|column| {
            let about = HashMap::from([("about".to_owned(), column.about.clone())]);
            Field::new(&column.name, column.values.data_type().clone(), true).with_metadata(about)
        });
        let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
        let values = columns.into_iter().map(|column| column.values).collect();
        let batch = RecordBatch::try_new(schema, values).map_err(wrong_setting)?;
        Ok(Self { batch })
    }

    /// Of objects: a column for each key in the order in which keys first come, nested ones joined with a point. Lists become their
    /// JSON text.
    pub(crate) fn of_rows(rows: &[Map<String, Value>], about: &HashMap<String, String>) -> PyResult<Self> {
        let flat: Vec<Map<String, Value>> = rows.iter().map(flattened).collect();
        let mut names: Vec<&str> = Vec::new();
        for name in flat.iter().flat_map(Map::keys) {
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
        let columns = names.iter().map(|name| column_of(name, &flat, about.get(*name).map_or("", String::as_str)));
        Self::of(columns.collect())
    }

    fn column_index(&self, name: &str) -> PyResult<usize> {
        let unknown =
            |_| PyKeyError::new_err(format!("there is no column `{name}`; expected {}", self.names().join(", ")));
        self.batch.schema().index_of(name).map_err(unknown)
    }
}

/// Nested objects as keys with points.
fn flattened(row: &Map<String, Value>) -> Map<String, Value> {
    let mut flat = Map::new();
    for (key, value) in row {
        match value {
            Value::Object(inner) => {
                flat.extend(flattened(inner).into_iter().map(|(name, value)| (format!("{key}.{name}"), value)));
            }
            value => {
                flat.insert(key.clone(), value.clone());
            }
        }
    }
    flat
}

/// The column of a key: truth values, whole or real numbers where all values are, else text.
fn column_of(name: &str, rows: &[Map<String, Value>], about: &str) -> Column {
    let known: Vec<Option<&Value>> = rows.iter().map(|row| row.get(name).filter(|value| !value.is_null())).collect();
    let all = |is: fn(&Value) -> bool| known.iter().flatten().all(|value| is(value));
    let none = known.iter().all(Option::is_none);
    let values: ArrayRef = if none || (!all(Value::is_i64) && all(Value::is_number)) {
        Arc::new(known.iter().map(|value| value.and_then(Value::as_f64)).collect::<Float64Array>())
    } else if all(Value::is_i64) {
        Arc::new(known.iter().map(|value| value.and_then(Value::as_i64)).collect::<Int64Array>())
    } else if all(Value::is_boolean) {
        Arc::new(known.iter().map(|value| value.and_then(Value::as_bool)).collect::<BooleanArray>())
    } else {
        Arc::new(known.iter().map(|value| value.map(plain)).collect::<StringArray>())
    };
    Column { name: name.to_owned(), about: about.to_owned(), values }
}

fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// A table of dictionaries, given as the JSON text of a list of objects; a column for each key in the order in which keys first come.
///
/// Raises :class:`pxpl5.SettingError` for text that is no such list.
#[pyfunction]
pub(crate) fn table_of_rows(json: &str, about: HashMap<String, String>) -> PyResult<Table> {
    let rows: Vec<Map<String, Value>> = serde_json::from_str(json).map_err(wrong_setting)?;
    Table::of_rows(&rows, &about)
}

#[pymethods]
impl Table {
    /// The rows as an Arrow stream of one batch, for the Arrow PyCapsule interface; ``requested_schema`` is not looked at.
    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        drop(requested_schema);
        let batches = RecordBatchIterator::new([Ok(self.batch.clone())], self.batch.schema());
        PyCapsule::new_with_value(py, FFI_ArrowArrayStream::new(Box::new(batches)), c"arrow_array_stream")
    }

    /// How many rows there are.
    fn __len__(&self) -> usize {
        self.batch.num_rows()
    }

    /// Names of the columns, in order.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.batch.schema().fields().iter().map(|field| field.name().clone()).collect()
    }

    /// What each column is, with its unit, by name; empty text where its name says all.
    #[getter]
    fn definitions(&self) -> HashMap<String, String> {
        let schema = self.batch.schema();
        let fields = schema.fields().iter();
        fields.map(|field| (field.name().clone(), field.metadata().get("about").cloned().unwrap_or_default())).collect()
    }

    /// A column by its name, one value a row: numbers as a NumPy array of shape (rows,), int64 or float64, where a missing
    /// value makes the array float64 with NaN; text and truth values as a list with None. The numbers are copied: Arrow's own
    /// readers take them without.
    ///
    /// Raises KeyError, with the names that there are.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let column = self.batch.column(self.column_index(name)?);
        if let Some(whole) = column.as_any().downcast_ref::<Int64Array>() {
            if whole.null_count() == 0 {
                return Ok(PyArray1::from_slice(py, whole.values()).into_any());
            }
            let real = whole.iter().map(|value| value.map_or(f64::NAN, |value| value as f64));
            return Ok(PyArray1::from_iter(py, real).into_any());
        }
        if let Some(real) = column.as_any().downcast_ref::<Float64Array>() {
            return Ok(PyArray1::from_iter(py, real.iter().map(|value| value.unwrap_or(f64::NAN))).into_any());
        }
        let values = (0..column.len()).map(|row| cell(py, column, row));
        Ok(PyList::new(py, values.collect::<PyResult<Vec<_>>>()?)?.into_any())
    }

    /// A row as a dictionary, by its number from 0; None for what is missing.
    ///
    /// Raises IndexError behind the last one.
    fn row<'py>(&self, py: Python<'py>, number: usize) -> PyResult<Bound<'py, PyDict>> {
        if number >= self.batch.num_rows() {
            let rows = self.batch.num_rows();
            return Err(pyo3::exceptions::PyIndexError::new_err(format!(
                "expected a row below {rows}, found {number}"
            )));
        }
        let row = PyDict::new(py);
        for (name, column) in self.names().iter().zip(self.batch.columns()) {
            row.set_item(name, cell(py, column, number)?)?;
        }
        Ok(row)
    }

    /// All rows as dictionaries, in order.
    fn rows<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        (0..self.batch.num_rows()).map(|number| self.row(py, number)).collect()
    }

    /// For notebooks: the first rows, with the definitions of the columns as titles.
    fn _repr_html_(&self) -> String {
        let schema = self.batch.schema();
        let head = schema.fields().iter().map(|field| {
            let about = field.metadata().get("about").map_or("", String::as_str);
            format!("<th title=\"{}\">{}</th>", escaped(about), escaped(field.name()))
        });
        let rows = self.batch.num_rows().min(SHOWN_ROWS);
        let body = (0..rows).map(|row| {
            let cells = self.batch.columns().iter().map(|column| format!("<td>{}</td>", escaped(&text(column, row))));
            format!("<tr>{}</tr>", cells.collect::<String>())
        });
        let more = self.batch.num_rows() - rows;
        let foot = if more > 0 { format!("<p>and {more} more rows</p>") } else { String::new() };
        format!(
            "<table><thead><tr>{}</tr></thead><tbody>{}</tbody></table>{foot}",
            head.collect::<String>(),
            body.collect::<String>()
        )
    }

    /// How many rows and columns there are, and the names of these.
    fn __repr__(&self) -> String {
        format!("<pxpl5.Table of {} rows: {}>", self.batch.num_rows(), self.names().join(", "))
    }
}

/// Rows that a notebook shows.
const SHOWN_ROWS: usize = 40;

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A value for people: four significant digits of a real number, nothing of what is missing.
fn text(column: &ArrayRef, row: usize) -> String {
    if column.is_null(row) {
        return String::new();
    }
    let any = column.as_any();
    if let Some(values) = any.downcast_ref::<Float64Array>() {
        let value = values.value(row);
        let digits = 3 - value.abs().max(1e-3).log10().floor() as i32;
        return format!("{value:.*}", digits.clamp(0, 6) as usize);
    }
    let whole = any.downcast_ref::<Int64Array>().map(|values| values.value(row).to_string());
    let flag = any.downcast_ref::<BooleanArray>().map(|values| values.value(row).to_string());
    let words = any.downcast_ref::<StringArray>().map(|values| values.value(row).to_owned());
    whole.or(flag).or(words).unwrap_or_default()
}

/// A value as Python has it.
fn cell<'py>(py: Python<'py>, column: &ArrayRef, row: usize) -> PyResult<Bound<'py, PyAny>> {
    if column.is_null(row) {
        return Ok(py.None().into_bound(py));
    }
    let any = column.as_any();
    let value = match column.data_type() {
        DataType::Int64 => any.downcast_ref::<Int64Array>().map(|values| Value::from(values.value(row))),
        DataType::Float64 => {
            return any
                .downcast_ref::<Float64Array>()
                .map_or(f64::NAN, |values| values.value(row))
                .into_pyobject(py)
                .map(|value| value.into_any())
                .map_err(Into::into);
        }
        DataType::Boolean => any.downcast_ref::<BooleanArray>().map(|values| Value::from(values.value(row))),
        _ => any.downcast_ref::<StringArray>().map(|values| Value::from(values.value(row))),
    };
    Ok(pythonize(py, &value)?)
}
