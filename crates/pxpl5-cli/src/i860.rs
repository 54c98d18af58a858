//! `pxpl5 i860`: assemble, disassemble, run with a cycle listing, and conformance vectors.

use ::i860::{AddressProfile, Config, Cpu, Outcome, Program, Ram, assemble, disassemble, vectors};
use clap::{Args, Subcommand};
use flate2::read::MultiGzDecoder;
use std::fmt::Write as _;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Work with programs of the graphics processor's CPU.
#[derive(Args, Debug)]
pub(crate) struct I860Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Debug)]
enum Command {
    /// Assemble a source file and list words, addresses and source lines.
    Asm {
        /// Assembler source.
        file: PathBuf,
        /// Address of the first byte.
        #[arg(long, default_value = "0x1000", value_parser = address)]
        base: u32,
        /// Write the bytes to this file instead of listing them.
        #[arg(short, long)]
        output: Option<PathBuf>,
    },
    /// Disassemble a file of little-endian words.
    Disasm {
        /// Binary file.
        file: PathBuf,
        /// Address of the first byte.
        #[arg(long, default_value = "0x1000", value_parser = address)]
        base: u32,
    },
    /// Assemble (FILE.s) or load (anything else) and run; list clocks by address and by cause.
    Run {
        /// Assembler source ending in .s, or a binary file.
        file: PathBuf,
        /// Address of the first byte.
        #[arg(long, default_value = "0x1000", value_parser = address)]
        base: u32,
        /// Where to begin: a label or an address; default: label `start`, or the first byte.
        #[arg(long)]
        entry: Option<String>,
        /// Where to stop: a label or an address; default: label `end`, or the end of the file.
        #[arg(long)]
        stop: Option<String>,
        /// Most instructions to execute.
        #[arg(long, default_value_t = 10_000_000)]
        budget: u64,
        /// Bytes of memory from address 0.
        #[arg(long, default_value = "0x800000", value_parser = address)]
        memory: u32,
        /// Leave out the listing by address.
        #[arg(long)]
        quiet: bool,
    },
    /// Run a file of conformance vectors (JSON lines, perhaps gzip-compressed).
    Vectors {
        /// FILE.jsonl or FILE.jsonl.gz.
        file: PathBuf,
        /// Report as one JSON object.
        #[arg(long)]
        json: bool,
        /// How many failures to show.
        #[arg(long, default_value_t = 10)]
        show: usize,
    },
}

fn address(text: &str) -> Result<u32, String> {
    let lower = text.to_ascii_lowercase();
    let parsed = match lower.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16),
        None => lower.parse(),
    };
    parsed.map_err(|_| format!("expected a 32-bit address such as 0x1000, found `{text}`"))
}

/// Runs the command.
///
/// # Errors
/// What to tell the user before a non-zero exit.
pub(crate) fn run(args: I860Args) -> Result<(), String> {
    match args.command {
        Command::Asm { file, base, output } => asm(&file, base, output.as_deref()),
        Command::Disasm { file, base } => {
            print(&listing(base, &words_of(&read(&file)?), None));
            Ok(())
        }
        Command::Run { file, base, entry, stop, budget, memory, quiet } => {
            let program = load(&file, base)?;
            let options = RunOptions { entry, stop, budget, memory, quiet };
            let (report, result) = execute(&program, &options)?;
            print(&report);
            result
        }
        Command::Vectors { file, json, show } => {
            let (report, failed) = check_vectors(&file, json, show)?;
            print(&report);
            if failed == 0 { Ok(()) } else { Err(format!("{failed} vectors failed")) }
        }
    }
}

fn print(text: &str) {
    use std::io::Write;
    // A closed pipe (`| head`) is no fault.
    let _ = std::io::stdout().lock().write_all(text.as_bytes());
}

fn read(file: &Path) -> Result<Vec<u8>, String> {
    std::fs::read(file).map_err(|e| format!("{}: {e}", file.display()))
}

