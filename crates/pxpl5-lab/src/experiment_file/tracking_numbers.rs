//! Parameters of trackers, predictors and the host's serial port. Their keys have the form `tracking.table.name`.

use super::{ExperimentFile, Setting};
use crate::compare::tracker_by;
use pxpl5_sim::parameters::Parameter;
use pxpl5_sim::parameters::{ParameterTable, SettingError};
use tracking::config::{FACTS, Tables};
use tracking::tracker::{SerialRead, TrackerConfig};

const PREFIX: &str = "tracking.";

/// Tables that apply to every tracker: the host's serial port, the prediction filters, and the gate in front of the
/// filters.
const COMMON: [&str; 3] = ["host", "filter", "gate"];

/// Returns every tracking parameter with its published value.
///
/// Parameters of heads, the measuring rig, the video and the papers' pictures are read-only. They are published facts
/// for comparison with a model, not settings of a tracked head.
pub fn tracking_parameters() -> Vec<Parameter> {
    let numbers = Tables::PAPERS.all().into_iter().flat_map(|(name, table)| parameters_of(name, table, false));
    let facts = FACTS.into_iter().flat_map(|(name, table)| parameters_of(name, table, true));
    numbers.chain(facts).collect()
}

fn parameters_of(name: &str, table: &dyn ParameterTable, read_only: bool) -> Vec<Parameter> {
    Parameter::of_table(&format!("{PREFIX}{name}"), table, read_only).collect()
}

/// Returns the parameters that affect a tracker. `own` is the name of the tracker's own table.
pub(super) fn parameters_with(tables: &Tables, own: &str, tracker: &TrackerConfig) -> Vec<Parameter> {
    let applying = tables.all().into_iter().filter(|(name, _)| applies(name, own));
    let numbers = applying.flat_map(|(name, table)| parameters_of(name, table, false));
    numbers.filter(|number| without_effect(&number.path, tracker).is_none()).collect()
}

fn applies(table: &str, own: &str) -> bool {
    table == own || COMMON.contains(&table)
}

/// Returns the reason why a parameter of the host's serial port does not affect a tracker, or `None` if it does.
fn without_effect(path: &str, tracker: &TrackerConfig) -> Option<&'static str> {
    match path {
        "tracking.host.poll" if !matches!(tracker.host, SerialRead::Polled { .. }) => {
            Some("whose host is patched and does not poll; fastrak-polled, flock and 3space are polled")
        }
        "tracking.host.byte_bits" if tracker.serial.is_none() => {
            Some("whose latency includes the cable; fastrak and fastrak-polled have a cable of their own")
        }
        _ => None,
    }
}

pub(super) fn is_tracking_parameter(path: &str) -> bool {
    path.starts_with(PREFIX) && tracking_parameters().iter().any(|parameter| parameter.path == path)
}

pub(super) fn read(file: &ExperimentFile, tracker: &str) -> Result<Tables, SettingError> {
    let mut tables = Tables::PAPERS;
    // The function that builds the tracker refuses an unknown name.
    let found = tracker_by(&tables, tracker).ok();
    let own = found.as_ref().map_or("", |(_, own)| *own);
    for (path, setting) in &file.settings {
        let Some((table, name)) = path.strip_prefix(PREFIX).and_then(|path| path.split_once('.')) else { continue };
        // Facts of the papers cannot be changed.
        refuse_facts(path, setting)?;
        if !applies(table, own) && !own.is_empty() {
            let reason = format!("{path} does not apply to head.tracker = {tracker}; leave it out");
            return Err(SettingError::combination(reason).at(&setting.place));
        }
        if let Some(why) = found.as_ref().and_then(|(tracker, _)| without_effect(path, tracker)) {
            let reason = format!("{path} does not apply to head.tracker = {tracker}, {why}");
            return Err(SettingError::combination(reason).at(&setting.place));
        }
        // Each assignment is checked together with the rest of its table.
        let value = ExperimentFile::parameter_value(path, setting)?;
        if let Some(table) = tables.named_mut(table) {
            let set = table.set(name, value).and_then(|()| table.check());
            set.map_err(|error| refused(path, setting, error))?;
        }
    }
    Ok(tables)
}

fn refused(path: &str, setting: &Setting, error: SettingError) -> SettingError {
    let table = path.rsplit_once('.').map_or(path, |(table, _)| table);
    error.in_table(table).at(&setting.place)
}

fn refuse_facts(path: &str, setting: &Setting) -> Result<(), SettingError> {
    match tracking_parameters().into_iter().find(|parameter| parameter.path == path && parameter.read_only) {
        Some(Parameter { path, info, value, .. }) => {
            Err(SettingError::read_only(&path, value, info.source).at(&setting.place))
        }
        None => Ok(()),
    }
}
