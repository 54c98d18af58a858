//! The command `pxpl5 i860 run`, which executes a program and prints clocks, registers and memory.

use ::i860::{AddressProfile, Config, Cpu, Program, Ram, RunEnd, disassemble};
use serde_json::{Value, json};
use std::fmt::Write as _;

#[derive(clap::Args, Debug)]
pub(super) struct RunOptions {
    /// First instruction: a label or an address; default: label `start`, or the first byte.
    #[arg(long)]
    pub(super) entry: Option<String>,
    /// Address at which the run stops: a label or an address; default: label `end`, or the end of the file.
    #[arg(long)]
    pub(super) stop: Option<String>,
    /// Maximum number of instructions to execute.
    #[arg(long, default_value_t = 10_000_000)]
    pub(super) budget: u64,
    /// Size of the memory in bytes, from address 0, at most 1 GiB.
    #[arg(long, default_value = "0x800000", value_parser = memory)]
    pub(super) memory: u32,
    /// Show the memory that begins at this place, PLACE or PLACE:WORDS; may be repeated; default: the words that
    /// the run changed.
    #[arg(long, value_name = "PLACE[:WORDS]")]
    pub(super) show: Vec<String>,
    /// Print one JSON object.
    #[arg(long)]
    pub(super) json: bool,
    /// Omit the listing by address.
    #[arg(long)]
    pub(super) quiet: bool,
}

const CHANGED_SHOWN: usize = 64;

struct Span {
    address: u32,
    words: Vec<u32>,
}

struct Run<'a> {
    program: &'a Program,
    cpu: Cpu,
    outcome: RunEnd,
    stop: u32,
    memory: Vec<Span>,
    /// Number of changed memory words that are not in the list, because the list is full.
    changed_besides: usize,
}

/// Executes a program and returns the report. The inner result is an error if the program did not reach its stop
/// address. The outer result is an error if the program does not fit in memory or an option is neither a label nor an
/// address.
pub(super) fn execute(program: &Program, options: &RunOptions) -> Result<(String, Result<(), String>), String> {
    let mut ram = Ram::new(0, options.memory as usize);
    let size = program.bytes.len();
    ram.load(program.base, &program.bytes)
        .map_err(|_| format!("{size} bytes at {:#x} do not fit {:#x} bytes of memory", program.base, options.memory))?;
    let end = program.base.wrapping_add(size as u32);
    // Resolve all places before the run, so that a wrong label is reported at once.
    let stop = place(program, options.stop.as_deref(), "end", end)?;
    let mut cpu = Cpu::at(Config::cycle(), place(program, options.entry.as_deref(), "start", program.base)?);
    let wanted = options.show.iter().map(|text| span(program, text)).collect::<Result<Vec<_>, _>>()?;
    let before = ram.clone();
    // Count the clocks of each instruction address.
    cpu.watch(Some(AddressProfile::new(program.base, size.div_ceil(4))));
    let outcome = cpu.run(&mut ram, Some(stop), options.budget);
    // Without --show, the report lists the words that the run changed.
    let (memory, changed_besides) = match wanted.is_empty() {
        true => changed(&before, &ram),
        false => (wanted.into_iter().map(|wanted| read(&ram, wanted)).collect::<Result<_, _>>()?, 0),
    };
    let run = Run { program, cpu, outcome, stop, memory, changed_besides };
    let text = if options.json { format!("{:#}\n", run.json()) } else { run.text(options.quiet) };
    Ok((text, run.result()))
}

/// Returns the address in `option`. Without an option, returns the address of the default label, or `otherwise` if the
/// program lacks this label.
fn place(program: &Program, option: Option<&str>, label: &str, otherwise: u32) -> Result<u32, String> {
    match option {
        None => Ok(program.symbol(label).unwrap_or(otherwise)),
        Some(text) => parse_address(program, text),
    }
}

/// Parses a label, an address, or a label with an offset in bytes, such as `table+8`.
fn parse_address(program: &Program, text: &str) -> Result<u32, String> {
    if let Some(at) = program.symbol(text) {
        return Ok(at);
    }
    if let Some((label, offset)) = text.split_once('+')
        && let Some(at) = program.symbol(label)
    {
        return Ok(at.wrapping_add(address(offset)?));
    }
    address(text).map_err(|_| {
        let labels: Vec<&str> = program.labels.iter().map(|(name, _)| name.as_str()).collect();
        let labels = if labels.is_empty() { "it has none".to_owned() } else { labels.join(", ") };
        format!("expected a label of the program ({labels}) or an address such as 0x1000, found `{text}`")
    })
}

