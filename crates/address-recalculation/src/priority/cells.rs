//! The policy `cells`: the floor is divided into square cells of unlimited height. The distance of a cell from the
//! viewer's cell determines the cell's display memory.

use crate::priority::config::PriorityTiming;
use crate::priority::update::Update;
use crate::priority::validity::Threshold;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// A square of the floor, identified by its column (along x) and its row (along z).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Cell {
    /// Column: the least x coordinate in the cell, divided by the side of a cell.
    pub x: i64,
    /// Row: the least z coordinate in the cell, divided by the side of a cell.
    pub z: i64,
}

impl Cell {
    /// Returns the cell that contains a position, for cells of side `side_m`. A position on a border belongs to the
    /// cell with the larger coordinates.
    pub fn of(x: f64, z: f64, side_m: f64) -> Self {
        Self { x: column(x, side_m), z: column(z, side_m) }
    }

    /// Returns the number of the ring of cells around `self` that contains `other`: 0 for the same cell, 1 for its
    /// eight neighbours.
    pub fn ring(self, other: Self) -> u64 {
        self.x.abs_diff(other.x).max(self.z.abs_diff(other.z))
    }
}

/// Returns the coordinate, in metres, at which the cells of column `number` begin.
pub(crate) fn border(number: i64, side_m: f64) -> f64 {
    number as f64 * side_m
}

/// Returns the number of the column of cells that contains a coordinate. The result is the last column that begins at
/// or before the coordinate.
///
/// Comparisons correct the rounding errors of the division.
pub(crate) fn column(coordinate: f64, side_m: f64) -> i64 {
    let near = (coordinate / side_m).floor() as i64;
    let after = i64::from(border(near.saturating_add(1), side_m) <= coordinate);
    let before = i64::from(border(near, side_m) > coordinate);
    near.saturating_add(after - before)
}

/// Assignment of cells to memories by rings of cells. The home cell contained the eye at the time of the assignment.
/// All cells at the same distance from the home cell form a ring of cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellAssignment {
    pub home: Cell,
    pub side_m: f64,
    /// Number of rings of cells around the home cell that memory 0 holds.
    pub inner_rings: u64,
    /// Number of rings of cells in memory k divided by the number of rings in memory k - 1, for k of 2 or more. Memory
    /// 1 holds one ring of cells, memory 2 holds `ring_growth` rings of cells, and so on.
    pub ring_growth: u64,
    pub memories: usize,
}

impl CellAssignment {
    /// Returns the index of the memory that holds a cell (square of the floor).
    pub fn memory(&self, cell: Cell) -> usize {
        let ring = self.home.ring(cell);
        (0..self.memories - 1).find(|memory| ring <= self.last_ring(*memory)).unwrap_or(self.memories - 1)
    }

    /// Returns the number of the outermost ring of cells that memory k = `memory` holds. It does not apply to the last
    /// memory (the least often drawn), which has no outer limit.
    ///
    /// This is the number of inner rings plus 1 + g + g^2 + ... + g^(k-1), where g is [`CellAssignment::ring_growth`].
    pub fn last_ring(&self, memory: usize) -> u64 {
        let next = |(rings, of_memory): (u64, u64)| {
            (rings.saturating_add(of_memory), of_memory.saturating_mul(self.ring_growth))
        };
        (0..memory).fold((self.inner_rings, 1), |rings, _| next(rings)).0
    }

    /// Returns the distance, in metres, between a position and the border at which memory k = `memory` begins.
    ///
    /// The memory's cells lie outside this border. On or outside it, the distance is 0, and so it is for memory 0,
    /// which begins at the eye.
    pub fn distance(&self, place: DVec3, memory: usize) -> f64 {
        if memory == 0 { 0.0 } else { self.inside_block(place, self.last_ring(memory - 1)) }
    }

    /// Returns the horizontal distance, in metres, from a position inside the outer border of memory k = `memory` to
    /// this border. Memory k + 1 holds the cells beyond the border, and is drawn less often. For a position beyond the
    /// border, the distance is 0.
    ///
    /// Returns `None` for the last memory (the least often drawn), which has no outer border.
    pub fn to_slower(&self, place: DVec3, memory: usize) -> Option<f64> {
        (memory + 1 < self.memories).then(|| self.inside_block(place, self.last_ring(memory)))
    }

    /// Returns the distances of a position from a cell along x and along z in metres. A distance is 0 inside the cell's
    /// column or row.
    fn to_columns(self, place: DVec3, cell: Cell) -> [f64; 2] {
        let along = |place: f64, number: i64| {
            (border(number, self.side_m) - place).max(place - border(number.saturating_add(1), self.side_m)).max(0.0)
        };
        [along(place.x, cell.x), along(place.z, cell.z)]
    }

    /// Returns the distance, in metres, from a position to the border of a square block: the home cell and `rings`
    /// rings of cells around it. The distance is 0 outside the block.
    fn inside_block(&self, place: DVec3, rings: u64) -> f64 {
        let across = |place: f64, home: i64| {
            let low = (home as f64 - rings as f64) * self.side_m;
            let high = (home as f64 + rings as f64 + 1.0) * self.side_m;
            (place - low).min(high - place)
        };
        across(place.x, self.home.x).min(across(place.z, self.home.z)).max(0.0)
    }
}

