//! Tests of all readers of user input with damaged files: a corpus in tests/corpus, and mutations of its files.
//!
//! Damaged input must not cause a panic or an endless loop. Accepted input must be valid, and must be the same value
//! after it was written and read again. A mutation follows from a number, which a failure states. `PXPL5_FUZZ=100` runs
//! a hundred times as many mutations, and `PXPL5_FUZZ_FROM` starts at another number.

use i860::vectors;
use pxpl5::scene::{Format, Scene, from_bytes};
use pxpl5::sweep::Sweep;
use pxpl5::tracking::motion::{Motion, Recording};
use pxpl5::{Experiment, ExperimentError, ExperimentFile, MachineConfig, Pixels, Slats};
use std::fs;
use std::path::{Path, PathBuf};

/// Returns the files with the given extension in a folder below tests/corpus, or elsewhere in the repository.
fn corpus(folder: &str, extension: Option<&str>) -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    let extension_of = |path: &Path| path.extension().unwrap_or_default().to_string_lossy().into_owned();
    let wanted = paths.into_iter().filter(|path| extension.is_none_or(|wanted| extension_of(path) == wanted));
    let files: Vec<_> = wanted.map(|path| (extension_of(&path), fs::read(&path).expect("it can be read"))).collect();
    assert!(!files.is_empty(), "{}", folder.display());
    files
}

/// SplitMix64, a pseudo-random number generator.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ z >> 31
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

/// Words that are likely to cause trouble in some format.
const WORDS: &str = "null 1e999 [] nan inf -inf -1 0 1e308 1e-320 3e-162 4294967296 18446744073709551615 \
    9223372036854775807 1000000000000 65536 \u{feff} \r \n \0 \" [[ { } = , .rept\u{a0}99999999\n \\x\\x .. \u{e9} #";

fn word(numbers: &mut Numbers) -> std::vec::IntoIter<u8> {
    let words: Vec<&str> = WORDS.split(' ').collect();
    words[numbers.below(words.len())].replace('\u{a0}', " ").into_bytes().into_iter()
}

fn noise(most: usize, numbers: &mut Numbers) -> Vec<u8> {
    (0..numbers.below(most)).map(|_| numbers.next() as u8).collect()
}

/// Returns a copy of a file with one to six random mutations. One file in 32 is noise before its mutations.
fn damaged(file: &[u8], others: &[(String, Vec<u8>)], numbers: &mut Numbers) -> Vec<u8> {
    let mut bytes = if numbers.below(32) == 0 { noise(400, numbers) } else { file.to_vec() };
    for _ in 0..=numbers.below(6) {
        let at = numbers.below(bytes.len() + 1);
        let end = (at + numbers.below(40)).min(bytes.len());
        match numbers.below(9) {
            0 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte ^= 1 << numbers.below(8)),
            1 => drop(bytes.splice(at..end, [])),
            2 => drop(bytes.splice(at..at, word(numbers))),
            3 => drop(bytes.splice(at..end, word(numbers))),
            4 => bytes.extend_from_within(at..end),
            5 => bytes.truncate(at.max(bytes.len() / 2)),
            6 => bytes.truncate(at),
            7 => drop(bytes.splice(at..end, noise(8, numbers))),
            _ => {
                let other = &others[numbers.below(others.len())].1;
                let from = numbers.below(other.len());
                let piece = other[from..(from + 60).min(other.len())].to_vec();
                drop(bytes.splice(at..end, piece));
            }
        }
    }
    bytes
}

fn setting(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(otherwise)
}

/// Passes `rounds` mutated files of a corpus to a reader, and then all files unchanged. The reader returns true if it
/// accepted the input.
fn try_all(files: &[(String, Vec<u8>)], rounds: u64, mut read: impl FnMut(&str, &[u8]) -> bool) {
    let mut accepted = 0;
    let first = setting("PXPL5_FUZZ_FROM", 0);
    let rounds = rounds * setting("PXPL5_FUZZ", 1);
    for round in first..first + rounds {
        let mut numbers = Numbers(round << 8);
        let (extension, file) = &files[numbers.below(files.len())];
        let bytes = damaged(file, files, &mut numbers);
        // If the reader panics, the drop of this guard prints the input.
        let _printer = PrintedOnPanic(round, &bytes);
        accepted += u64::from(read(extension, &bytes));
    }
    println!("{accepted} of {rounds} were accepted");
    assert!(files.iter().any(|(extension, file)| read(extension, file)), "the corpus itself is read");
}

/// A guard that prints the round and its input if a panic drops it.
struct PrintedOnPanic<'a>(u64, &'a [u8]);

impl Drop for PrintedOnPanic<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("PXPL5_FUZZ_FROM={}: {:?}", self.0, String::from_utf8_lossy(self.1));
        }
    }
}

#[test]
fn damaged_models_are_refused_or_give_a_valid_scene() {
    let files = corpus("tests/corpus/models", None);
    let is_read = |extension: &str, bytes: &[u8]| {
        let format = Format::of_extension(extension).expect("of the corpus");
        let Ok(scene) = from_bytes(bytes, format, "damaged") else { return false };
        assert!(scene.primitives() > 0);
        Scene::new(scene.into_parts()).expect("a reader's scene is sound");
        true
    };
    try_all(&files, 50_000, is_read);
    files.iter().for_each(|(extension, bytes)| assert!(is_read(extension, bytes), "{extension}"));
}

