//! Simulation of a viewer's walk, frame by frame: the updates that are due, and the drawing and display of memories.

use crate::content::{Content, warp};
use crate::settings::{PolicyKind, SourceKind, WalkSettings};
use crate::source::{Job, Queue};
use crate::world::World;
use address_recalculation::priority::{CellAssignment, Cells, Falloff, ObjectView, Objects, Threshold, Update};
use glam::DVec3;
use pxpl5_sim::parameters::SettingError;

/// The smallest part of a scene that a policy assigns to a memory: an object, or a segment of an object.
#[derive(Clone, Debug)]
struct Unit {
    segments: std::ops::Range<usize>,
    centre: DVec3,
    radius: f64,
}

impl Unit {
    /// Returns the distance, size and speed of this object or segment relative to an eye that moves at `speed` m/s.
    fn seen(&self, eye: DVec3, speed: f64) -> ObjectView {
        let distance_m = self.centre.distance(eye);
        ObjectView { distance_m, radius_m: self.radius, speed, turn: 0.0, animation_s: f64::INFINITY }
    }

    fn of(world: &World, segments: std::ops::Range<usize>) -> Self {
        let (centre, radius) = world.bounding_sphere(segments.clone());
        Self { segments, centre, radius }
    }
}

#[derive(Clone, Debug)]
enum Policy {
    Full,
    Objects(Objects),
    Cells(Cells),
}

/// Memories that became due, were updated or missed the retrace in one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameOutcome {
    pub eye: DVec3,
    /// Flag of each memory: true if it became due for an update.
    pub due: Vec<bool>,
    /// Flag of each memory: true if it has a new update. With an ideal renderer, the update is shown from this frame
    /// on. With a renderer of limited speed, the update is shown from the next frame on.
    pub swapped: Vec<bool>,
    /// Flag of each memory: true if its update was incomplete at the retrace.
    pub missed: Vec<bool>,
    /// True if cells (squares of the floor) were newly assigned to memories in this frame.
    pub reassigns_cells: bool,
}

/// A viewer's walk through a scene, simulated frame by frame.
#[derive(Clone, Debug)]
pub struct Simulation<'a> {
    pub world: &'a World,
    pub settings: WalkSettings,
    units: Vec<Unit>,
    policy: Policy,
    queue: Queue,
    /// Contents of each memory, or `None` for a memory without an update so far.
    pub shown: Vec<Option<Content>>,
    frames: u64,
    before: Option<DVec3>,
}

impl<'a> Simulation<'a> {
    /// Creates a simulation before its first frame. The world must have been cut with the cells of `settings`.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`WalkSettings::check`].
    pub fn new(world: &'a World, settings: &WalkSettings) -> Result<Self, SettingError> {
        settings.check()?;
        // With segmentation the policy assigns segments, without it whole objects.
        let units = units(world, settings.is_segmented);
        let policy = match settings.policy {
            PolicyKind::Full => Policy::Full,
            PolicyKind::Objects => Policy::Objects(Objects::new(&settings.numbers, units.len())),
            PolicyKind::Cells => Policy::Cells(Cells::new(&settings.numbers, world.cells(), settings.has_cascade)),
        };
        let memories = settings.memories();
        Ok(Self {
            world,
            settings: settings.clone(),
            units,
            policy,
            queue: Queue::new(memories),
            shown: vec![None; memories],
            frames: 0,
            before: None,
        })
    }

    /// Returns the current assignment of cells to memories. Returns `None` unless the policy is `cells`.
    pub const fn assignment(&self) -> Option<&CellAssignment> {
        match &self.policy {
            Policy::Cells(cells) => Some(cells.assignment()),
            Policy::Full | Policy::Objects(_) => None,
        }
    }

    /// Returns the number of times that an object moved from one memory to another. Returns `None` unless the policy is
    /// `objects`.
    pub const fn moved_objects(&self) -> Option<u64> {
        match &self.policy {
            Policy::Objects(objects) => Some(objects.counts()[0]),
            Policy::Full | Policy::Cells(_) => None,
        }
    }

