//! The interface between the machine and its displays: boards that receive pixels from the ring and show them.
//!
//! ```text
//!   ring --Delivered(port, body)--> [ Display ] --RegionArrived, Swapped--> machine: trace, status to the first GP
//!   clock ---Tick(n)-------------->     |
//!                                       +--> what a surface shows in a period, and when each of its pixels lights
//! ```
//!
//! A display has *ports* for messages from the ring, and a *clock*, which ticks at each retrace, update of cube faces
//! or strobe, depending on its kind. Its *surfaces* are what can be seen: an eye's picture, a face of a cube, or a
//! slice of a volume. A *period* is the time from one tick to the next.
//!
//! The machine owns any number of displays and uses only this interface. Its first display is the sync generator: the
//! ticks go to the first graphics processor, and the length of a run is counted in them.
//!
//! A new kind of display implements two traits, [`DisplayConfig`] for its parameters and [`Display`] for its boards.
//! Timelines, traces, reports, pictures, films and pixel errors use nothing else.
//!
//! **Not here:** properties of one kind of display, such as fields or beams. Every display is [`Any`], so firmware that
//! needs them can downcast.

#![warn(missing_docs)]

mod aim;
mod config;
mod double_buffer;
mod light;
mod surface;

pub use aim::{Aim, LightTimes};
pub use config::{Coverage, DisplayConfig};
pub use double_buffer::{BufferReceipt, DoubleBuffer};
pub use light::{PixelLight, ScanOrder};
pub use surface::{Counter, Surface};

use crate::{Body, CopyTarget, NodeId, PeriodNumber};
use image::RgbImage;
use pxpl5_sim::{Context, Time};
use std::any::Any;
use std::fmt::Debug;

/// An event of a display.
#[derive(Clone, Debug)]
pub enum DisplayEvent {
    /// The display's clock ticks and a period begins. The time of the event is exactly the time that [`Display::tick`]
    /// returns. The event belongs to phase `Arrive` of the event queue.
    Tick(PeriodNumber),
    /// The last word of a message has arrived at a port. The event belongs to phase `Arrive` of the event queue.
    Delivered {
        /// Index of the receiving port, counted from the display's first port.
        port: usize,
        /// Content of the message.
        body: Body,
    },
    /// An event that the display itself has scheduled. The number has a meaning only within the display.
    Timer(u64),
}

/// An output of a display to the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DisplayOutput {
    /// All messages of a region's pixels have arrived.
    RegionArrived {
        /// Index of the surface to which the region belongs, counted from the display's first surface.
        surface: usize,
        /// Destination of the region's pixels: the frame buffer, the region and the picture.
        target: CopyTarget,
        /// Arrival time of the region's first message.
        first_part_at: Time,
        /// Arrival time of the region's last message.
        last_part_at: Time,
    },
    /// A surface shows the requested buffer from this tick of the display's clock on. The machine notifies the first
    /// graphics processor.
    Swapped {
        /// Index of the surface that has swapped, counted from the display's first surface.
        surface: usize,
        /// Number of the buffer that is shown from now on, 0 or 1.
        buffer: u8,
        /// Number of the period that begins with the tick.
        tick: PeriodNumber,
    },
    /// A display memory shows the requested buffer from this tick on. Several of them, each with its own port, share a
    /// surface. The first graphics processor is notified of the swap at this port.
    Updated {
        /// Index of the surface that shows the display memory, counted from the display's first surface.
        surface: usize,
        /// Ring port at which the display memory receives its pixels.
        port: NodeId,
        /// Number of the buffer that is shown from now on, 0 or 1.
        buffer: u8,
        /// Number of the period that begins with the tick.
        tick: PeriodNumber,
    },
}

/// The context of one event, through which a display schedules its own events and sends its outputs.
pub type DisplayContext = Context<DisplayEvent, DisplayOutput>;

/// Boards that receive pixels from the ring and show them on surfaces.
pub trait Display: Any + Debug + Send + Sync {
    /// Returns the name of this kind of display, which is the value of the option `--display`.
    fn name(&self) -> &'static str;

    /// Returns the display's ring ports, in rising order.
    fn nodes(&self) -> &[NodeId];

    /// Returns the display's surfaces, in the order of their indices.
    fn surfaces(&self) -> &[Surface];

    /// Returns the time at which a period begins: a tick of the display's clock. The first period begins at time zero.
    fn tick(&self, period: PeriodNumber) -> Time;

    /// Returns the number of the period that contains an instant. At a tick, the result is the period that begins.
    fn period_at(&self, time: Time) -> PeriodNumber;

