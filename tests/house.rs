//! Rules for the structure of the workspace, and the part of ARCHITECTURE.md that is generated from the crates.
//!
//! `PXPL5_UPDATE_HOUSE=1 cargo test -p pxpl5 --test main house` updates that part, and the table of code lines
//! (lines.rs).

mod crates;
mod document;
mod lines;
mod modules;
mod packages;
mod prose;
mod source;

use crates::{Crate, workspace};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Layers of the workspace. A crate may depend on crates of the listed layers, and on crates of its own layer only if
/// its own layer is listed too.
const FLOORS: [(&str, &[&str], &[&str]); 13] = [
    ("ground", &["pxpl5-sim", "pxpl5-wire", "i860"], &["ground"]),
    (
        "boards",
        &["pxpl5-ring", "pxpl5-gp", "pxpl5-renderer", "pxpl5-framebuffer", "address-recalculation"],
        &["ground"],
    ),
    ("world", &["tracking", "pxpl5-scene"], &["ground", "world"]),
    ("volume", &["spatialgl"], &["ground", "world", "volume"]),
    ("geometry", &["pxpl5-geometry", "pphigs"], &["ground", "boards", "geometry"]),
    ("firmware", &["rendering-control", "slats", "jitp"], &["ground", "boards", "geometry"]),
    ("machine", &["pxpl5-machine"], &["ground", "boards"]),
    ("run", &["pxpl5-run"], &["ground", "boards", "geometry", "firmware", "world", "machine"]),
    ("slices", &["pxpl5-volume"], &["ground", "boards", "world", "volume"]),
    (
        "measure",
        &["pxpl5-measure", "pxpl5-analytic", "pxpl5-arp"],
        &["ground", "boards", "geometry", "firmware", "world", "machine", "run"],
    ),
    (
        "lab",
        &["pxpl5-lab"],
        &["ground", "boards", "geometry", "firmware", "world", "machine", "run", "slices", "measure"],
    ),
    ("views", &["pxpl5-views"], &["ground", "boards", "world", "machine", "run", "measure"]),
    (
        "front",
        &["pxpl5", "pxpl5-cli", "pxpl5-py", "pxpl5-web"],
        &[
            "ground", "boards", "geometry", "firmware", "world", "volume", "machine", "run", "slices", "measure",
            "lab", "views", "front",
        ],
    ),
];

fn floor_of(name: &str) -> Option<&'static str> {
    FLOORS.iter().find(|(_, crates, _)| crates.contains(&name)).map(|(floor, ..)| *floor)
}

#[test]
fn every_crate_depends_only_on_crates_of_lower_floors() {
    for member in workspace() {
        let floor = floor_of(&member.name).unwrap_or_else(|| panic!("{} is on no floor", member.name));
        let (_, _, allowed) = FLOORS.iter().find(|(name, ..)| *name == floor).expect("listed");
        for below in &member.dependencies {
            let other = floor_of(below).expect("a member");
            assert!(allowed.contains(&other), "{} ({floor}) depends on {below} ({other})", member.name);
        }
    }
}

#[test]
fn crates_have_no_circular_dependencies() {
    let members = workspace();
    let below: BTreeMap<&str, Vec<&str>> = members
        .iter()
        .map(|member| (member.name.as_str(), member.dependencies.iter().map(String::as_str).collect()))
        .collect();
    assert_eq!(modules::circles(&below), Vec::<Vec<&str>>::new());
}

#[test]
fn modules_have_no_circular_imports() {
    let mut found = Vec::new();
    for member in workspace() {
        let graph = modules::imports(&member);
        let arrows = graph.iter().map(|(from, to)| (from.as_str(), to.iter().map(String::as_str).collect())).collect();
        for circle in modules::circles(&arrows) {
            let inside: BTreeSet<&str> = circle.iter().copied().collect();
            let ties = circle.iter().flat_map(|from| {
                let to = graph[*from].iter().filter(|to| inside.contains(to.as_str()));
                to.map(move |to| format!("\n    {from} -> {to}"))
            });
            found.push(format!("{}: {circle:?}{}", member.name, ties.collect::<String>()));
        }
    }
    assert!(found.is_empty(), "{} circles:\n{}", found.len(), found.join("\n"));
}

