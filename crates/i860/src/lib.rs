//! Intel i860 XR: a processor model that executes its instruction set and counts its clocks.
//!
//! ```text
//!            +--------------------- Cpu ----------------------+
//!  program ->| fetch, pairs, slots, traps   (cpu, control)    |      +-----------+
//!            | integer | memory | floating | graphics         |<---->| impl Bus  |
//!            | State: r, f, psr .. , pipes, KR KI T MERGE     |      +-----------+
//!            | Clock: freezes, caches, TLB, store pipe, DRAM, |
//!            |        blocks that repeat                      |
//!            +------------------------------------------------+
//!  text -> assemble -> Program       word -> disassemble -> text
//!  linear code -> linear::schedule -> text in dual-instruction mode
//! ```
//!
//! ```
//! use i860::{Config, Cpu, Ram, RunEnd, assemble};
//!
//! let program = assemble("sum.s", 0x1000, "
//!         mov     10, r5
//! loop:   adds    r5, r6, r6
//!         adds    -1, r5, r5
//!         btne    r0, r5, loop
//! end:    nop").unwrap();
//! let mut memory = Ram::new(0, 1 << 16);
//! memory.load(0x1000, &program.bytes).unwrap();
//! let mut cpu = Cpu::at(Config::cycle(), 0x1000);
//! assert_eq!(cpu.run(&mut memory, program.symbol("end"), 1000), RunEnd::Stopped);
//! assert_eq!(cpu.state.r[6], 55);
//! println!("{}", cpu.profile());
//! ```
//!
//! # Behaviour
//!
//! - All XR instructions: integer core, loads and stores with auto-increment, scalar and pipelined arithmetic, the 62
//!   dual operations, pipelined loads, graphics unit, delay slots, `bla`, dual-instruction mode, control registers.
//! - Arithmetic is IEEE, to nearest even, with the same bits on every host; fsr.FZ flushes results. Without traps a
//!   NaN result is the first NaN operand made quiet, or the default NaN with its sign set.
//! - A scalar operation, a seed too, destroys what the pipe of its unit holds: it becomes NaN here. The assembler warns of
//!   code that takes a result out of a pipe behind one.
//! - The seeds of `frcp` and `frsqr` come from a [`SeedTable`], because the part's table is not public.
//! - Traps leave the state of the part at the handler's first instruction, and [`Cpu::step`] says which it was.
//!   Illegal words and pairs, a branch in a slot and a misaligned pair are instruction traps.
//! - Nothing that a program does panics; a run ends at its stop, at a trap, or when its budget is used up.
//!
//! # Timing
//!
//! An instruction, or a pair, issues in one clock unless a row of [`timing::FREEZES`] holds it. The longest of
//! simultaneous freezes counts; cache misses add. Every row can be switched off or given another cost, every DRAM
//! number is a parameter with an allowed range, and a [`Profile`] accounts for every clock. Instruction cache
//! 4 KB, data cache 8 KB write-back, both 2-way with 32-byte lines and pseudo-random replacement; no allocation on a
//! write miss; TLB of 64 entries. All rows are *assumed* (recollections of Intel's list); the published anchors are
//! tests: 2 and 1.5 operations per clock, 39 clocks for three reciprocal roots, about 48 for a square root. The loop of a
//! period tree code, 117 instructions in 106 clocks, cannot be re-created from its description; the test has a loop of its
//! shape (pairs, odd entry, taken `bnc.t`), so that anchor checks the rules of issue and not that program.
//!
//! # Speed
//!
//! Code is decoded once and executed block by block, from an address to the next branch and its slot; the clock is told of
//! each block afterwards. A run of units that finds all its instructions and data in the caches leaves bus, queues and
//! replacement alone, so that its clocks follow from the waits left by earlier instructions, from what is still to come of an
//! instruction line and from how it ended: they are remembered, as FastSim does (Schnarr and Larus, ASPLOS 1998). A block is one
//! such run, or several with accesses past the caches between them; these are counted, so are units behind a wait of more than
//! 15 clocks. Blocks that are not all in the instruction cache are taken apart at its lines too. Counting everything gives the same
//! state, clocks and profile after every run (tests/memo.rs: random programs, also larger than the caches; crates/pphigs/tests/memo.rs:
//! the triangle kernels with every row switched);
//! [`Config::memoise`] chooses. What it is worth for the triangle kernels, crates/pphigs/benches measures. Programs that take turns
//! in memory stay decoded, with what they remember, for all processors that run them ([`Shelf`]).
//! Clocks by address ([`Cpu::watch`]) and translation on are always counted.
//!
//! # Conformance
//!
//! 2,175 vectors of other functional models pass (tests/conformance.rs; module and feature `vectors`). Where
//! they decide what manuals leave open: `faddz` is one 64-bit addition; scalar `ftrunc` writes the low word only,
//! `fix` clears the high one; a dual operation that reloads K or T uses their old values.
//!
//! # Not modelled
//!
//! - Address translation: ATE charges TLB misses, but addresses stay what they are. Page protection likewise.
//! - Big-endian data (epsr.BE), breakpoints (db), floating-point traps (FTE), kill-next (KNF), the 8-bit boot mode.
//! - Rounding modes other than to nearest, except in `fix`. Status bits of fsr.
//! - Undefined register choices.
//! - Contents of the caches: they are always coherent; only time is theirs. Own stores into code are seen at once.
//! - XP additions: `pfld.q`, `pfmul3`, registers bear, ccr, p0 to p3.
//!
//! # Sources
//!
//! Intel, *i860 Microprocessor Programmer's Reference Manual*, as far as remembered; encodings as public assemblers
//! have them; period kernels with clock comments. What rests on which is in the table of freezes.

mod action;
mod arithmetic;
mod assembler;
mod block;
mod bus;
mod cache;
mod clock;
mod code;
mod code_map;
mod common;
mod control;
mod cpu;
mod data_cache;
mod decode;
mod decoded;
mod disassembler;
mod dram;
mod dual_operation;
mod encode;
mod execution;
mod fetch;
mod floating;
mod flow;
mod freeze;
mod graphics;
mod instruction;
mod integer;
pub mod linear;
mod load_pipe;
mod memo;
mod memory;
mod mnemonic;
mod operands;
mod profile;
mod runs;
mod scoreboard;
mod seed;
mod shelf;
pub mod state;
mod store_pipe;
mod syntax;
pub mod timing;
mod translation;
mod trap;
#[cfg(feature = "vectors")]
pub mod vectors;

pub use assembler::{
    AssemblyError, AssemblyErrors, AssemblyWarning, Data, DataKind, Program, Rule, assemble, instruction_word, link,
};
pub use bus::{Bus, Ram, Unmapped};
pub use cpu::Cpu;
pub use decode::{IllegalWord, decode};
pub use disassembler::disassemble;
pub use encode::encode;
pub use instruction::{Flags, Instruction, Op};
pub use mnemonic::mnemonic;
pub use profile::{AddressProfile, Profile};
pub use seed::SeedTable;
pub use shelf::Shelf;
pub use state::State;
pub use timing::{CHIP_PATH, Config};
pub use trap::{RunEnd, Trap, TrapCause};
