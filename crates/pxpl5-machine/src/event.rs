use crate::board::{Board, EventDescription};
use crate::ports::Ports;
use pxpl5_gp::GpEvent;
use pxpl5_renderer::RendererEvent;
use pxpl5_ring::{RingEvent, RingOutput};
use pxpl5_sim::{Context, EventQueue, Phase, Time};
use pxpl5_wire::PeriodNumber;
use pxpl5_wire::display::DisplayEvent;

/// An event in the queue of the machine, with the index of its board, host line or display.
#[derive(Debug)]
pub(crate) enum Event {
    Ring(RingEvent),
    FromRing(RingOutput),
    Gp(usize, GpEvent),
    Renderer(usize, RendererEvent),
    /// Messages arrive at the first display on a host line, a connection that bypasses the ring.
    HostLine(usize),
    Display(usize, DisplayEvent),
    Tick(usize, PeriodNumber),
    /// An edge of the boards' 40 MHz clock. Only runs without the optimization `IdleBoards` have such events.
    Edge,
}

impl Event {
    /// Returns true for events that occur even while all programs wait: events of displays, of clocks, and of host
    /// lines (connections that bypass the ring).
    pub(crate) const fn is_of_displays(&self) -> bool {
        matches!(self, Self::Edge | Self::Tick(..) | Self::Display(..) | Self::HostLine(_))
    }

    pub(crate) fn happening(&self, time: Time, ports: &Ports) -> EventDescription {
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
        EventDescription { time, board, what }
    }
}

fn brought(output: &RingOutput, ports: &Ports) -> (Board, &'static str) {
    match output {
        RingOutput::Announce { message, .. } => (ports.board(message.destination), "message announced"),
        RingOutput::Delivered(message) => (ports.board(message.destination), "message delivered"),
        RingOutput::Sent { source, .. } => (ports.board(*source), "message accepted by its receiver"),
        RingOutput::Refused { source, .. } => (ports.board(*source), "message refused"),
    }
}

const fn ring_what(event: &RingEvent) -> &'static str {
    match event {
        RingEvent::Request(_) => "a board asks for a channel",
        RingEvent::Accept { .. } => "a renderer says when it has room",
        RingEvent::Slot { .. } => "a word has passed",
        RingEvent::Arbitrate => "arbitration",
    }
}

const fn gp_what(event: &GpEvent) -> &'static str {
    match event {
        GpEvent::Delivered(_) => "message delivered",
        GpEvent::Accepted(_) => "message accepted by its receiver",
        GpEvent::Retrace(_) => "retrace",
        GpEvent::Status { .. } => "status line",
        GpEvent::Poll => "programs continue",
        GpEvent::WorkEnds => "work may end",
    }
}

const fn renderer_what(event: &RendererEvent) -> &'static str {
    match event {
        RendererEvent::Announce { .. } => "message announced",
        RendererEvent::CopyBegins => "copy command begins",
        RendererEvent::Stored => "region in the backing store",
        RendererEvent::Sent => "region delivered",
    }
}

pub(crate) fn schedule_own<E, O>(
    queue: &mut EventQueue<Event>,
    context: &mut Context<E, O>,
    event_of: impl Fn(E) -> Event,
) {
    context.each_event(|time, phase, event| queue.schedule(time, phase, event_of(event)));
}

pub(crate) fn schedule_outputs(queue: &mut EventQueue<Event>, context: &mut Context<RingEvent, RingOutput>) {
    for (time, output) in context.drain_outputs() {
        queue.schedule(time, Phase::Arrive, Event::FromRing(output));
    }
}
