use crate::board::Board;
use crate::config::MachineConfig;
use crate::observation::{Observation, Shown, StageSpan};
use crate::ports::Ports;
use pxpl5_gp::GpUse;
use pxpl5_renderer::Renderer;
use pxpl5_ring::Ring;
use pxpl5_sim::{Span, Time, TraceHash};
use pxpl5_wire::display::{Display, Surface};
use pxpl5_wire::{MAX_MESSAGE_WORDS, NodeId, PeriodNumber, PictureNumber, SurfaceId};
use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

/// Data that a pipeline adds to the record of a run, beside the observations of the boards.
///
/// Its programs write them, and its results read them with [`Record::attached`].
pub trait Attachment: Any + Debug + Send + Sync {
    /// Discards the data that belong only to discarded observations. By default, all data is kept.
    fn discard(&self, _record: &Record) {}
}

/// The boards of a machine, without programs, and all observations of the run.
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
    pub(crate) met_full_store: bool,
    pub(crate) elapsed: Time,
    pub(crate) processors_used: Vec<GpUse>,
    pub(crate) attachments: Vec<Arc<dyn Attachment>>,
}

impl Record {
    /// Returns the configuration that the machine was built from.
    pub const fn config(&self) -> &MachineConfig {
        &self.config
    }

    /// Returns the ring ports of all boards.
    pub const fn ports(&self) -> &Ports {
        &self.ports
    }

    /// Returns the ring with its state at the end of the run.
    pub const fn ring(&self) -> &Ring {
        &self.ring
    }

    /// Returns the renderers with their state at the end of the run, in the order of their boards.
    pub fn renderers(&self) -> &[Renderer] {
        &self.renderers
    }

    /// Returns the displays with their state at the end of the run. The clock of the first display defines the periods
    /// of the run.
    pub fn displays(&self) -> &[Box<dyn Display>] {
        &self.displays
    }

    /// Returns the first display. Pipelines draw for this display, and its clock defines the periods of a run.
    ///
    /// # Panics
    ///
    /// Never panics, because [`MachineConfig::check`] refuses a machine without a display.
    pub fn display(&self) -> &dyn Display {
        self.displays[0].as_ref()
    }

    /// Returns the first display of type `D`, or `None` if the machine has none.
    pub fn display_of_kind<D: Display + 'static>(&self) -> Option<&D> {
        self.displays.iter().find_map(|display| (display.as_ref() as &dyn Any).downcast_ref())
    }

    pub(crate) fn first_surface(&self, display: usize) -> usize {
        self.displays[..display].iter().map(|display| display.surfaces().len()).sum()
    }

    /// Returns the surfaces of all displays, in the order of their numbers.
    pub fn surfaces(&self) -> impl Iterator<Item = (SurfaceId, &Surface)> {
        let all = self.displays.iter().flat_map(|display| display.surfaces());
        (0..).map(SurfaceId).zip(all)
    }

    /// Returns a surface by its number.
    pub fn surface(&self, id: SurfaceId) -> Option<&Surface> {
        self.surfaces().nth(id.index()).map(|(_, surface)| surface)
    }

    /// Returns the attachment of type `T`, or `None` if the pipeline added none.
    pub fn attached<T: Attachment>(&self) -> Option<&T> {
        self.attachments.iter().find_map(|attachment| (attachment.as_ref() as &dyn Any).downcast_ref())
    }

    /// Returns all observations so far.
    pub const fn observation(&self) -> &Observation {
        &self.observation
    }

    /// Returns all stages of all pictures. The times of COPY are measured at the displays.
    pub fn stages(&self) -> Vec<StageSpan> {
        self.observation.stages(self.message_span())
    }

    /// Returns the pictures that a double-buffered port has shown, in the order of swaps.
    ///
    /// The picture of a swap is the newest one of which a region arrived before it. No region of the next picture can
    /// have arrived by then, because the port's second buffer becomes free only at the swap. Pictures with discarded
    /// observations are missing.
    pub fn shown_by(&self, port: NodeId) -> Vec<Shown> {
        // Sort the arrivals at this port by time.
        let arrivals = self.observation.arrivals.iter().filter(|arrival| arrival.target.frame_buffer == port);
        let arrivals = arrivals.map(|arrival| (arrival.last_part_at, arrival.target.picture));
        let mut arrivals: Vec<(Time, PictureNumber)> = arrivals.collect();
        arrivals.sort_unstable();
        let mut arrivals = arrivals.into_iter().peekable();
        let mut newest: Option<(PictureNumber, Time)> = None;
        let swaps = self.observation.swaps.iter().filter(|swap| swap.port == port);
        // For each swap, find the newest picture that has arrived.
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

    /// Returns the time for which a message of maximum length occupies a ring channel.
    pub const fn message_span(&self) -> Span {
        self.ring.timing().occupancy(MAX_MESSAGE_WORDS)
    }

    /// Returns the start of a period of the first display.
    pub fn tick(&self, period: PeriodNumber) -> Time {
        self.display().tick(period)
    }

    /// Returns the start of a period of the display `board`, or of the first display if `board` is not a display.
    pub(crate) fn period_start(&self, board: Board, period: PeriodNumber) -> Time {
        let display = if let Board::Display(number) = board { number } else { 0 };
        self.displays[display].tick(period)
    }

    /// Returns the trace hash of the run. Equal runs have equal hashes.
    pub const fn trace_hash(&self) -> TraceHash {
        self.hash
    }

    /// Returns the number of events handled in the whole run.
    pub const fn events(&self) -> u64 {
        self.events
    }

    /// Returns the simulated time at which the run ended. Returns time zero while the machine runs.
    pub const fn elapsed(&self) -> Time {
        self.elapsed
    }

    /// Returns the CPU time of the whole run by kind of work. The host comes first, then the graphics processors. The
    /// slice is empty while the machine runs.
    pub fn processors_used(&self) -> &[GpUse] {
        &self.processors_used
    }

    /// Returns the number of vertices that graphics processors transformed in the whole run.
    ///
    /// Each corner of a triangle and each centre of a sphere counts once in each pass for one eye.
    pub const fn vertex_transforms(&self) -> u64 {
        self.vertex_transforms
    }

    /// Returns true if a full backing store (`renderer.kept_bits`) has delayed a region or changed a decision of a
    /// program.
    ///
    /// Otherwise, the same run with larger backing stores has the same times. Firmware whose decisions depend on the
    /// capacity must report a full backing store with [`Gp::note_full_store`](pxpl5_gp::Gp::note_full_store).
    pub const fn met_full_store(&self) -> bool {
        self.met_full_store
    }
}
