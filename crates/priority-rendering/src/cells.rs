//! Policy `cells`: square cells of full height, dealt to memories by their distance from the user's.

use crate::config::PriorityTiming;
use crate::update::Update;
use crate::validity::Threshold;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// A square of the floor, counted along x and z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Cell {
    /// Whole sides along x, rounded down.
    pub x: i64,
    /// Whole sides along z, rounded down.
    pub z: i64,
}

impl Cell {
    /// The cell of a place in the world, with cells of this side, m. Borders belong to the cell on their positive side.
    #[must_use]
    pub fn of(x: f64, z: f64, side_m: f64) -> Self {
        Self { x: column(x, side_m), z: column(z, side_m) }
    }

    /// Rings between two cells: 0 for the same, 1 for its eight neighbours.
    #[must_use]
    pub fn ring(self, other: Self) -> u64 {
        self.x.abs_diff(other.x).max(self.z.abs_diff(other.z))
    }
}

/// Where a column of cells begins, m.
pub(crate) fn border(number: i64, side_m: f64) -> f64 {
    number as f64 * side_m
}

/// The column of cells of a coordinate: the last one that begins at or before it, whatever a division would round to.
pub(crate) fn column(coordinate: f64, side_m: f64) -> i64 {
    let near = (coordinate / side_m).floor() as i64;
    let after = i64::from(border(near.saturating_add(1), side_m) <= coordinate);
    let before = i64::from(border(near, side_m) > coordinate);
    near.saturating_add(after - before)
}

/// How cells are dealt around the one that counts as the user's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dealing {
    /// The cell around which they are dealt.
    pub home: Cell,
    /// Side of a cell, m.
    pub side_m: f64,
    /// Rings around the home cell that memory 0 holds besides it.
    pub inner_rings: u64,
    /// Rings of each memory relative to the next faster one: memory 1 holds one, memory 2 holds `ring_growth`, and so on.
    pub ring_growth: u64,
    /// Memories among which they are dealt.
    pub memories: usize,
}

impl Dealing {
    /// The memory of a cell.
    #[must_use]
    pub fn memory(&self, cell: Cell) -> usize {
        let ring = self.home.ring(cell);
        (0..self.memories - 1).find(|memory| ring <= self.last_ring(*memory)).unwrap_or(self.memories - 1)
    }

    /// The outermost ring of memory k, unless it is the slowest one: the inner rings, then 1 + g + g^2 + ... + g^(k-1) more, g being
    /// [`Dealing::ring_growth`].
    #[must_use]
    pub fn last_ring(&self, memory: usize) -> u64 {
        let next = |(rings, of_memory): (u64, u64)| {
            (rings.saturating_add(of_memory), of_memory.saturating_mul(self.ring_growth))
        };
        (0..memory).fold((self.inner_rings, 1), |rings, _| next(rings)).0
    }

    /// Distance of a place from the border behind which memory k begins, m: from inside, 0 outside or on it. Memory 0 begins
    /// at the eye.
    #[must_use]
    pub fn distance(&self, place: DVec3, memory: usize) -> f64 {
        if memory == 0 { 0.0 } else { self.inside_block(place, self.last_ring(memory - 1)) }
    }

    /// Horizontal distance of a place from the border between memory k and k + 1, m, from inside; `None` for the slowest
    /// memory, which has no such border.
    #[must_use]
    pub fn to_slower(&self, place: DVec3, memory: usize) -> Option<f64> {
        (memory + 1 < self.memories).then(|| self.inside_block(place, self.last_ring(memory)))
    }

    /// Horizontal distance of a place from a cell, m; 0 inside.
    fn to_cell(self, place: DVec3, cell: Cell) -> f64 {
        let along = |place: f64, number: i64| {
            (border(number, self.side_m) - place).max(place - border(number.saturating_add(1), self.side_m)).max(0.0)
        };
        libm::hypot(along(place.x, cell.x), along(place.z, cell.z))
    }

    /// Distance to the border of the block of so many rings around home.
    fn inside_block(&self, place: DVec3, rings: u64) -> f64 {
        let across = |place: f64, home: i64| {
            let low = (home as f64 - rings as f64) * self.side_m;
            let high = (home as f64 + rings as f64 + 1.0) * self.side_m;
            (place - low).min(high - place)
        };
        across(place.x, self.home.x).min(across(place.z, self.home.z)).max(0.0)
    }
}