#[test]
fn the_facade_only_re_exports() {
    let facade = workspace().into_iter().find(|member| member.name == "pxpl5").expect("the root");
    // Examples in comments do not count.
    let texts = facade.files.iter().flat_map(|file| file.text.lines());
    let code: Vec<&str> = texts.filter(|line| !line.trim_start().starts_with("//")).collect();
    assert!(code.len() < 300, "{} lines", code.len());
    for line in code {
        assert!(!line.trim_start().starts_with("pub fn") && !line.contains("impl "), "{line}");
    }
}

/// Names that a browser does not support: clocks, threads, files and the environment of the host.
const OF_THE_HOST: [&str; 7] =
    ["std::time", "Instant::now", "SystemTime", "std::thread", "std::fs", "std::env::", "std::process"];

#[test]
fn one_experiment_needs_no_clock_thread_or_file_of_the_host() {
    let members = workspace();
    for name in closure(&members, "pxpl5-run") {
        let member = members.iter().find(|member| member.name == name).expect("a member");
        for file in &member.files {
            let product = source::without_host_feature(&source::product(&file.text));
            for word in OF_THE_HOST {
                assert!(!product.contains(word), "{} of {name} uses {word}", file.path);
            }
        }
    }
}

/// Returns a crate together with all crates of the workspace on which it depends.
fn closure(members: &[Crate], name: &str) -> BTreeSet<String> {
    let mut all = BTreeSet::from([name.to_owned()]);
    loop {
        let more: Vec<String> = members
            .iter()
            .filter(|member| all.contains(&member.name))
            .flat_map(|member| member.dependencies.clone())
            .filter(|below| !all.contains(below))
            .collect();
        if more.is_empty() {
            return all;
        }
        all.extend(more);
    }
}

#[test]
fn only_ntsc_and_its_pipelines_name_eyes_fields_and_beams() {
    let general = ["pxpl5-machine", "pxpl5-measure", "pxpl5-views"];
    for member in workspace().iter().filter(|member| general.contains(&member.name.as_str())) {
        for file in member.files.iter().filter(|file| !KNOWS_EYES.contains(&file.path.as_str())) {
            let code = source::code(&source::product(&file.text));
            for word in ["Video", "FieldParity", "Eye::"] {
                assert!(!source::has_word(&code, word), "{} of {} names {word}", file.path, member.name);
            }
        }
    }
}

/// Files that may contain the labels of the frame buffers of two eyes.
const KNOWS_EYES: [&str; 1] = ["surface.rs"];

#[test]
fn only_the_command_prints() {
    for member in workspace().iter().filter(|member| member.name != "pxpl5-cli") {
        for file in &member.files {
            let code = source::code(&source::product(&file.text));
            let prints = ["println!", "eprintln!", "dbg!"].iter().any(|word| code.contains(word));
            assert!(!prints, "{} of {} prints", file.path, member.name);
        }
    }
}

/// The counts are only hints, because only a person can judge a text.
#[test]
fn the_counts_of_unclear_texts_stay_within_their_limits() {
    prose::check(&workspace());
}

/// A feature that a crate for tests turns on in a crate of the command would have that crate, and all that stand above
/// it, compiled once for `cargo run` and again for `cargo test`.
#[test]
fn crates_for_tests_turn_on_no_feature_of_a_crate_of_the_command() {
    let [built, tested] = ["no-dev", "normal,build,dev"].map(packages::features);
    let again: Vec<&String> = tested
        .difference(&built)
        .filter(|line| built.iter().any(|other| other.split('|').next() == line.split('|').next()))
        .collect();
    assert!(again.is_empty(), "compiled again for tests, with other features: {again:#?}");
}

