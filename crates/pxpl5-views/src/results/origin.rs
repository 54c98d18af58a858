//! Origin of a result file: the facts from which the file can be reproduced.

use pxpl5_measure::Report;
use std::fmt::Write;

/// Returns the origin of a report as pairs of key and value: preset, configuration hash, version, commit, level, seed
/// and experiment. The commit is missing if the program did not state its commit.
pub fn origin(report: &Report) -> Vec<(&'static str, String)> {
    let overrides: Vec<String> = report.overrides.iter().map(|(path, value)| format!("{path}={value}")).collect();
    let mut pairs = vec![
        ("machine", report.machine.clone()),
        ("config_hash", report.config_hash.clone()),
        ("version", report.version.clone()),
        ("level", report.level.clone()),
        ("seed", report.seed.to_string()),
        ("pipeline", report.pipeline.clone()),
        ("variant", report.variant.clone()),
        ("display", report.display.clone()),
        ("overrides", overrides.join(" ")),
        ("scene", format!("{}, {} triangles, {} spheres", report.scene, report.triangles, report.spheres)),
        ("fields", report.fields.to_string()),
    ];
    pairs.extend(report.commit.clone().map(|commit| ("commit", commit)));
    pairs
}

/// Returns the origin of a report as text. Each line begins with `mark`, a comment marker such as `# `.
pub fn origin_lines(report: &Report, mark: &str) -> String {
    let mut text = String::new();
    for (key, value) in origin(report) {
        // A line break in a value would end the comment.
        let value = value.replace(['\n', '\r'], " ");
        let _ = writeln!(text, "{mark}{key}: {value}");
    }
    text
}

/// Returns a count with the singular or plural form of a noun: `1 triangle`, `2 triangles`.
pub(crate) fn count_of(count: usize, name: &str) -> String {
    format!("{count} {name}{}", if count == 1 { "" } else { "s" })
}
