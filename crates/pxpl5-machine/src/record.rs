//! What is known of a machine: the state of its boards and everything observed.

use crate::config::MachineConfig;
use crate::observation::{Observation, Shown, StageSpan};
use crate::ports::Ports;
use pxpl5_display::{Display, Surface};
use pxpl5_renderer::Renderer;
use pxpl5_ring::Ring;
use pxpl5_sim::{Span, Time, TraceHash};
use pxpl5_wire::{MAX_MESSAGE_WORDS, NodeId, PeriodNumber, PictureNumber, SurfaceId};
use std::any::Any;

/// The boards of a machine without the programs that ran on it, and everything observed: plain data, which may be sent to
/// another thread.
#[derive(Debug)]
pub struct Record {
    pub(crate) config: MachineConfig,
    pub(crate) ports: Ports,
    pub(crate) ring: Ring,
    pub(crate) renderers: Vec<Renderer>,
    pub(crate) displays: Vec<Box<dyn Display>>,
    pub(crate) observation: Observation,
    pub(crate) hash: TraceHash,
    pub(crate) events: u64,
    pub(crate) vertex_transforms: u64,
}

impl Record {
    /// The numbers that the machine was built of.
    #[must_use]
    pub const fn config(&self) -> &MachineConfig {
        &self.config
    }

    /// The ports of the boards.
    #[must_use]
    pub const fn ports(&self) -> &Ports {
        &self.ports
    }

    /// The ring as it stands at the end of the run.
    #[must_use]
    pub const fn ring(&self) -> &Ring {
        &self.ring
    }

    /// The renderers as they stand at the end of the run, in the order of their boards.
    #[must_use]
    pub fn renderers(&self) -> &[Renderer] {
        &self.renderers
    }

    /// The displays as they stand at the end of the run; the first is the sync generator.
    #[must_use]
    pub fn displays(&self) -> &[Box<dyn Display>] {
        &self.displays
    }

    /// The first display: what pipelines draw for, and whose clock the length of a run is counted in.
    ///
    /// # Panics
    ///
    /// Never: a machine without a display is refused.
    #[must_use]
    pub fn display(&self) -> &dyn Display {
        self.displays[0].as_ref()
    }

    /// The first display of a kind; `None` where the machine has none.
    #[must_use]
    pub fn display_of_kind<D: Display + 'static>(&self) -> Option<&D> {
        self.displays.iter().find_map(|display| (display.as_ref() as &dyn Any).downcast_ref())
    }

    /// The number of a display's first surface.
    pub(crate) fn first_surface(&self, display: usize) -> usize {
        self.displays[..display].iter().map(|display| display.surfaces().len()).sum()
    }

    /// The surfaces of all displays, in the order of their numbers.
    pub fn surfaces(&self) -> impl Iterator<Item = (SurfaceId, &Surface)> {
        let all = self.displays.iter().flat_map(|display| display.surfaces());
        (0..).map(SurfaceId).zip(all)
    }

    /// A surface by its number.
    #[must_use]
    pub fn surface(&self, id: SurfaceId) -> Option<&Surface> {
        self.surfaces().nth(id.index()).map(|(_, surface)| surface)
    }

    /// What was observed so far.
    #[must_use]
    pub const fn observation(&self) -> &Observation {
        &self.observation
    }

    /// All stages of all pictures, COPY as the displays saw it.
    #[must_use]
    pub fn stages(&self) -> Vec<StageSpan> {
        self.observation.stages(self.message_span())
    }

    /// What a double-buffered port has shown, swap after swap: the picture of which the last region had come before the swap, as far as
    /// both are held. No region of the next comes before the buffer is free.
    #[must_use]
    pub fn shown_by(&self, port: NodeId) -> Vec<Shown> {
        let arrivals = self.observation.arrivals.iter().filter(|arrival| arrival.target.frame_buffer == port);
        let arrivals = arrivals.map(|arrival| (arrival.last_part_at, arrival.target.picture));
        let mut arrivals: Vec<(Time, PictureNumber)> = arrivals.collect();
        arrivals.sort_unstable();
        let mut arrivals = arrivals.into_iter().peekable();
        let mut newest: Option<(PictureNumber, Time)> = None;
        let swaps = self.observation.swaps.iter().filter(|swap| swap.port == port);
        let shown = swaps.filter_map(|swap| {
            let at = self.tick(swap.tick);
            while let Some((arrived_at, picture)) = arrivals.next_if(|arrival| arrival.0 <= at) {
                if newest.is_none_or(|newest| newest.0 != picture) {
                    newest = Some((picture, arrived_at));
                }
            }
            newest.take().map(|(picture, first_region_at)| Shown { picture, first_region_at, at })
        });
        shown.collect()
    }

    /// How long the longest message occupies a channel.
    #[must_use]
    pub const fn message_span(&self) -> Span {
        self.ring.timing().occupancy(MAX_MESSAGE_WORDS)
    }

    /// The tick that begins a period of the first display.
    #[must_use]
    pub fn tick(&self, period: PeriodNumber) -> Time {
        self.display().tick(period)
    }

    /// Hash of everything that happened.
    #[must_use]
    pub const fn trace_hash(&self) -> TraceHash {
        self.hash
    }

    /// Events handled in the whole run.
    #[must_use]
    pub const fn events(&self) -> u64 {
        self.events
    }

    /// Vertices that graphics processors transformed in the whole run: each corner of a triangle and each centre of a sphere, once for each view.
    #[must_use]
    pub const fn vertex_transforms(&self) -> u64 {
        self.vertex_transforms
    }
}