fn text_of(file: &Path, bytes: Vec<u8>) -> Result<String, String> {
    String::from_utf8(bytes).map_err(|e| format!("{}: not UTF-8 text: {e}", file.display()))
}

fn assembled(file: &Path, base: u32) -> Result<Program, String> {
    let source = text_of(file, read(file)?)?;
    assemble(&file.display().to_string(), base, &source).map_err(|e| e.to_string())
}

fn asm(file: &Path, base: u32, output: Option<&Path>) -> Result<(), String> {
    let program = assembled(file, base)?;
    match output {
        Some(path) => std::fs::write(path, &program.bytes).map_err(|e| format!("{}: {e}", path.display())),
        None => {
            print(&listing(base, &program.words(), Some(&program)));
            Ok(())
        }
    }
}

fn words_of(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks(4).map(word_of).collect()
}

/// A word of up to four bytes, the lowest first; missing ones are 0.
fn word_of(bytes: &[u8]) -> u32 {
    (0..4).map(|n| u32::from(bytes.get(n).copied().unwrap_or(0)) << (8 * n)).sum()
}

fn labels_at(program: Option<&Program>, pc: u32) -> String {
    let labels = program.map_or(&[][..], |p| &p.labels);
    labels.iter().filter(|(_, at)| *at == pc).map(|(name, _)| format!("{name}:\n")).collect()
}

fn listing(base: u32, words: &[u32], program: Option<&Program>) -> String {
    let mut text = String::new();
    for (n, word) in (0..).zip(words) {
        let pc = base.wrapping_add(4 * n);
        let _ = writeln!(text, "{}{pc:08x}  {word:08x}  {}", labels_at(program, pc), disassemble(*word, pc));
    }
    text
}

fn load(file: &Path, base: u32) -> Result<Program, String> {
    if file.extension().is_some_and(|e| e == "s") {
        return assembled(file, base);
    }
    let bytes = read(file)?;
    Ok(Program { base, bytes, symbols: Default::default(), labels: Vec::new(), lines: Vec::new() })
}

struct RunOptions {
    entry: Option<String>,
    stop: Option<String>,
    budget: u64,
    memory: u32,
    quiet: bool,
}

/// An option's label or address, else a default label, else a default address.
fn place(program: &Program, option: Option<&str>, label: &str, otherwise: u32) -> Result<u32, String> {
    match option {
        None => Ok(program.symbol(label).unwrap_or(otherwise)),
        Some(text) => program.symbol(text).map_or_else(|| address(text), Ok),
    }
}

/// Runs a program; gives the listing, and whether the run came to its stop.
fn execute(program: &Program, options: &RunOptions) -> Result<(String, Result<(), String>), String> {
    let mut ram = Ram::new(0, options.memory as usize);
    let size = program.bytes.len();
    ram.load(program.base, &program.bytes)
        .map_err(|_| format!("{size} bytes at {:#x} do not fit {:#x} bytes of memory", program.base, options.memory))?;
    let end = program.base.wrapping_add(size as u32);
    let stop = place(program, options.stop.as_deref(), "end", end)?;
    let mut cpu = Cpu::at(Config::cycle(), place(program, options.entry.as_deref(), "start", program.base)?);
    cpu.watch(Some(AddressProfile::new(program.base, size.div_ceil(4))));
    let outcome = cpu.run(&mut ram, Some(stop), options.budget);
    let mut report = if options.quiet { String::new() } else { cycle_listing(program, &cpu) };
    report.push_str(&label_listing(program, &cpu));
    let _ = writeln!(report, "{}", cpu.profile());
    let result = match outcome {
        Outcome::Stopped => Ok(()),
        Outcome::Trapped(trap) => Err(trap.to_string()),
        Outcome::Exhausted => Err(format!("not at {stop:#x} after {} instructions", cpu.instructions())),
    };
    Ok((report, result))
}

