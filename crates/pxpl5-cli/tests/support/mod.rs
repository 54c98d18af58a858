//! Support for tests that run the command in a folder of its own.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// A temporary folder, which is removed when the value is dropped.
pub(crate) struct Folder {
    pub(crate) path: PathBuf,
    _removed: TempDir,
}

impl Folder {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().expect("the temporary directory can be written");
        Self { path: folder.path().to_owned(), _removed: folder }
    }

    pub(crate) fn file(&self, name: &str, contents: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path.join(name);
        std::fs::write(&path, contents).expect("the temporary directory can be written");
        path
    }

    /// Returns the sorted names of all entries of the folder.
    pub(crate) fn names(&self) -> Vec<String> {
        names(&self.path)
    }

    pub(crate) fn run(&self, args: &[&str]) -> Output {
        command(args).current_dir(&self.path).output().expect("the command starts")
    }
}

/// Splits a command line into words, and keeps quoted words together.
pub(crate) fn words(line: &str) -> Vec<String> {
    let parts = line.split('"').enumerate();
    let words = parts.flat_map(|(n, part)| match n % 2 {
        0 => part.split_whitespace().map(str::to_owned).collect(),
        _ => vec![part.to_owned()],
    });
    words.collect()
}

pub(crate) fn names(path: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(path).expect("a folder");
    let mut names: Vec<_> = entries.map(|e| e.expect("entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

pub(crate) fn command(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pxpl5"));
    command.args(args);
    command
}

pub(crate) fn out(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

pub(crate) fn err(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Returns the JSON object that a command printed as its whole standard output.
pub(crate) fn json(output: &Output) -> serde_json::Value {
    assert!(output.status.success(), "{}", err(output));
    serde_json::from_slice(&output.stdout).expect("one JSON object on standard output")
}
