//! Hashes of traces and pictures of 48 experiments. They detect every change of a simulated value, on any host and with
//! any vector unit.
//!
//! `tests/golden/hashes.txt` changes only by `PXPL5_UPDATE_HASHES=1 cargo test -p pxpl5 --test main hashes`.
//! CHANGELOG.md then states the reason.

use pxpl5::{ExperimentFile, Measured, SurfaceId};
use pxpl5_renderer::Vectors;
use rayon::prelude::*;
use std::path::Path;

/// Pipelines, each with a number of fields that is large enough to show a picture.
const PIPELINES: [(&str, &str, u64); 16] = [
    ("rendering-control", "mono = false", 14),
    ("rendering-control", "mono = true", 12),
    ("slats", "copy = \"whole\"", 12),
    ("slats", "copy = \"split\"", 12),
    ("frameless", "batch = 0", 6),
    ("jitp-field", "strip_rows = 64", 12),
    ("jitp-field-racing", "strip_rows = 64", 12),
    ("jitp-scanline", "strip_rows = 32", 12),
    ("jitp-dual-screen", "strip_rows = 64", 12),
    ("jitp-dual-view-racing", "strip_rows = 64", 12),
    ("arp-full", "display = \"arp\"", 9),
    ("arp-priority-line", "display = \"arp\"", 9),
    ("arp-cells-warp", "display = \"arp\"", 9),
    ("arp-ideal-pixel", "display = \"arp\"", 9),
    ("rendering-control", "level = \"cycle\"", 14),
    ("slats", "level = \"cycle\"", 12),
];

const SCENES: [(&str, u64); 3] = [("full-screen:8", 8), ("mig", 24), ("molecules", 30)];

/// Returns the 64-bit FNV-1a hash of some bytes.
fn fnv(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

/// Returns a line with the name, the hash of the trace, and the hash of all last pictures.
fn hashed(pipeline: &str, key: &str, fields: u64, scene: &str, triangles: u64) -> String {
    let text =
        format!("pipeline = \"{pipeline}\"\n{key}\nscene = \"{scene}\"\ntriangles = {triangles}\nfields = {fields}\n");
    let plan =
        ExperimentFile::parse(&text, "test").and_then(|file| file.resolve()).unwrap_or_else(|e| panic!("{e}: {text}"));
    let outcome = plan.experiment(plan.load_scene().expect("built in")).run().unwrap_or_else(|e| panic!("{e}: {text}"));
    let surfaces = (0..outcome.record().surfaces().count() as u16).map(SurfaceId);
    let pictures: Vec<u8> =
        surfaces.filter_map(|surface| outcome.picture(surface)).flat_map(|p| p.into_raw()).collect();
    assert!(!pictures.is_empty(), "{text}");
    let hash = outcome.report().trace_hash;
    format!("{hash} {:016x} {pipeline} {} {scene}", fnv(pictures.into_iter()), key.replace(' ', ""))
}

/// Returns the lines of all experiments with these scenes.
fn all_hashed(scenes: &[(&str, u64)]) -> String {
    let lines = PIPELINES.par_iter().flat_map(|(pipeline, key, fields)| {
        scenes.par_iter().map(|(scene, triangles)| hashed(pipeline, key, *fields, scene, *triangles) + "\n")
    });
    lines.collect()
}

/// Without `PXPL5_ALL_CASES=1`, only the best vector unit runs all scenes, and each other unit runs one of them.
#[test]
fn traces_and_pictures_of_forty_eight_experiments_are_unchanged_on_every_vector_unit() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/hashes.txt");
    if std::env::var_os("PXPL5_UPDATE_HASHES").is_some() {
        std::fs::write(&path, all_hashed(&SCENES)).expect("tests/golden can be written");
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert_eq!(expected.lines().count(), 48);
    for (n, vectors) in Vectors::available().into_iter().enumerate() {
        vectors.at_most();
        let is_whole = crate::support::runs_all_cases() || Vectors::available().last() == Some(&vectors);
        let scenes = if is_whole { &SCENES[..] } else { &SCENES[n % SCENES.len()..][..1] };
        let expected = expected.lines().filter(|line| scenes.iter().any(|(scene, _)| line.ends_with(scene)));
        // An empty line ends both texts, so a missing line is found.
        for (line, expected) in all_hashed(scenes).lines().chain([""]).zip(expected.chain([""])) {
            assert_eq!(line, expected, "trace, pictures, experiment on {vectors:?}");
        }
    }
}
