//! The i860 for Python: assembler, disassembler, and a processor with memory.

use crate::errors::{failed_run, not_assembled, wrong_setting};
use i860::{AddressProfile, Config, Cpu, Program as NativeProgram, Ram, RunEnd};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::collections::BTreeMap;

/// An assembled i860 program: its bytes with their address, its labels and its source lines.
#[pyclass(frozen, module = "pxpl5")]
pub(crate) struct Program {
    program: NativeProgram,
}

/// Assembles i860 source text. ``base`` is the address of the program's first byte. ``name`` stands for the source in
/// error messages.
///
/// Raises :class:`pxpl5.AssemblyError` with all invalid lines.
#[pyfunction]
#[pyo3(signature = (source, *, base = 0x1000, name = "source.s"))]
pub(crate) fn assemble(source: &str, base: u32, name: &str) -> PyResult<Program> {
    let program = i860::assemble(name, base, source).map_err(not_assembled)?;
    Ok(Program { program })
}

/// Returns the text of the instruction that a 32-bit word encodes. ``address`` is the address of the word, from which
/// the targets of branches are computed.
#[pyfunction]
#[pyo3(signature = (word, address = 0))]
pub(crate) fn disassemble(word: u32, address: u32) -> String {
    i860::disassemble(word, address)
}

#[pymethods]
impl Program {
    /// Returns the address of the program's first byte.
    #[getter]
    fn base(&self) -> u32 {
        self.program.base
    }

    /// Returns the bytes of the program from address :attr:`base` on. Gaps between the parts of the program are
    /// included.
    #[getter]
    fn bytes<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.program.bytes)
    }

    /// Returns the program as 32-bit words, in an array of shape (n,), uint32.
    #[getter]
    fn words<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        PyArray1::from_vec(py, self.program.words())
    }

    /// Returns the values of the program's labels and constants, by name.
    #[getter]
    fn symbols(&self) -> BTreeMap<String, u32> {
        self.program.symbols.clone()
    }

    /// Returns a listing of the program with one line for each word: address, word, and instruction or data.
    fn listing(&self) -> String {
        self.program.listing(None)
    }

    /// Returns a text that states address, length and labels of the program.
    fn __repr__(&self) -> String {
        let labels: Vec<&str> = self.program.labels.iter().map(|(name, _)| name.as_str()).collect();
        format!(
            "<pxpl5.Program of {} bytes at {:#x}: {}>",
            self.program.bytes.len(),
            self.program.base,
            labels.join(", ")
        )
    }
}

/// An emulated i860 processor with clock, caches, a program, and memory from address 0 on.
#[pyclass(module = "pxpl5")]
pub(crate) struct Processor {
    cpu: Cpu,
    memory: Ram,
    program: NativeProgram,
}

impl Processor {
    fn place(&self, place: &Bound<'_, PyAny>) -> PyResult<u32> {
        let Ok(name) = place.extract::<String>() else { return place.extract() };
        self.program.symbol(&name).ok_or_else(|| {
            let labels: Vec<&str> = self.program.labels.iter().map(|(name, _)| name.as_str()).collect();
            wrong_setting(format!(
                "expected a label of the program ({}) or an address, found `{name}`",
                labels.join(", ")
            ))
        })
    }
}

const MAX_MEMORY: usize = 1 << 30;

#[pymethods]
impl Processor {
    /// Creates a processor with a program. ``memory`` is the size of the processor's memory in bytes: 8 MiB by default,
    /// as on a board, and at most 1 GiB. The processor starts at ``entry``, a label or an address. The default is the
    /// label ``start``.
    ///
    /// Raises :class:`pxpl5.SettingError` for a program that does not fit into memory, and for an unknown label.
    #[new]
    #[pyo3(signature = (program, *, memory = 0x0080_0000, entry = None))]
    fn new(program: &Program, memory: usize, entry: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let program = program.program.clone();
        if memory > MAX_MEMORY {
            return Err(wrong_setting(format!("memory: expected at most {MAX_MEMORY} bytes, found {memory}")));
        }
        let mut ram = Ram::new(0, memory);
        let base = program.base;
        let size = program.bytes.len();
        // Load the program, then choose the start address.
        ram.load(base, &program.bytes)
            .map_err(|_| wrong_setting(format!("{size} bytes at {base:#x} do not fit {memory:#x} bytes of memory")))?;
        let start = program.symbol("start").unwrap_or(base);
        let mut made = Self { cpu: Cpu::at(Config::cycle(), start), memory: ram, program };
        // The clocks spent at each word are recorded for `profile`.
        made.cpu.watch(Some(AddressProfile::new(base, size.div_ceil(4))));
        if let Some(entry) = entry {
            made.cpu.state.pc = made.place(entry)?;
        }
        Ok(made)
    }

