//! The memory of a board, as the number of bytes in use for each purpose. The bins have a limit of their own.

use pxpl5_wire::{NodeId, RegionId};
use serde::Serialize;
use std::fmt;

/// A purpose for which a board uses memory, such as bins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub enum Account {
    /// The program, its stacks and message buffers.
    Program,
    /// The primitives of the scene that this graphics processor stores.
    DisplayList,
    /// The renderer commands of one of the two sets of bins (bin context 0 or 1).
    Commands(u8),
    /// The pointers in one of the two sets of bins (bin context 0 or 1).
    Bins(u8),
}

impl Account {
    const SLOTS: usize = 6;

    /// All purposes of memory. Commands and bins occur twice, once for each set of bins.
    pub const ALL: [Self; Self::SLOTS] =
        [Self::Program, Self::DisplayList, Self::Commands(0), Self::Commands(1), Self::Bins(0), Self::Bins(1)];

    const fn slot(self) -> usize {
        match self {
            Self::Program => 0,
            Self::DisplayList => 1,
            Self::Commands(context) => 2 + (context & 1) as usize,
            Self::Bins(context) => 4 + (context & 1) as usize,
        }
    }
}

impl fmt::Display for Account {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Program => f.write_str("program and buffers"),
            Self::DisplayList => f.write_str("display list"),
            Self::Commands(context) => write!(f, "renderer commands of bin context {context}"),
            Self::Bins(context) => write!(f, "bins of context {context}"),
        }
    }
}

/// A request for more memory than is free.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, thiserror::Error)]
#[error(
    "graphics processor at node {}: {account} {}needs {needed_bytes} bytes, {available_bytes} are available",
    gp.0,
    named(*region)
)]
pub struct OutOfMemory {
    pub gp: NodeId,
    pub account: Account,
    /// Region whose bin did not fit in memory, if the request was for bins.
    pub region: Option<RegionId>,
    /// Number of bytes in use for the purpose `account` after the request.
    pub needed_bytes: u64,
    /// Largest number of bytes that could be in use for the purpose `account`.
    pub available_bytes: u64,
}

fn named(region: Option<RegionId>) -> String {
    region.map_or_else(String::new, |region| format!("(region {}) ", region.0))
}

#[derive(Clone, Debug)]
pub struct Memory {
    gp: NodeId,
    capacity: u64,
    bins: u64,
    used: [u64; Account::SLOTS],
    peak: u64,
}

impl Memory {
    /// Makes a memory of `capacity` bytes, of which the two sets of bins (contexts) together can use at most `bins`.
    pub const fn new(gp: NodeId, capacity: u64, bins: u64) -> Self {
        Self { gp, capacity, bins, used: [0; Account::SLOTS], peak: 0 }
    }

    /// Sets the number of bytes in use for a purpose.
    ///
    /// # Errors
    ///
    /// Returns [`OutOfMemory`] if the bytes do not fit into the memory that the other purposes leave free. In this
    /// case, nothing changes.
    pub fn set(&mut self, account: Account, bytes: u64, region: Option<RegionId>) -> Result<(), OutOfMemory> {
        // The request replaces the old value of the account, so only the other accounts count.
        let others = self.used() - self.used[account.slot()];
        let free = self.capacity.saturating_sub(others);
        let available_bytes = match account {
            Account::Bins(context) => free.min(self.room_for_bins(context)),
            _ => free,
        };
        if bytes > available_bytes {
            return Err(OutOfMemory { gp: self.gp, account, region, needed_bytes: bytes, available_bytes });
        }
        self.used[account.slot()] = bytes;
        self.peak = self.peak.max(others + bytes);
        Ok(())
    }

    /// Returns the number of bytes that the bins of `context` (one of two sets of bins) can use while the other set
    /// keeps its size.
    pub const fn room_for_bins(&self, context: u8) -> u64 {
        self.bins.saturating_sub(self.used[Account::Bins(context ^ 1).slot()])
    }

    pub const fn used_by(&self, account: Account) -> u64 {
        self.used[account.slot()]
    }

    pub fn used(&self) -> u64 {
        self.used.iter().sum()
    }

    /// Returns the greatest number of bytes so far that were in use at the same time.
    pub const fn peak(&self) -> u64 {
        self.peak
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_overflow_names_the_board_the_use_and_the_region_and_changes_nothing() {
        let mut memory = Memory::new(NodeId(3), 1_000, 1_000);
        memory.set(Account::DisplayList, 600, None).expect("fits");
        memory.set(Account::Bins(1), 400, Some(RegionId(7))).expect("fits exactly");
        let error = memory.set(Account::Bins(1), 401, Some(RegionId(7))).expect_err("one byte too many");
        assert_eq!(
            error.to_string(),
            "graphics processor at node 3: bins of context 1 (region 7) needs 401 bytes, 400 are available"
        );
        assert_eq!((memory.used(), memory.peak()), (1_000, 1_000));
    }

    #[test]
    fn the_bins_of_both_contexts_share_one_part_of_the_memory() {
        let mut memory = Memory::new(NodeId(0), 1_000, 300);
        memory.set(Account::Bins(0), 200, Some(RegionId(0))).expect("fits");
        let error = memory.set(Account::Bins(1), 101, Some(RegionId(4))).expect_err("100 are left of 300");
        assert_eq!((error.needed_bytes, error.available_bytes, error.region), (101, 100, Some(RegionId(4))));
        memory.set(Account::Commands(1), 500, None).expect("commands are not in the bins' part");
        memory.set(Account::Bins(0), 0, None).expect("less always fits");
        memory.set(Account::Bins(1), 300, Some(RegionId(4))).expect("fits now");
    }
}
