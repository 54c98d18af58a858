//! The last picture that a compared pipeline shows in the run with the first seed.

use image::RgbImage;
use pxpl5_measure::Measured;
use pxpl5_run::Outcome;
use pxpl5_sim::Time;
use pxpl5_wire::SurfaceId;

/// Last picture of a run for the first eye, and the ideal picture of the same instant.
#[derive(Clone, Debug)]
pub struct LastPicture {
    /// Picture on the display, which may be incomplete.
    pub seen: RgbImage,
    /// Ideal picture for the true pose of the head in the middle of the last display period, with the shading of the
    /// pipeline. `None` if the middle of the displayed picture has no lit pixel.
    pub should_be: Option<RgbImage>,
    /// True if the displayed picture was complete in time.
    pub is_complete: bool,
}

const FIRST: SurfaceId = SurfaceId(0);

impl LastPicture {
    /// Returns the last picture of a run, or `None` if no picture was shown. The run must have computed pixels.
    pub(super) fn of(outcome: &Outcome, is_complete: bool) -> Option<Self> {
        let seen = outcome.picture(FIRST)?;
        let should_be = middle_of_last(outcome).and_then(|middle| outcome.ideal_picture(FIRST, middle));
        Some(Self { seen, should_be: should_be.map(|ideal| ideal.image().clone()), is_complete })
    }
}

/// Returns the time at which the display's beam is in the middle of the last period.
fn middle_of_last(outcome: &Outcome) -> Option<Time> {
    let display = outcome.record().display();
    let surface = display.surfaces().first()?;
    display.line_lights(0, surface.width / 2, surface.height / 2, display.last_seen()?)
}
