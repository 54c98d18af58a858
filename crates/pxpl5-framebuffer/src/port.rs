//! What comes into a frame buffer and what goes out of it.

use pxpl5_sim::Time;
use pxpl5_wire::{CopyTarget, NodeId, PeriodNumber, RegionPixels};
use thiserror::Error;

/// What happens to a frame buffer.
#[derive(Clone, Debug)]
pub enum FrameBufferEvent {
    /// The last word of a message of pixels has arrived. Phase `Arrive`.
    Pixels(RegionPixels),
    /// Software asks for a buffer, 0 or 1, to be displayed from the next retrace on. Phase `Arrive`.
    SwapRequested {
        /// The buffer.
        buffer: u8,
    },
    /// The sync generator starts a field, at exactly [`Video::retrace`](crate::Video::retrace). Phase `Arrive`.
    ///
    /// Requests that have arrived before (not at) this instant take effect, the last of them.
    Retrace {
        /// The field that begins.
        field: PeriodNumber,
    },
}

/// What a frame buffer puts out, one word time after the event that caused it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameBufferOutput {
    /// All messages of a region have arrived.
    RegionArrived {
        /// The region.
        target: CopyTarget,
        /// When its first message had arrived.
        first_part_at: Time,
        /// When its last message had arrived.
        last_part_at: Time,
    },
    /// The swap that was asked for has taken effect, at the retrace at which `field` began.
    Swapped {
        /// The displayed buffer.
        buffer: u8,
        /// The first field that is scanned from it.
        field: PeriodNumber,
    },
}

/// Something that a frame buffer cannot do. It is counted, recorded and otherwise without effect.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum FrameBufferFault {
    /// Pixels for another board came here.
    #[error("pixels for node {} came to the frame buffer at node {}", found.0, expected.0)]
    WrongBoard {
        /// This board's port.
        expected: NodeId,
        /// Where the pixels were to go.
        found: NodeId,
    },
    /// There are two buffers, 0 and 1.
    #[error("expected buffer 0 or 1, found {found}")]
    NoSuchBuffer {
        /// The buffer that was asked for.
        found: u8,
    },
    /// A region does not lie in the frame, or is larger than a renderer's array.
    #[error(
        "region {} of {:?}, {:?}, does not lie in the frame of {} x {} or exceeds 128 x 128",
        target.region.0, target.grid, target.lines, frame[0], frame[1]
    )]
    Region {
        /// Where the pixels were to go.
        target: CopyTarget,
        /// Width and height of the frame.
        frame: [u32; 2],
    },
    /// A region's number of messages does not fit its number of pixels.
    #[error("region {} needs {expected} messages of pixels, found {found}", target.region.0)]
    Parts {
        /// Where the pixels were to go.
        target: CopyTarget,
        /// Messages that the region needs.
        expected: u32,
        /// Messages that it was said to have.
        found: u32,
    },
    /// A message does not exist in its region, or has arrived already.
    #[error("message {found} of {parts} of region {} does not exist or has arrived already", target.region.0)]
    Part {
        /// Where the pixels were to go.
        target: CopyTarget,
        /// The message's number.
        found: u32,
        /// Messages of the region.
        parts: u32,
    },
    /// A retrace came at another time than the video timing says.
    #[error("retrace {field} expected at {expected}, found at {found}")]
    Retrace {
        /// The field.
        field: PeriodNumber,
        /// When it should begin.
        expected: Time,
        /// When it did.
        found: Time,
    },
}

/// Faults of one board.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// How many faults there were in the whole run.
    pub count: u64,
    /// The first, with its time.
    pub first: Option<(Time, FrameBufferFault)>,
}

impl Faults {
    pub(crate) fn record(&mut self, now: Time, fault: FrameBufferFault) {
        self.count += 1;
        self.first.get_or_insert((now, fault));
    }
}
