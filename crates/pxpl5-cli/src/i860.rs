//! The command `pxpl5 i860`: assembler, disassembler, execution with a cycle listing, and conformance vectors.

mod run;

use crate::error::CliError;
use crate::output::OutputFile;
use crate::terminal::{print, warn};
use ::i860::{Config, Program, Rule, assemble, disassemble, vectors};
use clap::{Args, Subcommand};
use flate2::read::MultiGzDecoder;
use run::{RunOptions, address, execute};
use std::fmt::Write as _;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Assemble, disassemble and run programs of the graphics processor's CPU.
#[derive(Args, Debug)]
pub(crate) struct I860Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Assemble a source file, and list words, addresses and source lines.
    Asm {
        /// Assembler source.
        file: PathBuf,
        /// Address at which the first byte of the program lies.
        #[arg(long, default_value = "0x1000", value_parser = address)]
        base: u32,
        /// Write the bytes to this file instead of listing them.
        #[arg(short, long)]
        output: Option<PathBuf>,
        #[command(flatten)]
        warnings: Warnings,
    },
    /// Disassemble a file of little-endian words.
    Disasm {
        /// Binary file.
        file: PathBuf,
        /// Address at which the first byte of the program lies.
        #[arg(long, default_value = "0x1000", value_parser = address)]
        base: u32,
    },
    /// Assemble (FILE.s) or load (any other file) a program and run it. Print the clocks by address and by cause, the
    /// registers, and the memory.
    ///
    /// A place is a label of the program, an address, or a label with an offset such as table+8.
    Run {
        /// Assembler source ending in .s, or a binary file.
        file: PathBuf,
        /// Address at which the first byte of the program lies.
        #[arg(long, default_value = "0x1000", value_parser = address)]
        base: u32,
        #[command(flatten)]
        options: RunOptions,
        #[command(flatten)]
        warnings: Warnings,
    },
    /// Run a file of conformance vectors (JSON lines, optionally gzip-compressed).
    Vectors {
        /// File of vectors: FILE.jsonl or FILE.jsonl.gz.
        file: PathBuf,
        /// Print the report as one JSON object.
        #[arg(long)]
        json: bool,
        /// Maximum number of failures to show.
        #[arg(long, default_value_t = 10)]
        show: usize,
    },
}

/// Options that disable warnings of the assembler.
#[derive(Args, Debug, Default)]
struct Warnings {
    /// Disable these warnings of the assembler, separated by commas; may be repeated.
    #[arg(long, value_name = "RULE", value_delimiter = ',', value_parser = ["all", "alignment", "multiply-source", "lost-result"])]
    allow: Vec<String>,
}

impl Warnings {
    fn print(&self, program: &Program) {
        let is_allowed = |rule: Rule| self.allow.iter().any(|name| name == "all" || name == rule.name());
        let warnings: Vec<String> =
            program.warnings.iter().filter(|warning| !is_allowed(warning.rule)).map(ToString::to_string).collect();
        warn(&warnings, false);
    }
}

pub(crate) fn run(args: I860Args) -> Result<(), CliError> {
    match args.command {
        Command::Asm { file, base, output, warnings } => asm(&file, base, output.as_deref(), &warnings),
        Command::Disasm { file, base } => print(&listing(base, &words_of(&read(&file).map_err(CliError::usage)?))),
        Command::Run { file, base, options, warnings } => {
            let program = load(&file, base).map_err(CliError::usage)?;
            warnings.print(&program);
            let (report, result) = execute(&program, &options).map_err(CliError::failure)?;
            // The report is printed even if the program did not reach its end.
            print(&report)?;
            result.map_err(CliError::failure)
        }
        Command::Vectors { file, json, show } => {
            let (report, failed) = check_vectors(&file, json, show).map_err(CliError::usage)?;
            print(&report)?;
            if failed == 0 { Ok(()) } else { Err(CliError::failure(format!("{failed} vectors failed"))) }
        }
    }
}