    /// Handles one event. New events and outputs are passed to `context`.
    fn handle(&mut self, event: DisplayEvent, context: &mut DisplayContext);

    /// Returns the time at which pixel (x, y) of a surface starts to shine in a period. Returns `None` if the pixel
    /// stays dark in this period.
    fn lights(&self, surface: usize, x: u32, y: u32, period: PeriodNumber) -> Option<Time>;

    /// Returns the contents of the buffer that a surface shows now, with all pixels that have arrived. Pixels that the
    /// scan has not reached are included.
    fn shown(&self, surface: usize) -> Option<RgbImage>;

    /// Returns the picture that a viewer sees at the end of a period: the pixels lit in it, and earlier ones that are
    /// still visible. Returns `None` before that end, and after the display has discarded the data of the period.
    fn seen(&self, surface: usize, period: PeriodNumber) -> Option<RgbImage>;

    /// Returns the colour of the pixel [x, y] in the picture that [`seen`](Self::seen) returns. Returns `None` for a
    /// pixel outside the picture.
    ///
    /// By default this computes the whole picture. A display can do less.
    fn seen_pixel(&self, surface: usize, [x, y]: [u32; 2], period: PeriodNumber) -> Option<[u8; 3]> {
        Some(self.seen(surface, period)?.get_pixel_checked(x, y)?.0)
    }

    /// Returns the picture that a viewer sees at the instant `time`. Returns `None` if the display no longer has the
    /// pictures of the period that contains `time`, or if this period has not ended.
    ///
    /// By default this is the picture at the end of the period, which is right for displays that light all pixels at
    /// the same time.
    fn seen_at(&self, surface: usize, time: Time) -> Option<RgbImage> {
        self.seen(surface, self.period_at(time))
    }

    /// Returns the picture that a viewer sees at `now`, the current simulated time: the pixels lit so far in the
    /// current period, and earlier ones that are still visible. Unlit pixels are black. The display stays unchanged.
    ///
    /// By default it is assumed that the shown buffer was complete when its period began, as in double buffers.
    fn picture_so_far(&self, surface: usize, now: Time) -> Option<RgbImage> {
        let period = self.period_at(now);
        let size = self.surfaces().get(surface)?;
        // Begin with the last complete picture, and add the pixels lit in the current period.
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

    /// Returns the number of the last period for which [`Display::seen`] has a picture.
    fn last_seen(&self) -> Option<PeriodNumber>;

    /// Returns the index of the first row that is lit in a period, and the distance between lit rows. Both numbers are
    /// in rows of the surface. Code that shifts a picture row by row needs both numbers.
    fn rows_lit(&self, _period: PeriodNumber) -> (u32, u32) {
        (0, 1)
    }

    /// Returns the order in which pixels are lit, and the time for which each pixel shines from [`Display::lights`] on.
    /// The default is a scan from the top, line by line, in which each pixel shines only for an instant.
    fn light(&self) -> PixelLight {
        PixelLight::default()
    }

    /// Returns the display's counters. Each counter covers the time since the start of the run.
    fn counters(&self) -> Vec<Counter>;

    /// Returns the number of messages that the display could not use. The text states why the display could not use the
    /// first of these messages, if the reason is known.
    fn faults(&self) -> (u64, Option<String>);

    /// Returns the time at which pixel `x` of line `y` starts to shine in a period. If the period skips this line, the
    /// function uses the next line.
    fn line_lights(&self, surface: usize, x: u32, y: u32, period: PeriodNumber) -> Option<Time> {
        self.lights(surface, x, y, period).or_else(|| self.lights(surface, x, y + 1, period))
    }

    /// Returns the time at which the first visible pixel of a surface starts to shine in a period.
    fn first_light(&self, surface: usize, period: PeriodNumber) -> Option<Time> {
        self.line_lights(surface, 0, 0, period)
    }

    /// Returns the time at which the last visible pixel of a surface starts to shine in a period.
    fn last_light(&self, surface: usize, period: PeriodNumber) -> Option<Time> {
        let size = self.surfaces().get(surface)?;
        self.line_lights(surface, size.width - 1, size.height.saturating_sub(2), period).max(self.lights(
            surface,
            size.width - 1,
            size.height - 1,
            period,
        ))
    }

    /// Returns the time at which the pixel in the middle of a surface starts to shine in a period.
    fn middle_light(&self, surface: usize, period: PeriodNumber) -> Option<Time> {
        let size = self.surfaces().get(surface)?;
        self.line_lights(surface, size.width / 2, size.height / 2, period)
    }
}