fn experiment(bytes: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else { return false };
    let Ok(file) = ExperimentFile::parse(text, "damaged") else { return false };
    let Ok(plan) = file.resolve() else { return false };
    let printed = plan.settings().to_string();
    let again = ExperimentFile::parse(&printed, "printed").and_then(|file| file.resolve());
    assert!(again.unwrap_or_else(|error| panic!("{error}: {printed}")) == plan, "{printed}");
    true
}

#[test]
fn damaged_experiments_are_refused_or_can_be_read() {
    let mut files = corpus("tests/corpus/experiments", None);
    files.extend(corpus("../../experiments", Some("toml")));
    try_all(&files, 4_000, |_, bytes| experiment(bytes));
}

#[test]
fn damaged_sweeps_are_refused_or_give_valid_points() {
    let mut files = corpus("tests/corpus/sweeps", None);
    files.extend(
        corpus("../../experiments", Some("toml"))
            .into_iter()
            .filter(|(_, file)| std::str::from_utf8(file).is_ok_and(|text| text.contains("[sweep"))),
    );
    try_all(&files, 4_000, |_, bytes| {
        let Ok(text) = std::str::from_utf8(bytes) else { return false };
        let Ok(sweep) = ExperimentFile::parse(text, "damaged").and_then(Sweep::new) else { return false };
        let points = sweep.space().points();
        for point in [0, points / 2, points - 1] {
            let given: usize = sweep.space().axes().iter().map(|axis| axis.paths.len()).sum();
            assert_eq!(sweep.space().settings(point).len(), given);
            drop(sweep.plan(point));
        }
        true
    });
}

#[test]
fn damaged_recordings_are_refused_or_give_finite_poses() {
    try_all(&corpus("tests/corpus/recordings", None), 20_000, |_, bytes| {
        let Ok(recording) = Recording::read(bytes) else { return false };
        let (first, last) = recording.span_ps();
        for t_ps in [0, first, first + (last - first) / 3, last, last.saturating_add(1)] {
            let pose = recording.pose(t_ps);
            assert!(pose.position.is_finite() && (pose.orientation.length() - 1.0).abs() < 1e-9, "{pose:?}");
            assert!(recording.velocity(t_ps).is_finite() && recording.angular_velocity(t_ps).is_finite());
        }
        true
    });
}

#[test]
fn damaged_assembler_sources_are_refused_or_give_a_program() {
    try_all(&corpus("tests/corpus/assembler", None), 1_000, |_, bytes| {
        let Ok(program) = i860::assemble("damaged.s", 0x1000, &String::from_utf8_lossy(bytes)) else { return false };
        // A word that is not an instruction disassembles as data, so that any program can be written and read again.
        let text: String = program.words().iter().map(|word| format!(".long {word:#x}\n")).collect();
        assert_eq!(i860::assemble("again.s", 0x1000, &text).expect("data").words(), program.words());
        true
    });
}

#[test]
fn damaged_conformance_vectors_are_refused_or_counted() {
    try_all(&corpus("tests/corpus/vectors", None), 4_000, |_, bytes| {
        let Ok(list) = vectors::parse(&String::from_utf8_lossy(bytes)) else { return false };
        let summary = vectors::run(&list, i860::Config::cycle());
        assert_eq!(summary.passed + summary.failed(), list.len());
        true
    });
}

/// Tests that accepted settings run. Small machines with parameters from anywhere within their limits must end their
/// run and report results.
#[test]
fn machines_of_any_numbers_run_or_are_refused() {
    let parameters = MachineConfig::small_hmd().parameters();
    let rounds = 60 * setting("PXPL5_FUZZ", 1);
    let first = setting("PXPL5_FUZZ_FROM", 0);
    let mut ran = 0;
    for round in first..first + rounds {
        let mut numbers = Numbers(round << 8 | 1);
        let mut config = MachineConfig::small_hmd();
        let mut changed = Vec::new();
        for _ in 0..=numbers.below(3) {
            let parameter = &parameters[numbers.below(parameters.len())];
            let (Some(least), Some(most)) = (parameter.info.limits.0.whole(), parameter.info.limits.1.whole()) else {
                continue;
            };
            // All sizes are equally likely.
            let size = numbers.below(41) as u32;
            let value = (numbers.next() >> (63 - size.min(63))).clamp(least, most);
            if config.set(&parameter.path, value).is_ok() {
                changed.push(format!("{}={value}", parameter.path));
            }
        }
        let settings = changed.join(" ");
        let _printer = PrintedOnPanic(round, settings.as_bytes());
        if first > 0 {
            // Output before the run identifies the input if the run does not end.
            println!("{round}: {settings}");
        }
        if config.check().is_ok() {
            let scene = pxpl5::scene::builtin("full-screen:6").expect("built in");
            let experiment = Experiment::new(config, Slats::split(), scene).fields(16).pixels(Pixels::Off);
            // Some parameters allow no picture in time, which is a valid result.
            ran += u64::from(matches!(experiment.run(), Ok(_) | Err(ExperimentError::TooShort { .. })));
        }
    }
    println!("{ran} of {rounds} ran");
    assert!(ran > rounds / 4, "{ran} of {rounds} ran");
}
