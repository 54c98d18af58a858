//! Tests that each number of the machine, of its displays and of the trackers has an effect.

use glam::DVec3;
use pxpl5_arp::{WalkSettings, World, walk};
use pxpl5_lab::{ExperimentFile, Plan, registry, tracking_parameters};
use pxpl5_machine::MachineConfig;
use pxpl5_measure::{Measure, Measured, Results};
use pxpl5_run::Pixels;
use pxpl5_scene::builtin;
use pxpl5_sim::parameters::{Parameter, ParameterTable, Value};
use pxpl5_wire::Eye;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

const EFFECTS: &str = include_str!("effects.txt");

/// Settings of each experiment. The part of the key that `*` stands for replaces `NAME`.
const EXPERIMENTS: [(&str, &str); 36] = [
    ("walk", "walk "),
    ("control", "pipeline=rendering-control scene=full-screen:2 fields=36 n_gps=2"),
    ("heavy", "pipeline=rendering-control scene=full-screen:300 fields=120 n_gps=2"),
    ("application", "pipeline=rendering-control scene=full-screen:2 fields=60 n_gps=2 host.application_ns=20000000"),
    ("moving", "pipeline=rendering-control scene=mig triangles=60 fields=36 n_gps=2"),
    ("spheres", "pipeline=rendering-control scene=molecules triangles=20 fields=36 n_gps=2"),
    ("gouraud-spheres", "pipeline=rendering-control scene=molecules triangles=20 fields=36 n_gps=2 shading=gouraud"),
    ("near", "pipeline=rendering-control scene=gallery triangles=100 fields=36 n_gps=2"),
    ("slats", "pipeline=slats scene=full-screen:2 fields=18"),
    ("many", "pipeline=slats scene=typical:60 fields=18 n_gps=3"),
    ("code", "pipeline=slats scene=full-screen:2 fields=18 level=cycle"),
    ("code-with-dma", "pipeline=slats scene=full-screen:2 fields=18 level=cycle i860.dram.dma_interval=20"),
    ("jitp", "pipeline=jitp-field scene=full-screen:2 fields=24"),
    ("jitp-between", "pipeline=jitp-dual-screen scene=mig triangles=20 fields=24"),
    ("head", "pipeline=slats scene=full-screen:2 fields=24 head.motion=synthetic:1 head.predict=none"),
    ("unblanked", "EXPERIMENT head video.left_blanking=0 video.top_blanking=0"),
    ("tracker", "EXPERIMENT head fields=30 head.tracker=NAME"),
    ("3space", "EXPERIMENT head fields=30 head.tracker=3space"),
    ("flock", "EXPERIMENT head fields=30 head.tracker=flock"),
    ("flock-patched", "EXPERIMENT head fields=30 head.tracker=flock-patched"),
    ("fastrak", "EXPERIMENT head fields=30 head.tracker=fastrak"),
    ("fastrak-polled", "EXPERIMENT head fields=30 head.tracker=fastrak-polled"),
    ("velocity", "EXPERIMENT head fields=30 head.predict=velocity"),
    ("kalman", "EXPERIMENT head fields=30 head.predict=kalman head.filter=given"),
    ("sliding", "EXPERIMENT velocity head.motion=slide:3 tracking.gate.speed=1"),
    ("turning", "EXPERIMENT velocity head.motion=pan:800 tracking.gate.turn=370"),
    ("often", "EXPERIMENT velocity head.tracker=ideal tracking.ideal.rate=2000"),
    ("display", "EXPERIMENT control fields=60 head.motion=pan:40 head.predict=none display=NAME"),
    ("panel", "EXPERIMENT control fields=60 display=panel"),
    ("lcd-120", "EXPERIMENT control fields=60 head.motion=pan:40 head.predict=none display=lcd-120"),
    ("rolling", "EXPERIMENT lcd-120 lcd-120.scan=0"),
    ("hires", "EXPERIMENT control fields=60 display=hires hires.ports=4"),
    ("arp", "pipeline=arp-full scene=full-screen:2 fields=30 n_gps=2 head.motion=pan:40 head.predict=none"),
    ("seen", "EXPERIMENT arp scene=mig triangles=60"),
    ("priority", "pipeline=arp-priority scene=gallery triangles=60 fields=60 head.motion=walk:1.4 head.predict=none"),
    ("cells", "EXPERIMENT priority pipeline=arp-cells-warp"),
];

fn settings(experiment: &str, name: &str) -> String {
    let (_, found) = EXPERIMENTS.iter().find(|(known, _)| *known == experiment).expect(experiment);
    let found = found.replace("NAME", name);
    match found.strip_prefix("EXPERIMENT ").and_then(|rest| rest.split_once(' ')) {
        Some((base, rest)) => format!("{} {rest}", settings(base, name)),
        None => found,
    }
}

fn plan(settings: &str) -> Plan {
    let mut file = ExperimentFile::new();
    let set = settings.split_whitespace().try_for_each(|assignment| file.set_text(assignment, "--set"));
    set.and_then(|()| file.resolve()).unwrap_or_else(|error| panic!("{settings}: {error}"))
}