/// Tests are not found by their place, because each crate has one program of tests. A library without unit tests is
/// not compiled for them.
#[test]
fn every_file_of_tests_belongs_to_a_program() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let members = workspace();
    for member in members.iter().filter(|member| member.name != "pxpl5") {
        let manifest = root.join("crates").join(&member.name).join("Cargo.toml");
        let manifest = std::fs::read_to_string(manifest).expect("text");
        let library = manifest.split("\n[").find(|part| part.starts_with("lib]")).unwrap_or_default();
        let has_tests = member.files.iter().any(|file| file.text.contains("#[cfg(test)]"));
        assert!(!has_tests || !library.contains("\ntest = false"), "tests of {} would not run", member.name);
    }
    let folders = members.iter().map(|member| root.join("crates").join(&member.name)).chain([root.into()]);
    for folder in folders.filter(|folder| folder.join("tests/main.rs").exists()) {
        let read = |file: &str| std::fs::read_to_string(folder.join(file)).expect("text");
        let (main, manifest) = (read("tests/main.rs"), read("Cargo.toml"));
        for entry in std::fs::read_dir(folder.join("tests")).expect("a folder") {
            let path = entry.expect("readable").path();
            let name = path.file_stem().and_then(|name| name.to_str()).unwrap_or_default();
            let is_source = path.extension().is_some_and(|extension| extension == "rs");
            let is_known = main.contains(&format!("\nmod {name};")) || manifest.contains(&format!("name = \"{name}\""));
            assert!(!is_source || is_known, "{} is a module of no program", path.display());
        }
    }
}

#[test]
fn architecture_describes_the_current_crates() {
    document::check(&workspace());
}

#[test]
fn no_crate_has_more_code_lines_than_the_lock_allows() {
    lines::check();
}

#[test]
fn every_published_crate_has_the_metadata_of_a_registry() {
    packages::check();
}

/// Functions whose results depend on the library of the host. Square roots are exact everywhere.
const OF_THE_HOSTS_LIBRARY: &str = ".sin() .cos() .tan() .sin_cos() .asin() .acos() .atan() .atan2( .sinh() .cosh() \
    .tanh() .exp() .exp2() .exp_m1() .ln() .ln_1p() .log( .log2() .log10() .powf( .powi( .cbrt() .hypot( .slerp( \
    ::from_rotation_y( ::from_axis_angle(";

/// Places that may call such a function, because no simulated number depends on it.
const ACCEPTED_PLACES: [(&str, &str, &str); 2] = [
    (
        "pxpl5-sim",
        "parameters/value.rs",
        "2f64.powi(64) is a power of two, exact everywhere; it tells whether a setting is a whole number",
    ),
    (
        "tracking",
        "motion/spline.rs",
        "a power with a whole exponent is products of Rust's own compiler-builtins on every target",
    ),
];

/// The same input must give the same trace on every host. Simulation code takes transcendental functions from `libm`,
/// which is compiled with the program.
#[test]
fn nothing_simulated_calls_a_transcendental_function_of_the_host() {
    let members = workspace();
    let simulated: BTreeSet<String> =
        ["pxpl5-measure", "pxpl5-analytic", "spatialgl"].iter().flat_map(|top| closure(&members, top)).collect();
    let mut found = Vec::new();
    for member in members.iter().filter(|member| simulated.contains(&member.name)) {
        for file in member.files.iter().filter(|file| !file.path.contains("tests")) {
            let product = source::code(&source::product(&file.text));
            for function in OF_THE_HOSTS_LIBRARY.split(' ').filter(|function| product.contains(*function)) {
                let accepted =
                    ACCEPTED_PLACES.iter().any(|(name, end, _)| *name == member.name && file.path.ends_with(end));
                if !accepted {
                    found.push(format!("{} of {}: {function}", file.path, member.name));
                }
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}
