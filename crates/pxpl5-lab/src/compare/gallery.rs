//! The pictures of all rows beside each other.

use super::contender::{Contender, contenders};
use super::query::{CompareError, CompareQuery};
use crate::experiment_file::Plan;
use crate::parallel;
use image::RgbImage;
use pxpl5_measure::{FieldError, Measured, pixel_errors};
use pxpl5_run::{Outcome, Pixels};
use pxpl5_scene::Scene;
use pxpl5_sim::Time;
use pxpl5_wire::SurfaceId;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// What stands before the first eye at the end of a row's run, of the first seed.
#[derive(Clone, Debug)]
pub struct GalleryPicture {
    /// Name of the row.
    pub pipeline: String,
    /// What the eye sees; why nothing, where the pipeline cannot run.
    pub seen: Result<RgbImage, String>,
    /// What an ideal renderer would show of the scene in the middle of the last period, the head being where it truly is: in the
    /// shading of the pipeline. `None` where nothing is seen.
    pub should_be: Option<RgbImage>,
    /// Whether what is seen was complete in time.
    pub is_complete: bool,
    /// The error of the last period that was judged, if one was.
    pub last_error: Option<FieldError>,
}

impl CompareQuery {
    /// Runs every row once more, with pixels, and looks at the end of it; `finished` hears how many of all are done.
    ///
    /// # Errors
    ///
    /// As [`CompareQuery::run`].
    pub fn gallery(&self, finished: impl Fn(u64, u64) + Sync) -> Result<Vec<GalleryPicture>, CompareError> {
        let any = self.any_plan()?;
        let scene = any.load_scene()?;
        let drawn: Vec<Contender> =
            contenders(&any.registry).into_iter().filter(|contender| !contender.is_reference()).collect();
        let seed = self.seeds.first().copied().unwrap_or_default();
        let done = AtomicU64::new(0);
        Ok(parallel::map(&drawn, |contender| {
            let plan = contender.plan(&self.shared, seed).map_err(|error| error.to_string());
            let outcome = plan.and_then(|plan| run(&plan, &scene));
            finished(done.fetch_add(1, Ordering::Relaxed) + 1, drawn.len() as u64);
            let pipeline = contender.name.clone();
            match outcome {
                Ok(outcome) => GalleryPicture::of_run(pipeline, &outcome),
                Err(why) => GalleryPicture::of_failure(pipeline, why),
            }
        }))
    }
}

fn run(plan: &Plan, scene: &Arc<Scene>) -> Result<Outcome, String> {
    plan.experiment(Arc::clone(scene)).pixels(Pixels::Lazy).run().map_err(|error| error.to_string())
}

/// The surface that is looked at.
const FIRST: SurfaceId = SurfaceId(0);

impl GalleryPicture {
    fn of_run(pipeline: String, outcome: &Outcome) -> Self {
        let should_be = middle_of_last(outcome).and_then(|middle| outcome.ideal_picture(FIRST, middle));
        Self {
            pipeline,
            seen: outcome.picture(FIRST).ok_or_else(|| "nothing was shown".to_owned()),
            should_be: should_be.map(|ideal| ideal.image().clone()),
            is_complete: outcome.report().ends_complete,
            last_error: pixel_errors(outcome).and_then(|errors| errors.by_field.last().copied()),
        }
    }

    const fn of_failure(pipeline: String, why: String) -> Self {
        Self { pipeline, seen: Err(why), should_be: None, is_complete: false, last_error: None }
    }
}

/// When the beam is in the middle of the last period.
fn middle_of_last(outcome: &Outcome) -> Option<Time> {
    let display = outcome.record().display();
    let surface = display.surfaces().first()?;
    display.line_lights(0, surface.width / 2, surface.height / 2, display.last_seen()?)
}