/// Returns a quantity of a run: a measure, a value of its report, a sum over its picture, or 1 for a run that fails and 0
/// for another one.
fn value(settings: &str, quantity: &str) -> f64 {
    if let Some(changes) = settings.strip_prefix("walk ") {
        return draws_per_s(changes);
    }
    let plan = plan(settings);
    let pixels = if quantity == "picture" { Pixels::Lazy } else { Pixels::Off };
    let outcome = match plan.experiment(plan.load_scene().expect("built in")).pixels(pixels).run() {
        Ok(outcome) => outcome,
        Err(_) if quantity == "error" => return 1.0,
        Err(error) => panic!("{settings}: {error}"),
    };
    match quantity {
        "error" => 0.0,
        "picture" => {
            let picture = outcome.picture(Eye::Left).expect("pixels");
            picture.as_raw().iter().zip(1..).map(|(byte, place)| f64::from(*byte) * f64::from(place % 9_973)).sum()
        }
        path if path.starts_with('/') => {
            let report = serde_json::to_value(outcome.report()).expect("data");
            report.pointer(path).and_then(serde_json::Value::as_f64).expect(path)
        }
        name => {
            let measured = Measure::named(name).expect("listed").of(&Results::of_run(outcome));
            measured.unwrap_or_else(|| panic!("{settings}: no {name}"))
        }
    }
}

/// Returns the draws a second in a short walk with an ideal renderer. `changes` are numbers of the walk.
fn draws_per_s(changes: &str) -> f64 {
    let mut settings = WalkSettings::CELLS;
    for (path, value) in changes.split_whitespace().filter_map(|change| change.split_once('=')) {
        let name = path.rsplit('.').next().expect("a name");
        settings.numbers.set(name, Value::Whole(value.parse().expect("a number"))).expect("listed");
    }
    let world = World::new(&builtin("gallery").expect("built in"), settings.numbers.cell_m).expect("it can be cut");
    let eye = |frame| DVec3::new(0.05 * frame as f64, 1.7, 0.0);
    walk(&world, &settings, 60, eye).expect("valid").draws_per_s(settings.numbers.frame_hz)
}

/// Returns the text that `*` stands for if a row's key covers a path.
fn star<'a>(key: &str, path: &'a str) -> Option<&'a str> {
    let Some((before, after)) = key.split_once('*') else { return (key == path).then_some("") };
    path.strip_prefix(before)?.strip_suffix(after).filter(|name| !name.contains('.'))
}

/// Tests each number with one other value, in the first row of effects.txt that covers the number. The quantity in this
/// row must rise, fall or change, by any amount. For a row with `in`, the named test must exist. By day, every fourth
/// number is tested.
#[test]
fn each_number_moves_the_quantity_in_its_row_or_has_a_test_of_its_own() {
    let displays = registry().displays().iter().map(|entry| (entry.config)()).collect();
    let machine = MachineConfig { displays, ..registry().machine_of(MachineConfig::small_hmd()) };
    let parameters = machine.parameters().into_iter().chain(tracking_parameters());
    let parameters: Vec<Parameter> = parameters.filter(|parameter| !parameter.read_only).collect();
    let rows = EFFECTS.lines().filter(|line| !line.starts_with('#')).map(|line| line.split(' ').collect());
    let rows: Vec<Vec<&'static str>> = rows.collect();
    // The first row that covers a number applies.
    let row_of = |path: &str| {
        let found = rows.iter().find(|row| star(row[0], path).is_some());
        found.unwrap_or_else(|| panic!("{path}: no row in effects.txt, or no effect: then the number has to go"))
    };
    let applied: Vec<(&Parameter, &Vec<&'static str>)> =
        parameters.iter().map(|one| (one, row_of(&one.path))).collect();
    for row in &rows {
        assert!(applied.iter().any(|(_, applied)| applied[0] == row[0]), "{}: there is no such number", row[0]);
    }
    let by_day = |n: &usize| std::env::var_os("PXPL5_ALL_CASES").is_some() || n.is_multiple_of(4);
    let all: Vec<_> = applied.into_iter().enumerate().filter(|(n, _)| by_day(n)).map(|(_, one)| one).collect();
    // Many rows change the same experiment.
    let of = |(parameter, row): &(&Parameter, &Vec<&'static str>)| {
        let name = star(row[0], &parameter.path).unwrap_or_default();
        (row[3] != "in").then(|| (settings(row[4], name), row[2]))
    };
    let bases: Vec<(String, &str)> = all.iter().filter_map(of).collect::<BTreeSet<_>>().into_iter().collect();
    let values: Vec<f64> = bases.par_iter().map(|(settings, quantity)| value(settings, quantity)).collect();
    let values: BTreeMap<&(String, &str), f64> = bases.iter().zip(values).collect();
    let wrong = all.par_iter().filter_map(|applied| {
        let (Parameter { path, value: own, info, .. }, row) = applied;
        let [_, far, quantity, direction, experiment] = row[..] else { panic!("{row:?}: five columns") };
        let Some(base) = of(applied) else {
            let file = format!("{}/../../{experiment}", env!("CARGO_MANIFEST_DIR"));
            let test = std::fs::read_to_string(file).expect("a test");
            let is_there = test.contains(&format!("fn {quantity}() {{"));
            return (!is_there).then(|| format!("{path}: {experiment} has no test {quantity}"));
        };
        let eight_times = (8.0 * own.real() + 1.0).min(info.limits.1.real()).round();
        let far = if far == "~" { eight_times.to_string() } else { far.to_owned() };
        let prefix = if path.starts_with("tracking.") { "" } else { "machine." };
        let (before, after) = (values[&base], value(&format!("{} {prefix}{path}={far}", base.0), quantity));
        let is_right = match direction {
            "+" => after > before,
            "-" => after < before,
            _ => (after - before).abs() > 0.0,
        };
        (!is_right)
            .then(|| format!("{path} = {far}, {experiment}: {quantity} {after} after {before}, expected {direction}"))
    });
    let wrong: Vec<String> = wrong.collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
