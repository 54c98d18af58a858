//! Experiments given as text.

use pxpl5_lab::{ExperimentFile, Plan};
use pxpl5_run::{ExperimentError, Outcome};

pub(crate) fn plan(text: &str) -> Plan {
    let resolved = ExperimentFile::parse(text, "test").and_then(|file| file.resolve());
    resolved.unwrap_or_else(|error| panic!("{error}: {text}"))
}

pub(crate) fn run(plan: &Plan) -> Result<Outcome, ExperimentError> {
    plan.experiment(plan.load_scene().expect("built in")).run()
}
