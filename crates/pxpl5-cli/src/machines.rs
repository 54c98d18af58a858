//! `pxpl5 machines`.

use crate::error::CliError;
use crate::options::registry;
use crate::terminal::print;
use clap::Args;
use pxpl5::{MachineConfig, PRESETS, Parameter, tracking_parameters};
use serde_json::json;
use std::fmt::Write;

/// List the machines that are built in.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 machines
  pxpl5 machines small-hmd      every parameter with unit, standing, allowed range and source,
                                those of the i860 and of trackers too; --set PATH=VALUE changes it")]
pub(crate) struct MachinesArgs {
    /// Show all parameters of this one.
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
    print(&if args.json { all_json() } else { all_text() })
}

fn all_text() -> String {
    let mut text = format!("{:<16} {:>4} {:>10}  {}\n", "machine", "GPs", "renderers", "what it is");
    for preset in PRESETS {
        let machine = MachineConfig::preset(preset.name);
        let (gps, renderers) = machine.map_or((0, 0), |machine| (machine.n_gps, machine.n_renderers));
        let _ = writeln!(text, "{:<16} {gps:>4} {renderers:>10}  {}", preset.name, preset.about);
    }
    text
}

fn all_json() -> String {
    let machines = PRESETS.iter().map(|preset| {
        let machine = MachineConfig::preset(preset.name).ok();
        let gps = machine.as_ref().map(|m| m.n_gps);
        let renderers = machine.as_ref().map(|m| m.n_renderers);
        json!({"name": preset.name, "about": preset.about, "n_gps": gps, "n_renderers": renderers})
    });
    let machines: Vec<_> = machines.collect();
    format!("{:#}\n", json!({"schema": "pxpl5-machines/1", "machines": machines}))
}

fn one_json(machine: &MachineConfig) -> String {
    let object = json!({
        "schema": "pxpl5-machine/1",
        "name": machine.preset,
        "n_gps": machine.n_gps,
        "n_renderers": machine.n_renderers,
        "parameters": machine.parameters(),
        "tracking": tracking_parameters(),
    });
    format!("{object:#}\n")
}

fn one_text(machine: &MachineConfig) -> String {
    let mut text = format!("{}: {} GPs, {} renderers\n\n", machine.preset, machine.n_gps, machine.n_renderers);
    machine.parameters().iter().for_each(|parameter| line(&mut text, parameter));
    text.push_str("\nWith a tracked head (head.motion, --head), whatever the machine:\n\n");
    tracking_parameters().iter().for_each(|parameter| line(&mut text, parameter));
    text
}

fn line(text: &mut String, Parameter { path, info, value, read_only }: &Parameter) {
    let (low, high) = info.range;
    let fixed = if *read_only { " (cannot be set)" } else { "" };
    let _ = writeln!(
        text,
        "{path:<42} {value:>12} {:<8} {:<9} {low}..{high}: {}{fixed}",
        info.unit, info.standing, info.source
    );
}