fn read(file: &Path) -> Result<Vec<u8>, String> {
    std::fs::read(file).map_err(|e| format!("{}: {e}", file.display()))
}

fn text_of(file: &Path, bytes: Vec<u8>) -> Result<String, String> {
    let text = pxpl5_sim::parameters::text_of(&bytes).map_err(|error| format!("{}: {error}", file.display()))?;
    Ok(text.to_owned())
}

/// Assembles a file. Returns the program and the source text. Comments in the source text may have any text encoding.
fn assembled(file: &Path, base: u32) -> Result<(Program, String), String> {
    let source = String::from_utf8_lossy(&read(file)?).into_owned();
    let program = assemble(&file.display().to_string(), base, &source).map_err(|e| e.to_string())?;
    Ok((program, source))
}

fn asm(file: &Path, base: u32, output: Option<&Path>, warnings: &Warnings) -> Result<(), CliError> {
    let (program, source) = assembled(file, base).map_err(CliError::usage)?;
    warnings.print(&program);
    match output {
        Some(path) => OutputFile::open(path, "-o")?.write(&program.bytes),
        None => print(&program.listing(Some(&source))),
    }
}

fn words_of(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks(4).map(word_of).collect()
}

/// Returns a little-endian word of up to four bytes. Missing bytes are 0.
fn word_of(bytes: &[u8]) -> u32 {
    (0..4).map(|n| u32::from(bytes.get(n).copied().unwrap_or(0)) << (8 * n)).sum()
}

fn listing(base: u32, words: &[u32]) -> String {
    let mut text = String::new();
    for (n, word) in (0..).zip(words) {
        let pc = base.wrapping_add(4 * n);
        let _ = writeln!(text, "{pc:08x}  {word:08x}  {}", disassemble(*word, pc));
    }
    text
}

fn load(file: &Path, base: u32) -> Result<Program, String> {
    if file.extension().is_some_and(|e| e == "s") {
        return assembled(file, base).map(|(program, _)| program);
    }
    Ok(Program::of_bytes(base, read(file)?))
}

/// Executes the conformance vectors of a file. Returns the report and the number of failed vectors.
fn check_vectors(file: &Path, json: bool, show: usize) -> Result<(String, usize), String> {
    let text = text_of(file, unpacked(file, read(file)?, MAX_VECTOR_BYTES)?)?;
    let list = vectors::parse(&text).map_err(|e| format!("{}: {e}", file.display()))?;
    let summary = vectors::run(&list, Config::cycle());
    let report = if json { json_report(&summary, show) } else { plain_report(&summary, show) };
    Ok((report, summary.failed()))
}

/// Maximum unpacked size of a file of conformance vectors, in bytes. Assumed: about ten times the published set. The
/// limit guards against gzip bombs.
const MAX_VECTOR_BYTES: u64 = 256 << 20;

/// Returns the contents of a file, unpacked if the first two bytes are the gzip signature. Fails if the unpacked data
/// exceed `most` bytes.
fn unpacked(file: &Path, bytes: Vec<u8>, most: u64) -> Result<Vec<u8>, String> {
    if !bytes.starts_with(&[0x1F, 0x8B]) {
        return Ok(bytes);
    }
    let mut plain = Vec::new();
    // Read one byte more than allowed, so that an excess is noticed.
    let mut limited = MultiGzDecoder::new(bytes.as_slice()).take(most + 1);
    limited.read_to_end(&mut plain).map_err(|e| format!("{}: gzip: {e}", file.display()))?;
    if plain.len() as u64 > most {
        return Err(format!("{}: expected at most {most} bytes unpacked, found more", file.display()));
    }
    Ok(plain)
}

fn plain_report(summary: &vectors::VectorSummary, show: usize) -> String {
    let mut text = format!("passed {}\nfailed {}\n", summary.passed, summary.failed());
    for (id, what, failure) in summary.failures.iter().take(show) {
        let _ = writeln!(text, "{id} ({what}): {failure}");
    }
    text
}

