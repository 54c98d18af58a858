//! Conformance vectors. A vector consists of a program, the memory before its run, and the expected state after its
//! run. A file of vectors has one JSON object per line.
//!
//! ```text
//! {"id","group","what","load","code":["hex32",...],"entry","stop",
//!  "mem":[[address,"hex32"],...],"expect":{"r":[32 hex],"f":[32 hex],"mem":[[address,"hex32"],...]}}
//! ```
//!
//! Every register starts at zero, and pc starts at `entry`. The run ends when pc is `stop` in single-instruction mode.

use crate::{Bus, Config, Cpu, RunEnd, Trap, Unmapped};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use std::fmt;

/// Largest number of instructions that the program of a vector may execute. A longer run fails. The actual programs
/// execute fewer than 1,000 instructions.
pub const BUDGET: u64 = 10_000;

/// One conformance vector: a program, the memory before its run, and the expected state after its run.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct TestVector {
    /// Identifier of the vector, unique in its file.
    pub id: String,
    /// Name of the group of vectors in the file to which this vector belongs.
    #[serde(default)]
    pub group: String,
    #[serde(default)]
    pub what: String,
    /// Address of the first word of `code`.
    pub load: u32,
    /// Instruction words, loaded into memory from address `load` on.
    #[serde(deserialize_with = "hex_list")]
    pub code: Vec<u32>,
    pub entry: u32,
    pub stop: u32,
    /// Addresses and words that are written to memory before the program runs.
    #[serde(default, deserialize_with = "hex_pairs")]
    pub mem: Vec<(u32, u32)>,
    pub expect: Expectation,
}

/// Expected registers and memory words after the program of a vector has run.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct Expectation {
    /// Expected integer registers, as bit patterns.
    #[serde(deserialize_with = "registers")]
    pub r: [u32; 32],
    /// Expected floating-point registers, as bit patterns.
    #[serde(deserialize_with = "registers")]
    pub f: [u32; 32],
    /// Addresses and words that memory must contain after the run.
    #[serde(default, deserialize_with = "hex_pairs")]
    pub mem: Vec<(u32, u32)>,
}

fn hex<E: serde::de::Error>(text: &str) -> Result<u32, E> {
    let digits = text.len() == 8 && text.bytes().all(|b| b.is_ascii_hexdigit());
    let value = u32::from_str_radix(text, 16).ok().filter(|_| digits);
    value.ok_or_else(|| E::custom(format_args!("expected 8 hexadecimal digits, found {text:?}")))
}

fn hex_list<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<u32>, D::Error> {
    Vec::<String>::deserialize(from)?.iter().map(|text| hex(text)).collect()
}

fn hex_pairs<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<(u32, u32)>, D::Error> {
    let pairs = Vec::<(u32, String)>::deserialize(from)?;
    pairs.iter().map(|(address, text)| Ok((*address, hex(text)?))).collect()
}

fn registers<'de, D: Deserializer<'de>>(from: D) -> Result<[u32; 32], D::Error> {
    let list = hex_list(from)?;
    let found = list.len();
    list.try_into().map_err(|_| serde::de::Error::custom(format_args!("expected 32 registers, found {found}")))
}

/// Memory at every address. Words that were never written are zero.
#[derive(Clone, Debug, Default)]
struct Sparse(BTreeMap<u32, u32>);

impl Sparse {
    fn word(&self, address: u32) -> u32 {
        self.0.get(&(address & !3)).copied().unwrap_or(0)
    }

    fn put(&mut self, address: u32, value: u32, mask: u32) {
        let old = self.word(address);
        self.0.insert(address & !3, old & !mask | value & mask);
    }
}

impl Bus for Sparse {
    fn read(&mut self, address: u32, size: u32) -> Result<u64, Unmapped> {
        let word = u64::from(self.word(address));
        Ok(match size {
            8 => u64::from(self.word(address.wrapping_add(4))) << 32 | word,
            4 => word,
            _ => word >> (8 * (address & 3)) & ((1 << (8 * size)) - 1),
        })
    }

    fn write(&mut self, address: u32, size: u32, value: u64) -> Result<(), Unmapped> {
        if size >= 4 {
            self.put(address, value as u32, !0);
        }
        match size {
            8 => self.put(address.wrapping_add(4), (value >> 32) as u32, !0),
            4 => {}
            _ => {
                let shift = 8 * (address & 3);
                self.put(address, (value as u32) << shift, ((1u32 << (8 * size)) - 1) << shift);
            }
        }
        Ok(())
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Name of the register (such as `r5` or `f12`), or address of the memory word.
    pub place: String,
    pub expected: u32,
    pub found: u32,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: expected {:08x}, found {:08x}", self.place, self.expected, self.found)
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Failure {
    /// The program trapped before it reached its stop address.
    Trapped(Trap),
    /// The program used up its instruction budget before it reached its stop address.
    Exhausted {
        /// Address at which the program was stopped.
        pc: u32,
    },
    /// The run ended correctly, but some registers or memory words differ.
    Differs(Vec<Difference>),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Trapped(trap) => write!(f, "{trap}"),
            Failure::Exhausted { pc } => write!(f, "not at its stop after {BUDGET} instructions, pc {pc:#010x}"),
            Failure::Differs(list) => {
                let shown: Vec<String> = list.iter().map(Difference::to_string).collect();
                f.write_str(&shown.join("; "))
            }
        }
    }
}

