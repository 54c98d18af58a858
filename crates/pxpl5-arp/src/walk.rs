//! A complete walk of the viewer through a scene, with counters of updates and draws.

use crate::settings::{SourceKind, WalkSettings};
use crate::simulation::{FrameOutcome, Simulation};
use crate::tears::Tears;
use crate::world::World;
use glam::DVec3;
use pxpl5_sim::Watcher;
use pxpl5_sim::parameters::SettingError;
use tracking::motion::Walk;

/// Counts of the updates of one display memory during a walk.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MemoryTally {
    /// Number of updates that were shown.
    pub updates: u64,
    /// Number of retraces at which an update was incomplete.
    pub missed: u64,
    /// Number of segments (parts of objects) drawn, summed over all updates.
    pub segments_drawn: u64,
    /// Number of triangles drawn, summed over all updates.
    pub triangles_drawn: u64,
    /// Number of segments (parts of objects) in the memory, summed over frames.
    pub segment_frames: u64,
    /// Distance between the eye and the position from which the memory was drawn, summed over frames, in metres.
    pub age_m: f64,
    /// Number of frames in which the memory showed any update.
    pub shown_frames: u64,
    /// Age of the eye position from which the shown update was drawn, in frames. The ages are summed over all frames in
    /// which the memory showed an update.
    pub age_frames: u64,
    /// Part of `age_frames` that passed while the renderer drew the updates.
    pub drawing_frames: u64,
    /// Number of frames in which the renderer drew the shown update.
    drawn_in: u64,
}

/// The results of a walk: counts of each display memory, and the tears between memories.
#[derive(Clone, Debug, PartialEq)]
pub struct WalkTally {
    pub frames: u64,
    pub memories: Vec<MemoryTally>,
    /// Number of times that cells (squares of the floor) were assigned to memories anew.
    pub redeals: u64,
    /// Number of times that an object moved from one memory to another, or `None` unless the policy is `objects`.
    pub moved_objects: Option<u64>,
    /// Angles of the tears (gaps between memories) at shared vertices, over all frames.
    pub tears: Tears,
    /// Width in radians of the widest tear (gap between two memories) that each frame shows, and the index of the
    /// tear's vertex. `None` for a frame in which no memories share a vertex.
    pub widest: Vec<Option<(f64, u32)>>,
    /// Memories that were due, showed an update, or missed the retrace, for each frame.
    pub outcomes: Vec<FrameOutcome>,
}

impl WalkTally {
    pub fn rates_hz(&self, frame_hz: f64) -> Vec<f64> {
        self.memories.iter().map(|memory| memory.updates as f64 * frame_hz / self.frames as f64).collect()
    }

    /// Returns the number of segments (parts of objects) drawn per second.
    pub fn draws_per_s(&self, frame_hz: f64) -> f64 {
        let draws: u64 = self.memories.iter().map(|memory| memory.segments_drawn).sum();
        draws as f64 * frame_hz / self.frames as f64
    }

    fn count(&mut self, simulation: &Simulation<'_>, outcome: FrameOutcome) {
        self.frames += 1;
        self.redeals += u64::from(outcome.reassigns_cells);
        for (memory, tally) in self.memories.iter_mut().enumerate() {
            tally.missed += u64::from(outcome.missed[memory]);
            let Some(content) = &simulation.shown[memory] else { continue };
            // Count the contents of the memory and the age of its eye position.
            let segments = content.segments.len() as u64;
            tally.segment_frames += segments;
            tally.age_m += content.eye.distance(outcome.eye);
            let age = self.frames - 1 - content.frame;
            if outcome.swapped[memory] {
                // A timed source shows an update from the next frame on.
                tally.drawn_in = age + u64::from(simulation.settings.source != SourceKind::Ideal);
                tally.updates += 1;
                tally.segments_drawn += segments;
                tally.triangles_drawn += content.triangles(simulation.world);
            }
            tally.shown_frames += 1;
            tally.age_frames += age.max(tally.drawn_in);
            tally.drawing_frames += tally.drawn_in;
        }
        // Tears between all memories in this frame.
        let tears = Tears::of(simulation.world, &simulation.shown);
        self.widest.push(tears.widest);
        self.tears.before.extend(tears.before);
        self.tears.after.extend(tears.after);
        self.tears.stretch.extend(tears.stretch.into_iter().max_by(f64::total_cmp));
        self.outcomes.push(outcome);
    }
}

/// Walks through a world for `frames` frames. `eye` returns the position of the eye in each frame.
///
/// # Errors
///
/// Fails in the same cases as [`Simulation::new`].
pub fn walk(
    world: &World,
    settings: &WalkSettings,
    frames: u64,
    eye: impl Fn(u64) -> DVec3,
) -> Result<WalkTally, SettingError> {
    Ok(walked(world, settings, frames, eye, &mut ())?.1)
}

pub(crate) fn walked<'a>(
    world: &'a World,
    settings: &WalkSettings,
    frames: u64,
    eye: impl Fn(u64) -> DVec3,
    watcher: &mut dyn Watcher,
) -> Result<(Simulation<'a>, WalkTally), SettingError> {
    let mut simulation = Simulation::new(world, settings)?;
    let mut tally = WalkTally {
        frames: 0,
        memories: vec![MemoryTally::default(); settings.memories()],
        redeals: 0,
        moved_objects: None,
        tears: Tears::default(),
        widest: Vec::new(),
        outcomes: Vec::new(),
    };
    let stop = watcher.stop();
    for frame in 0..frames {
        let outcome = simulation.frame(eye(frame))?;
        tally.count(&simulation, outcome);
        watcher.progress(frame + 1, frames);
        if stop.is_stopped() {
            break;
        }
    }
    tally.moved_objects = simulation.moved_objects();
    Ok((simulation, tally))
}

/// Returns a function that maps the index of a frame to the walker's position at the start of this frame.
pub fn at_frames(path: &Walk, m_per_s: f64, frame_hz: f64) -> impl Fn(u64) -> DVec3 {
    move |frame| path.place(m_per_s * frame as f64 / frame_hz)
}
