//! Rules for the packages of the crates that are published.

use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

/// Keys of a manifest that a registry shows.
const SHOWN: [&str; 6] = ["description", "documentation", "license", "readme", "repository", "rust_version"];

/// Greatest number of keywords, and of characters in a keyword, that crates.io accepts.
const MAX_KEYWORDS: usize = 5;
const MAX_KEYWORD: usize = 20;

/// Returns the name, version and features of each package below the default members, without or with those for tests:
/// `no-dev` or `normal,build,dev`.
pub(crate) fn features(edges: &str) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--offline", "--edges", edges, "--prefix", "none", "--format", "{p}|{f}"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("text");
    text.lines().filter(|line| !line.is_empty()).map(|line| line.trim_end_matches(" (*)").to_owned()).collect()
}

/// Fails if a published crate lacks what a registry shows, a licence, or a README with an example that is compiled.
pub(crate) fn check() {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--offline", "--format-version", "1"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let packages = metadata["packages"].as_array().expect("a list").iter();
    // `publish = false` is an empty list of registries.
    let published: Vec<&Value> = packages.filter(|package| package["publish"].is_null()).collect();
    assert!(published.len() > 20, "{} published crates", published.len());
    let missing: Vec<String> = published.iter().flat_map(|package| missing(package)).collect();
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}

/// Returns a line for each part that a package lacks.
fn missing(package: &Value) -> Vec<String> {
    let name = package["name"].as_str().expect("a name");
    let folder = Path::new(package["manifest_path"].as_str().expect("a path")).parent().expect("a folder");
    let read = |file: &str| std::fs::read_to_string(folder.join(file)).unwrap_or_default();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut missing: Vec<String> =
        SHOWN.iter().filter(|key| package[**key].is_null()).map(|key| format!("{name}: {key}")).collect();
    let mut expect = |holds: bool, what: &str| {
        if !holds {
            missing.push(format!("{name}: {what}"));
        }
    };
    let words = |key: &str| -> Vec<String> { serde_json::from_value(package[key].clone()).unwrap_or_default() };
    let keywords = words("keywords");
    let is_valid =
        (1..=MAX_KEYWORDS).contains(&keywords.len()) && keywords.iter().all(|word| word.len() <= MAX_KEYWORD);
    expect(is_valid, "one to five keywords of at most 20 characters");
    expect(!words("categories").is_empty(), "categories");
    expect(package["metadata"]["docs"]["rs"].is_object(), "package.metadata.docs.rs");
    expect(read("Cargo.toml").contains("\ninclude = ["), "include, so that the package is small");
    for licence in ["LICENSE-APACHE", "LICENSE-MIT"] {
        let text = std::fs::read_to_string(root.join(licence)).expect("a licence");
        expect(read(licence) == text, licence);
    }
    expect(read("README.md").contains("\n```rust"), "README.md with an example");
    expect(read("src/lib.rs").contains("#[doc = include_str!(\"../README.md\")]"), "the example compiled as a test");
    missing
}
