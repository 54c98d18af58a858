//! The interface between the machine and its displays: boards that take pixels from the ring and show them.
//!
//! ```text
//!   ring --Delivered(port, body)--> [ Display ] --RegionArrived, Swapped--> machine: trace, status to the first GP
//!   clock ---Tick(n)-------------->     |
//!                                       +--> what a surface shows in a period, and when each of its pixels lights
//! ```
//!
//! A display has *ports* on the ring, a *clock* that ticks (a retrace, an update of cube faces, a strobe), and visible
//! *surfaces* (an eye's picture, a face of a cube, a slice of a volume). A *period* is the time from one tick to the
//! next. The machine owns any number of displays and uses only this interface. The first display is the machine's sync
//! generator: its ticks reach the first graphics processor, and the length of a run is a number of its periods.
//!
//! A display is a crate that implements two traits: [`DisplayConfig`] for the numbers of a display, and [`Display`] for
//! its boards. Timelines, traces, reports, pictures, films and pixel errors use only these traits.
//!
//! **Not here:** knowledge that firmware needs to draw for one display (fields, beams). A pipeline for one display
//! finds that display by its type, because a display is [`Any`].

#![warn(missing_docs)]

mod aim;
mod config;
mod double_buffer;
mod light;
mod surface;

pub use aim::{Aim, LightTimes};
pub use config::{DisplayConfig, DisplayError};
pub use double_buffer::{BufferReceipt, DoubleBuffer};
pub use light::{Light, Scan};
pub use surface::{Counter, Surface};

use image::RgbImage;
use pxpl5_sim::{Context, Time};
use pxpl5_wire::{Body, CopyTarget, NodeId, PeriodNumber};
use std::any::Any;
use std::fmt::Debug;

/// An event of a display.
#[derive(Clone, Debug)]
pub enum DisplayEvent {
    /// The display's clock begins a period, at exactly [`Display::tick`]. Phase `Arrive`.
    Tick(PeriodNumber),
    /// The last word of a message has arrived at a port. Phase `Arrive`.
    Delivered {
        /// Index of the port, counted from the display's first port.
        port: usize,
        /// Content of the message.
        body: Body,
    },
    /// An event that the display itself has scheduled, with a number of its choice.
    Timer(u64),
}

/// An output of a display to the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisplayOutput {
    /// All messages of a region have arrived.
    RegionArrived {
        /// Surface of the region, counted from the display's first surface.
        surface: usize,
        /// Target of the region.
        target: CopyTarget,
        /// Arrival time of the first message.
        first_part_at: Time,
        /// Arrival time of the last message.
        last_part_at: Time,
    },
    /// A surface shows its other buffer from a tick on. The first graphics processor is notified.
    Swapped {
        /// Surface that has swapped, counted from the display's first surface.
        surface: usize,
        /// Buffer that is shown from now on, 0 or 1.
        buffer: u8,
        /// Period that begins with the tick.
        tick: PeriodNumber,
    },
    /// A display memory behind one of several ports of a surface shows its other buffer from a tick on. The first
    /// graphics processor is notified by the status line of that port.
    Updated {
        /// Surface that is made from the display memory, counted from the display's first surface.
        surface: usize,
        /// Ring port of the display memory.
        port: NodeId,
        /// Buffer that is shown from now on, 0 or 1.
        buffer: u8,
        /// Period that begins with the tick.
        tick: PeriodNumber,
    },
}

/// The context through which a display schedules its own events and sends its outputs.
pub type DisplayContext = Context<DisplayEvent, DisplayOutput>;

/// Boards that take pixels from the ring and show them.
pub trait Display: Any + Debug + Send + Sync {
    /// Returns the name of the display's kind, as in `--display`.
    fn name(&self) -> &'static str;

    /// Returns the display's ring ports, in rising order.
    fn nodes(&self) -> &[NodeId];

    /// Returns the display's surfaces, in the order of their numbers.
    fn surfaces(&self) -> &[Surface];

