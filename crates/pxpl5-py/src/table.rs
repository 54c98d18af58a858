//! Tables with typed columns that Python reads through the Arrow PyCapsule interface.

use crate::arrays::Count;
use crate::errors::wrong_setting;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{
    Array, ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, RecordBatchIterator, StringArray,
};
use arrow_schema::{Field, Schema};
use numpy::PyArray1;
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict, PyList, PySlice, PyTuple, PyType};
use serde_json::{Map, Value};
use std::collections::HashMap;
use std::sync::Arc;

pub(crate) struct Column {
    pub(crate) name: String,
    /// Description of the column's values with their unit, for the metadata `about` of the Arrow field.
    pub(crate) about: String,
    pub(crate) values: ArrayRef,
}

impl Column {
    pub(crate) fn whole(name: &str, about: &str, values: impl Iterator<Item = Option<i64>>) -> Self {
        Self { name: name.to_owned(), about: about.to_owned(), values: Arc::new(values.collect::<Int64Array>()) }
    }

    pub(crate) fn text(name: &str, about: &str, values: impl Iterator<Item = Option<String>>) -> Self {
        Self { name: name.to_owned(), about: about.to_owned(), values: Arc::new(values.collect::<StringArray>()) }
    }
}

/// A table whose columns have names and types.
///
/// pandas, polars, pyarrow and DuckDB read the table through ``__arrow_c_stream__`` without a copy of the columns:
/// ``pyarrow.table(table)``, ``polars.DataFrame(table)``, ``pandas.DataFrame.from_arrow(table)``. A column has integers
/// (int64), real numbers (float64), truth values or text. A missing value is null. :attr:`definitions` has a
/// description and the unit of each column. The metadata ``about`` of the Arrow fields has the same texts.
#[pyclass(frozen, module = "pxpl5")]
pub(crate) struct Table {
    batch: RecordBatch,
}

impl Table {
    pub(crate) fn of(columns: Vec<Column>) -> PyResult<Self> {
        // A batch without columns needs its own constructor, because no column has the number of rows.
        if columns.is_empty() {
            return Ok(Self { batch: RecordBatch::new_empty(Arc::new(Schema::empty())) });
        }
        let fields = columns.iter().map(|column| {
            let about = HashMap::from([("about".to_owned(), column.about.clone())]);
            Field::new(&column.name, column.values.data_type().clone(), true).with_metadata(about)
        });
        let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
        let values = columns.into_iter().map(|column| column.values).collect();
        let batch = RecordBatch::try_new(schema, values).map_err(wrong_setting)?;
        Ok(Self { batch })
    }

