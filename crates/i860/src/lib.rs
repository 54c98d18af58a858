//! Intel i860 XR: a processor model that executes its instruction set and counts its clocks.
//!
//! ```text
//!            +--------------------- Cpu ----------------------+
//!  program ->| fetch, pairs, slots, traps   (cpu, control)    |      +-----------+
//!            | integer | memory | floating | graphics         |<---->| impl Bus  |
//!            | State: r, f, psr .. , pipes, KR KI T MERGE     |      +-----------+
//!            | Clock: freezes, caches, TLB, store pipe, DRAM, |
//!            |        memoized blocks                         |
//!            +------------------------------------------------+
//!  text -> assemble -> Program       word -> disassemble -> text
//!  linear stretch -> linear::schedule -> text in dual-instruction mode
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
//! - All XR instructions are modelled: integer core, loads and stores with auto-increment, scalar and pipelined
//!   arithmetic, the 62 dual operations, pipelined loads, graphics unit, delay slots, `bla`, dual-instruction mode, and
//!   control registers.
//! - Arithmetic is IEEE, rounded to nearest even, with the same bits on every computer. fsr.FZ flushes results to zero.
//!   Without traps, a NaN result is the first NaN operand, converted to a quiet NaN, or the default NaN with its sign
//!   set.
//! - A scalar operation (including `frcp` and `frsqr`) destroys the contents of its unit's pipe, which become NaN here.
//!   If code reads a result from the pipe afterwards, the assembler prints a warning.
//! - The approximations `frcp` and `frsqr` come from a [`SeedTable`], because the chip's table is not public.
//! - After a trap, the processor is at the first instruction of the trap handler, and [`Cpu::step`] returns the cause.
//!   Illegal words and pairs, a branch in a delay slot and a misaligned pair are instruction traps.
//! - No program can make the model panic. A run ends at its stop address, at a trap, or when its instruction budget is
//!   used up.
//!
//! # Timing
//!
//! An instruction or pair is issued in one clock unless a row of [`timing::FREEZES`] delays it. Of several simultaneous
//! freezes, only the longest counts; the times of cache misses are added. You can disable every row or change its cost,
//! and every DRAM time is a parameter with an allowed range. A [`Profile`] accounts for every clock.
//!
//! The instruction cache has 4 KB and the write-back data cache 8 KB. Both are 2-way set-associative with 32-byte cache
//! lines and pseudo-random replacement. A write miss allocates no cache line. The TLB has 64 entries.
//!
//! All rows are *assumed*: they repeat Intel's list of instruction timings as the authors remember it. Tests compare
//! them with published figures: 2 and 1.5 operations per clock, 39 clocks for three reciprocal roots, and about 48 for
//! a square root. A fourth figure, 106 clocks for 117 instructions of a tree-traversal loop, has no published code. Its
//! test runs a loop of the same shape (pairs, odd entry, taken `bnc.t`), and checks only the issue rules.
//!
//! # Speed
//!
//! Code is decoded once, as basic blocks from an address to the next branch and its delay slot. The processor executes
//! a block, and the clock then counts its time.
//!
//! A *run* is a part of a block whose instructions and data are all in the caches. It uses neither the bus nor the
//! queues nor the replacement sequence. Its clocks therefore depend only on the remaining waits of earlier
//! instructions, the rest of an arriving instruction-cache line, and taken branches and traps. The model memoizes them
//! and reuses them, like FastSim (Schnarr and Larus, ASPLOS 1998). [`Config::memoise`] turns this optimization on.
//!
//! A block is one run, or several between accesses that miss the cache. Those accesses are counted one by one, and so
//! are instructions after a wait of more than 15 clocks. A block that is not entirely in the instruction cache is also
//! split at cache lines.
//!
//! Counted and reused clocks give the same state, clocks and profile. `tests/memo.rs` checks this with random programs,
//! some larger than the caches, and `crates/pphigs/tests/memo.rs` with the triangle kernels and changed delays in every
//! row. The benchmarks of `crates/pphigs` measure the gain.
//!
//! A [`DecodedPrograms`] keeps decoded programs and their clocks for all processors that run them. Profiles by address
//! ([`Cpu::watch`]) and address translation always count every instruction.
//!
//! # Conformance
//!
//! 2,175 test vectors of other functional models pass (tests/conformance.rs; module and feature `vectors`). The vectors
//! decide three questions that the manuals leave open. `faddz` is one 64-bit addition. Scalar `ftrunc` writes only the
//! low word, and `fix` clears the high word. A dual operation that reloads K or T uses their old values.
//!
//! # Not modelled
//!
//! - Address translation: ATE charges the time of TLB misses, but addresses stay unchanged. There is no page
//!   protection.
//! - Big-endian data (epsr.BE), breakpoints (db), floating-point traps (FTE), kill-next (KNF), the 8-bit boot mode.
//! - Rounding modes other than to nearest, except in `fix`. The status bits of fsr are not modelled either.
//! - Results of instructions with registers for which Intel leaves the result undefined.
//! - Contents of the caches. The caches are always coherent and affect only the time. A store of the processor into its
//!   own code takes effect immediately.
//! - XP additions: `pfld.q`, registers bear, ccr, p0 to p3.
//!
//! # Sources
//!
//! Intel, *i860 Microprocessor Programmer's Reference Manual*, from memory. Encodings of public assemblers. Assembler
//! routines of about 1990 with comments about clocks. [`timing::FREEZES`] and [`timing::FreezeClocks`] state the source
//! of each row.

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
mod decoded_programs;
mod disassembler;
mod dram;
mod dual_operation;
mod encode;
mod fetch;
mod floating;
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
pub use decoded_programs::DecodedPrograms;
pub use disassembler::disassemble;
pub use encode::encode;
pub use instruction::{Flags, Instruction, Op};
pub use mnemonic::mnemonic;
pub use profile::{AddressProfile, Profile};
pub use seed::SeedTable;
pub use state::State;
pub use timing::{CHIP_PATH, Config};
pub use trap::{RunEnd, Trap, TrapCause};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