fn json_report(summary: &vectors::VectorSummary, show: usize) -> String {
    let shown = summary.failures.iter().take(show);
    let failures: Vec<_> = shown.map(|(id, what, failure)| json_failure(id, what, failure)).collect();
    let report = serde_json::json!({
        "passed": summary.passed,
        "failed": summary.failed(),
        "failures": failures,
    });
    format!("{report:#}\n")
}

fn hex(bits: u32) -> String {
    format!("{bits:08x}")
}

fn json_failure(id: &str, what: &str, failure: &vectors::Failure) -> serde_json::Value {
    let differences: Vec<_> = match failure {
        vectors::Failure::Differs(list) => (list.iter())
            .map(|d| serde_json::json!({"place": d.place, "expected": hex(d.expected), "found": hex(d.found)}))
            .collect(),
        _ => Vec::new(),
    };
    serde_json::json!({"id": id, "what": what, "reason": failure.to_string(), "differences": differences})
}

#[cfg(test)]
mod tests {
    use super::*;

    const ADD: &str = r#"{"id":"a","group":"g","what":"adds","load":0,"code":["94840005","a0000000"],"entry":0,
        "stop":8,"expect":{"r":R,"f":Z}}"#;

    fn vector(r4: &str) -> String {
        let zero = vec!["00000000"; 32];
        let mut r = zero.clone();
        r[4] = r4;
        ADD.replace('\n', "").replace('R', &format!("{r:?}")).replace('Z', &format!("{zero:?}"))
    }

    fn file(name: &str, text: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("pxpl5-{}-{name}", std::process::id()));
        std::fs::write(&path, text).expect("the temporary directory can be written");
        path
    }

    #[test]
    fn failed_vectors_are_counted_and_shown_with_the_expected_and_found_values() {
        let path = file("two.jsonl", &format!("{}\n\n{}\n", vector("00000005"), vector("00000006")));
        let (report, failed) = check_vectors(&path, false, 10).expect("well-formed");
        assert_eq!(failed, 1);
        assert_eq!(report, "passed 1\nfailed 1\na (adds): r4: expected 00000006, found 00000005\n");
        let (json, _) = check_vectors(&path, true, 10).expect("well-formed");
        let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        assert_eq!((&json["passed"], &json["failures"][0]["differences"][0]["found"]), (&1.into(), &"00000005".into()));
    }

    fn packed(empty_lines: usize) -> Vec<u8> {
        use std::io::Write;
        let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
        packer.write_all(&vec![b'\n'; empty_lines]).expect("memory can be written");
        packer.finish().expect("memory can be written")
    }

    #[test]
    fn a_gzip_bomb_of_vectors_is_refused() {
        let at = Path::new("v.gz");
        assert_eq!(unpacked(at, packed(1 << 20), 1 << 20).expect("not too much").len(), 1 << 20);
        let bomb = packed((1 << 20) + 1);
        assert!(bomb.len() < 2_000);
        let error = unpacked(at, bomb, 1 << 20).expect_err("too much");
        assert_eq!(error, "v.gz: expected at most 1048576 bytes unpacked, found more");
    }

    #[test]
    fn a_malformed_line_is_named_by_number() {
        let path = file("bad.jsonl", &format!("{}\n{{\"id\":3}}\n", vector("00000005")));
        let error = check_vectors(&path, false, 10).expect_err("line 2 is no vector");
        assert!(error.contains("line 2: not a vector"), "{error}");
    }

    #[test]
    fn a_run_lists_clocks_by_address_and_stops_at_its_end() {
        let path = file("loop.s", "start: mov 3, r5\nloop: adds -1, r5, r5\nbtne r0, r5, loop\nend: nop");
        let program = load(&path, 0x1000).expect("correct");
        let options = options();
        let (report, result) = execute(&program, &options).expect("fits");
        assert_eq!(result, Ok(()));
        assert!(report.contains("          3           3  00001004  94a5ffff  adds -1, r5, r5"), "{report}");
        let short = RunOptions { budget: 2, ..options };
        assert!(execute(&program, &short).expect("fits").1.is_err());
    }

    fn options() -> RunOptions {
        RunOptions { entry: None, stop: None, budget: 100, memory: 0x2000, show: Vec::new(), json: false, quiet: false }
    }

    /// An i860 program that stores the number 7 in the second word of a table. The table follows the code in memory.
    const STORE: &str = "start: mov 7, r5\nmov table, r6\nst.l r5, 4(r6)\nend: nop\ntable: .long 1, 2, 3";

    #[test]
    fn a_run_prints_registers_and_changed_memory_by_label() {
        let program = load(&file("store.s", STORE), 0x1000).expect("correct");
        let table = program.symbol("table").expect("a label");
        let (text, result) = execute(&program, &options()).expect("fits");
        assert_eq!(result, Ok(()));
        assert!(text.contains("r5  00000007") && text.contains(&format!("r6  {table:08x}")), "{text}");
        assert!(text.contains(&format!("{:08x}  00000007", table + 4)) && text.contains("table+0x4"), "{text}");
        let shown = RunOptions { show: vec!["table:3".to_owned(), "table+8".to_owned()], ..options() };
        let (text, _) = execute(&program, &shown).expect("fits");
        assert!(text.contains("00000001 00000007 00000003"), "{text}");
    }

    #[test]
    fn a_run_as_json_has_registers_memory_and_labels() {
        let program = load(&file("json.s", STORE), 0x1000).expect("correct");
        let (text, _) = execute(&program, &RunOptions { json: true, ..options() }).expect("fits");
        let run: serde_json::Value = serde_json::from_str(&text).expect("one object");
        assert_eq!(
            (&run["stopped"], &run["r"][5], &run["pc_label"]),
            (&true.into(), &"00000007".into(), &"end".into())
        );
        assert_eq!(run["memory"][0]["words"][0], "00000007");
        assert_eq!(run["memory"][0]["label"], "table+0x4");
        assert_eq!(run["labels"]["start"], "00001000");
    }

    /// Tests the example program of the guide, which computes 1 + 4 + 9 + 16 = 30.
    #[test]
    fn the_program_of_the_guide_gives_the_results_in_the_guide() {
        let page = include_str!("../../../docs/guide/assembler.md");
        let source = page.split_once("```i860\n").and_then(|(_, rest)| rest.split_once("```")).expect("a program").0;
        let program = load(&file("guide.s", source), 0x1000).expect("correct");
        let shown = RunOptions { show: vec!["result:1".to_owned()], json: true, budget: 1_000, ..options() };
        let (text, result) = execute(&program, &shown).expect("fits");
        assert_eq!(result, Ok(()));
        let run: serde_json::Value = serde_json::from_str(&text).expect("one object");
        assert_eq!((&run["memory"][0]["label"], &run["memory"][0]["words"][0]), (&"result".into(), &"0000001e".into()));
    }

    #[test]
    fn an_unknown_label_is_refused_with_the_known_labels() {
        let program = load(&file("labels.s", STORE), 0x1000).expect("correct");
        let wrong = RunOptions { stop: Some("ende".to_owned()), ..options() };
        let error = execute(&program, &wrong).expect_err("no label");
        assert!(error.contains("start, end, table") && error.contains("`ende`"), "{error}");
        for show in ["table:0", "table:x", "0x1ffc:2"] {
            let wrong = RunOptions { show: vec![show.to_owned()], ..options() };
            assert!(execute(&program, &wrong).is_err(), "{show}");
        }
    }

    #[test]
    fn an_invalid_address_is_refused() {
        assert_eq!(address("0x1F"), Ok(31));
        assert!(address("end").is_err() && address("0x1_0000_0000").is_err());
    }
}
