//! Command line options that set one key of an experiment file each. Their help is that of the keys.

use crate::error::CliError;
use clap::{Arg, ArgAction, ArgMatches, Command};
use pxpl5::{ExperimentFile, KeyValues, Registry};
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

/// Options of all pipelines: the option, its key, and the name of its value. The keys of single pipelines follow.
const OPTIONS: [(&str, &str, &str); 21] = [
    ("pipeline", "pipeline", "PIPELINE"),
    ("scene", "scene", "NAME|FILE"),
    ("triangles", "triangles", "N"),
    ("model-size", "model.size", "METRES"),
    ("model-turn", "model.turn", "DEGREES"),
    ("machine", "machine.preset", "PRESET"),
    ("gps", "machine.n_gps", "N"),
    ("renderers", "machine.n_renderers", "N"),
    ("head", "head.motion", "MOTION"),
    ("evaluate-at", "head.evaluate_at", "METRES"),
    ("tracker", "head.tracker", "TRACKER"),
    ("predict", "head.predict", "PREDICT"),
    ("place", "head.place", "PLACE"),
    ("aim", "head.aim", "AIM"),
    ("display", "display", "DISPLAY"),
    ("raster", "head.raster", "RASTER"),
    ("fields", "fields", "N"),
    ("level", "level", "LEVEL"),
    ("within", "within", "PERCENT"),
    ("pixels", "pixels", "PIXELS"),
    ("seed", "seed", "S"),
];

/// Options without a value: the option, its key, and the value of the key.
const FLAGS: [(&str, &str, &str); 3] =
    [("no-fit", "fit", "false"), ("in-room", "model.room", "true"), ("cull", "cull", "true")];

/// The given options, each with its key and value.
#[derive(Clone, Debug, Default)]
pub(crate) struct KeyOptions {
    given: Vec<(String, &'static str, String)>,
}

impl KeyOptions {
    /// Sets the keys of all given options.
    pub(crate) fn set_in(&self, file: &mut ExperimentFile) -> Result<(), CliError> {
        for (option, key, value) in &self.given {
            // The name of a raster after `--display` sets the key of the raster, as in earlier versions.
            let is_raster = *key == "display" && pxpl5::Raster::ALL.iter().any(|(raster, _)| raster == value);
            let key = if is_raster { "head.raster" } else { key };
            file.set_text(&format!("{key}={value}"), &format!("--{option}"))?;
        }
        Ok(())
    }
}

/// Returns all options with their keys. Many commands have them, so they are made once.
fn options() -> &'static [(Arg, &'static str)] {
    static ALL: OnceLock<Vec<(Arg, &'static str)>> = OnceLock::new();
    ALL.get_or_init(all_options)
}

fn all_options() -> Vec<(Arg, &'static str)> {
    let registry = registry();
    let keys = ExperimentFile::keys_of(&registry);
    let help = |path: &str| match path {
        "machine.n_gps" => "number of graphics processors, including the master".to_owned(),
        "machine.n_renderers" => "number of renderers".to_owned(),
        _ => keys.iter().find(|key| key.path == path).map(|key| key.about.clone()).unwrap_or_default(),
    };
    let option = |name: &str, path: &str| Arg::new(name.to_owned()).long(name.to_owned()).help(help(path));
    let values =
        OPTIONS.map(|(name, key, value)| (option(name, key).value_name(value).allow_negative_numbers(true), key));
    let flags = FLAGS.map(|(name, key, value)| {
        let help = format!("{key} = {value}; the key is: {}", help(key));
        (option(name, key).help(help).action(ArgAction::Set).num_args(0).default_missing_value(value), key)
    });
    // With a separate heading, the help lists these options after the options of all pipelines.
    const HEADING: &str = "Settings of single pipelines";
    // Each key of a registered pipeline becomes an option whose syntax depends on the type of its values.
    let of_pipelines = registry.keys().into_iter().map(|(key, families)| {
        let arg = option(&key.name.replace('_', "-"), key.name).help_heading(HEADING);
        let arg = arg.help(format!("{}: {}", families.join(", "), key.help()));
        let arg = match key.values {
            KeyValues::Flag => arg.num_args(0..=1).default_missing_value("true").require_equals(true),
            KeyValues::Whole(..) | KeyValues::Real(..) => arg.value_name("N").allow_negative_numbers(true),
            KeyValues::Names(_) | KeyValues::Text(..) => {
                arg.value_name(key.name.to_uppercase()).allow_negative_numbers(true)
            }
        };
        (arg, key.name)
    });
    values.into_iter().chain(flags).chain(of_pipelines).collect()
}

impl clap::Args for KeyOptions {
    fn augment_args(command: Command) -> Command {
        command.args(options().iter().map(|(arg, _)| arg))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl clap::FromArgMatches for KeyOptions {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let given = options().iter().filter_map(|(arg, key)| {
            let name = arg.get_id().as_str();
            Some((name.to_owned(), *key, matches.get_one::<String>(name)?.clone()))
        });
        Ok(Self { given: given.collect() })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