    /// Returns the time of the tick that begins a period. The first period begins at time zero.
    fn tick(&self, period: PeriodNumber) -> Time;

    /// Returns the period that contains an instant. At a tick this is the period that begins.
    fn period_at(&self, time: Time) -> PeriodNumber;

    /// Handles one event; events and outputs that follow go to `context`.
    fn handle(&mut self, event: DisplayEvent, context: &mut DisplayContext);

    /// Returns the time at which pixel (x, y) of a surface lights in a period; `None` if it does not light.
    fn lights(&self, surface: usize, x: u32, y: u32, period: PeriodNumber) -> Option<Time>;

    /// Returns the buffer that a surface shows now, with all pixels that have arrived.
    fn shown(&self, surface: usize) -> Option<RgbImage>;

    /// Returns the picture that a viewer sees at the end of a period: pixels lit in this period, and pixels that are
    /// still visible from earlier ones.
    /// Returns `None` before the end of the period, and after the display has forgotten it.
    fn seen(&self, surface: usize, period: PeriodNumber) -> Option<RgbImage>;

    /// Returns the picture that a viewer sees at an instant of a remembered period. The default is the picture at the
    /// end of the period, for displays that light all pixels at once.
    fn seen_at(&self, surface: usize, time: Time) -> Option<RgbImage> {
        self.seen(surface, self.period_at(time))
    }

    /// Returns the picture that a viewer sees while the simulation is at `now`: pixels lit in the current period so
    /// far, and pixels still visible from earlier ones. Unlit pixels are black. The display stays unchanged.
    ///
    /// The default assumes that the shown buffer was complete when its period began, which is true for double buffers.
    fn picture_so_far(&self, surface: usize, now: Time) -> Option<RgbImage> {
        let period = self.period_at(now);
        let size = self.surfaces().get(surface)?;
        // Begin with the last complete picture and add the pixels lit since.
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

    /// Returns the last period for which [`Display::seen`] has a picture.
    fn last_seen(&self) -> Option<PeriodNumber>;

    /// Returns the first row of the surface that is lit in a period, and the distance of lit rows. Code that shifts a
    /// picture line by line needs them.
    fn rows_lit(&self, _period: PeriodNumber) -> (u32, u32) {
        (0, 1)
    }

    /// Returns the order in which pixels light, and the light of each from the instant on that [`Display::lights`]
    /// gives. By default pixels light line by line from the top, each for an instant.
    fn light(&self) -> Light {
        Light::default()
    }

    /// Returns the display's counters since the start of the run.
    fn counters(&self) -> Vec<Counter>;

    /// Returns the number of messages that the display could not use, and the reason of the first if it is known.
    fn faults(&self) -> (u64, Option<String>);

    /// Returns the time at which the first pixel of a line lights in a period. If the period skips the line, the next
    /// line counts.
    fn line_lights(&self, surface: usize, x: u32, y: u32, period: PeriodNumber) -> Option<Time> {
        self.lights(surface, x, y, period).or_else(|| self.lights(surface, x, y + 1, period))
    }

    /// Returns the time at which the first visible pixel of a surface lights in a period.
    fn first_light(&self, surface: usize, period: PeriodNumber) -> Option<Time> {
        self.line_lights(surface, 0, 0, period)
    }

    /// Returns the time at which the last visible pixel of a surface lights in a period.
    fn last_light(&self, surface: usize, period: PeriodNumber) -> Option<Time> {
        let size = self.surfaces().get(surface)?;
        self.line_lights(surface, size.width - 1, size.height.saturating_sub(2), period).max(self.lights(
            surface,
            size.width - 1,
            size.height - 1,
            period,
        ))
    }

    /// Returns the time at which the middle of a surface lights in a period.
    fn middle_light(&self, surface: usize, period: PeriodNumber) -> Option<Time> {
        let size = self.surfaces().get(surface)?;
        self.line_lights(surface, size.width / 2, size.height / 2, period)
    }
}
