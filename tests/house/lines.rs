//! The lock: code lines of each crate, which may fall and not rise. A change that needs more room in one crate takes it from
//! another: its row of `tests/golden/lines.txt` is raised by hand, and the sum stays below [`LIMITS`].

use std::collections::BTreeMap;
use std::path::Path;

/// Upper limits of the sums of all crates: sources, and tests.
const LIMITS: [usize; 2] = [89_933, 44_244];

/// Returns the lines of a file that are neither blank nor only a comment: before its tests, and from its first
/// `#[cfg(test)]` on. In a file of tests, all lines are lines of tests.
pub(crate) fn count(text: &str, mut is_test: bool) -> [usize; 2] {
    let mut counts = [0; 2];
    for line in text.lines().map(str::trim) {
        is_test |= line.contains("#[cfg(test)]");
        counts[usize::from(is_test)] += usize::from(!line.is_empty() && !line.starts_with("//"));
    }
    counts
}

fn add(path: &Path, is_test: bool, counts: &mut [usize; 2]) {
    for path in std::fs::read_dir(path).into_iter().flatten().map(|entry| entry.expect("readable").path()) {
        if path.is_dir() {
            add(&path, is_test, counts);
        } else if path.extension().is_some_and(|end| end == "rs") {
            let text = std::fs::read_to_string(&path).expect("text");
            let [src, tests] = count(&text, is_test || path.ends_with("tests.rs"));
            *counts = [counts[0] + src, counts[1] + tests];
        }
    }
}

pub(crate) fn check() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let crates = std::fs::read_dir(root.join("crates")).expect("a folder").map(|entry| entry.expect("readable").path());
    let mut now: BTreeMap<String, [usize; 2]> = BTreeMap::new();
    for path in crates.chain([root.to_owned()]) {
        let name = if path == root { "pxpl5".into() } else { path.file_name().expect("a name").to_string_lossy() };
        let counts = now.entry(name.into_owned()).or_default();
        ["src", "tests"].into_iter().for_each(|folder| add(&path.join(folder), folder == "tests", counts));
    }
    let table = root.join("tests/golden/lines.txt");
    if std::env::var_os("PXPL5_UPDATE_HOUSE").is_some() {
        let rows = now.iter().map(|(name, [src, tests])| format!("{name:24}{src:8}{tests:8}\n"));
        std::fs::write(&table, rows.collect::<String>()).expect("it can be written");
    }
    let text = std::fs::read_to_string(&table).expect("the table");
    let mut sums = [0; 2];
    for row in text.lines().map(|row| row.split_whitespace().collect::<Vec<_>>()) {
        let allowed = [1, 2].map(|i| row[i].parse::<usize>().expect("a number"));
        let found = now.remove(row[0]).unwrap_or_default();
        assert!((0..2).all(|i| found[i] <= allowed[i]), "{}: {found:?} lines, the lock allows {allowed:?}", row[0]);
        sums = [sums[0] + allowed[0], sums[1] + allowed[1]];
    }
    assert!(now.is_empty(), "crates without a row: {now:?}");
    assert!((0..2).all(|i| sums[i] <= LIMITS[i]), "{sums:?} lines in all, at most {LIMITS:?}");
}

#[test]
fn comments_blank_lines_and_tests_are_told_from_code() {
    assert_eq!(count("//! About.\n\nfn a() {}\n    // why\n", false), [1, 0]);
    assert_eq!(count("fn a() {} // why\n#[cfg(test)]\nmod tests {\n}\n", false), [1, 3]);
    assert_eq!(count("fn a() {}\n", true), [0, 1]);
}