/// Parses a memory range: `PLACE` or `PLACE:WORDS`. Returns the address of the range and the number of words.
fn span(program: &Program, text: &str) -> Result<(u32, usize), String> {
    let Some((at, words)) = text.rsplit_once(':') else { return Ok((parse_address(program, text)?, 1)) };
    let count = words.parse().ok().filter(|count| (1..=65_536).contains(count));
    let count = count.ok_or_else(|| format!("--show: expected 1 to 65536 words after the colon, found `{words}`"))?;
    Ok((parse_address(program, at)?, count))
}

fn read(ram: &Ram, (address, count): (u32, usize)) -> Result<Span, String> {
    let words = ram.words(address, count);
    let words = words.map_err(|_| format!("--show: {count} words at {address:#x} are not all in memory"))?;
    Ok(Span { address, words })
}

/// Returns the first [`CHANGED_SHOWN`] changed memory words, joined into ranges, and the number of the remaining
/// changed words.
fn changed(before: &Ram, after: &Ram) -> (Vec<Span>, usize) {
    let words = |ram: &'_ Ram| -> Vec<u32> {
        ram.bytes().chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
    };
    let all = words(before).into_iter().zip(words(after)).enumerate();
    // Compare whole words and join neighbours into spans.
    let different: Vec<(u32, u32)> =
        all.filter(|(_, (old, new))| old != new).map(|(n, (_, new))| (4 * n as u32, new)).collect();
    let mut spans: Vec<Span> = Vec::new();
    for &(address, word) in different.iter().take(CHANGED_SHOWN) {
        match spans.last_mut().filter(|span| span.address + 4 * span.words.len() as u32 == address) {
            Some(span) => span.words.push(word),
            None => spans.push(Span { address, words: vec![word] }),
        }
    }
    (spans, different.len().saturating_sub(CHANGED_SHOWN))
}

impl Run<'_> {
    fn result(&self) -> Result<(), String> {
        match &self.outcome {
            RunEnd::Stopped => Ok(()),
            RunEnd::Trapped(trap) => Err(format!("{trap}, at {}", self.named(self.cpu.state.pc))),
            RunEnd::Exhausted => {
                let instructions = self.cpu.instructions();
                Err(format!(
                    "not at {} after {instructions} instructions, but at {}",
                    self.named(self.stop),
                    self.named(self.cpu.state.pc)
                ))
            }
        }
    }

    fn named(&self, address: u32) -> String {
        label_of(self.program, address)
            .map_or_else(|| format!("{address:#x}"), |label| format!("{address:#x} ({label})"))
    }

    fn text(&self, quiet: bool) -> String {
        let mut text = if quiet { String::new() } else { cycle_listing(self.program, &self.cpu) };
        text.push_str(&self.label_listing());
        let _ = writeln!(text, "{}", self.cpu.profile());
        text.push_str(&self.registers());
        text.push_str(&self.memory_text());
        text
    }

    /// Returns each label of the program, with the clocks that the program spent between this label and the label after
    /// it.
    fn clocks_by_label(&self) -> Vec<(&str, u64)> {
        let labels: Vec<(&str, u32)> = self.program.labels.iter().map(|(name, at)| (name.as_str(), *at)).collect();
        let by_label = self.cpu.watched().map(|watched| watched.by_label(&labels)).unwrap_or_default();
        by_label.into_iter().filter(|(_, clocks)| *clocks != 0).collect()
    }

    fn label_listing(&self) -> String {
        let lines = self.clocks_by_label().into_iter();
        lines.map(|(name, clocks)| format!("{clocks:>12}  clocks by label: {name}\n")).collect()
    }

    fn registers(&self) -> String {
        let state = &self.cpu.state;
        let mut text = format!("\npc  {}\n", self.named(state.pc));
        for (name, file) in [('r', &state.r), ('f', &state.f)] {
            for (row, registers) in file.chunks(4).enumerate() {
                for (column, value) in registers.iter().enumerate() {
                    let register = format!("{name}{}", 4 * row + column);
                    let _ = write!(text, "{register:<4}{value:08x}  ");
                }
                text.truncate(text.trim_end().len());
                text.push('\n');
            }
        }
        let _ = writeln!(text, "psr {:08x}  epsr {:08x}  fsr {:08x}", state.psr, state.epsr, state.fsr);
        text
    }

    fn memory_text(&self) -> String {
        let mut text = String::from(if self.memory.is_empty() { "\nmemory: nothing changed\n" } else { "\nmemory\n" });
        for span in &self.memory {
            for (row, words) in span.words.chunks(4).enumerate() {
                let address = span.address + 16 * row as u32;
                let words: Vec<String> = words.iter().map(|word| format!("{word:08x}")).collect();
                let label = label_of(self.program, address).map_or_else(String::new, |label| format!("  {label}"));
                let _ = writeln!(text, "{address:08x}  {:<35}{label}", words.join(" "));
            }
        }
        if self.changed_besides > 0 {
            let _ = writeln!(text, "and {} more words; --show PLACE:WORDS shows any", self.changed_besides);
        }
        text
    }

    fn json(&self) -> Value {
        let state = &self.cpu.state;
        let profile = self.cpu.profile();
        let hex = |word: &u32| format!("{word:08x}");
        let words = |words: &[u32]| words.iter().map(hex).collect::<Vec<_>>();
        // Words of 32 bits are written as hexadecimal text.
        let memory = self.memory.iter().map(|span| {
            json!({
                "address": hex(&span.address),
                "label": label_of(self.program, span.address),
                "words": words(&span.words),
            })
        });
        let labels = self.program.labels.iter().map(|(name, at)| (name.clone(), json!(hex(at))));
        let by_label = self.clocks_by_label().into_iter().map(|(name, clocks)| (name.to_owned(), json!(clocks)));
        json!({
            "schema": "pxpl5-i860-run/1",
            "stopped": self.result().is_ok(),
            "reason": self.result().err(),
            "clocks": self.cpu.clocks(),
            "instructions": self.cpu.instructions(),
            "issue_clocks": profile.issue,
            "instruction_cache_misses": profile.instruction_misses,
            "data_cache_misses": profile.data_misses,
            "bus_requests": profile.bus_requests,
            "pc": hex(&state.pc),
            "pc_label": label_of(self.program, state.pc),
            "r": words(&state.r),
            "f": words(&state.f),
            "psr": hex(&state.psr),
            "epsr": hex(&state.epsr),
            "fsr": hex(&state.fsr),
            "memory": memory.collect::<Vec<_>>(),
            "changed_words_not_listed": self.changed_besides,
            "labels": labels.collect::<serde_json::Map<_, _>>(),
            "clocks_by_label": by_label.collect::<serde_json::Map<_, _>>(),
        })
    }
}

