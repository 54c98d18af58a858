//! A walk through a scene, and what is seen at its end.

use crate::error::ExperimentError;
use crate::hall::{path_of, scaled};
use crate::look::Faces;
use crate::pictures::ahead;
use crate::plan::Plan;
use crate::report::{Looked, Report};
use crate::settings::Settings;
use crate::walk::{WalkTally, at_frames, walked};
use crate::world::World;
use pxpl5_scene::Scene;
use serde::Serialize;
use std::collections::BTreeMap;
use tracking::motion::Walk;

/// A report with what it is of.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WalkReport {
    /// What was counted and seen.
    #[serde(flatten)]
    pub report: Report,
    /// Name of the scene that was walked through.
    pub scene: String,
    /// Triangles of all segments.
    pub triangles: u64,
    /// Segments that cells cut the scene into.
    pub segments: u64,
    /// Length of the walk, frames of the fastest memory.
    pub frames: u64,
    /// Speed of the walk.
    pub m_per_s: f64,
    /// Paths that were set, and to what.
    pub settings: BTreeMap<String, String>,
}

/// A walk that was taken.
#[derive(Clone, Debug)]
pub struct WalkOutcome {
    /// The scene as it was cut.
    pub world: World,
    /// The way through it.
    pub path: Walk,
    /// What was drawn.
    pub settings: Settings,
    /// What was counted, frame by frame.
    pub tally: WalkTally,
    /// The same as a report, with a look at the end along the path.
    pub report: WalkReport,
}

impl WalkOutcome {
    /// Walks; `finished` hears how many of all frames are done.
    ///
    /// # Errors
    ///
    /// [`ExperimentError`] for settings or a scene that do not suit.
    pub fn of(scene: &Scene, plan: &Plan, finished: impl Fn(u64, u64)) -> Result<Self, ExperimentError> {
        let settings = plan.settings()?;
        let scaled = (plan.walk.hall_scale != 1.0).then(|| scaled(scene, plan.walk.hall_scale)).transpose()?;
        let scene = scaled.as_ref().unwrap_or(scene);
        let path = path_of(scene, plan.route())?;
        let world = World::new(scene, settings.numbers.cell_m)?;
        let frames = plan.walk.frames;
        let eye = at_frames(&path, plan.walk.m_per_s, settings.numbers.frame_hz);
        let (simulation, tally) = walked(&world, &settings, frames, |frame| {
            finished(frame + 1, frames);
            eye(frame)
        })?;
        let faces = Faces::of(&simulation)?;
        let (_, stats) =
            faces.seen(ahead(&path, plan.walk.m_per_s * (frames - 1) as f64 / settings.numbers.frame_hz))?;
        let looked = Looked { stats, drawing: faces.drawing };
        let report = WalkReport {
            report: Report::of(&world, &settings, &tally, Some(&looked)),
            scene: scene.name().to_owned(),
            triangles: world.segments.iter().map(|segment| segment.triangles.len() as u64).sum(),
            segments: world.segments.len() as u64,
            frames,
            m_per_s: plan.walk.m_per_s,
            settings: plan.said().clone(),
        };
        drop(eye);
        Ok(Self { path, settings, tally, report, world })
    }

    /// Triangles drawn a second, all memories together.
    #[must_use]
    pub fn triangles_per_s(&self) -> f64 {
        let drawn: u64 = self.tally.memories.iter().map(|memory| memory.triangles_drawn).sum();
        drawn as f64 * self.settings.numbers.frame_hz / self.tally.frames as f64
    }
}
