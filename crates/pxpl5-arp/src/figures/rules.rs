//! Rules of priority rendering that the paper CPR05 (Chow, Pose and Regan, ACSC 2005) leaves open.

use address_recalculation::priority::PriorityTiming;
use serde::Serialize;

/// One set of answers to the questions about priority rendering that the paper CPR05 leaves open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Rules {
    /// Number of rings of cells around the viewer's cell in memory 0.
    pub inner_rings: u64,
    /// Number of rings of cells in memory k (2 or more), divided by the number of rings in memory k - 1. Memory k - 1
    /// is drawn more often.
    pub ring_growth: u64,
    /// Way of measuring the distance that determines when a memory is due. True: to the nearest cell with segments
    /// (parts of objects). False: to the border of a block of cells.
    pub to_held_cells: bool,
    /// True if an update of a memory makes all more often drawn memories due for an update.
    pub has_cascade: bool,
}

impl Rules {
    /// The rules that this project uses by default, because they have the smallest error of prediction.
    pub const USUAL: Self = Self {
        inner_rings: PriorityTiming::PAPERS.inner_rings,
        ring_growth: PriorityTiming::PAPERS.ring_growth,
        to_held_cells: PriorityTiming::PAPERS.to_held_cells == 1,
        has_cascade: true,
    };

    /// Returns all sets of rules that are compared.
    ///
    /// In some sets, memory 0 holds 0, 1 or 2 inner rings of cells, and every other memory holds one ring. In other
    /// sets, memory 0 holds 1 inner ring, and the number of rings doubles from memory to memory.
    pub fn all() -> Vec<Self> {
        let flags = [(false, false), (false, true), (true, false), (true, true)];
        let rings = [(0, 1), (1, 1), (2, 1), (1, 2)];
        let all = rings.into_iter().flat_map(|rings| flags.map(|flags| (rings, flags)));
        let rules = all.map(|((inner_rings, ring_growth), (to_held_cells, has_cascade))| Self {
            inner_rings,
            ring_growth,
            to_held_cells,
            has_cascade,
        });
        rules.collect()
    }

    pub fn text(&self) -> String {
        let rings = if self.ring_growth == 1 { "equal rings" } else { "rings that double" };
        let distance = if self.to_held_cells { "to held cells" } else { "to the block's border" };
        let cascade = if self.has_cascade { "cascade" } else { "no cascade" };
        format!("q = {}, {rings}, {distance}, {cascade}", self.inner_rings)
    }

    /// Returns the parameters of the policy with these rules. `cell_m` is the side of a cell in metres.
    pub fn numbers(&self, cell_m: f64) -> PriorityTiming {
        PriorityTiming {
            cell_m,
            inner_rings: self.inner_rings,
            ring_growth: self.ring_growth,
            to_held_cells: u64::from(self.to_held_cells),
            ..PriorityTiming::PAPERS
        }
    }
}