/// A line that does not contain a valid vector.
#[derive(Debug, thiserror::Error)]
#[error("line {line}: not a vector: {reason}")]
pub struct MalformedLine {
    pub line: usize,
    pub reason: String,
}

/// Reads test vectors from text with one JSON object per line. Empty lines are skipped.
///
/// # Errors
/// Returns the error of the first line that does not contain a valid vector.
pub fn parse(text: &str) -> Result<Vec<TestVector>, MalformedLine> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    lines.map(|(n, line)| parse_line(n + 1, line)).collect()
}

fn parse_line(line: usize, text: &str) -> Result<TestVector, MalformedLine> {
    let vector: TestVector = serde_json::from_str(text).map_err(|e| MalformedLine { line, reason: e.to_string() })?;
    // Instruction addresses must be aligned.
    let unaligned = [vector.load, vector.entry, vector.stop].iter().any(|address| address % 4 != 0);
    if unaligned {
        let reason = "load, entry and stop must be multiples of 4".to_owned();
        return Err(MalformedLine { line, reason });
    }
    Ok(vector)
}

impl TestVector {
    fn memory(&self) -> Sparse {
        let mut memory = Sparse::default();
        for (n, word) in self.code.iter().enumerate() {
            memory.put(self.load.wrapping_add(4 * n as u32), *word, !0);
        }
        for (address, word) in &self.mem {
            memory.put(*address, *word, !0);
        }
        memory
    }

    /// Runs the program of the vector on a new processor, and compares the state after the run with the expected state.
    ///
    /// # Errors
    /// Returns the differences, or the reason why the program did not reach its stop address.
    pub fn check(&self, config: Config) -> Result<(), Failure> {
        let mut cpu = Cpu::at(config, self.entry);
        self.check_on(&mut cpu)
    }

    /// Resets `cpu`, runs the program of the vector on it, and compares the state after the run with the expected
    /// state.
    ///
    /// # Errors
    /// Returns the same errors as [`TestVector::check`].
    pub fn check_on(&self, cpu: &mut Cpu) -> Result<(), Failure> {
        cpu.reset();
        // Registers are zero after the reset. Only the start address is set here.
        cpu.state.pc = self.entry;
        let mut memory = self.memory();
        match cpu.run(&mut memory, Some(self.stop), BUDGET) {
            RunEnd::Stopped => self.compare(cpu, &memory),
            RunEnd::Trapped(trap) => Err(Failure::Trapped(trap)),
            RunEnd::Exhausted => Err(Failure::Exhausted { pc: cpu.state.pc }),
        }
    }

    fn compare(&self, cpu: &Cpu, memory: &Sparse) -> Result<(), Failure> {
        let r = (0..32).map(|n| (format!("r{n}"), self.expect.r[n], cpu.state.r[n]));
        let f = (0..32).map(|n| (format!("f{n}"), self.expect.f[n], cpu.state.f[n]));
        let words = self.expect.mem.iter();
        let mem = words.map(|(a, word)| (format!("memory {a:#010x}"), *word, memory.word(*a)));
        let differences: Vec<Difference> = (r.chain(f).chain(mem))
            .filter(|(_, expected, found)| expected != found)
            .map(|(place, expected, found)| Difference { place, expected, found })
            .collect();
        if differences.is_empty() { Ok(()) } else { Err(Failure::Differs(differences)) }
    }
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct VectorSummary {
    pub passed: usize,
    /// Identifier, description and reason of each failed vector.
    pub failures: Vec<(String, String, Failure)>,
}

impl VectorSummary {
    pub fn failed(&self) -> usize {
        self.failures.len()
    }
}

/// Runs the programs of all vectors on one processor, which is reset before each program.
pub fn run(vectors: &[TestVector], config: Config) -> VectorSummary {
    let mut cpu = Cpu::new(config);
    let mut summary = VectorSummary::default();
    for vector in vectors {
        match vector.check_on(&mut cpu) {
            Ok(()) => summary.passed += 1,
            Err(failure) => summary.failures.push((vector.id.clone(), vector.what.clone(), failure)),
        }
    }
    summary
}
