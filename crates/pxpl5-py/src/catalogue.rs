//! What there is to choose from: presets, parameters, pipelines, displays, scenes, keys and quantities.

use crate::errors::wrong_setting;
use pxpl5::{ExperimentFile, MachineConfig, PRESETS, Parameter, QUANTITIES, Value, registry};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use pythonize::pythonize;
use serde_json::json;
use std::collections::BTreeMap;

/// Any value of the library as Python's.
pub(crate) fn python<'py>(py: Python<'py>, value: &impl serde::Serialize) -> PyResult<Bound<'py, PyAny>> {
    Ok(pythonize(py, value)?)
}

/// A number that is whole if its text is.
#[derive(FromPyObject)]
pub(crate) enum Number {
    /// An exact one.
    Whole(u64),
    /// A measured one.
    Real(f64),
}

impl From<Number> for Value {
    fn from(number: Number) -> Self {
        match number {
            Number::Whole(number) => Self::Whole(number),
            Number::Real(number) => Self::Real(number),
        }
    }
}

/// Names of the machines that are built in, those of the papers first, each with what it is and its source.
#[pyfunction]
pub(crate) fn presets() -> Vec<(&'static str, &'static str)> {
    PRESETS.iter().map(|preset| (preset.name, preset.about)).collect()
}

/// Boards and parameters of a preset with some of them changed, by path: ``n_gps``, ``n_renderers``, and a list of dictionaries with
/// path, name, unit, standing, range, limits, source, papers, value and read_only.
///
/// Raises :class:`pxpl5.SettingError` for a preset, path or value that no machine has.
#[pyfunction]
pub(crate) fn machine_parameters<'py>(
    py: Python<'py>,
    preset: &str,
    changes: BTreeMap<String, Number>,
) -> PyResult<Bound<'py, PyAny>> {
    let machine = MachineConfig::preset(preset).map_err(wrong_setting)?;
    let mut machine = registry().machine_of(machine);
    for (path, value) in changes {
        machine.set(&path, value).map_err(wrong_setting)?;
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

/// Parameters as objects: path, value, unit, standing, range, source and whether they are only listed.
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
        "standing": info.standing.to_string(),
        "low": low,
        "high": high,
        "source": info.source,
        "read_only": parameter.read_only,
    })
}

/// Parameters of all trackers, of the host's port and of the predictors: dictionaries as in :func:`machine_parameters`.
#[pyfunction]
pub(crate) fn tracking_parameters(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    python(py, &described(&pxpl5::tracking_parameters()))
}

/// All pipelines: dictionaries with name, family, about, preset and keys (name, about, values).
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

/// Names of the displays that pipelines draw for.
#[pyfunction]
pub(crate) fn displays() -> Vec<&'static str> {
    registry().displays().iter().map(|entry| entry.name).collect()
}

/// Names of the built-in scenes, each with what it is; ``N`` stands for a number of triangles.
#[pyfunction]
pub(crate) fn builtin_scenes() -> Vec<(&'static str, &'static str)> {
    pxpl5::scene::names().to_vec()
}

/// All keys of experiments but the parameters, each with what it sets.
#[pyfunction]
pub(crate) fn keys() -> Vec<(String, String)> {
    ExperimentFile::keys_of(&registry()).into_iter().map(|key| (key.path, key.about)).collect()
}

/// The quantities that can be measured, by name, with their definitions.
#[pyfunction]
pub(crate) fn quantities(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    QUANTITIES.iter().try_for_each(|quantity| all.set_item(quantity.name, quantity.definition))?;
    Ok(all)
}