/// State of the policy `cells`: the assignment of cells, and the eye position from which each memory was drawn.
#[derive(Clone, Debug)]
pub struct Cells {
    assignment: CellAssignment,
    threshold: Threshold,
    has_cascade: bool,
    to_held_cells: bool,
    occupied: BTreeSet<Cell>,
    /// Eye position of each memory's last update. `None` before its first update.
    drawn_from: Vec<Option<DVec3>>,
}

impl Cells {
    /// Creates the policy for a scene. `occupied` lists the cells in which the scene has content.
    ///
    /// With `has_cascade`, an update of a memory makes all memories that are drawn more often due for an update as
    /// well. Warping requires such a cascade.
    pub fn new(timing: &PriorityTiming, occupied: impl IntoIterator<Item = Cell>, has_cascade: bool) -> Self {
        let memories = timing.memories as usize;
        // The first frame will assign the cells around the viewer's own cell.
        let assignment = CellAssignment {
            home: Cell { x: 0, z: 0 },
            side_m: timing.cell_m,
            inner_rings: timing.inner_rings,
            ring_growth: timing.ring_growth,
            memories,
        };
        Self {
            assignment,
            threshold: Threshold::of_degrees(timing.theta_deg),
            has_cascade,
            to_held_cells: timing.to_held_cells == 1,
            occupied: occupied.into_iter().collect(),
            drawn_from: vec![None; memories],
        }
    }

    /// Returns the current assignment of cells to memories.
    pub const fn assignment(&self) -> &CellAssignment {
        &self.assignment
    }

    /// Returns the eye position from which a memory was last drawn, or `None` if it was never drawn.
    pub fn drawn_from(&self, memory: usize) -> Option<DVec3> {
        self.drawn_from.get(memory).copied().flatten()
    }

    /// Returns the distance, in metres, that the eye may move from the position of a memory's last update before the
    /// memory is due.
    ///
    /// If distances are measured to occupied cells, the result is infinite for a memory without occupied cells.
    pub fn way(&self, eye: DVec3, memory: usize) -> f64 {
        self.threshold.way(self.distances(eye).get(memory).copied().unwrap_or(0.0))
    }

    /// Returns, for each memory, the distance from the eye that determines when the memory is due, in metres. The
    /// distance is measured to the border of the memory's block of cells, or to the memory's nearest occupied cell.
    fn distances(&self, eye: DVec3) -> Vec<f64> {
        if !self.to_held_cells {
            return (0..self.assignment.memories).map(|memory| self.assignment.distance(eye, memory)).collect();
        }
        let CellAssignment { home, memories, .. } = self.assignment;
        let mut distances = vec![f64::INFINITY; memories];
        // The outermost rings are computed once for all cells, as in `CellAssignment::memory`.
        let last_rings: Vec<u64> = (0..memories - 1).map(|memory| self.assignment.last_ring(memory)).collect();
        for cell in &self.occupied {
            let ring = home.ring(*cell);
            let nearest = &mut distances[last_rings.partition_point(|last| *last < ring)];
            let [x, z] = self.assignment.to_columns(eye, *cell);
            // Most cells are too far in one direction, so the distance need not be computed.
            if x.max(z) < *nearest {
                *nearest = nearest.min(libm::hypot(x, z));
            }
        }
        distances[0] = 0.0;
        distances
    }

    /// Computes the updates of one frame for an eye position. Returns the memories to draw.
    pub fn frame(&mut self, eye: DVec3) -> Update {
        let memories = self.assignment.memories;
        let is_first = self.drawn_from[0].is_none();
        // Find the memories whose images are wrong.
        let ways: Vec<f64> = self.distances(eye).into_iter().map(|distance| self.threshold.way(distance)).collect();
        let is_due = |(from, way): (&Option<DVec3>, &f64)| from.is_none_or(|from| eye.distance(from) > *way);
        let mut due: Vec<bool> = self.drawn_from.iter().zip(&ways).map(is_due).collect();
        // A memory without cells is right from every position: it is never due and does not delay a new assignment.
        for (from, _) in self.drawn_from.iter_mut().zip(&ways).filter(|(from, way)| from.is_some() && way.is_infinite())
        {
            *from = Some(eye);
        }
        // Assign cells anew if the eye has left the home cell.
        let cell = Cell::of(eye.x, eye.z, self.assignment.side_m);
        let slowest_is_due = due[memories - 1] || ways[memories - 1].is_infinite();
        let reassigns_cells = cell != self.assignment.home && slowest_is_due;
        let mut together = vec![false; memories];
        if reassigns_cells {
            together = self.reassign(cell);
            for (due, changed) in due.iter_mut().zip(&together) {
                *due |= changed;
            }
        }
        // With a cascade, all memories that are drawn more often than a due memory are due.
        if self.has_cascade
            && let Some(slowest) = due.iter().rposition(|due| *due)
        {
            due[..slowest].fill(true);
        }
        for (from, _) in self.drawn_from.iter_mut().zip(&due).filter(|(_, due)| **due) {
            *from = Some(eye);
        }
        Update { due, together, reassigns_cells: reassigns_cells && !is_first }
    }

    /// Assigns cells to memories around `home`, the new home cell. Returns, for each memory, true if the cells of the
    /// memory have changed.
    fn reassign(&mut self, home: Cell) -> Vec<bool> {
        let before = self.assignment;
        self.assignment.home = home;
        let mut changed = vec![false; before.memories];
        for cell in &self.occupied {
            let memories = [before.memory(*cell), self.assignment.memory(*cell)];
            if memories[0] != memories[1] {
                memories.into_iter().for_each(|memory| changed[memory] = true);
            }
        }
        changed
    }
}
