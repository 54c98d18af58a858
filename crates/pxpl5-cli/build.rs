//! Finds the commit from which the command is built, and sets PXPL5_COMMIT and PXPL5_SHORT_COMMIT for the compiler.
//!
//! A package from a registry has `.cargo_vcs_info.json`. In a clone, Git names the commit. If the crate has neither the
//! file nor a clone, the commit is `unknown`: a build must not fail because no commit was found.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// File that `cargo package` adds to a package.
const PACKAGED: &str = ".cargo_vcs_info.json";

/// Number of digits that identify a commit for a reader.
const SHORT: usize = 12;

fn main() {
    let crate_folder = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").expect("set by cargo"));
    let (digits, is_modified) = packaged(&crate_folder).or_else(|| of_clone(&crate_folder)).unwrap_or_default();
    let suffix = if is_modified { "-modified" } else { "" };
    let named = |digits: &str| if digits.is_empty() { "unknown".to_owned() } else { format!("{digits}{suffix}") };
    println!("cargo:rustc-env=PXPL5_COMMIT={}", named(&digits));
    println!("cargo:rustc-env=PXPL5_SHORT_COMMIT={}", named(digits.get(..SHORT).unwrap_or(&digits)));
    println!("cargo:rerun-if-changed=build.rs");
}

/// Returns the commit of a package, and true if the package was made from modified files.
fn packaged(crate_folder: &Path) -> Option<(String, bool)> {
    let text = fs::read_to_string(crate_folder.join(PACKAGED)).ok()?;
    let (_, rest) = text.split_once("\"sha1\":")?;
    let digits = rest.split('"').nth(1).filter(|digits| is_commit(digits))?;
    Some((digits.to_owned(), text.contains("\"dirty\": true")))
}

/// Returns the commit of the clone that holds this crate, and true if tracked files differ from the commit.
///
/// Returns `None` in the clone of another project, for example of a project that vendors this crate.
fn of_clone(crate_folder: &Path) -> Option<(String, bool)> {
    let root = crate_folder.parent()?.parent()?;
    let top = PathBuf::from(git(crate_folder, &["rev-parse", "--show-toplevel"])?);
    if top.canonicalize().ok()? != root.canonicalize().ok()? {
        return None;
    }
    // The script runs again after a commit and after a change of a source. Cargo then compiles the command anyway.
    for file in ["HEAD", "logs/HEAD"] {
        watch(&crate_folder.join(git(crate_folder, &["rev-parse", "--git-path", file])?));
    }
    watch(&root.join("src"));
    let crates = fs::read_dir(root.join("crates")).ok()?;
    crates.flatten().for_each(|entry| watch(&entry.path().join("src")));
    let digits = git(crate_folder, &["rev-parse", "HEAD"]).filter(|digits| is_commit(digits))?;
    let changes = git(crate_folder, &["status", "--porcelain", "--untracked-files=no"])?;
    Some((digits, !changes.is_empty()))
}

/// Makes Cargo run the script again when a file or folder changes. A missing path would make the script run at every
/// build.
fn watch(path: &Path) {
    if path.exists() {
        println!("cargo:rerun-if-changed={}", path.display());
    }
}

fn is_commit(text: &str) -> bool {
    text.len() >= SHORT && text.bytes().all(|digit| digit.is_ascii_hexdigit())
}

/// Returns the output of a Git command without the final line break. Returns `None` if Git is missing or fails.
fn git(folder: &Path, args: &[&str]) -> Option<String> {
    let output = Command::new("git").args(args).current_dir(folder).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim_end().to_owned())
}
