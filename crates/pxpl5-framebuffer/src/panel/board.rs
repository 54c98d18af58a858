//! The boards of a panel: double-buffered pictures, and the times at which their pixels are lit.

use super::PanelNumbers;
use image::RgbImage;
use pxpl5_sim::parameters::SettingError;
use pxpl5_sim::{Clock, Span, Time};
use pxpl5_wire::display::{
    BufferReceipt, Counter, Display, DisplayContext, DisplayEvent, DisplayOutput, DoubleBuffer, PixelLight, ScanOrder,
    Surface,
};
use pxpl5_wire::{NodeId, PeriodNumber};

/// A panel for a single picture, or two panels for the eyes of a stereo pair, which share a sync generator.
///
/// Each panel has a frame buffer board, which writes regions into the buffer that is not shown. A swap request takes
/// effect at the next retrace.
///
/// **Not modelled:** pixels that arrive while their line is scanned.
#[derive(Debug)]
pub struct Panel {
    name: &'static str,
    numbers: PanelNumbers,
    /// Time in which a port receives one word.
    word: Span,
    frame: Clock,
    nodes: Vec<NodeId>,
    surfaces: Vec<Surface>,
    /// One board for each surface. Port n belongs to the board with index n modulo the number of boards.
    boards: Vec<DoubleBuffer>,
    /// Copies of the boards of an interlaced panel, from one period ago. The previous period lit the lines that the
    /// current period skips.
    older: Vec<DoubleBuffer>,
    scans: u64,
}

/// Builds a panel from parameters that were already checked. The list of ring ports contains the first ports of all
/// boards, then the second ports of all boards, and so on.
///
/// # Errors
///
/// Returns [`SettingError`] if the number of ports is not a multiple of the number of boards.
pub(super) fn build(
    name: &'static str,
    numbers: PanelNumbers,
    nodes: &[NodeId],
    word: Span,
) -> Result<Box<dyn Display>, SettingError> {
    let boards = nodes.len() / numbers.ports as usize;
    // Every board needs the same number of ports.
    if boards == 0 || !nodes.len().is_multiple_of(numbers.ports as usize) {
        let (ports, found) = (numbers.ports, nodes.len());
        return Err(SettingError::value("ports", format_args!("a multiple of {ports} nodes"), found).in_table(name));
    }
    let frame = Clock::from_hz(numbers.refresh_hz)
        .ok_or_else(|| SettingError::value("refresh_hz", "1 or more", numbers.refresh_hz).in_table(name))?;
    let [width, height] = [numbers.width as u32, numbers.height as u32];
    let surfaces = Surface::of_frame_buffers(boards, width, height);
    let boards = vec![DoubleBuffer::new(width, height); boards];
    Ok(Box::new(Panel {
        name,
        numbers,
        word,
        frame,
        nodes: nodes.to_vec(),
        surfaces,
        boards,
        older: Vec::new(),
        scans: 0,
    }))
}

impl Panel {
    /// Returns the parameters of the panel.
    pub const fn numbers(&self) -> &PanelNumbers {
        &self.numbers
    }

    const fn is_interlaced(&self) -> bool {
        self.numbers.interlace == 1
    }

    /// Returns the first line that a period lights, and the distance between lit lines (1, or 2 if interlaced).
    const fn rows(&self, period: PeriodNumber) -> (u64, u64) {
        if self.is_interlaced() { (period.0 % 2, 2) } else { (0, 1) }
    }

    /// Returns the number of pixels that a rolling scan lights before pixel (x, y). For a global scan, the result is
    /// the number of all pixels, because they are lit at the end of the scan.
    fn order(&self, x: u64, y: u64, rows: (u64, u64)) -> u64 {
        let [columns, lines] = [self.numbers.width, self.numbers.height / rows.1];
        let line = (y - rows.0) / rows.1;
        match self.light().scan {
            ScanOrder::Down => line * columns + x,
            ScanOrder::Up => (lines - 1 - line) * columns + x,
            ScanOrder::Right => x * lines + line,
            ScanOrder::Left => (columns - 1 - x) * lines + line,
            ScanOrder::Global => lines * columns,
        }
    }

