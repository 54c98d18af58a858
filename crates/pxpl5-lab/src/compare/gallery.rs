//! The picture that a row shows at the end of its first run.

use image::RgbImage;
use pxpl5_measure::Measured;
use pxpl5_run::Outcome;
use pxpl5_sim::Time;
use pxpl5_wire::SurfaceId;

/// What stands before the first eye at the end of a run, and what should.
#[derive(Clone, Debug)]
pub struct LastPicture {
    /// What the eye sees, whether it was complete in time or not.
    pub seen: RgbImage,
    /// What an ideal renderer would show of the scene in the middle of the last period, the head being where it truly is: in the
    /// shading of the pipeline. `None` where the display has no such instant.
    pub should_be: Option<RgbImage>,
    /// Whether what is seen was complete in time.
    pub is_complete: bool,
}

/// The surface that is looked at.
const FIRST: SurfaceId = SurfaceId(0);

impl LastPicture {
    /// Of a run with pixels; `None` where nothing was shown.
    pub(super) fn of(outcome: &Outcome, is_complete: bool) -> Option<Self> {
        let seen = outcome.picture(FIRST)?;
        let should_be = middle_of_last(outcome).and_then(|middle| outcome.ideal_picture(FIRST, middle));
        Some(Self { seen, should_be: should_be.map(|ideal| ideal.image().clone()), is_complete })
    }
}

/// When the beam is in the middle of the last period.
fn middle_of_last(outcome: &Outcome) -> Option<Time> {
    let display = outcome.record().display();
    let surface = display.surfaces().first()?;
    display.line_lights(0, surface.width / 2, surface.height / 2, display.last_seen()?)
}