    /// Runs until the program reaches ``stop``, a label or an address, but for at most ``budget`` instructions. The
    /// default of ``stop`` is the label ``end``, or the end of the program. The run does not hold the interpreter's
    /// lock. Returns ``stopped`` if ``stop`` was reached, otherwise ``exhausted``.
    ///
    /// Raises :class:`pxpl5.RunError` for a trap, with its cause and address, and :class:`pxpl5.SettingError` for an
    /// unknown label.
    #[pyo3(signature = (stop = None, *, budget = 10_000_000))]
    fn run(&mut self, py: Python<'_>, stop: Option<&Bound<'_, PyAny>>, budget: u64) -> PyResult<&'static str> {
        let end = self.program.base.wrapping_add(self.program.bytes.len() as u32);
        let stop = match stop {
            Some(stop) => self.place(stop)?,
            None => self.program.symbol("end").unwrap_or(end),
        };
        let mut left = budget;
        // Run a limited number of instructions at a time, so that Ctrl-C can take effect.
        while left > 0 {
            let piece = left.min(PIECE);
            let Self { cpu, memory, .. } = self;
            match py.detach(|| cpu.run(memory, Some(stop), piece)) {
                RunEnd::Stopped => return Ok("stopped"),
                RunEnd::Trapped(trap) => return Err(failed_run(trap)),
                RunEnd::Exhausted => left -= piece,
            }
            py.check_signals()?;
        }
        Ok("exhausted")
    }

    /// Executes one instruction, or two in dual-instruction mode. The instruction in the delay slot of a branch is
    /// executed together with the branch. Returns the new program counter.
    ///
    /// Raises :class:`pxpl5.RunError` for a trap.
    fn step(&mut self) -> PyResult<u32> {
        let Self { cpu, memory, .. } = self;
        cpu.step(memory).map_err(failed_run)?;
        Ok(self.cpu.state.pc)
    }

    /// Returns the program counter, which is the address of the next instruction.
    #[getter]
    fn pc(&self) -> u32 {
        self.cpu.state.pc
    }

    /// Returns a copy of the integer registers as an array of shape (32,), uint32.
    #[getter]
    fn r<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        PyArray1::from_slice(py, &self.cpu.state.r)
    }

    /// Returns a copy of the floating-point registers as 32-bit words, in an array of shape (32,), uint32.
    /// ``.view(numpy.float32)`` converts the words to their floating-point values.
    #[getter]
    fn f<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        PyArray1::from_slice(py, &self.cpu.state.f)
    }

    /// Sets integer register ``number``, 1 to 31.
    ///
    /// Raises :class:`pxpl5.SettingError` for any other number. Register 0 is always 0.
    fn set_r(&mut self, number: usize, value: u32) -> PyResult<()> {
        if !(1..32).contains(&number) {
            return Err(wrong_setting(format!("register: expected 1 to 31, found {number}")));
        }
        self.cpu.state.r[number] = value;
        Ok(())
    }

    /// Returns the number of clocks since the start, including clocks in which the processor waits.
    #[getter]
    fn clocks(&self) -> u64 {
        self.cpu.clocks()
    }

    /// Returns the number of executed instructions. A pair in dual-instruction mode counts as two.
    #[getter]
    fn instructions(&self) -> u64 {
        self.cpu.instructions()
    }

    /// Returns a profile of the clocks as a dictionary: instructions, issue, bus_requests, page_misses,
    /// instruction_misses, data_misses, clocks and by_label. The dictionary by_label has the clocks of the code after
    /// each label.
    fn profile<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let profile = self.cpu.profile();
        let all = PyDict::new(py);
        all.set_item("clocks", profile.clocks())?;
        all.set_item("instructions", profile.instructions)?;
        all.set_item("issue", profile.issue)?;
        all.set_item("bus_requests", profile.bus_requests)?;
        all.set_item("page_misses", profile.page_misses)?;
        all.set_item("instruction_misses", profile.instruction_misses)?;
        all.set_item("data_misses", profile.data_misses)?;
        let labels: Vec<(&str, u32)> = self.program.labels.iter().map(|(name, at)| (name.as_str(), *at)).collect();
        let by_label = self.cpu.watched().map(|watched| watched.by_label(&labels)).unwrap_or_default();
        all.set_item("by_label", by_label.into_iter().collect::<BTreeMap<_, _>>())?;
        Ok(all)
    }

    /// Returns a copy of ``count`` words of memory as an array of shape (count,), uint32. ``place`` is a label or an
    /// address, which must be a multiple of 4.
    ///
    /// Raises :class:`pxpl5.SettingError` for an address outside the memory.
    #[pyo3(signature = (place, count = 1))]
    fn read<'py>(
        &self,
        py: Python<'py>,
        place: &Bound<'py, PyAny>,
        count: usize,
    ) -> PyResult<Bound<'py, PyArray1<u32>>> {
        let address = self.place(place)?;
        let words = self.memory.words(address, count);
        let words = words.map_err(|_| wrong_setting(format!("{count} words at {address:#x} are not all in memory")))?;
        Ok(PyArray1::from_vec(py, words))
    }

    /// Writes 32-bit words to memory from ``place`` on, a label or an address.
    ///
    /// Raises :class:`pxpl5.SettingError` for an address outside the memory. In this case nothing is written.
    fn write(&mut self, place: &Bound<'_, PyAny>, words: Vec<u32>) -> PyResult<()> {
        let address = self.place(place)?;
        let count = words.len();
        let written = self.memory.load_words(address, &words);
        written.map_err(|_| wrong_setting(format!("{count} words at {address:#x} are not all in memory")))?;
        self.cpu.invalidate_code();
        Ok(())
    }

    /// Returns a text that states the program counter and the number of clocks.
    fn __repr__(&self) -> String {
        format!("<pxpl5.Processor at {:#010x} after {} clocks>", self.cpu.state.pc, self.cpu.clocks())
    }
}

/// Number of instructions between two checks for Ctrl-C, which take some tens of milliseconds.
const PIECE: u64 = 2_000_000;