/// Clocks between each label and the next.
fn label_listing(program: &Program, cpu: &Cpu) -> String {
    let labels: Vec<(&str, u32)> = program.labels.iter().map(|(name, at)| (name.as_str(), *at)).collect();
    let by_label = cpu.watched().map(|w| w.by_label(&labels)).unwrap_or_default();
    let visited = by_label.into_iter().filter(|(_, clocks)| *clocks != 0);
    visited.map(|(name, clocks)| format!("{clocks:>12}  clocks by label: {name}\n")).collect()
}

fn cycle_listing(program: &Program, cpu: &Cpu) -> String {
    let mut text = String::from("     visits      clocks  address   word      instruction\n");
    for (n, word) in program.words().iter().enumerate() {
        let pc = program.base.wrapping_add(4 * n as u32);
        let (clocks, visits) = cpu.watched().map_or((0, 0), |w| w.at(pc));
        let labels = labels_at(Some(program), pc);
        let _ = writeln!(text, "{labels}{visits:>11} {clocks:>11}  {pc:08x}  {word:08x}  {}", disassemble(*word, pc));
    }
    text
}

/// Runs a file of vectors; gives the report and the number that failed.
fn check_vectors(file: &Path, json: bool, show: usize) -> Result<(String, usize), String> {
    let text = text_of(file, unpacked(file, read(file)?)?)?;
    let list = vectors::parse(&text).map_err(|e| format!("{}: {e}", file.display()))?;
    let summary = vectors::run(&list, Config::cycle());
    let report = if json { json_report(&summary, show) } else { plain_report(&summary, show) };
    Ok((report, summary.failed()))
}

/// The file's contents; gzip is known by its first two bytes.
fn unpacked(file: &Path, bytes: Vec<u8>) -> Result<Vec<u8>, String> {
    if !bytes.starts_with(&[0x1F, 0x8B]) {
        return Ok(bytes);
    }
    let mut plain = Vec::new();
    let result = MultiGzDecoder::new(bytes.as_slice()).read_to_end(&mut plain);
    result.map(|_| plain).map_err(|e| format!("{}: gzip: {e}", file.display()))
}

fn plain_report(summary: &vectors::Summary, show: usize) -> String {
    let mut text = format!("passed {}\nfailed {}\n", summary.passed, summary.failed());
    for (id, what, failure) in summary.failures.iter().take(show) {
        let _ = writeln!(text, "{id} ({what}): {failure}");
    }
    text
}

fn json_report(summary: &vectors::Summary, show: usize) -> String {
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
    fn vectors_that_fail_are_counted_and_shown_with_both_values() {
        let path = file("two.jsonl", &format!("{}\n\n{}\n", vector("00000005"), vector("00000006")));
        let (report, failed) = check_vectors(&path, false, 10).expect("well-formed");
        assert_eq!(failed, 1);
        assert_eq!(report, "passed 1\nfailed 1\na (adds): r4: expected 00000006, found 00000005\n");
        let (json, _) = check_vectors(&path, true, 10).expect("well-formed");
        let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        assert_eq!((&json["passed"], &json["failures"][0]["differences"][0]["found"]), (&1.into(), &"00000005".into()));
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
        let options = RunOptions { entry: None, stop: None, budget: 100, memory: 0x2000, quiet: false };
        let (report, result) = execute(&program, &options).expect("fits");
        assert_eq!(result, Ok(()));
        assert!(report.contains("          3           3  00001004  94a5ffff  adds -1, r5, r5"), "{report}");
        let short = RunOptions { budget: 2, ..options };
        assert!(execute(&program, &short).expect("fits").1.is_err());
    }

    #[test]
    fn an_address_that_is_none_is_refused() {
        assert_eq!(address("0x1F"), Ok(31));
        assert!(address("end").is_err() && address("0x1_0000_0000").is_err());
    }
}
