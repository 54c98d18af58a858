//! Policy `cells`: assigns the cells (squares of the floor) around the user to the display memories.

use super::plan::{Due, DuePolicy, Updates, place};
use address_recalculation::priority::{Cell, Cells, Falloff, PriorityTiming};
use glam::DVec3;
use pphigs::FrameView;
use pxpl5_sim::Time;
use pxpl5_wire::PictureNumber;
use rendering_control::cube::FaceWarp;
use std::collections::VecDeque;
use std::sync::Arc;

/// Region priority rendering: assigns each structure to the fastest (most often updated) display memory among the
/// memories of its cells. A structure that moves by itself is in memory 0.
///
/// In each cycle (a round of updates), the policy redraws the display memories that are due. All memories of a cycle
/// are drawn from one position of the eye, because warping needs the exact positions. With warping, all memories of a
/// cycle swap together. Otherwise, a memory that swapped before its neighbour would be warped for an eye position that
/// the neighbour does not display yet.
pub(super) struct ByCells {
    policy: Cells,
    cells: Arc<[Vec<Cell>]>,
    falloff: Falloff,
    length_m: f64,
    /// Position of the eye in the last update of each display memory.
    drawn_from: Vec<DVec3>,
    /// Flag of each display memory: true if its last update contained any structure.
    held: Vec<bool>,
    has_moving: bool,
}

impl ByCells {
    pub(super) fn new(updates: &Updates, cells: Arc<[Vec<Cell>]>, timing: &PriorityTiming, falloff: Falloff) -> Self {
        let memories = timing.memories as usize;
        Self {
            policy: Cells::new(timing, cells.iter().flatten().copied(), falloff != Falloff::None),
            has_moving: updates.moving.iter().any(|moves| *moves),
            cells,
            falloff,
            length_m: timing.falloff_length_m(),
            drawn_from: vec![DVec3::ZERO; memories],
            held: vec![false; memories],
        }
    }

    fn memory(&self, structure: usize) -> usize {
        let cells = self.cells.get(structure).into_iter().flatten();
        cells.map(|cell| self.policy.assignment().memory(*cell)).min().unwrap_or(0)
    }

    /// Returns the displacement of vertices for a display memory. The displaced image meets the image of the memory
    /// with the next lower update rate at their border.
    fn warp(&self, memory: usize) -> Option<FaceWarp> {
        let slower_from = *self.drawn_from.get(memory + 1).filter(|_| self.falloff != Falloff::None)?;
        Some(FaceWarp {
            assignment: *self.policy.assignment(),
            falloff: self.falloff,
            length_m: self.length_m,
            drawn_from: self.drawn_from[memory],
            slower_from,
        })
    }

    /// Returns the display memories to draw in this cycle. A memory that contained no structure and still contains none
    /// is left out.
    fn drawn(&mut self, due: &[bool], of_memories: &[Arc<[bool]>]) -> Vec<usize> {
        let mut drawn = Vec::new();
        for (memory, structures) in of_memories.iter().enumerate().filter(|(memory, _)| due[*memory]) {
            let holds = structures.contains(&true);
            if std::mem::replace(&mut self.held[memory], holds) || holds {
                drawn.push(memory);
            }
        }
        drawn
    }
}

impl DuePolicy for ByCells {
    fn begin(&mut self, updates: &Updates, number: PictureNumber, now: Time) -> VecDeque<Due> {
        let eye = updates.setup.views.pose_at(now, now).position;
        let mut update = self.policy.frame(eye);
        update.due[0] |= self.has_moving;
        if !update.due.contains(&true) {
            return VecDeque::new();
        }
        // All memories in one cycle of the policy use the same view.
        let view = updates.view(number, now);
        let from = view.eyes.first().map_or(eye, |eye| place(&eye.world_to_eye));
        for (memory, drawn_from) in self.drawn_from.iter_mut().enumerate() {
            // A memory without cells needs no warp, because it is correct from everywhere.
            if update.due[memory] || self.policy.way(eye, memory).is_infinite() {
                *drawn_from = from;
            }
        }
        // Assign the structures to memories, and decide which memories swap together.
        let memories: Vec<usize> = (0..self.cells.len()).map(|structure| self.memory(structure)).collect();
        let of_memory = |memory: usize| memories.iter().map(|held_by| *held_by == memory).collect();
        let of_memories: Vec<Arc<[bool]>> = (0..update.due.len()).map(of_memory).collect();
        let drawn = self.drawn(&update.due, &of_memories);
        let all_together = self.falloff != Falloff::None && drawn.len() > 1;
        let together = drawn.iter().filter(|memory| all_together || update.together[**memory]);
        let bits = together.fold(0, |bits, memory| bits | 1 << memory);
        let due = drawn.iter().map(|memory| self.due(*memory, bits, &of_memories[*memory], (now, &view)));
        due.collect()
    }
}

impl ByCells {
    fn due(&self, memory: usize, together: u8, structures: &Arc<[bool]>, (at, view): (Time, &FrameView)) -> Due {
        Due {
            memory,
            together: if together >> memory & 1 == 1 { together } else { 0 },
            structures: Arc::clone(structures),
            at,
            view: Some(view.clone()),
            warp: self.warp(memory),
        }
    }
}
