//! Shares of a sweep.

/// A disjoint share of a sweep: the points whose number leaves remainder `index` when divided by `of`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: u64,
    of: u64,
}

impl Shard {
    /// The whole sweep in one share.
    pub const ALL: Self = Self { index: 0, of: 1 };

    /// Share `number` of `of`, counted from 1; `None` when there is no such share.
    #[must_use]
    pub const fn new(number: u64, of: u64) -> Option<Self> {
        if number == 0 || number > of { None } else { Some(Self { index: number - 1, of }) }
    }

    /// Which of them it is, from 1.
    #[must_use]
    pub const fn number(self) -> u64 {
        self.index + 1
    }

    /// How many shares there are.
    #[must_use]
    pub const fn of(self) -> u64 {
        self.of
    }

    /// How many of the first `points` points belong to it.
    #[must_use]
    pub const fn share_of(&self, points: u64) -> u64 {
        (points + self.of - 1 - self.index) / self.of
    }

    /// Whether a point belongs to it.
    #[must_use]
    pub const fn holds(&self, point: u64) -> bool {
        point % self.of == self.index
    }
}
