//! The observations of a run as one list of events, in which boards have names.

use crate::board::Board;
use crate::record::Record;
use pxpl5_gp::{Stage, StageEdge};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{PictureNumber, RegionId, SurfaceId};
use std::fmt;

/// An observed event of a run, with its time and board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ObservedEvent {
    /// Simulated time of the event.
    pub time: Time,
    /// The board that caused the event.
    pub board: Board,
    /// The event, with the picture or message that it belongs to.
    pub kind: ObservedKind,
}

/// The kinds of observed events.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ObservedKind {
    /// A program began or ended a stage of a picture.
    Stage {
        /// The stage of the pipeline.
        stage: Stage,
        /// The beginning or the end of the stage.
        edge: StageEdge,
        /// Number of the picture, as counted by the pipeline.
        picture: PictureNumber,
        /// Surface for which the stage draws, if the stage draws one eye at a time.
        surface: Option<SurfaceId>,
    },
    /// A renderer started to copy a region that it had drawn.
    Copied {
        /// Number of the picture, as counted by the pipeline.
        picture: PictureNumber,
        /// Index of the region in the picture's grid of regions.
        region: RegionId,
        /// Execution time of the region's commands.
        executed: Span,
    },
    /// A region has completely arrived at a display.
    Arrived {
        /// Number of the picture, as counted by the pipeline.
        picture: PictureNumber,
        /// Index of the region in the picture's grid of regions.
        region: RegionId,
        /// The surface that shows the region.
        surface: SurfaceId,
    },
    /// A display has changed the buffer that it shows for a surface.
    Swapped {
        /// The surface whose visible buffer changed.
        surface: SurfaceId,
        /// The buffer that is visible from this event on.
        buffer: u8,
    },
    /// The first word of a ring message arrived. The event's board is the sender. Only runs that record messages have
    /// such events.
    Message {
        /// The board that receives the message.
        to: Board,
        /// Length of the message in words of 32 bits, without the overhead of the ring.
        words: u32,
        /// Time at which the receiver finished taking the last word.
        end: Time,
    },
}

impl ObservedKind {
    /// Returns the number of the picture that the event belongs to. Returns `None` for swaps and messages.
    pub const fn picture(&self) -> Option<PictureNumber> {
        match *self {
            Self::Stage { picture, .. } | Self::Copied { picture, .. } | Self::Arrived { picture, .. } => Some(picture),
            Self::Swapped { .. } | Self::Message { .. } => None,
        }
    }
}

impl fmt::Display for ObservedEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}: {}", self.time, self.board, self.kind)
    }
}

impl fmt::Display for ObservedKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stage { stage, edge, picture, surface } => {
                write!(f, "{edge} of {stage}, picture {picture}")?;
                surface.map_or(Ok(()), |surface| write!(f, ", surface {}", surface.0))
            }
            Self::Copied { picture, region, .. } => write!(f, "copy of region {}, picture {picture}", region.0),
            Self::Arrived { picture, region, surface } => {
                write!(f, "region {} complete, picture {picture}, surface {}", region.0, surface.0)
            }
            Self::Swapped { surface, buffer } => write!(f, "swap to buffer {buffer}, surface {}", surface.0),
            Self::Message { to, words, .. } => write!(f, "message of {words} words to {to}"),
        }
    }
}

impl Record {
    /// Returns all observed events in memory, in the order of time.
    ///
    /// The events are stages of programs, copied regions, arrived regions, swaps, and ring messages if these were
    /// recorded.
    pub fn observed_events(&self) -> Vec<ObservedEvent> {
        let observed = self.observation();
        let board = |node| self.ports().board(node);
        let stages = observed.marks.iter().map(|mark| ObservedEvent {
            time: mark.time,
            board: board(mark.node),
            kind: ObservedKind::Stage {
                stage: mark.stage,
                edge: mark.edge,
                picture: mark.picture,
                surface: mark.surface,
            },
        });
        let copied = observed.drawn.iter().map(|(renderer, region)| ObservedEvent {
            time: region.copy_at,
            board: Board::Renderer(*renderer),
            kind: ObservedKind::Copied {
                picture: region.target.picture,
                region: region.target.region,
                executed: region.executed,
            },
        });
        let arrived = observed.arrivals.iter().map(|arrival| ObservedEvent {
            time: arrival.last_part_at,
            board: board(arrival.target.frame_buffer),
            kind: ObservedKind::Arrived {
                picture: arrival.target.picture,
                region: arrival.target.region,
                surface: arrival.surface,
            },
        });
        let swapped = observed.swaps.iter().map(|swap| ObservedEvent {
            time: self.period_start(board(swap.port), swap.tick),
            board: board(swap.port),
            kind: ObservedKind::Swapped { surface: swap.surface, buffer: swap.buffer },
        });
        let transfers = observed.traffic.iter().flat_map(|traffic| &traffic.transfers);
        let messages = transfers.map(|transfer| ObservedEvent {
            time: transfer.begin,
            board: board(transfer.source),
            kind: ObservedKind::Message { to: board(transfer.destination), words: transfer.words, end: transfer.end },
        });
        let mut events: Vec<_> = stages.chain(copied).chain(arrived).chain(swapped).chain(messages).collect();
        // The sort is stable, so simultaneous events keep the order of the lists above.
        events.sort_by_key(|event| event.time);
        events
    }
}