    /// Creates a table from JSON objects, one row for each object. Each key becomes a column, in the order in which
    /// keys first occur. A nested key `b` within `a` becomes the column `a.b`. Lists become JSON text.
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

/// Returns a JSON object without nested objects. A nested key `b` within `a` becomes the key `a.b`.
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

/// Returns the column of values for one key. If all values are truth values, integers or numbers, the column has this
/// type. Otherwise the values become text.
fn column_of(name: &str, rows: &[Map<String, Value>], about: &str) -> Column {
    let values: Vec<Option<&Value>> = rows.iter().map(|row| row.get(name).filter(|value| !value.is_null())).collect();
    let all = |is: fn(&Value) -> bool| values.iter().flatten().all(|value| is(value));
    let none = values.iter().all(Option::is_none);
    // A column has float64 if it has no values, or if all values are numbers and at least one is not an integer.
    let values: ArrayRef = if none || (!all(Value::is_i64) && all(Value::is_number)) {
        Arc::new(values.iter().map(|value| value.and_then(Value::as_f64)).collect::<Float64Array>())
    } else if all(Value::is_i64) {
        Arc::new(values.iter().map(|value| value.and_then(Value::as_i64)).collect::<Int64Array>())
    } else if all(Value::is_boolean) {
        Arc::new(values.iter().map(|value| value.and_then(Value::as_bool)).collect::<BooleanArray>())
    } else {
        Arc::new(values.iter().map(|value| value.map(plain)).collect::<StringArray>())
    };
    Column { name: name.to_owned(), about: about.to_owned(), values }
}

fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Creates a table from the JSON text of a list of objects. Each key becomes a column, in the order in which keys first
/// occur.
///
/// Raises :class:`pxpl5.SettingError` for invalid text.
#[pyfunction]
pub(crate) fn table_of_rows(json: &str, about: HashMap<String, String>) -> PyResult<Table> {
    let rows: Vec<Map<String, Value>> = serde_json::from_str(json).map_err(wrong_setting)?;
    Table::of_rows(&rows, &about)
}

/// Rebuilds a table from the parts that `Table.__reduce__` returned: name, description, type and values of each column.
/// The module `pickle` needs this function.
///
/// Raises :class:`pxpl5.SettingError` for columns that `Table.__reduce__` does not make.
#[pyfunction]
pub(crate) fn table_of_columns(columns: &Bound<'_, PyAny>) -> PyResult<Table> {
    let columns: Vec<(String, String, String, Bound<'_, PyAny>)> = columns.extract().map_err(|_| {
        wrong_setting(
            "a table: expected a list of columns, each with name, description, type and values, found another",
        )
    })?;
    let columns = columns.into_iter().map(|(name, about, kind, values)| {
        let values = typed(&name, &kind, &values)?;
        Ok(Column { name, about, values })
    });
    let columns: Vec<Column> = columns.collect::<PyResult<_>>()?;
    let rows = columns.first().map_or(0, |column| column.values.len());
    match columns.iter().find(|column| column.values.len() != rows) {
        Some(Column { name, values, .. }) => {
            Err(wrong_setting(format!("column {name}: expected {rows} values, found {}", values.len())))
        }
        None => Table::of(columns),
    }
}

fn typed(name: &str, kind: &str, values: &Bound<'_, PyAny>) -> PyResult<ArrayRef> {
    let values: PyResult<ArrayRef> = match kind {
        "Int64" => values.extract().map(|values: Vec<Option<i64>>| Arc::new(Int64Array::from(values)) as ArrayRef),
        "Float64" => values.extract().map(|values: Vec<Option<f64>>| Arc::new(Float64Array::from(values)) as ArrayRef),
        "Boolean" => values.extract().map(|values: Vec<Option<bool>>| Arc::new(BooleanArray::from(values)) as ArrayRef),
        "Utf8" => values.extract().map(|values: Vec<Option<String>>| Arc::new(StringArray::from(values)) as ArrayRef),
        _ => {
            return Err(wrong_setting(format!(
                "column {name}: expected the type Int64, Float64, Boolean or Utf8, found {kind}"
            )));
        }
    };
    values.map_err(|error| wrong_setting(format!("column {name}: expected a list of values of {kind} ({error})")))
}

#[pymethods]
impl Table {
    /// Returns the table as an Arrow stream of one batch, for the Arrow PyCapsule interface. ``requested_schema`` is
    /// ignored.
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

