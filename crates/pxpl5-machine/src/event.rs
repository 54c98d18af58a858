//! Events of a machine, and what they are called.

use crate::board::{Board, Happening};
use crate::ports::Ports;
use pxpl5_display::DisplayEvent;
use pxpl5_gp::GpEvent;
use pxpl5_renderer::RendererEvent;
use pxpl5_ring::{RingEvent, RingOutput};
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;

/// An event of any board.
#[derive(Debug)]
pub(crate) enum Event {
    Ring(RingEvent),
    /// What the ring brings to a board.
    FromRing(RingOutput),
    Gp(usize, GpEvent),
    Renderer(usize, RendererEvent),
    /// What a line, by its number, brings to the first display past the ring.
    HostLine(usize),
    /// What a display scheduled for itself.
    Display(usize, DisplayEvent),
    /// The tick of a display's clock that begins a period.
    Tick(usize, PeriodNumber),
    /// An edge of the boards' clock, where every one of them counts.
    Edge,
}

impl Event {
    /// Whether it is one of displays or clocks alone: what goes on in a machine whose programs all wait.
    pub(crate) const fn is_of_displays(&self) -> bool {
        matches!(self, Self::Edge | Self::Tick(..) | Self::Display(..) | Self::HostLine(_))
    }

    /// What it is to somebody who watches.
    pub(crate) fn happening(&self, time: Time, ports: &Ports) -> Happening {
        let (board, what) = match self {
            Self::Ring(event) => (Board::Ring, ring_what(event)),
            Self::FromRing(output) => brought(output, ports),
            Self::Gp(board, event) => (Board::of_processor(*board), gp_what(event)),
            Self::Renderer(board, event) => (Board::Renderer(*board), renderer_what(event)),
            Self::HostLine(_) => (Board::Display(0), "message of a line past the ring"),
            Self::Display(display, _) => (Board::Display(*display), "own timer"),
            Self::Tick(display, _) => (Board::Display(*display), "tick"),
            Self::Edge => (Board::Ring, "edge of the boards' clock"),
        };
        Happening { time, board, what }
    }
}

/// Whom the ring brings something, and what.
fn brought(output: &RingOutput, ports: &Ports) -> (Board, &'static str) {
    match output {
        RingOutput::Announce { message, .. } => (ports.board(message.destination), "message announced"),
        RingOutput::Delivered(message) => (ports.board(message.destination), "message delivered"),
        RingOutput::Sent { source, .. } => (ports.board(*source), "message accepted by its receiver"),
        RingOutput::Refused { source, .. } => (ports.board(*source), "message refused"),
    }
}

/// What an event of the ring is, in words.
const fn ring_what(event: &RingEvent) -> &'static str {
    match event {
        RingEvent::Request(_) => "a board asks for a channel",
        RingEvent::Accept { .. } => "a renderer says when it has room",
        RingEvent::Slot { .. } => "a word has passed",
        RingEvent::Arbitrate => "arbitration",
    }
}

/// What an event of a processor is, in words.
const fn gp_what(event: &GpEvent) -> &'static str {
    match event {
        GpEvent::Delivered(_) => "message delivered",
        GpEvent::Accepted(_) => "message accepted by its receiver",
        GpEvent::Retrace(_) => "retrace",
        GpEvent::Status { .. } => "status line",
        GpEvent::Poll => "programs look",
        GpEvent::WorkEnds => "work may end",
    }
}

/// What an event of a renderer is, in words.
const fn renderer_what(event: &RendererEvent) -> &'static str {
    match event {
        RendererEvent::Announce { .. } => "message announced",
        RendererEvent::CopyBegins => "copy command begins",
        RendererEvent::Stored => "region in the backing store",
        RendererEvent::Sent => "region delivered",
    }
}
