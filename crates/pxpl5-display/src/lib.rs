//! What a display is to the machine: the interface of everything that takes pixels from the ring and shows them.
//!
//! ```text
//!   ring --Delivered(port, body)--> [ Display ] --RegionArrived, Swapped--> machine: trace, status to the first GP
//!   clock ---Tick(n)-------------->     |
//!                                       +--> what a surface shows in a period, and when each of its pixels lights
//! ```
//!
//! A display has *ports* on the ring, a *clock* of its own that ticks (a retrace, an update of cube faces, a strobe), and
//! *surfaces* that somebody looks at (an eye's picture, a face of a cube, a slice of a volume). The span from one tick to
//! the next is a *period*. The machine owns any number of displays and knows nothing else of them; the first one is its
//! sync generator: its ticks reach the first graphics processor, and runs are as long as so many of its periods.
//!
//! A display is a device crate that implements two traits: [`DisplayConfig`], the numbers that one is built of, and
//! [`Display`], the boards themselves. Timelines, traces, reports, pictures, films and pixel errors ask nothing but what
//! stands here.
//!
//! **Not here:** what firmware must know of a display to draw for it (fields, beams): a pipeline that is written for one
//! display finds it by its type: a display is [`Any`].

#![warn(missing_docs)]

mod aim;
mod config;
mod double_buffer;
mod surface;

pub use aim::{Aim, LightSpan};
pub use config::{DisplayConfig, DisplayError};
pub use double_buffer::{BufferReceipt, DoubleBuffer};
pub use surface::{Counter, Surface};

use image::RgbImage;
use pxpl5_sim::{Context, Time};
use pxpl5_wire::{Body, CopyTarget, NodeId, PeriodNumber};
use std::any::Any;
use std::fmt::Debug;

/// What happens to a display.
#[derive(Clone, Debug)]
pub enum DisplayEvent {
    /// Its clock begins a period, at exactly [`Display::tick`]. Phase `Arrive`.
    Tick(PeriodNumber),
    /// The last word of a message has arrived at a port. Phase `Arrive`.
    Delivered {
        /// The port, counted from the display's first.
        port: usize,
        /// What the message carries.
        body: Body,
    },
    /// An instant that the display itself scheduled, with a number that it chose.
    Timer(u64),
}

/// What a display tells the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisplayOutput {
    /// All messages of a region have arrived.
    RegionArrived {
        /// The surface that it is for, counted from the display's first.
        surface: usize,
        /// Where on it the region belongs.
        target: CopyTarget,
        /// When its first message had arrived.
        first_part_at: Time,
        /// When its last message had arrived.
        last_part_at: Time,
    },
    /// A surface shows its other buffer from a tick on; the first graphics processor is told.
    Swapped {
        /// The surface, counted from the display's first.
        surface: usize,
        /// The buffer that is shown now.
        buffer: u8,
        /// The period that begins with the tick.
        tick: PeriodNumber,
    },
    /// What is behind one of several ports of a surface (a display memory) shows its other buffer from a tick on; the first graphics
    /// processor is told by a line of that port.
    Updated {
        /// The surface that is made of it, counted from the display's first.
        surface: usize,
        /// The port.
        port: NodeId,
        /// The buffer that is shown now.
        buffer: u8,
        /// The period that begins with the tick.
        tick: PeriodNumber,
    },
}

/// Where a display puts what it schedules for itself and what leaves it.
pub type DisplayContext = Context<DisplayEvent, DisplayOutput>;

/// Boards that take pixels from the ring and show them.
pub trait Display: Any + Debug + Send + Sync {
    /// Name of its kind, as in `--display`.
    fn name(&self) -> &'static str;

    /// Its ports on the ring, in rising order.
    fn nodes(&self) -> &[NodeId];

    /// Its surfaces, in the order of their numbers.
    fn surfaces(&self) -> &[Surface];

    /// The tick that begins a period; the first period begins at time zero.
    fn tick(&self, period: PeriodNumber) -> Time;

    /// The period in which an instant lies; at a tick the one that begins.
    fn period_at(&self, time: Time) -> PeriodNumber;

    /// Handles one event.
    fn handle(&mut self, event: DisplayEvent, context: &mut DisplayContext);

    /// When pixel (x, y) of a surface lights in a period; `None` when it does not.
    fn lights(&self, surface: usize, x: u32, y: u32, period: PeriodNumber) -> Option<Time>;

    /// The buffer from which a surface is shown now, with everything that has arrived in it.
    fn shown(&self, surface: usize) -> Option<RgbImage>;

    /// What stands before a viewer at the end of a period: what was lit in it and what still stands from before. `None`
    /// until it is over, and when it is no longer remembered.
    fn seen(&self, surface: usize, period: PeriodNumber) -> Option<RgbImage>;

    /// What stands before a viewer at an instant of a period that is remembered; what he sees at the end of the period,
    /// for a display that is lit as a whole.
    fn seen_at(&self, surface: usize, time: Time) -> Option<RgbImage> {
        self.seen(surface, self.period_at(time))
    }

    /// What stands before a viewer while the simulation is at `now`: what has been lit in the period that goes on, and what still
    /// stands from before; black where nothing was lit yet. Looking changes nothing.
    ///
    /// Unless a display says it better, the buffer that is shown counts as filled when its period began, which is so of double
    /// buffers.
    fn seen_so_far(&self, surface: usize, now: Time) -> Option<RgbImage> {
        let period = self.period_at(now);
        let size = self.surfaces().get(surface)?;
        let before = self.last_seen().and_then(|last| self.seen(surface, last));
        let mut screen = before.unwrap_or_else(|| RgbImage::new(size.width, size.height));
        let shown = self.shown(surface)?;
        for (x, y, pixel) in screen.enumerate_pixels_mut() {
            if self.lights(surface, x, y, period).is_some_and(|at| at <= now) {
                *pixel = *shown.get_pixel(x, y);
            }
        }
        Some(screen)
    }

    /// The last period that [`Display::seen`] knows.
    fn last_seen(&self) -> Option<PeriodNumber>;

    /// What the rows that are lit in a period are, when a picture is shifted line by line on its way: the number of the
    /// surface's first one and their distance.
    fn rows_lit(&self, _period: PeriodNumber) -> (u32, u32) {
        (0, 1)
    }

    /// What it has counted since the start.
    fn counters(&self) -> Vec<Counter>;

    /// Messages that it could not use, and what was wrong with the first, where it knows.
    fn faults(&self) -> (u64, Option<String>);

    /// When the first pixel of a line lights in a period; that of the next line, where a period skips lines.
    fn line_lights(&self, surface: usize, x: u32, y: u32, period: PeriodNumber) -> Option<Time> {
        self.lights(surface, x, y, period).or_else(|| self.lights(surface, x, y + 1, period))
    }

    /// When the first visible pixel of a surface lights in a period.
    fn first_light(&self, surface: usize, period: PeriodNumber) -> Option<Time> {
        self.line_lights(surface, 0, 0, period)
    }

    /// When the last visible pixel of a surface lights in a period.
    fn last_light(&self, surface: usize, period: PeriodNumber) -> Option<Time> {
        let size = self.surfaces().get(surface)?;
        self.line_lights(surface, size.width - 1, size.height.saturating_sub(2), period).max(self.lights(
            surface,
            size.width - 1,
            size.height - 1,
            period,
        ))
    }

    /// When the middle of a surface lights in a period.
    fn middle_light(&self, surface: usize, period: PeriodNumber) -> Option<Time> {
        let size = self.surfaces().get(surface)?;
        self.line_lights(surface, size.width / 2, size.height / 2, period)
    }
}
