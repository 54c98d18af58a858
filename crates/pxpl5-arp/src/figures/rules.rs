//! Rules of priority rendering that the paper does not print.

use priority_rendering::PriorityTiming;
use serde::Serialize;

/// Rules that the paper does not print.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Rules {
    /// Rings of cells around the home cell in memory 0.
    pub inner_rings: u64,
    /// Rings of a memory relative to those of the next faster one.
    pub ring_growth: u64,
    /// True if distances are those of cells that hold something, false if those of a block's border.
    pub to_held_cells: bool,
    /// True if an update of a memory makes all faster ones due.
    pub has_cascade: bool,
}

impl Rules {
    /// The rules of this project.
    pub const USUAL: Self = Self {
        inner_rings: PriorityTiming::PAPERS.inner_rings,
        ring_growth: PriorityTiming::PAPERS.ring_growth,
        to_held_cells: PriorityTiming::PAPERS.to_held_cells == 1,
        has_cascade: false,
    };

    /// All combinations: the home cell, one or two inner rings with equal rings; one inner ring with rings that double.
    #[must_use]
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

    /// As a line of a table.
    #[must_use]
    pub fn text(&self) -> String {
        let rings = if self.ring_growth == 1 { "equal rings" } else { "rings that double" };
        let distance = if self.to_held_cells { "to held cells" } else { "to the block's border" };
        let cascade = if self.has_cascade { "cascade" } else { "no cascade" };
        format!("q = {}, {rings}, {distance}, {cascade}", self.inner_rings)
    }

    /// The numbers of the policy with these rules and cells of this side, m.
    #[must_use]
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