/// Returns the nearest label at or before an address of the program, with the distance from the label in bytes.
fn label_of(program: &Program, address: u32) -> Option<String> {
    let end = program.base.wrapping_add(program.bytes.len() as u32);
    if !(program.base..=end).contains(&address) {
        return None;
    }
    let before = program.labels.iter().filter(|(_, at)| *at <= address);
    let (name, at) = before.max_by_key(|(_, at)| *at)?;
    Some(if *at == address { name.clone() } else { format!("{name}+{:#x}", address - at) })
}

fn cycle_listing(program: &Program, cpu: &Cpu) -> String {
    let mut text = String::from("     visits      clocks  address   word      instruction\n");
    for (n, word) in program.words().iter().enumerate() {
        let pc = program.base.wrapping_add(4 * n as u32);
        let (clocks, visits) = cpu.watched().map_or((0, 0), |watched| watched.at(pc));
        let labels = labels_at(program, pc);
        let what = match program.data_at(pc) {
            Some(_) => format!(".long {word:#x}"),
            None => disassemble(*word, pc),
        };
        let _ = writeln!(text, "{labels}{visits:>11} {clocks:>11}  {pc:08x}  {word:08x}  {what}");
    }
    text
}

/// Parses the size of a memory: at most 1 GiB, because a run keeps a second copy of the memory.
fn memory(text: &str) -> Result<u32, String> {
    let most = 1 << 30;
    Some(address(text)?)
        .filter(|bytes| *bytes <= most)
        .ok_or_else(|| format!("expected at most {most:#x}, found `{text}`"))
}

/// Parses a 32-bit number, decimal or hexadecimal with `0x`.
pub(super) fn address(text: &str) -> Result<u32, String> {
    let lower = text.to_ascii_lowercase();
    let parsed = match lower.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16),
        None => lower.parse(),
    };
    parsed.map_err(|_| format!("expected a 32-bit address such as 0x1000, found `{text}`"))
}

pub(super) fn labels_at(program: &Program, pc: u32) -> String {
    program.labels.iter().filter(|(_, at)| *at == pc).map(|(name, _)| format!("{name}:\n")).collect()
}
