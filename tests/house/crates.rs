//! The crates of the workspace, from their manifests and sources.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

pub(crate) struct Crate {
    /// Name of the folder below `crates`. On a registry, the package's name has the prefix `pxpl5-`.
    pub(crate) name: String,
    /// Description in the manifest.
    pub(crate) about: String,
    /// Crates of the workspace on which this crate depends, without dependencies for tests.
    pub(crate) dependencies: Vec<String>,
    /// Rust files below `src`.
    pub(crate) files: Vec<SourceFile>,
}

pub(crate) struct SourceFile {
    /// Path below `src`, with `/` as separator.
    pub(crate) path: String,
    pub(crate) text: String,
}

/// Returns all crates, sorted by name. The benches are no crate of the product.
pub(crate) fn workspace() -> Vec<Crate> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--offline", "--format-version", "1"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let packages = metadata["packages"].as_array().expect("a list").iter();
    let packages: Vec<&Value> = packages.filter(|package| package["name"] != "pxpl5-benches").collect();
    let names: Vec<(&str, &str)> = packages.iter().map(|package| (text(package, "name"), name(package))).collect();
    let mut all: Vec<Crate> = packages.iter().map(|package| read(package, &names)).collect();
    all.sort_by(|a, b| a.name.cmp(&b.name));
    all
}

/// Returns the name of a crate: its folder below `crates`, which is also the name in `use` declarations.
fn name(package: &Value) -> &str {
    let manifest = Path::new(text(package, "manifest_path"));
    let folder =
        manifest.strip_prefix(Path::new(env!("CARGO_MANIFEST_DIR")).join("crates")).ok().and_then(Path::parent);
    folder.and_then(Path::to_str).unwrap_or("pxpl5")
}

fn read(package: &Value, names: &[(&str, &str)]) -> Crate {
    let dependencies = package["dependencies"].as_array().expect("a list").iter();
    let mut below: Vec<String> = dependencies
        .filter(|dependency| dependency["kind"].is_null())
        .filter_map(|dependency| names.iter().find(|(package, _)| *package == text(dependency, "name")))
        .map(|(_, folder)| (*folder).to_owned())
        .collect();
    below.sort();
    below.dedup();
    let src = Path::new(text(package, "manifest_path")).with_file_name("src");
    let mut files = Vec::new();
    collect(&src, &src, &mut files);
    files.sort_by(|a, b| a.path.cmp(&b.path));
    Crate { name: name(package).to_owned(), about: text(package, "description").to_owned(), dependencies: below, files }
}

fn text<'a>(package: &'a Value, key: &str) -> &'a str {
    package[key].as_str().unwrap_or_default()
}

fn collect(src: &Path, folder: &Path, files: &mut Vec<SourceFile>) {
    for entry in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("readable")) {
        let path: PathBuf = entry.path();
        if path.is_dir() {
            collect(src, &path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let below = path.strip_prefix(src).expect("below src").to_string_lossy().replace('\\', "/");
            files.push(SourceFile { path: below, text: std::fs::read_to_string(&path).expect("text") });
        }
    }
}
