//! The command `pxpl5 machines`, which lists the built-in machines and their parameters.

use crate::error::CliError;
use crate::numbers::count_of;
use crate::options::registry;
use crate::terminal::print;
use clap::Args;
use pxpl5::{MachineConfig, PRESETS, Parameter, Preset, SettingError, Suitability, suitability, tracking_parameters};
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// List the built-in machines.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 machines
  pxpl5 machines small-hmd      every parameter with unit, provenance, allowed range and source,
                                also for the i860 and the trackers; --set PATH=VALUE changes a parameter")]
pub(crate) struct MachinesArgs {
    /// Show all parameters of this machine.
    #[arg(value_name = "PRESET")]
    preset: Option<String>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: MachinesArgs) -> Result<(), CliError> {
    if let Some(name) = &args.preset {
        let machine = registry().machine_of(MachineConfig::preset(name).map_err(CliError::usage)?);
        return print(&if args.json { one_json(&machine) } else { one_text(&machine) });
    }
    let machines = PRESETS.iter().map(Listed::new).collect::<Result<Vec<_>, _>>().map_err(CliError::usage)?;
    print(&if args.json { all_json(&machines) } else { all_text(&machines) })
}

/// A built-in machine, and the pipelines that it can and cannot run.
#[derive(Serialize)]
struct Listed {
    name: &'static str,
    about: &'static str,
    n_gps: usize,
    n_renderers: usize,
    pipelines: Vec<&'static str>,
    /// Reason for each pipeline that the machine cannot run.
    cannot_run: Map<String, Value>,
}

impl Listed {
    fn new(preset: &Preset) -> Result<Self, SettingError> {
        let machine = MachineConfig::preset(preset.name)?;
        let all = suitability(&registry(), &machine);
        let (runs, lacking): (Vec<_>, Vec<_>) = all.into_iter().partition(|one| one.lacks.is_none());
        Ok(Self {
            name: preset.name,
            about: preset.about,
            n_gps: machine.n_gps,
            n_renderers: machine.n_renderers,
            pipelines: runs.into_iter().map(|one| one.pipeline).collect(),
            cannot_run: lacking.into_iter().map(|one| (one.pipeline.to_owned(), json!(one.lacks))).collect(),
        })
    }
}

fn all_text(machines: &[Listed]) -> String {
    let mut text = format!("{:<16} {:>4} {:>10}  {}\n", "machine", "GPs", "renderers", "what it is");
    for Listed { name, about, n_gps, n_renderers, pipelines, cannot_run } in machines {
        let runs = match (pipelines.len(), cannot_run.len()) {
            (_, 0) => "every pipeline".to_owned(),
            (0, _) => "no pipeline".to_owned(),
            _ => pipelines.join(", "),
        };
        let _ = writeln!(text, "{name:<16} {n_gps:>4} {n_renderers:>10}  {about}");
        let _ = writeln!(text, "{:<32}  runs {runs}", "");
    }
    text
}

fn all_json(machines: &[Listed]) -> String {
    format!("{:#}\n", json!({"schema": "pxpl5-machines/1", "machines": machines}))
}

fn one_json(machine: &MachineConfig) -> String {
    let object = json!({
        "schema": "pxpl5-machine/1",
        "name": machine.preset,
        "n_gps": machine.n_gps,
        "n_renderers": machine.n_renderers,
        "pipelines": suitability(&registry(), machine),
        "parameters": machine.parameters(),
        "tracking": tracking_parameters(),
    });
    format!("{object:#}\n")
}

fn one_text(machine: &MachineConfig) -> String {
    let mut text = format!(
        "{}: {}, {}\n\n",
        machine.preset,
        count_of(machine.n_gps, "GP"),
        count_of(machine.n_renderers, "renderer")
    );
    for Suitability { pipeline, lacks } in suitability(&registry(), machine) {
        let status = lacks.map_or_else(|| "runs".to_owned(), |lacks| format!("cannot run: {lacks}"));
        let _ = writeln!(text, "{pipeline:<42} {status}");
    }
    text.push('\n');
    // Parameters of the machine come first, parameters of tracking second.
    machine.parameters().iter().for_each(|parameter| line(&mut text, parameter));
    text.push_str("\nWith a tracked head (head.motion, --head), on every machine:\n\n");
    tracking_parameters().iter().for_each(|parameter| line(&mut text, parameter));
    text
}

fn line(text: &mut String, Parameter { path, info, value, read_only }: &Parameter) {
    let (low, high) = info.range;
    let fixed = if *read_only { " (cannot be set)" } else { "" };
    let _ = writeln!(
        text,
        "{path:<42} {value:>12} {:<8} {:<9} {low}..{high}: {}{fixed}",
        info.unit, info.provenance, info.source
    );
}
