//! Lists of all names that a user can choose: presets, parameters, pipelines, displays, scenes, settings and measured
//! quantities.

use crate::errors::wrong_setting;
use pxpl5::{ExperimentFile, MachineConfig, PRESETS, Parameter, QUANTITIES, Value, registry};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use pythonize::pythonize;
use serde_json::json;
use std::collections::BTreeMap;

/// Converts a serializable value of the library to a Python object. A number that was not measured becomes None.
pub(crate) fn python<'py>(py: Python<'py>, value: &impl serde::Serialize) -> PyResult<Bound<'py, PyAny>> {
    // JSON has no NaN: a number without a finite value becomes null.
    let value = serde_json::to_value(value).map_err(wrong_setting)?;
    Ok(pythonize(py, &value)?)
}

/// Converts a Python number to the value of a setting. An integer from 0 to 2^64 - 1 becomes a whole number, and every
/// other number becomes a real number.
///
/// If `value` is not a number, the function raises `SettingError` with the path of the parameter.
fn number(path: &str, value: &Bound<'_, PyAny>) -> PyResult<Value> {
    if let Ok(whole) = value.extract::<u64>() {
        return Ok(Value::Whole(whole));
    }
    if let Ok(real) = value.extract::<f64>() {
        return Ok(Value::Real(real));
    }
    Err(wrong_setting(format!("{path}: expected a number, found {}", value.repr()?)))
}

/// Returns the names of the built-in machines, each with a description and its source. The machines of the papers come
/// first.
#[pyfunction]
pub(crate) fn presets() -> Vec<(&'static str, &'static str)> {
    PRESETS.iter().map(|preset| (preset.name, preset.about)).collect()
}

/// Returns the boards and parameters of a built-in machine in which some parameters are changed. ``changes`` maps the
/// paths of these parameters to their new values. The result has ``n_gps``, ``n_renderers``, ``warnings`` and a list of
/// parameters. Each parameter is a dictionary with path, value, unit, provenance (where the number comes from), low,
/// high, source and read_only.
///
/// Raises :class:`pxpl5.SettingError` for an invalid preset, path or value.
#[pyfunction]
pub(crate) fn machine_parameters<'py>(
    py: Python<'py>,
    preset: &str,
    changes: BTreeMap<String, Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let machine = MachineConfig::preset(preset).map_err(wrong_setting)?;
    let mut machine = registry().machine_of(machine);
    // Apply the changes, then check the machine as a whole.
    for (path, value) in changes {
        machine.set(&path, number(&path, &value)?).map_err(wrong_setting)?;
    }
    machine.check().map_err(wrong_setting)?;
    python(
        py,
        &json!({
            "n_gps": machine.n_gps,
            "n_renderers": machine.n_renderers,
            "parameters": described(&machine.parameters()),
            "warnings": machine.out_of_range().iter().map(Parameter::warning).collect::<Vec<_>>(),
        }),
    )
}

/// Converts parameters to JSON objects with path, value, unit, provenance, range, source and read_only.
pub(crate) fn described(parameters: &[Parameter]) -> Vec<serde_json::Value> {
    parameters.iter().map(described_one).collect()
}

fn described_one(parameter: &Parameter) -> serde_json::Value {
    let info = &parameter.info;
    let (low, high) = info.range;
    json!({
        "path": parameter.path,
        "value": parameter.value,
        "unit": info.unit,
        "provenance": info.provenance.to_string(),
        "low": low,
        "high": high,
        "source": info.source,
        "read_only": parameter.read_only,
    })
}

/// Returns the parameters of all trackers, of the host's serial port and of the predictors. Each parameter is a
/// dictionary as in :func:`machine_parameters`.
#[pyfunction]
pub(crate) fn tracking_parameters(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    python(py, &described(&pxpl5::tracking_parameters()))
}

/// Returns all pipelines as dictionaries with name, family, about (a description), preset, has_closed_form and keys.
/// The keys are the pipeline's own settings, each with name, about and values. has_closed_form is true if formulas give
/// the pipeline's times without a simulation.
#[pyfunction]
pub(crate) fn pipelines(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    let registry = registry();
    let all: Vec<serde_json::Value> = registry
        .pipelines()
        .iter()
        .map(|entry| {
            let keys: Vec<serde_json::Value> = entry
                .keys
                .iter()
                .map(|key| json!({ "name": key.name, "about": key.about, "values": key.values.to_string() }))
                .collect();
            json!({
                "name": entry.name,
                "family": entry.family,
                "about": entry.about,
                "preset": entry.preset,
                "keys": keys,
                "has_closed_form": entry.closed_form.is_some(),
            })
        })
        .collect();
    python(py, &all)
}

/// Returns the names of all displays that a pipeline can use.
#[pyfunction]
pub(crate) fn displays() -> Vec<&'static str> {
    registry().displays().iter().map(|entry| entry.name).collect()
}

/// Returns the names of the built-in scenes, each with a description. In a name, ``N`` stands for a number of
/// triangles.
#[pyfunction]
pub(crate) fn builtin_scenes() -> Vec<(&'static str, &'static str)> {
    pxpl5::scene::names().to_vec()
}

/// Returns the names of all settings of experiments, each with a description. The parameters of the machine are not
/// included.
#[pyfunction]
pub(crate) fn keys() -> Vec<(String, String)> {
    ExperimentFile::keys_of(&registry()).into_iter().map(|key| (key.path, key.about)).collect()
}

/// Returns the definitions of all quantities that an experiment can measure, by name.
#[pyfunction]
pub(crate) fn quantities(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    QUANTITIES.iter().try_for_each(|quantity| all.set_item(quantity.name, quantity.definition))?;
    Ok(all)
}
