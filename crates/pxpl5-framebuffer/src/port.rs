//! Events, outputs and faults of a frame buffer.

use pxpl5_sim::Time;
use pxpl5_wire::{CopyTarget, NodeId, PeriodNumber, RegionPixels};
use thiserror::Error;

/// An event of a frame buffer.
#[derive(Clone, Debug)]
pub enum FrameBufferEvent {
    /// The last word of a message of pixels has arrived. The event belongs to phase `Arrive`.
    Pixels(RegionPixels),
    /// Software requests that buffer 0 or 1 be displayed from the next retrace on. The event belongs to phase `Arrive`.
    SwapRequested {
        /// Requested buffer, 0 or 1.
        buffer: u8,
    },
    /// The sync generator starts a field, exactly at [`Video::retrace`](crate::Video::retrace). The event belongs to
    /// phase `Arrive`.
    ///
    /// The last swap request that arrived before this instant takes effect. A request at this instant waits for the
    /// next retrace.
    Retrace {
        /// Number of the field that begins.
        field: PeriodNumber,
    },
}

/// An output of a frame buffer, one word time after the event that caused it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameBufferOutput {
    /// All pixels of a region have arrived.
    RegionArrived {
        /// Destination of the pixels: the frame buffer, the region and the picture.
        target: CopyTarget,
        /// Arrival time of the region's first message.
        first_part_at: Time,
        /// Arrival time of the region's last message.
        last_part_at: Time,
    },
    /// A requested swap has taken effect, at the retrace that began `field`.
    Swapped {
        /// Number of the buffer that is displayed from now on, 0 or 1.
        buffer: u8,
        /// First field that is scanned from the newly displayed buffer.
        field: PeriodNumber,
    },
}

/// An event that a frame buffer cannot handle. A fault is counted, and has no other effect.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum FrameBufferFault {
    /// The pixels are for another board.
    #[error("pixels for node {} came to the frame buffer at node {}", found.0, expected.0)]
    WrongBoard {
        /// Ring port of this frame buffer.
        expected: NodeId,
        /// Ring port of the frame buffer for which the sender meant the pixels.
        found: NodeId,
    },
    /// A swap request contains the number of a buffer that does not exist (neither 0 nor 1).
    #[error("expected buffer 0 or 1, found {found}")]
    NoSuchBuffer {
        /// Number of the requested buffer.
        found: u8,
    },
    /// The region is not in the frame, or is larger than a renderer's array.
    #[error(
        "region {} of {:?}, {:?}, does not lie in the frame of {} x {} or exceeds 128 x 128",
        target.region.0, target.grid, target.lines, frame[0], frame[1]
    )]
    Region {
        /// Frame buffer, region and picture of the pixels according to the sender.
        target: CopyTarget,
        /// Width and height of the frame in pixels.
        frame: [u32; 2],
    },
    /// The sender's number of messages does not fit the number of pixels in the region.
    #[error("region {} needs {expected} messages of pixels, found {found}", target.region.0)]
    Parts {
        /// Frame buffer, region and picture of the pixels according to the sender.
        target: CopyTarget,
        /// Number of messages that a region of this size needs.
        expected: u32,
        /// Number of messages of the region according to the sender.
        found: u32,
    },
    /// The message does not exist in its region, or has already arrived.
    #[error("message {found} of {parts} of region {} does not exist or has arrived already", target.region.0)]
    Part {
        /// Frame buffer, region and picture of the pixels according to the sender.
        target: CopyTarget,
        /// Number of the message in its region, counted from 0.
        found: u32,
        /// Number of messages of which the region consists.
        parts: u32,
    },
    /// A retrace occurred at a time that differs from the video timing.
    #[error("retrace {field} expected at {expected}, found at {found}")]
    Retrace {
        /// Number of the field that begins.
        field: PeriodNumber,
        /// Time of the retrace according to the video timing.
        expected: Time,
        /// Time at which the retrace occurred.
        found: Time,
    },
}

/// Faults of one board.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// Number of faults in the whole run.
    pub count: u64,
    /// First fault with its time.
    pub first: Option<(Time, FrameBufferFault)>,
}

impl Faults {
    pub(crate) fn record(&mut self, now: Time, fault: FrameBufferFault) {
        self.count += 1;
        self.first.get_or_insert((now, fault));
    }
}
