//! A complete experiment: a viewer's walk through a scene, and the view at the end of the walk.

use crate::hall::{path_of, scaled};
use crate::pictures::ahead;
use crate::plan::WalkPlan;
use crate::report::ArpReport;
use crate::settings::WalkSettings;
use crate::walk::{WalkTally, at_frames, walked};
use crate::walk_faces::WalkFaces;
use crate::world::World;
use pxpl5_scene::Scene;
use pxpl5_sim::Watcher;
use pxpl5_sim::parameters::SettingError;
use serde::Serialize;
use std::collections::BTreeMap;
use tracking::motion::Walk;

/// A report of a viewer's walk, with the scene and the settings.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WalkReport {
    /// Counters of the viewer's walk, and results of the view at the end of the walk.
    #[serde(flatten)]
    pub report: ArpReport,
    pub scene: String,
    /// Number of triangles in the scene after cutting: the sum over all segments (parts of objects in one cell).
    pub triangles: u64,
    /// Number of segments (parts of objects) into which the borders of cells cut the scene.
    pub segments: u64,
    /// Length of the viewer's walk, in frames of the most often drawn memory.
    pub frames: u64,
    pub m_per_s: f64,
    /// Settings that the user chose, by their path, for example `priority.cell_m`.
    pub settings: BTreeMap<String, String>,
}

/// Inputs and results of a completed walk of the viewer. As JSON, it is its report.
#[derive(Clone, Debug, Serialize)]
pub struct WalkOutcome {
    /// The scene after it was cut at the borders of cells.
    #[serde(skip)]
    pub world: World,
    #[serde(skip)]
    pub path: Walk,
    #[serde(skip)]
    pub settings: WalkSettings,
    #[serde(skip)]
    pub tally: WalkTally,
    /// Report of the viewer's walk. The report includes a view along the path at the end of the walk.
    #[serde(flatten)]
    pub report: WalkReport,
}

impl WalkOutcome {
    /// Simulates a walk. A stopped walk ends at its current frame.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if a setting is invalid or the scene is not supported.
    pub fn of(scene: &Scene, plan: &WalkPlan, watcher: &mut dyn Watcher) -> Result<Self, SettingError> {
        // Prepare the scene, the path and the segments.
        let settings = plan.settings()?;
        let scaled = (plan.walk.hall_scale != 1.0).then(|| scaled(scene, plan.walk.hall_scale)).transpose()?;
        let scene = scaled.as_ref().unwrap_or(scene);
        let path = path_of(scene, plan.route)?;
        let world = World::new(scene, settings.numbers.cell_m)?;
        let eye = at_frames(&path, plan.walk.m_per_s, settings.numbers.frame_hz);
        // Walk, and draw the view at the end.
        let (simulation, tally) = walked(&world, &settings, plan.walk.frames, &eye, watcher)?;
        let frames = tally.frames;
        let faces = WalkFaces::of(&simulation)?;
        let (_, stats) =
            faces.seen(ahead(&path, plan.walk.m_per_s * (frames - 1) as f64 / settings.numbers.frame_hz))?;
        let report = WalkReport {
            report: ArpReport::of(&world, &settings, &tally).with_view(&stats, &faces.drawing),
            scene: scene.name().to_owned(),
            triangles: world.segments.iter().map(|segment| segment.triangles.len() as u64).sum(),
            segments: world.segments.len() as u64,
            frames,
            m_per_s: plan.walk.m_per_s,
            settings: plan.given.clone(),
        };
        drop(eye);
        Ok(Self { path, settings, tally, report, world })
    }

    /// Returns the number of triangles drawn per second, summed over all memories.
    pub fn triangles_per_s(&self) -> f64 {
        let drawn: u64 = self.tally.memories.iter().map(|memory| memory.triangles_drawn).sum();
        drawn as f64 * self.settings.numbers.frame_hz / self.tally.frames as f64
    }
}
