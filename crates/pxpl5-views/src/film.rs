//! Films of the displayed pictures, period by period, as animated PNG.

use crate::animation::Animation;
use crate::frame_time::frame_seconds;
use crate::picture::PictureError;
use image::RgbImage;
use pxpl5_machine::Machine;
use pxpl5_measure::{RasterOffsets, screen, side_by_side};
use pxpl5_run::{Experiment, ExperimentError, Outcome, Pixels, Raster};
use pxpl5_sim::Span;
use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::display::{Display, Surface};
use pxpl5_wire::{PeriodNumber, SurfaceId};
use std::io::Write;

/// Surfaces of the first display that a film shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmSurfaces {
    /// A single surface, such as the surface of one eye.
    One(SurfaceId),
    /// All surfaces side by side, the first surface on the left.
    All,
}

/// A film of an experiment. The film has one frame per display period, which shows the screen at the end of the period.
///
/// With an NTSC display, a frame combines the lines of the current field with the lines of the previous field.
#[derive(Clone, Debug)]
pub struct Film {
    experiment: Experiment,
    first_period: PeriodNumber,
    periods: u64,
    of: FilmSurfaces,
}

/// Smallest and largest number of periods in a film. The largest number corresponds to more than an hour of NTSC.
pub const FILM_PERIODS: (u64, u64) = (1, 250_000);

impl Film {
    /// Creates a film of an experiment that begins at the display period `first_period`.
    pub const fn new(experiment: Experiment, first_period: PeriodNumber, periods: u64, of: FilmSurfaces) -> Self {
        Self { experiment, first_period, periods, of }
    }

    /// Runs the experiment and writes the film as animated PNG. `texts` become text chunks of the file, as in
    /// [`png_bytes`](crate::png_bytes).
    ///
    /// # Errors
    ///
    /// Returns [`PictureError`] if the experiment cannot run, or if a picture cannot be written. The file is then
    /// incomplete.
    pub fn write(&self, texts: &[(&str, String)], out: impl Write) -> Result<(), PictureError> {
        let mut machine = self.begin()?;
        let surfaces = self.surfaces(machine.record().display())?;
        let delay = frame_seconds(machine.record().display());
        let size = size(machine.record().display(), &surfaces);
        let mut animation = Animation::begin(out, size, self.periods as u32, delay, texts)?;
        let add = |_, picture| animation.add(&picture).map(|()| true);
        self.each_of(&mut machine, &surfaces, add)?;
        animation.finish()
    }

    /// Runs the experiment and calls `take` with the number and the picture of each period, in order. The pictures are
    /// the frames that [`write`](Self::write) writes. The run ends early if `take` returns false.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`write`](Self::write), except for errors of the PNG file.
    pub fn each(&self, mut take: impl FnMut(PeriodNumber, RgbImage) -> bool) -> Result<(), PictureError> {
        let mut machine = self.begin()?;
        let surfaces = self.surfaces(machine.record().display())?;
        self.each_of(&mut machine, &surfaces, |period, picture| Ok(take(period, picture)))
    }

    fn begin(&self) -> Result<Machine, PictureError> {
        if !(FILM_PERIODS.0..=FILM_PERIODS.1).contains(&self.periods) {
            let (low, high) = FILM_PERIODS;
            let reason = format_args!("a film has {low} to {high} periods of the display, found {}", self.periods);
            return Err(SettingError::combination(reason).into());
        }
        Ok(self.experiment.build()?)
    }

    fn each_of(
        &self,
        machine: &mut Machine,
        surfaces: &[SurfaceId],
        mut take: impl FnMut(PeriodNumber, RgbImage) -> Result<bool, PictureError>,
    ) -> Result<(), PictureError> {
        // A raster that shifts its picture needs the offsets of a run without pixels.
        let plain = self.without_pixels()?;
        let offsets = plain.as_ref().and_then(RasterOffsets::of);
        // The periods before the film are run one by one too, so that the host can stop them.
        for period in PeriodNumber::FIRST.until(self.first_period.after(self.periods)) {
            self.experiment.check_stopped()?;
            // A period is over when all events at the beginning of the next one have been handled.
            let begun = machine.record().tick(period.next()) + Span(1);
            machine.run_until(begun)?;
            if period < self.first_period {
                continue;
            }
            if !take(period, frame(machine, surfaces, period, offsets.as_ref()))? {
                break;
            }
        }
        Ok(())
    }

    /// Runs the experiment for the periods of the film without pixels. The run gives the shift that the display applies
    /// to the picture in each period. Returns `None` if the display shifts no pictures.
    fn without_pixels(&self) -> Result<Option<Outcome>, PictureError> {
        if self.experiment.head.as_ref().is_none_or(|head| head.raster == Raster::Plain) {
            return Ok(None);
        }
        let length = self.first_period.after(self.periods).next().since(PeriodNumber::FIRST);
        match self.experiment.clone().pixels(Pixels::Off).fields(length).run() {
            // A run that is too short for statistics is long enough for a film.
            Err(ExperimentError::TooShort { partial, .. }) => Ok(Some(*partial)),
            run => Ok(Some(run?)),
        }
    }

    fn surfaces(&self, display: &dyn Display) -> Result<Vec<SurfaceId>, PictureError> {
        let there = display.surfaces().len();
        match self.of {
            FilmSurfaces::One(found) if found.index() >= there => {
                let reason = format_args!("a film of surface {}: the display has {there}, counted from 0", found.0);
                Err(SettingError::combination(reason).into())
            }
            FilmSurfaces::One(surface) => Ok(vec![surface]),
            FilmSurfaces::All => Ok((0..there as u16).map(SurfaceId).collect()),
        }
    }
}

/// Returns the size of a frame that shows surfaces side by side: the sum of the widths, and the greatest height.
fn size(display: &dyn Display, surfaces: &[SurfaceId]) -> (u32, u32) {
    let shown: Vec<&Surface> = surfaces.iter().filter_map(|id| display.surfaces().get(id.index())).collect();
    let width = shown.iter().map(|surface| surface.width).sum();
    let height = shown.iter().map(|surface| surface.height).max();
    (width, height.unwrap_or_default())
}

fn frame(
    machine: &Machine,
    surfaces: &[SurfaceId],
    period: PeriodNumber,
    offsets: Option<&RasterOffsets<'_>>,
) -> RgbImage {
    let screens = surfaces.iter().map(|surface| screen(machine.record(), *surface, period, offsets));
    screens.reduce(|left, right| side_by_side(&left, &right)).unwrap_or_default()
}
