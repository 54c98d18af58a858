//! Converters of values from Python to arrays of numbers. They accept each value that `numpy.asarray` accepts, such as
//! lists, arrays and the arrays of this package.

use crate::errors::wrong_setting;
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::Borrowed;
use pyo3::prelude::*;

/// Returns a value as an array of shape (n, columns) with real numbers. Otherwise raises `SettingError` with the
/// expected and the found shape or type.
pub(crate) fn reals2<'py>(
    name: &str,
    value: &Bound<'py, PyAny>,
    columns: usize,
) -> PyResult<PyReadonlyArray2<'py, f64>> {
    let array = numbers(name, value)?;
    let array = as_rows(name, &array, columns)?;
    Ok(array.call_method1("astype", ("float64",))?.extract()?)
}

/// Returns a value as an array of shape (n, columns) with integers. Real numbers without a fraction count as integers.
/// Otherwise raises `SettingError` with the expected and the found shape or type.
pub(crate) fn wholes2<'py>(
    name: &str,
    value: &Bound<'py, PyAny>,
    columns: usize,
) -> PyResult<PyReadonlyArray2<'py, i64>> {
    let array = numbers(name, value)?;
    let array = as_rows(name, &array, columns)?;
    let numpy = value.py().import("numpy")?;
    // A cast of NaN, infinity or a fraction to an integer gives another number without an error.
    if kind(&array)? == 'f' {
        let rounded = numpy.call_method1("rint", (&array,))?;
        let is_finite = numpy.call_method1("isfinite", (&array,))?.call_method0("all")?.is_truthy()?;
        if !is_finite || !numpy.call_method1("array_equal", (&rounded, &array))?.is_truthy()? {
            return Err(wrong_setting(format!("{name}: expected whole numbers, found numbers with a fraction")));
        }
    }
    Ok(array.call_method1("astype", ("int64",))?.extract()?)
}

/// Returns a value as an array of shape (n,) with real numbers. Otherwise raises `SettingError` with the expected and
/// the found shape or type.
pub(crate) fn reals1<'py>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArray1<'py, f64>> {
    let array = numbers(name, value)?;
    let shape: Vec<usize> = array.getattr("shape")?.extract()?;
    if shape.len() != 1 {
        return Err(wrong_setting(format!("{name}: expected shape (n,), found {}", shape_text(&shape))));
    }
    Ok(array.call_method1("astype", ("float64",))?.extract()?)
}

fn numbers<'py>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    let numpy = value.py().import("numpy")?;
    let array = numpy.call_method1("asarray", (value,)).map_err(|error| {
        let found = value.get_type().name().map_or_else(|_| "an object".to_owned(), |name| name.to_string());
        wrong_setting(format!("{name}: expected an array of numbers, found {found} ({})", error.value(value.py())))
    })?;
    match kind(&array)? {
        'b' | 'i' | 'u' | 'f' => Ok(array),
        _ => {
            let found = array.getattr("dtype")?;
            Err(wrong_setting(format!("{name}: expected an array of numbers, found elements of type {found}")))
        }
    }
}

/// Returns the letter with which NumPy names the kind of an array's elements, such as `f` for real numbers.
fn kind(array: &Bound<'_, PyAny>) -> PyResult<char> {
    array.getattr("dtype")?.getattr("kind")?.extract()
}

/// Returns an array with two dimensions and `columns` columns. An empty array of one dimension becomes an array without
/// rows.
fn as_rows<'py>(name: &str, array: &Bound<'py, PyAny>, columns: usize) -> PyResult<Bound<'py, PyAny>> {
    let shape: Vec<usize> = array.getattr("shape")?.extract()?;
    match shape[..] {
        [_, found] if found == columns => Ok(array.clone()),
        [0] => array.call_method1("reshape", ((0, columns),)),
        _ => Err(wrong_setting(format!("{name}: expected shape (n, {columns}), found {}", shape_text(&shape)))),
    }
}

fn shape_text(shape: &[usize]) -> String {
    let sizes: Vec<String> = shape.iter().map(usize::to_string).collect();
    if sizes.len() == 1 { format!("({},)", sizes[0]) } else { format!("({})", sizes.join(", ")) }
}

/// A whole number of 0 or more from Python.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Count(pub(crate) u64);

impl<'py> FromPyObject<'_, 'py> for Count {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        value.extract::<u64>().map(Self).map_err(|_| {
            let found = value.repr().map_or_else(|_| "an object".to_owned(), |text| text.to_string());
            wrong_setting(format!("expected a whole number of 0 or more, found {found}"))
        })
    }
}

impl Count {
    /// Returns the number as `u32`. A greater number becomes the greatest `u32`, which is no valid index of a picture
    /// or slice.
    pub(crate) fn small(self) -> u32 {
        u32::try_from(self.0).unwrap_or(u32::MAX)
    }

    /// Returns the number as `usize`. A greater number becomes the greatest `usize`.
    pub(crate) fn size(self) -> usize {
        usize::try_from(self.0).unwrap_or(usize::MAX)
    }
}