    /// Returns the class with the type of its rows, for type checkers: ``Table[dict[str, float]]``.
    #[classmethod]
    fn __class_getitem__<'py>(cls: &Bound<'py, PyType>, rows: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        cls.py().import("types")?.getattr("GenericAlias")?.call1((cls, rows))
    }

    /// Returns the number of rows.
    fn __len__(&self) -> usize {
        self.batch.num_rows()
    }

    /// Returns the names of the columns, in order.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.batch.schema().fields().iter().map(|field| field.name().clone()).collect()
    }

    /// Returns the description of each column with its unit, by the column's name. The description is empty if the name
    /// of the column is sufficient.
    #[getter]
    fn definitions(&self) -> HashMap<String, String> {
        let schema = self.batch.schema();
        let fields = schema.fields().iter();
        fields.map(|field| (field.name().clone(), field.metadata().get("about").cloned().unwrap_or_default())).collect()
    }

    /// Returns the values of a column by its name, or the rows of a slice such as ``table[10:20]`` as a table. Numbers
    /// are returned as a NumPy array of shape (rows,), int64 or float64. If a number is missing, the array is float64
    /// with NaN. Text and truth values are returned as a list with None for missing values. The numbers are copied,
    /// whereas readers of the Arrow stream share the memory of the table.
    ///
    /// Raises KeyError with the existing names, and :class:`pxpl5.SettingError` for a slice whose step is not 1.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        if let Ok(slice) = name.cast::<PySlice>() {
            let rows = slice.indices(self.batch.num_rows() as isize)?;
            if rows.step != 1 {
                return Err(wrong_setting(format!("a slice of a table: expected the step 1, found {}", rows.step)));
            }
            let batch = self.batch.slice(rows.start as usize, rows.slicelength);
            return Ok(Bound::new(py, Self { batch })?.into_any());
        }
        let Ok(name) = name.extract::<&str>() else {
            let found = name.repr()?;
            return Err(PyKeyError::new_err(format!(
                "expected the name of a column, found {found}; row({found}) returns a row"
            )));
        };
        let column = self.batch.column(self.column_index(name)?);
        // NumPy has no missing integers, so a column with missing values becomes float64.
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

    /// Returns the row with index ``number``, from 0, as a dictionary. A missing value is None.
    ///
    /// Raises IndexError for a number beyond the last row.
    fn row<'py>(&self, py: Python<'py>, number: i64) -> PyResult<Bound<'py, PyDict>> {
        let rows = self.batch.num_rows();
        let Some(number) = usize::try_from(number).ok().filter(|number| *number < rows) else {
            return Err(pyo3::exceptions::PyIndexError::new_err(format!(
                "expected a row below {rows} and from 0, found {number}"
            )));
        };
        let row = PyDict::new(py);
        for (name, column) in self.names().iter().zip(self.batch.columns()) {
            row.set_item(name, cell(py, column, number)?)?;
        }
        Ok(row)
    }

    /// Returns an iterator over all rows as dictionaries, in order.
    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.rows(py)?.into_pyobject(py)?.call_method0("__iter__")
    }

    /// Returns true if the table has a column with this name.
    fn __contains__(&self, name: &str) -> bool {
        self.column_index(name).is_ok()
    }

    /// Creates a table from dictionaries, one for each row. Keys of nested dictionaries are joined with a point. Lists
    /// become JSON text. ``definitions`` maps names of columns to descriptions.
    ///
    /// Raises :class:`pxpl5.SettingError` for a row that is not a dictionary, or a value that no column can have.
    #[staticmethod]
    #[pyo3(signature = (rows, definitions = None))]
    fn from_rows<'py>(
        py: Python<'py>,
        rows: Bound<'py, PyAny>,
        definitions: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        py.import("pxpl5._tables")?.call_method1("table_of", (rows, definitions))
    }

    /// Returns the table as a ``pandas.DataFrame``. The method needs the package pandas. With pandas before version 3,
    /// the method also needs pyarrow.
    fn to_pandas<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let py = slf.py();
        let frame = py.import("pandas")?.getattr("DataFrame")?;
        match frame.getattr("from_arrow") {
            Ok(from_arrow) => from_arrow.call1((slf,)),
            Err(_) => py.import("pyarrow")?.call_method1("table", (slf,))?.call_method0("to_pandas"),
        }
    }

    /// Returns the table as a ``polars.DataFrame``. The method needs the package polars.
    fn to_polars<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("polars")?.call_method1("DataFrame", (slf,))
    }

    /// Returns the table as a ``pyarrow.Table`` without a copy. The fields have the definitions as metadata ``about``.
    /// The method needs the package pyarrow.
    fn to_arrow<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("pyarrow")?.call_method1("table", (slf,))
    }

    /// Writes the table as a Parquet file, with the definitions of the columns. The method needs the package pyarrow.
    ///
    /// Raises OSError if the file cannot be written.
    fn to_parquet(slf: &Bound<'_, Self>, path: std::path::PathBuf) -> PyResult<()> {
        let parquet = slf.py().import("pyarrow.parquet")?;
        parquet.call_method1("write_table", (Self::to_arrow(slf)?, path)).map(drop)
    }

    /// Returns the function and the arguments that make an equal table, for the module ``pickle``.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let schema = self.batch.schema();
        let columns = schema.fields().iter().zip(self.batch.columns()).map(|(field, column)| {
            let values = (0..column.len()).map(|row| cell(py, column, row)).collect::<PyResult<Vec<_>>>()?;
            let about = field.metadata().get("about").cloned().unwrap_or_default();
            Ok((field.name().clone(), about, field.data_type().to_string(), PyList::new(py, values)?))
        });
        let columns = PyList::new(py, columns.collect::<PyResult<Vec<_>>>()?)?;
        Ok((py.import("pxpl5._pickle")?.getattr("table")?, (columns,).into_pyobject(py)?))
    }

    /// Returns a table of the first rows.
    #[pyo3(signature = (rows = Count(5)), text_signature = "($self, rows=5)")]
    fn head(&self, rows: Count) -> Self {
        let rows = rows.size().min(self.batch.num_rows());
        Self { batch: self.batch.slice(0, rows) }
    }

    /// Returns all rows as dictionaries, in order.
    fn rows<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        (0..self.batch.num_rows()).map(|number| self.row(py, number as i64)).collect()
    }

    /// Returns the first rows as HTML for notebooks. The definitions of the columns are tooltips.
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
        // A line below the table states the number of rows that are not shown.
        let more = self.batch.num_rows() - rows;
        let foot = if more > 0 { format!("<p>and {more} more rows</p>") } else { String::new() };
        format!(
            "<table><thead><tr>{}</tr></thead><tbody>{}</tbody></table>{foot}",
            head.collect::<String>(),
            body.collect::<String>()
        )
    }

    /// Returns a text with the number of rows and the names of the columns.
    fn __repr__(&self) -> String {
        format!("<pxpl5.Table of {} rows: {}>", self.batch.num_rows(), self.names().join(", "))
    }
}

