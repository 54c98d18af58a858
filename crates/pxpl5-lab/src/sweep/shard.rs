//! Division of a sweep into disjoint shards, which separate processes can compute.

/// A part of a sweep: the points whose index has the remainder `index` after division by `of`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: u64,
    of: u64,
}

impl Shard {
    /// The whole sweep as a single shard.
    pub const ALL: Self = Self { index: 0, of: 1 };

    /// Creates shard `number` of `of`, counted from 1. Returns `None` if `number` is out of range.
    pub const fn new(number: u64, of: u64) -> Option<Self> {
        if number == 0 || number > of { None } else { Some(Self { index: number - 1, of }) }
    }

    /// Returns the number of the shard, counted from 1.
    pub const fn number(self) -> u64 {
        self.index + 1
    }

    /// Returns the number of shards into which the sweep is divided.
    pub const fn of(self) -> u64 {
        self.of
    }

    /// Returns the number of points of this shard among the first `points` points of the sweep.
    pub const fn share_of(&self, points: u64) -> u64 {
        (points + self.of - 1 - self.index) / self.of
    }

    /// Returns true if a point belongs to this shard.
    pub const fn holds(&self, point: u64) -> bool {
        point % self.of == self.index
    }
}