/// The state of the policy: which cells are in which memory, and where each memory was drawn from.
#[derive(Clone, Debug)]
pub struct Cells {
    dealing: Dealing,
    threshold: Threshold,
    has_cascade: bool,
    to_held_cells: bool,
    occupied: BTreeSet<Cell>,
    /// Where each memory was last drawn from; `None` before its first update.
    drawn_from: Vec<Option<DVec3>>,
}

impl Cells {
    /// The policy for a world with something in these cells. With `has_cascade` an update of a memory makes all faster ones
    /// due, as warping needs it.
    #[must_use]
    pub fn new(timing: &PriorityTiming, occupied: impl IntoIterator<Item = Cell>, has_cascade: bool) -> Self {
        let memories = timing.memories as usize;
        let dealing = Dealing {
            home: Cell { x: 0, z: 0 },
            side_m: timing.cell_m,
            inner_rings: timing.inner_rings,
            ring_growth: timing.ring_growth,
            memories,
        };
        Self {
            dealing,
            threshold: Threshold::of_degrees(timing.theta_deg),
            has_cascade,
            to_held_cells: timing.to_held_cells == 1,
            occupied: occupied.into_iter().collect(),
            drawn_from: vec![None; memories],
        }
    }

    /// How cells are dealt now.
    #[must_use]
    pub const fn dealing(&self) -> &Dealing {
        &self.dealing
    }

    /// Where a memory was last drawn from.
    #[must_use]
    pub fn drawn_from(&self, memory: usize) -> Option<DVec3> {
        self.drawn_from.get(memory).copied().flatten()
    }

    /// How far the eye may be from where a memory was drawn, m, before it is due; infinite for a memory without cells, where
    /// distances are those of cells that hold something.
    #[must_use]
    pub fn way(&self, eye: DVec3, memory: usize) -> f64 {
        self.threshold.way(self.distances(eye).get(memory).copied().unwrap_or(0.0))
    }

    /// The distance that counts for each memory, m.
    fn distances(&self, eye: DVec3) -> Vec<f64> {
        if !self.to_held_cells {
            return (0..self.dealing.memories).map(|memory| self.dealing.distance(eye, memory)).collect();
        }
        let mut distances = vec![f64::INFINITY; self.dealing.memories];
        for cell in &self.occupied {
            let nearest = &mut distances[self.dealing.memory(*cell)];
            *nearest = nearest.min(self.dealing.to_cell(eye, *cell));
        }
        distances[0] = 0.0;
        distances
    }

    /// A frame: what is drawn for this place of the eye.
    pub fn frame(&mut self, eye: DVec3) -> Update {
        let memories = self.dealing.memories;
        let is_first = self.drawn_from[0].is_none();
        let ways: Vec<f64> = self.distances(eye).into_iter().map(|distance| self.threshold.way(distance)).collect();
        let is_due = |(from, way): (&Option<DVec3>, &f64)| from.is_none_or(|from| eye.distance(from) > *way);
        let mut due: Vec<bool> = self.drawn_from.iter().zip(&ways).map(is_due).collect();
        // A memory without cells is right from everywhere: it is never due, and it does not hold back a new dealing.
        for (from, _) in self.drawn_from.iter_mut().zip(&ways).filter(|(from, way)| from.is_some() && way.is_infinite())
        {
            *from = Some(eye);
        }
        let cell = Cell::of(eye.x, eye.z, self.dealing.side_m);
        let slowest_may_deal = due[memories - 1] || ways[memories - 1].is_infinite();
        let deals_anew = cell != self.dealing.home && slowest_may_deal;
        let mut together = vec![false; memories];
        if deals_anew {
            together = self.deal(cell);
            for (due, changed) in due.iter_mut().zip(&together) {
                *due |= changed;
            }
        }
        if self.has_cascade
            && let Some(slowest) = due.iter().rposition(|due| *due)
        {
            due[..slowest].fill(true);
        }
        for (from, _) in self.drawn_from.iter_mut().zip(&due).filter(|(_, due)| **due) {
            *from = Some(eye);
        }
        Update { due, together, deals_anew: deals_anew && !is_first }
    }

    /// Deals around another cell; the memories whose cells are others now.
    fn deal(&mut self, home: Cell) -> Vec<bool> {
        let before = self.dealing;
        self.dealing.home = home;
        let mut changed = vec![false; before.memories];
        for cell in &self.occupied {
            let memories = [before.memory(*cell), self.dealing.memory(*cell)];
            if memories[0] != memories[1] {
                memories.into_iter().for_each(|memory| changed[memory] = true);
            }
        }
        changed
    }
}