const SHOWN_ROWS: usize = 40;

pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Formats a value of a column. Real numbers have four significant digits, and a missing value has no text.
fn text(column: &ArrayRef, row: usize) -> String {
    if column.is_null(row) {
        return String::new();
    }
    let any = column.as_any();
    if let Some(values) = any.downcast_ref::<Float64Array>() {
        let value = values.value(row);
        // Four significant digits, but at most six after the decimal point.
        let digits = 3 - value.abs().max(1e-3).log10().floor() as i32;
        return format!("{value:.*}", digits.clamp(0, 6) as usize);
    }
    let whole = any.downcast_ref::<Int64Array>().map(|values| values.value(row).to_string());
    let flag = any.downcast_ref::<BooleanArray>().map(|values| values.value(row).to_string());
    let words = any.downcast_ref::<StringArray>().map(|values| values.value(row).to_owned());
    whole.or(flag).or(words).unwrap_or_default()
}

fn cell<'py>(py: Python<'py>, column: &ArrayRef, row: usize) -> PyResult<Bound<'py, PyAny>> {
    if column.is_null(row) {
        return Ok(py.None().into_bound(py));
    }
    let any = column.as_any();
    let real = any.downcast_ref::<Float64Array>().map(|values| values.value(row).into_bound_py_any(py));
    let whole = any.downcast_ref::<Int64Array>().map(|values| values.value(row).into_bound_py_any(py));
    let flag = any.downcast_ref::<BooleanArray>().map(|values| values.value(row).into_bound_py_any(py));
    let words = any.downcast_ref::<StringArray>().map(|values| values.value(row).into_bound_py_any(py));
    real.or(whole).or(flag).or(words).unwrap_or_else(|| Ok(py.None().into_bound(py)))
}
