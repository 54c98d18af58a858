//! Studies of walks of a viewer through a scene, with a display that follows the head's rotation.

use crate::error::StudyError;
use crate::estimate::{BASE, BUSY, Estimate};
use crate::study::{Study, check};
use pxpl5_arp::figures::Interpretations;
use pxpl5_arp::{ArpComparison, WalkOutcome, WalkPlan, compare, variant_count};
use pxpl5_scene::Scene;
use pxpl5_sim::Watcher;
use std::sync::Arc;

/// A walk through a scene.
#[derive(Clone, Debug)]
pub struct WalkQuery {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Settings of the display and of the walk.
    pub plan: WalkPlan,
    /// True if the estimate counts the pictures of the walk.
    pub has_pictures: bool,
}

/// Bytes for one texel of a cube face, one frame of a walk, and one primitive of its scene.
const BYTES: [f64; 3] = [10.0, 3e3, 2e3];
/// Seconds for one texel of a cube face, and for one primitive in one frame.
const SECONDS: [f64; 2] = [15e-9, 65e-9];
/// Factor on time and memory of a walk whose pictures are drawn, and seconds for the pictures.
const PICTURES: (f64, f64) = (10.0, 0.5);

impl Study for WalkQuery {
    type Report = WalkOutcome;

    fn estimate(&self, _: usize) -> Estimate {
        let face_texels = self.plan.settings().map_or(0, |settings| settings.display.timing.face_texels);
        let texels = 6.0 * (face_texels as f64).powi(2);
        let [frames, primitives] = [self.plan.walk.frames, self.scene.primitives() as u64].map(|number| number as f64);
        let (times, more_s) = if self.has_pictures { PICTURES } else { (1.0, 0.0) };
        let bytes = BASE + BYTES[0] * times * texels + BYTES[1] * frames + BYTES[2] * primitives;
        let seconds = times * (SECONDS[0] * texels + SECONDS[1] * frames * primitives) + more_s;
        Estimate { bytes, seconds: BUSY * seconds }
    }

    /// Simulates the walk. After a stop, the report has the frames that were walked.
    fn run(&self, watcher: &mut dyn Watcher) -> Result<WalkOutcome, StudyError> {
        check(&watcher.stop())?;
        Ok(WalkOutcome::of(&self.scene, &self.plan, watcher)?)
    }
}

/// A walk with each policy and each kind of warping.
#[derive(Clone, Debug)]
pub struct WalkComparisonQuery(pub WalkQuery);

impl Study for WalkComparisonQuery {
    type Report = ArpComparison;

    fn estimate(&self, threads: usize) -> Estimate {
        let one = self.0.estimate(threads);
        Estimate { seconds: variant_count() as f64 * one.seconds, ..one }
    }

    fn run(&self, watcher: &mut dyn Watcher) -> Result<ArpComparison, StudyError> {
        Ok(compare(&self.0.scene, &self.0.plan, watcher))
    }
}

/// A ranking of the interpretations of the paper on priority rendering.
#[derive(Clone, Copy, Debug)]
pub struct WalkInterpretationQuery;

impl Study for WalkInterpretationQuery {
    type Report = Interpretations;

    fn run(&self, watcher: &mut dyn Watcher) -> Result<Interpretations, StudyError> {
        Ok(Interpretations::run(watcher)?)
    }
}
