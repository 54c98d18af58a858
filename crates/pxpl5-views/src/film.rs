//! Films: what a viewer sees, period by period, as animated PNG.

use crate::animation::Animation;
use crate::frame_time::frame_seconds;
use crate::picture::PngError;
use image::RgbImage;
use pxpl5_display::{Display, Surface};
use pxpl5_machine::{Machine, RunError};
use pxpl5_measure::{RasterOffsets, screen, side_by_side};
use pxpl5_run::{Experiment, ExperimentError, Outcome, Pixels, Raster};
use pxpl5_sim::Span;
use pxpl5_wire::{PeriodNumber, SurfaceId};
use std::io::Write;
use thiserror::Error;

/// Which surfaces of the first display a film shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmOf {
    /// A single one, such as an eye's.
    One(SurfaceId),
    /// All, side by side, the first one left.
    All,
}

/// A film of an experiment: a frame for each period of the display, as a viewer sees it at the period's end. Of an NTSC
/// display the lines of the field before stand between those of its own.
#[derive(Clone, Debug)]
pub struct Film {
    experiment: Experiment,
    first_period: PeriodNumber,
    periods: u64,
    of: FilmOf,
}

/// Why a film could not be made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FilmError {
    /// The experiment cannot be run.
    #[error(transparent)]
    Experiment(#[from] ExperimentError),
    /// The machine stopped before the last picture of the film.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A film of no period, or of more than a PNG can hold.
    #[error("a film has {} to {} periods of the display, found {found}", expected.0, expected.1)]
    Periods {
        /// Smallest and largest number.
        expected: (u64, u64),
        /// What was asked for.
        found: u64,
    },
    /// The display has no such surface.
    #[error("a film of surface {}: the display has {there}, counted from 0", found.0)]
    Surface {
        /// How many there are.
        there: usize,
        /// What was asked for.
        found: SurfaceId,
    },
    /// The PNG could not be written.
    #[error("the film: {0}")]
    Png(#[from] PngError),
}

/// Smallest and largest number of periods in a film: an hour of NTSC and more.
pub const FILM_PERIODS: (u64, u64) = (1, 250_000);

impl Film {
    /// A film of an experiment, from a period of the display on.
    #[must_use]
    pub const fn new(experiment: Experiment, first_period: PeriodNumber, periods: u64, of: FilmOf) -> Self {
        Self { experiment, first_period, periods, of }
    }

    /// Runs the experiment and writes the film as animated PNG. `texts` go into the file's text chunks, as those of
    /// [`png_bytes`](crate::png_bytes).
    ///
    /// # Errors
    ///
    /// [`FilmError`]; the file is then not complete.
    pub fn write(&self, texts: &[(&str, String)], out: impl Write) -> Result<(), FilmError> {
        if !(FILM_PERIODS.0..=FILM_PERIODS.1).contains(&self.periods) {
            return Err(FilmError::Periods { expected: FILM_PERIODS, found: self.periods });
        }
        let plain = self.without_pixels()?;
        let offsets = plain.as_ref().and_then(RasterOffsets::of);
        let mut machine = self.experiment.build()?;
        let surfaces = self.surfaces(machine.record().display())?;
        let delay = frame_seconds(machine.record().display());
        let size = size(machine.record().display(), &surfaces);
        let mut animation = Animation::begin(out, size, self.periods as u32, delay, texts)?;
        for period in self.first_period.until(self.first_period.after(self.periods)) {
            // A period is over when the next one has begun, all of whose events are taken.
            let begun = machine.record().tick(period.next()) + Span(1);
            machine.run_until(begun)?;
            animation.add(&frame(&machine, &surfaces, period, offsets.as_ref()))?;
        }
        Ok(animation.finish()?)
    }

    /// A run of the same length without pixels, from which it is known how the raster shifts each period; `None` where it
    /// shifts nothing.
    fn without_pixels(&self) -> Result<Option<Outcome>, FilmError> {
        if self.experiment.raster() == Raster::Plain {
            return Ok(None);
        }
        let length = self.first_period.after(self.periods).next().since(PeriodNumber::FIRST);
        match self.experiment.clone().pixels(Pixels::Off).fields(length).run() {
            // Too short for statistics is long enough for a film.
            Err(ExperimentError::TooShort { partial, .. }) => Ok(Some(*partial)),
            run => Ok(Some(run?)),
        }
    }

    fn surfaces(&self, display: &dyn Display) -> Result<Vec<SurfaceId>, FilmError> {
        let there = display.surfaces().len();
        match self.of {
            FilmOf::One(found) if found.index() >= there => Err(FilmError::Surface { there, found }),
            FilmOf::One(surface) => Ok(vec![surface]),
            FilmOf::All => Ok((0..there as u16).map(SurfaceId).collect()),
        }
    }
}

/// Width and height of some surfaces of a display side by side.
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
