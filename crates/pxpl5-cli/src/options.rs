//! Command line options for the keys of the registered pipelines.

use clap::{Arg, ArgMatches, Command};
use pxpl5::{KeyValues, Registry};
use std::sync::{Arc, OnceLock};

/// The pipelines and displays of this process, which [`crate::main`] sets before clap builds the options.
static REGISTRY: OnceLock<Arc<Registry>> = OnceLock::new();

pub(crate) fn know(registry: Arc<Registry>) {
    // Only a second call of `main` would set the registry again. The options of the first call are kept.
    let _ = REGISTRY.set(registry);
}

/// Returns the pipelines and displays of this process, which are the built-in pipelines and displays by default.
pub(crate) fn registry() -> Arc<Registry> {
    Arc::clone(REGISTRY.get_or_init(pxpl5::registry))
}

#[derive(Clone, Debug, Default)]
pub(crate) struct PipelineOptions {
    pub(crate) given: Vec<(&'static str, String)>,
}

/// Returns the option name of a key, with hyphens instead of underscores.
pub(crate) fn option_of(key: &str) -> String {
    key.replace('_', "-")
}

impl clap::Args for PipelineOptions {
    fn augment_args(command: Command) -> Command {
        let registry = registry();
        let names: Vec<&str> = registry.pipelines().iter().map(|entry| entry.name).collect();
        let pipeline = Arg::new("pipeline").long("pipeline").value_name("PIPELINE").help(names.join(", "));
        // With a separate heading, the help lists these options after the options of all pipelines.
        const HEADING: &str = "Settings of single pipelines";
        // Each key of a registered pipeline becomes an option whose syntax depends on the type of its values.
        registry.keys().into_iter().fold(command.arg(pipeline), |command, (key, families)| {
            let help = format!("{}: {}", families.join(", "), key.help());
            let arg = Arg::new(key.name).long(option_of(key.name)).help(help).help_heading(HEADING);
            command.arg(match key.values {
                KeyValues::Flag => arg.num_args(0..=1).default_missing_value("true").require_equals(true),
                KeyValues::Whole(..) | KeyValues::Real(..) => arg.value_name("N").allow_negative_numbers(true),
                KeyValues::Names(_) | KeyValues::Text(..) => {
                    arg.value_name(key.name.to_uppercase()).allow_negative_numbers(true)
                }
            })
        })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl clap::FromArgMatches for PipelineOptions {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let keys = registry().keys();
        let names = ["pipeline"].into_iter().chain(keys.iter().map(|(key, _)| key.name));
        let given = names.filter_map(|name| Some((name, matches.get_one::<String>(name)?.clone())));
        Ok(Self { given: given.collect() })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
