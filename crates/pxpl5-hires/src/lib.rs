//! The high-resolution frame buffer of Pixel-Planes 5: 1280 x 1024 at 72 Hz, every line in every scan, double-buffered.
//!
//! A board writes regions into the buffer that is not shown, and swaps at the next retrace after a request. This crate
//! is also the example of a new display: it consists of this file and one line in the registry.
//!
//! **Not modelled:** blanking (the scan fills its whole period), and pixels that arrive while their line is scanned.
//!
//! Sources: F89 (size), TR94 (words). The rate and the scan without blanking are assumed.

use image::RgbImage;
use parameters::ParameterTable;
use pxpl5_display::{
    BufferReceipt, Counter, Display, DisplayConfig, DisplayContext, DisplayError, DisplayEvent, DisplayOutput,
    DoubleBuffer, Surface,
};
use pxpl5_sim::{Clock, Span, Time};
use pxpl5_wire::{NodeId, PeriodNumber};

parameters::parameter_table! {
    /// Size and rate of the scan.
    pub struct HiResConfig {
        /// Visible pixels of a line.
        width: 1280, "pixels", Published, 1280..=1280 in 1..=1408, "F89";
        /// Visible lines of a frame.
        height: 1024, "lines", Published, 1024..=1024 in 1..=1408, "F89";
        /// Scans of the whole frame per second.
        refresh_hz: 72, "Hz", Assumed, 60..=76 in 1..=1000, "monitors of this size at the time";
        /// Ports of a board on the ring. Successive regions use them in turn.
        ports: 1, "ports", Assumed, 1..=8 in 1..=8, "no source gives the number. 1 is the number of an NTSC frame buffer (TR94). With 1 port, the 80 regions of a picture take 66.6 ms or five scans, so at most 14.4 pictures per second reach the display. 8 is the number of channels of the ring";
        /// Time of one word at a port.
        word_ns: 50, "ns", Published, 50..=50 in 1..=1_000_000, "TR94: 20 Mwords/s per channel";
    }
}

/// High-resolution frame buffers that share a sync generator, one for each picture that is drawn at a time.
#[derive(Debug)]
struct HiRes {
    config: HiResConfig,
    frame: Clock,
    nodes: Vec<NodeId>,
    surfaces: Vec<Surface>,
    /// One board for each surface. Port n belongs to the board with number n modulo the number of boards.
    boards: Vec<DoubleBuffer>,
    scans: u64,
}

impl Display for HiRes {
    fn name(&self) -> &'static str {
        "hires"
    }

    fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }

    fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    fn tick(&self, period: PeriodNumber) -> Time {
        self.frame.edge(period.0)
    }

    fn period_at(&self, time: Time) -> PeriodNumber {
        let n = self.frame.edge_at_or_after(time);
        PeriodNumber(if self.frame.edge(n) == time { n } else { n - 1 })
    }

    fn handle(&mut self, event: DisplayEvent, context: &mut DisplayContext) {
        let at = context.now() + Span::from_ns(self.config.word_ns);
        match event {
            DisplayEvent::Tick(tick) => {
                self.scans += 1;
                for (surface, board) in self.boards.iter_mut().enumerate() {
                    // A board swaps only if a request arrived before this tick.
                    if let Some(buffer) = board.swap(context.now()) {
                        context.output(at, DisplayOutput::Swapped { surface, buffer, tick });
                    }
                }
            }
            DisplayEvent::Delivered { port, body } => {
                // Ports are assigned to the boards in turn.
                let surface = port % self.boards.len();
                match self.boards[surface].receive(body, context.now()) {
                    BufferReceipt::Region(pixels, first_part_at) => {
                        let (target, last_part_at) = (pixels.target, context.now());
                        let region = DisplayOutput::RegionArrived { surface, target, first_part_at, last_part_at };
                        context.output(at, region);
                    }
                    BufferReceipt::Part | BufferReceipt::Fault => {}
                }
            }
            DisplayEvent::Timer(_) => {}
        }
    }

    fn lights(&self, _: usize, x: u32, y: u32, period: PeriodNumber) -> Option<Time> {
        let pixel = u64::from(y) * self.config.width + u64::from(x);
        let visible = u64::from(x) < self.config.width && u64::from(y) < self.config.height;
        let frame = self.tick(period.next()).since(self.tick(period));
        // The pixels share the period evenly, because the scan has no blanking.
        let share = u128::from(frame.0) * u128::from(pixel) / u128::from(self.config.width * self.config.height);
        visible.then(|| self.tick(period) + Span(share as u64))
    }

    fn shown(&self, surface: usize) -> Option<RgbImage> {
        Some(self.boards.get(surface)?.picture())
    }

    fn seen(&self, surface: usize, period: PeriodNumber) -> Option<RgbImage> {
        let board = self.boards.get(surface).filter(|_| self.last_seen() == Some(period))?;
        Some(board.scanned_picture())
    }

    fn last_seen(&self) -> Option<PeriodNumber> {
        self.scans.checked_sub(2).map(PeriodNumber)
    }

    fn counters(&self) -> Vec<Counter> {
        vec![Counter { name: "scans", count: self.scans }]
    }

    fn faults(&self) -> (u64, Option<String>) {
        let each = || self.boards.iter().map(DoubleBuffer::faults);
        (each().map(|(count, _)| count).sum(), each().find_map(|(_, first)| first.map(str::to_owned)))
    }
}

impl DisplayConfig for HiResConfig {
    fn name(&self) -> &'static str {
        "hires"
    }

    fn about(&self) -> &'static str {
        "high-resolution frame buffer of 1280 x 1024, progressive, 72 Hz (F89)"
    }

    fn tables(&self) -> Vec<(&'static str, &dyn ParameterTable)> {
        vec![("hires", self)]
    }

    fn tables_mut(&mut self) -> Vec<(&'static str, &mut dyn ParameterTable)> {
        vec![("hires", self)]
    }

    fn ports(&self, pictures: usize) -> usize {
        pictures * self.ports as usize
    }

    /// Builds the boards. Of the ring ports, the first ones of all boards come first, then the second ones.
    fn build(&self, nodes: &[NodeId]) -> Result<Box<dyn Display>, DisplayError> {
        DisplayConfig::check(self)?;
        let boards = nodes.len() / self.ports as usize;
        // Every board needs the same number of ports.
        if boards == 0 || !nodes.len().is_multiple_of(self.ports as usize) {
            let (ports, found) = (self.ports, nodes.len());
            return Err(DisplayError(format!("hires.ports: expected a multiple of {ports} nodes, found {found}")));
        }
        let frame = Clock::from_hz(self.refresh_hz).ok_or_else(|| DisplayError("hires.refresh_hz".to_owned()))?;
        let surfaces = Surface::of_frame_buffers(boards, self.width as u32, self.height as u32);
        let boards = vec![DoubleBuffer::new(self.width as u32, self.height as u32); boards];
        Ok(Box::new(HiRes { config: *self, frame, nodes: nodes.to_vec(), surfaces, boards, scans: 0 }))
    }

    fn boxed(&self) -> Box<dyn DisplayConfig> {
        Box::new(*self)
    }
}