    /// Returns a picture in the colours that the panel can show: each primary colour keeps only its highest bits.
    fn in_its_colours(&self, mut picture: RgbImage) -> RgbImage {
        let bits = self.numbers.bits / 3;
        if bits < 8 {
            let mask = !(u8::MAX >> bits);
            picture.iter_mut().for_each(|value| *value &= mask);
        }
        picture
    }

    /// Returns the times at which the corner pixels of a surface are lit in a period. They include the first and the
    /// last light of the surface, in every direction of the scan.
    fn corners(&self, surface: usize, period: PeriodNumber) -> impl Iterator<Item = Time> {
        let [right, low] = [self.numbers.width as u32 - 1, (self.numbers.height as u32).saturating_sub(2)];
        let bottom = self.numbers.height as u32 - 1;
        let all = [(0, 0), (right, 0), (0, low), (right, low), (0, bottom), (right, bottom)];
        all.into_iter().filter_map(move |(x, y)| self.line_lights(surface, x, y, period))
    }
}

impl Display for Panel {
    fn name(&self) -> &'static str {
        self.name
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
        let at = context.now() + self.word;
        match event {
            DisplayEvent::Tick(tick) => {
                self.scans += 1;
                if self.is_interlaced() {
                    self.older.clone_from(&self.boards);
                }
                for (surface, board) in self.boards.iter_mut().enumerate() {
                    // A board swaps only if a request arrived before this retrace.
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
        let [x, y] = [u64::from(x), u64::from(y)];
        let rows = self.rows(period);
        let PanelNumbers { width, height, active_permille, .. } = self.numbers;
        if x >= width || y >= height || y % rows.1 != rows.0 {
            return None;
        }
        let frame = self.tick(period.next()).since(self.tick(period));
        // Each pixel takes an equal part of the time in which the scan lights pixels.
        let pixels = u128::from(width * (height / rows.1)) * 1_000;
        let passed = u128::from(frame.0) * u128::from(active_permille) * u128::from(self.order(x, y, rows)) / pixels;
        Some(self.tick(period) + Span(passed as u64))
    }

    fn shown(&self, surface: usize) -> Option<RgbImage> {
        Some(self.in_its_colours(self.boards.get(surface)?.picture()))
    }

    fn seen(&self, surface: usize, period: PeriodNumber) -> Option<RgbImage> {
        let board = self.boards.get(surface).filter(|_| self.last_seen() == Some(period))?;
        let mut seen = board.scanned_picture();
        // The lines that this period skipped still show the picture of the previous period.
        if let Some(before) = self.older.get(surface).map(DoubleBuffer::scanned_picture) {
            let (first, distance) = self.rows(period);
            let bytes = self.numbers.width as usize * 3;
            let rows = seen.chunks_exact_mut(bytes).zip(before.as_raw().chunks_exact(bytes)).zip(0..);
            let still_waiting = rows.filter(|(_, y)| y % distance != first);
            still_waiting.for_each(|((row, old), _)| row.copy_from_slice(old));
        }
        Some(self.in_its_colours(seen))
    }

    fn last_seen(&self) -> Option<PeriodNumber> {
        self.scans.checked_sub(2).map(PeriodNumber)
    }

    fn rows_lit(&self, period: PeriodNumber) -> (u32, u32) {
        let (first, distance) = self.rows(period);
        (first as u32, distance as u32)
    }

    fn light(&self) -> PixelLight {
        self.numbers.light()
    }

    fn first_light(&self, surface: usize, period: PeriodNumber) -> Option<Time> {
        self.corners(surface, period).min()
    }

    fn last_light(&self, surface: usize, period: PeriodNumber) -> Option<Time> {
        self.corners(surface, period).max()
    }

    fn counters(&self) -> Vec<Counter> {
        vec![Counter { name: "scans", count: self.scans }]
    }

    fn faults(&self) -> (u64, Option<String>) {
        let each = || self.boards.iter().map(DoubleBuffer::faults);
        (each().map(|(count, _)| count).sum(), each().find_map(|(_, first)| first.map(str::to_owned)))
    }
}
