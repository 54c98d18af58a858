//! Trace and pictures of 30 experiments, as hashes: nothing that is simulated changes unnoticed, on any host.
//!
//! `tests/golden/hashes.txt` changes only by `PXPL5_UPDATE_HASHES=1 cargo test --test hashes`, and CHANGELOG.md says why then.

use pxpl5::{ExperimentFile, Measured, SurfaceId};
use std::fmt::Write as _;
use std::path::Path;

const UPDATE: &str = "PXPL5_UPDATE_HASHES";

/// Pipelines with the fields in which something is shown.
const PIPELINES: [(&str, &str, u64); 10] = [
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
];

const SCENES: [(&str, u64); 3] = [("full-screen:8", 8), ("mig", 24), ("molecules", 30)];

/// 64 bits of FNV-1a.
fn fnv(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

/// Name, hash of the trace, hash of all last pictures.
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

#[test]
fn trace_and_pictures_of_thirty_experiments_are_what_they_were() {
    let mut text = String::new();
    for (pipeline, key, fields) in PIPELINES {
        for (scene, triangles) in SCENES {
            writeln!(text, "{}", hashed(pipeline, key, fields, scene, triangles)).expect("into a string");
        }
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/hashes.txt");
    if std::env::var_os(UPDATE).is_some() {
        std::fs::write(&path, &text).expect("tests/golden can be written");
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert_eq!(text.lines().count(), 30);
    for (line, expected) in text.lines().zip(expected.lines()) {
        assert_eq!(line, expected, "trace, pictures, experiment");
    }
    assert_eq!(text, expected);
}
