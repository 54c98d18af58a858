//! Profiles: the clocks that a program takes, by cause and by code address.

use crate::timing::{FREEZES, Freeze, N_FREEZES};
use std::fmt;

/// Clocks by cause, and counts of instructions and misses, since reset or the last
/// [`Cpu::clear_profile`](crate::Cpu::clear_profile).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Profile {
    /// Number of executed instructions, including `fnop` and `nop`. A pair counts as two.
    pub instructions: u64,
    /// Number of clocks in which an instruction or pair was issued.
    pub issue: u64,
    /// Number of clocks lost to each row of the freeze table, in the order of [`FREEZES`].
    pub frozen: [u64; N_FREEZES],
    pub bus_requests: u64,
    /// Number of bus requests that had to open a DRAM row.
    pub page_misses: u64,
    pub instruction_misses: u64,
    /// Number of loads that missed the data cache.
    pub data_misses: u64,
}

impl Profile {
    pub(crate) fn new() -> Profile {
        Profile {
            instructions: 0,
            issue: 0,
            frozen: [0; N_FREEZES],
            bus_requests: 0,
            page_misses: 0,
            instruction_misses: 0,
            data_misses: 0,
        }
    }

    /// Returns the number of clocks lost to row `id` of the freeze table.
    pub fn frozen_by(&self, id: Freeze) -> u64 {
        self.frozen[id as usize]
    }

    /// Returns the number of all clocks: issue clocks and freezes.
    pub fn clocks(&self) -> u64 {
        self.issue + self.frozen.iter().sum::<u64>()
    }
}

impl fmt::Display for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{:>12}  clocks", self.clocks())?;
        writeln!(f, "{:>12}  issue ({} instructions)", self.issue, self.instructions)?;
        for (row, clocks) in FREEZES.iter().zip(self.frozen).filter(|(_, clocks)| *clocks != 0) {
            writeln!(f, "{clocks:>12}  row {}: {}", row.number, row.condition)?;
        }
        writeln!(f, "{:>12}  instruction-cache misses", self.instruction_misses)?;
        writeln!(f, "{:>12}  data-cache misses of loads", self.data_misses)?;
        write!(f, "{:>12}  bus requests, {} opened a row", self.bus_requests, self.page_misses)
    }
}

/// Number of clocks and of executions for each instruction word in a range of addresses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AddressProfile {
    base: u32,
    rows: Vec<(u64, u64)>,
}

impl AddressProfile {
    /// Makes an empty profile for `words` instruction words from address `base` on.
    pub fn new(base: u32, words: usize) -> AddressProfile {
        AddressProfile { base, rows: vec![(0, 0); words] }
    }

    pub(crate) fn add(&mut self, pc: u32, clocks: u64) {
        let at = (pc.wrapping_sub(self.base) / 4) as usize;
        if let Some(row) = self.rows.get_mut(at) {
            row.0 += clocks;
            row.1 += 1;
        }
    }

    /// Returns the clocks and the number of executions of the instruction or pair at `pc`. Both numbers are zero
    /// outside the profile's range of addresses.
    pub fn at(&self, pc: u32) -> (u64, u64) {
        let at = (pc.wrapping_sub(self.base) / 4) as usize;
        self.rows.get(at).copied().unwrap_or_default()
    }

    /// Returns the clocks of the code from each label to the next label. `labels` must be sorted by address. Clocks
    /// before the first label do not count.
    pub fn by_label<'a>(&self, labels: &[(&'a str, u32)]) -> Vec<(&'a str, u64)> {
        let end = self.base.wrapping_add(4 * self.rows.len() as u32);
        // The code of a label ends at the next label.
        let ends = labels.iter().skip(1).map(|next| next.1).chain([end]);
        labels.iter().zip(ends).map(|((name, begin), end)| (*name, self.clocks_between(*begin, end))).collect()
    }

    fn clocks_between(&self, begin: u32, end: u32) -> u64 {
        (begin..end).step_by(4).map(|pc| self.at(pc).0).sum()
    }
}
