//! A whole walk and what is counted of it.

use crate::error::ExperimentError;
use crate::settings::{Settings, SourceKind};
use crate::simulation::{FrameOutcome, Simulation};
use crate::tears::Tears;
use crate::world::World;
use glam::DVec3;
use tracking::motion::Walk;

/// What a memory has counted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MemoryTally {
    /// Pictures that were shown.
    pub updates: u64,
    /// Retraces at which an update was not whole.
    pub missed: u64,
    /// Segments of all updates together.
    pub segments_drawn: u64,
    /// Triangles of all updates together.
    pub triangles_drawn: u64,
    /// Segments in it, summed over frames.
    pub segment_frames: u64,
    /// Distance of the eye from where it was drawn, summed over frames, m.
    pub age_m: f64,
    /// Frames in which it showed something.
    pub shown_frames: u64,
    /// Frames since the eye was where it was drawn from, summed over those.
    pub age_frames: u64,
    /// The part of them until the picture was shown first.
    pub drawing_frames: u64,
    /// Frames that the picture that is shown needed.
    drawn_in: u64,
}

/// What a walk has counted.
#[derive(Clone, Debug, PartialEq)]
pub struct WalkTally {
    /// Frames of it.
    pub frames: u64,
    /// Each memory.
    pub memories: Vec<MemoryTally>,
    /// How often cells were dealt anew.
    pub redeals: u64,
    /// Objects that changed memories, with the policy that has them.
    pub moved_objects: Option<u64>,
    /// Angles at shared vertices, of all frames.
    pub tears: Tears,
    /// The widest tear of each frame as drawn, radians, and the vertex where it gapes; `None` where no memories meet.
    pub widest: Vec<Option<(f64, u32)>>,
    /// Which memories were due, shown and missed in each frame.
    pub outcomes: Vec<FrameOutcome>,
}

impl WalkTally {
    /// Pictures a second of each memory.
    #[must_use]
    pub fn rates_hz(&self, frame_hz: f64) -> Vec<f64> {
        self.memories.iter().map(|memory| memory.updates as f64 * frame_hz / self.frames as f64).collect()
    }

    /// Segments drawn a second.
    #[must_use]
    pub fn draws_per_s(&self, frame_hz: f64) -> f64 {
        let draws: u64 = self.memories.iter().map(|memory| memory.segments_drawn).sum();
        draws as f64 * frame_hz / self.frames as f64
    }

    fn count(&mut self, simulation: &Simulation<'_>, outcome: FrameOutcome) {
        self.frames += 1;
        self.redeals += u64::from(outcome.deals_anew);
        for (memory, tally) in self.memories.iter_mut().enumerate() {
            tally.missed += u64::from(outcome.missed[memory]);
            let Some(content) = &simulation.shown()[memory] else { continue };
            let segments = content.segments.len() as u64;
            tally.segment_frames += segments;
            tally.age_m += content.eye.distance(outcome.eye);
            let age = self.frames - 1 - content.frame;
            if outcome.swapped[memory] {
                // What needs time is shown from the next frame on.
                tally.drawn_in = age + u64::from(simulation.settings().source != SourceKind::Ideal);
                tally.updates += 1;
                tally.segments_drawn += segments;
                tally.triangles_drawn += content.triangles(simulation.world());
            }
            tally.shown_frames += 1;
            tally.age_frames += age.max(tally.drawn_in);
            tally.drawing_frames += tally.drawn_in;
        }
        let tears = Tears::of(simulation.world(), simulation.shown());
        self.widest.push(tears.widest);
        self.tears.before.extend(tears.before);
        self.tears.after.extend(tears.after);
        self.tears.stretch.extend(tears.stretch.into_iter().max_by(f64::total_cmp));
        self.outcomes.push(outcome);
    }
}

/// Walks through a world for so many frames, with the eye of each frame at a place of its own.
///
/// # Errors
///
/// As [`Simulation::new`].
pub fn walk(
    world: &World,
    settings: &Settings,
    frames: u64,
    eye: impl Fn(u64) -> DVec3,
) -> Result<WalkTally, ExperimentError> {
    Ok(walked(world, settings, frames, eye)?.1)
}

/// The same, with what memories show at the end.
pub(crate) fn walked<'a>(
    world: &'a World,
    settings: &Settings,
    frames: u64,
    eye: impl Fn(u64) -> DVec3,
) -> Result<(Simulation<'a>, WalkTally), ExperimentError> {
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
    for frame in 0..frames {
        let outcome = simulation.frame(eye(frame))?;
        tally.count(&simulation, outcome);
    }
    tally.moved_objects = simulation.moved_objects();
    Ok((simulation, tally))
}

/// Where a walker is at the beginning of each frame.
pub fn at_frames(path: &Walk, m_per_s: f64, frame_hz: f64) -> impl Fn(u64) -> DVec3 {
    move |frame| path.place(m_per_s * frame as f64 / frame_hz)
}
