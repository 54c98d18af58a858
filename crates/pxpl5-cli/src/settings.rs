//! Options that describe an experiment. Each option sets keys of an experiment file.

use crate::error::CliError;
use crate::options::{KeyOptions, registry};
use clap::Args;
use pxpl5::ExperimentFile;
use pxpl5_sim::parameters::text_of;
use std::path::{Path, PathBuf};

/// An experiment file and the options that override its keys.
#[derive(Args, Debug, Default)]
pub(crate) struct SettingArgs {
    /// Experiment file (TOML).
    #[arg(value_name = "FILE")]
    experiment: Option<PathBuf>,
    /// Experiment file (TOML), given as an option.
    #[arg(long, value_name = "FILE", conflicts_with = "experiment")]
    file: Option<PathBuf>,
    #[command(flatten)]
    options: KeyOptions,
    /// Place of the middle of the scene in its world: metres to the right, upwards and backwards.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    model_at: Option<String>,
    /// Columns of a recording, by name or number: t_ns=stamp,x=px,y=py,z=pz,qw=qw,qx=qx,qy=qy,qz=qz. The time is t,
    /// t_ms, t_us or t_ns; positions are x,y,z or x_mm and so on.
    #[arg(long, value_name = "FIELD=COLUMN,...")]
    columns: Option<String>,
    /// Set any key of an experiment file, such as machine.gp.triangle_ns=30000 or tracking.optical.latency=20; `pxpl5
    /// machines small-hmd` lists all numbers; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
}

impl SettingArgs {
    /// Returns the experiment file after all options. `--set` is applied last, so that its values replace all others.
    pub(crate) fn gather(&self) -> Result<ExperimentFile, CliError> {
        let file = ExperimentFile::with(registry());
        let mut file = match self.experiment.as_ref().or(self.file.as_ref()) {
            Some(path) => file.and_load(path)?,
            None => file,
        };
        self.options.set_in(&mut file)?;
        // `--columns` sets one key for each column.
        for column in self.columns.iter().flat_map(|columns| columns.split(',')) {
            let (field, name) = column.split_once('=').unwrap_or((column, ""));
            file.set(&format!("head.columns.{}", field.trim()), name.trim(), "--columns")?;
        }
        let places = self.model_at.iter().flat_map(|places| places.splitn(3, ','));
        for (axis, place) in ["x", "y", "z"].into_iter().zip(places) {
            file.set_text(&format!("model.{axis}={place}"), "--model-at")?;
        }
        for assignment in &self.sets {
            file.set_text(assignment, "--set")?;
        }
        Ok(file)
    }
}

/// Reads a text file. An error names the file.
pub(crate) fn text_of_file(path: &Path) -> Result<String, CliError> {
    let place = path.display();
    let bytes = std::fs::read(path).map_err(|error| CliError::usage(format!("{place}: cannot be read: {error}")))?;
    Ok(text_of(&bytes).map_err(|error| CliError::usage(format!("{place}: {error}")))?.to_owned())
}

/// Reads a TOML file of settings by path. Also returns its name, for error messages.
pub(crate) fn table_of(path: &Path) -> Result<(toml::Table, String), CliError> {
    let place = path.display().to_string();
    let table = toml::from_str(&text_of_file(path)?).map_err(|error| CliError::usage(format!("{place}: {error}")))?;
    Ok((table, place))
}
