//! Limits: the most triangles that a pipeline can draw in time.
//!
//! A limit is found by simulation, not by a formula: the scene grows until the goal is missed. The answer need not be
//! monotone (a clump that is nearly empty costs as many messages as a full one), so after a bisection the next two
//! clumps' worth of sizes above the answer are tried as well.

use crate::levels::summarise;
use glam::Vec3;
use pxpl5_machine::{ConfigError, MachineConfig};
use pxpl5_run::{
    Experiment, ExperimentError, Goal, Level, LimitCriterion, Pipeline, PipelineSettings, Pixels, Registry, Summary,
    TestScene,
};
use pxpl5_scene::{
    Frame, HeadMotion, HeadPath, Hmd, HmdConfig, Lighting, Scene, SceneParts, Structure, Sway, Vertex, builtin,
};
use serde::Serialize;
use std::sync::Arc;

/// Which pipeline, on which machine, must do what.
#[derive(Clone, Debug)]
pub struct LimitQuery {
    /// Where the pipeline's closed form is found.
    pub registry: Arc<Registry>,
    /// The machine that it runs on.
    pub config: MachineConfig,
    /// The pipeline whose limit is sought.
    pub pipeline: Arc<dyn Pipeline>,
    /// The triangles, what must hold, and for how many fields each size is simulated.
    pub criterion: LimitCriterion,
    /// The level of modelling at which every size is tried.
    pub level: Level,
}

/// What was found, and how sure it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Limit {
    /// Most triangles for which the goal was reached; 0 if it was not reached with one.
    pub triangles: u32,
    /// Fewest triangles above them that were tried and missed it; `None` if all that were tried reached it.
    pub first_miss: Option<u32>,
    /// Whether no smaller size that was tried missed it.
    pub monotone: bool,
    /// Sizes that were simulated.
    pub tried: usize,
}

/// NTSC's rates over the round ones.
const NTSC: f64 = 0.999;

/// Most triangles that are tried.
pub const CEILING: u32 = 1_000_000;

/// Sizes tried above the answer of the bisection.
const LOOK_AHEAD: u32 = 60;

/// Pictures after the warm-up without which nothing can be said of a rate: the goal counts as missed.
const PICTURES: usize = 4;

impl LimitQuery {
    /// The most triangles by the pipeline's own criterion, which its registry entry states.
    ///
    /// # Errors
    ///
    /// [`ExperimentError::Config`] when the registry of the papers does not know the pipeline.
    pub fn of_papers(config: MachineConfig, pipeline: impl Pipeline) -> Result<Self, ExperimentError> {
        let registry = crate::registry();
        let unknown = |_| ConfigError::Board(format!("no pipeline {} is known", pipeline.name()));
        let criterion = (registry.pipeline(pipeline.name()).map_err(unknown)?.limit)(&PipelineSettings::default());
        Ok(Self { registry, config, pipeline: Arc::new(pipeline), criterion, level: Level::Transaction })
    }

    /// Searches.
    ///
    /// # Errors
    ///
    /// [`ExperimentError`] when the machine cannot be built or the pipeline cannot run on it. A scene that does not
    /// fit into a board's memory, or that is too slow to be shown at all, misses the goal.
    pub fn search(&self) -> Result<Limit, ExperimentError> {
        most(CEILING, |triangles| self.reached(triangles))
    }

    fn reached(&self, triangles: u32) -> Result<bool, ExperimentError> {
        let scene = Arc::new(test_scene(self.criterion.scene, triangles));
        let experiment = Experiment::with(self.config.clone(), Arc::clone(&self.pipeline), scene)
            .fields(self.criterion.fields)
            .pixels(Pixels::Off)
            .level(self.level);
        match summarise(&self.registry, &experiment) {
            Ok(summary) => Ok(is_reached(self.criterion.goal, &summary)),
            Err(ExperimentError::TooShort { .. } | ExperimentError::Run { .. }) => Ok(false),
            Err(error) => Err(error),
        }
    }
}

fn is_reached(goal: Goal, summary: &Summary) -> bool {
    if summary.latencies_ms.len() < PICTURES {
        return false;
    }
    match goal {
        Goal::NoMissedRetrace => summary.due.is_some_and(|due| due.not_shown() == 0),
        Goal::RateHz(least) => summary.updates_hz.is_some_and(|hz| hz >= least * NTSC),
        Goal::LatencyFields(most) => summary.latency_fields().mean <= most,
    }
}

