//! Intel i860 XR processor: decode, execute, cycle timing, assembler, disassembler.

mod arithmetic;
mod assembler;
mod bus;
mod cache;
mod clock;
mod control;
mod cpu;
mod decode;
mod decoded;
mod dram;
mod encode;
mod floating;
mod graphics;
mod instruction;
mod integer;
mod memory;
mod mnemonic;
mod profile;
mod seed;
pub mod state;
pub mod timing;
#[cfg(feature = "vectors")]
pub mod vectors;

pub use assembler::{AssemblyError, AssemblyErrors, Program, assemble, instruction_word};
pub use bus::{Bus, Ram, Unmapped};
pub use cpu::{Cpu, Outcome, Trap, TrapCause};
pub use decode::{IllegalWord, decode};
pub use encode::encode;
pub use instruction::{Flags, Instruction, Op};
pub use mnemonic::{disassemble, mnemonic};
pub use profile::{AddressProfile, Profile};
pub use seed::SeedTable;
pub use state::State;
pub use timing::Config;