    /// Simulates a frame with the eye at a position.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the distance over which warping decreases is zero.
    pub fn frame(&mut self, eye: DVec3) -> Result<FrameOutcome, SettingError> {
        // Ask the policy which memories are due, and collect their contents.
        let update = self.update(eye);
        let contents = self.contents(&update, eye)?;
        let mut outcome = FrameOutcome {
            eye,
            due: update.due.clone(),
            swapped: vec![false; update.due.len()],
            missed: vec![false; update.due.len()],
            reassigns_cells: update.reassigns_cells,
        };
        // Draw: an ideal source shows the contents at once.
        match self.settings.source {
            SourceKind::Ideal => {
                for (memory, content) in contents {
                    self.shown[memory] = Some(content);
                    outcome.swapped[memory] = true;
                }
            }
            SourceKind::Timed { triangles_per_s } => self.draw(contents, &update, triangles_per_s, &mut outcome),
        }
        self.frames += 1;
        self.before = Some(eye);
        Ok(outcome)
    }

    fn draw(
        &mut self,
        contents: Vec<(usize, Content)>,
        update: &Update,
        triangles_per_s: f64,
        outcome: &mut FrameOutcome,
    ) {
        // Queue the new updates.
        for (memory, content) in contents {
            let work_s = content.triangles(self.world) as f64 / triangles_per_s;
            let together = if update.together[memory] { update.together_bits() } else { 0 };
            self.queue.put(memory, Job { content, work_s, left_s: work_s, together });
        }
        // Draw for the duration of one frame, then show complete updates.
        self.queue.work(self.settings.numbers.frame_s());
        for (memory, shown) in self.queue.retrace().into_iter().enumerate() {
            match shown {
                Some(Ok(content)) => {
                    self.shown[memory] = Some(content);
                    outcome.swapped[memory] = true;
                }
                Some(Err(())) => outcome.missed[memory] = true,
                None => {}
            }
        }
    }

    fn update(&mut self, eye: DVec3) -> Update {
        // The validity of an object depends on the eye's speed since the previous frame.
        let speed = self.before.map_or(0.0, |before| before.distance(eye) * self.settings.numbers.frame_hz);
        match &mut self.policy {
            Policy::Full => Update { due: vec![true], together: vec![false], reassigns_cells: false },
            Policy::Cells(cells) => cells.frame(eye),
            Policy::Objects(objects) => {
                let threshold = Threshold::of_degrees(self.settings.numbers.theta_deg);
                let seen = self.units.iter().map(|unit| unit.seen(eye, speed));
                let periods: Vec<f64> = seen.map(|object| threshold.period(&object).least()).collect();
                objects.frame(self.frames, &periods)
            }
        }
    }

    fn contents(&self, update: &Update, eye: DVec3) -> Result<Vec<(usize, Content)>, SettingError> {
        let mut segments = vec![Vec::new(); update.due.len()];
        for (number, unit) in self.units.iter().enumerate() {
            segments[self.memory(number)].extend(unit.segments.clone());
        }
        let due = segments.into_iter().enumerate().filter(|(memory, _)| update.due[*memory]);
        due.map(|(memory, segments)| {
            Ok((memory, Content { eye, frame: self.frames, segments, warp: self.warp(memory, eye)? }))
        })
        .collect()
    }

    fn warp(
        &self,
        memory: usize,
        eye: DVec3,
    ) -> Result<Option<(address_recalculation::priority::RegionWarp, CellAssignment, usize)>, SettingError> {
        let Policy::Cells(cells) = &self.policy else { return Ok(None) };
        let is_warped = self.settings.falloff != Falloff::None && self.settings.is_segmented;
        match cells.drawn_from(memory + 1) {
            Some(slower) if is_warped => Ok(warp(&self.settings, cells.assignment(), memory, [eye, slower])?),
            _ => Ok(None),
        }
    }

    fn memory(&self, unit: usize) -> usize {
        match &self.policy {
            Policy::Full => 0,
            Policy::Objects(objects) => objects.memory(unit).unwrap_or(0),
            Policy::Cells(cells) => {
                let inside = &self.world.segments[self.units[unit].segments.clone()];
                inside.iter().map(|segment| cells.assignment().memory(segment.cell)).min().unwrap_or(0)
            }
        }
    }
}

fn units(world: &World, is_segmented: bool) -> Vec<Unit> {
    if is_segmented {
        return (0..world.segments.len()).map(|i| Unit::of(world, i..i + 1)).collect();
    }
    world.objects.iter().map(|object| Unit::of(world, object.segments.clone())).collect()
}