/// The largest size up to `ceiling` at which `reached` holds, as far as bisection and a look ahead can tell.
///
/// # Errors
///
/// The first error of `reached`.
pub fn most<E>(ceiling: u32, mut reached: impl FnMut(u32) -> Result<bool, E>) -> Result<Limit, E> {
    let mut tried = std::collections::BTreeMap::new();
    let mut ask = |size: u32| -> Result<bool, E> {
        if let Some(known) = tried.get(&size) {
            return Ok(*known);
        }
        let answer = reached(size)?;
        tried.insert(size, answer);
        Ok(answer)
    };
    let mut low = 0;
    let mut high = 1;
    while high < ceiling && ask(high)? {
        (low, high) = (high, (high * 2).min(ceiling));
    }
    loop {
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            *if ask(middle)? { &mut low } else { &mut high } = middle;
        }
        let ahead = (high..=(high + LOOK_AHEAD).min(ceiling)).rev();
        let step = (low / 400).max(1) as usize;
        let mut better = None;
        for size in ahead.step_by(step) {
            if ask(size)? {
                better = Some(size);
                break;
            }
        }
        match better {
            Some(size) => (low, high) = (size, size + 1),
            None => break,
        }
    }
    let first_miss = tried.iter().find(|(size, reached)| **size > low && !**reached).map(|(size, _)| *size);
    let monotone = tried.iter().all(|(size, reached)| *size > low || *reached);
    Ok(Limit { triangles: low, first_miss, monotone, tried: tried.len() })
}

/// Legs of a typical triangle in pixels: its box touches (1 + 18/128)^2 = 1.30 regions of 128 x 128 on average.
pub(crate) const TYPICAL_LEG_PX: f64 = 18.0;

/// Width and height of the place that their corners are spread over: with the disparity of the eyes and the triangle itself
/// they stay inside the 640 x 480 pixels.
pub(crate) const TYPICAL_SPREAD_PX: [f64; 2] = [540.0, 420.0];

/// Distance of typical triangles from the head, metres (assumed; any within the display's near and far planes).
const TYPICAL_DEPTH_M: f32 = 1.0;

/// A scene of so many triangles, at least one.
///
/// # Panics
///
/// Above the scene generator's largest number of triangles.
#[must_use]
pub fn test_scene(kind: TestScene, triangles: u32) -> Scene {
    match kind {
        TestScene::FullScreen => builtin(&format!("full-screen:{}", triangles.max(1))).expect("in range"),
        TestScene::Typical => typical(triangles.max(1)),
    }
}

/// Right-angled triangles fixed to the head, spread evenly by an additive recurrence.
fn typical(count: u32) -> Scene {
    let hmd = Hmd::new(HmdConfig::unc()).expect("the preset is valid");
    let pixel = TYPICAL_DEPTH_M / hmd.focal_length_px() as f32;
    let vertices = (0..count).flat_map(|i| corners(i, pixel)).map(|position| Vertex {
        position,
        normal: Vec3::Z,
        colour: [200, 196, 188],
    });
    let name = format!("typical:{count}");
    let parts = SceneParts {
        name: name.clone(),
        vertices: vertices.collect(),
        triangles: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        spheres: Vec::new(),
        structures: vec![Structure {
            name,
            vertices: 0..3 * count as usize,
            triangles: 0..count as usize,
            spheres: 0..0,
            frame: Frame::Head,
            hinge: None,
        }],
        lighting: Lighting::over_the_shoulder(),
        motion: HeadMotion::new(HeadPath::Still { eye: Vec3::ZERO, target: Vec3::NEG_Z }, Sway::none())
            .expect("in range"),
    };
    Scene::new(parts).expect("indices and normals are right by construction")
}

/// The plastic number's recurrence spreads points evenly over the unit square; 16 bits keep it exact.
fn corners(i: u32, pixel: f32) -> [Vec3; 3] {
    let share = |step: u32| (i.wrapping_mul(step) >> 16) as f32 / 65_536.0;
    let [width, height] = TYPICAL_SPREAD_PX.map(|px| px as f32);
    let x = (share(3_242_174_889) - 0.5) * width * pixel;
    let y = (share(2_447_445_413) - 0.5) * height * pixel;
    let leg = TYPICAL_LEG_PX as f32 * pixel;
    let at = |dx: f32, dy: f32| Vec3::new(x + dx, y + dy, -TYPICAL_DEPTH_M);
    [at(0.0, 0.0), at(leg, 0.0), at(0.0, leg)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    fn of(ceiling: u32, reached: impl Fn(u32) -> bool) -> Limit {
        most(ceiling, |size| Ok::<_, Infallible>(reached(size))).expect("infallible")
    }

    #[test]
    fn a_monotone_limit_is_found_exactly() {
        for limit in [0, 1, 2, 63, 110, 4_096] {
            let found = of(CEILING, |size| size <= limit);
            assert_eq!((found.triangles, found.first_miss, found.monotone), (limit, Some(limit + 1), true));
        }
    }

    #[test]
    fn a_gap_below_the_limit_is_looked_across() {
        // 121 to 123 miss because of an almost empty clump, 124 to 150 do not.
        let found = of(CEILING, |size| size <= 120 || (124..=150).contains(&size));
        assert_eq!((found.triangles, found.first_miss), (150, Some(151)));
    }

    #[test]
    fn a_goal_that_is_always_reached_ends_at_the_ceiling() {
        let found = of(1_000, |_| true);
        assert_eq!((found.triangles, found.first_miss), (1_000, None));
    }
}
