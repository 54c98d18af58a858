//! Who takes part, and which variant runs.

use crate::timing::JitpTiming;
use pxpl5_display::{Aim, LightSpan};
use pxpl5_geometry::Viewport;
use pxpl5_renderer::Layout;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{
    CopyTarget, FieldParity, Lines, NodeId, PeriodNumber, PictureNumber, RegionGrid, RegionId, ViewNumber,
};
use std::fmt;
use std::sync::Arc;
use thiserror::Error;

/// Between what the vertices of a dual display list are interpolated, from the begin to the end of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Interpolation {
    /// Between the vertex's two places on the screen, after the divide by depth.
    Screen,
    /// Between the vertex's two positions in the view, before the divide by depth.
    View,
}

/// The moments that a field's picture is computed for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Viewpoint {
    /// One for the whole field.
    Field,
    /// One for each strip.
    Strip,
    /// Between the first and the last pixel of the field.
    Dual(Interpolation),
}

/// The order in which regions are drawn.
#[derive(Clone, Debug)]
pub enum DrawingSchedule {
    /// Strips of a field from top to bottom.
    Beam {
        /// The moments that the picture is computed for.
        viewpoint: Viewpoint,
        /// Whether strips reach the frame buffer just before the beam, or one field earlier.
        racing: bool,
        /// Rows of a strip: 1 to 128.
        strip_rows: u32,
    },
    /// Square blocks of the whole frame in a random order, without end.
    Roam {
        /// Width and height of a block, 4 to 128 pixels.
        block: u32,
        /// Number of blocks that the master gives a slave in one order.
        batch: u32,
        /// Which block comes at a step.
        order: BlockOrder,
    },
}

/// When the beam is where.
#[derive(Clone)]
pub struct Beam {
    /// A function of (field, row of the field, pixel).
    at: Arc<dyn Fn(PeriodNumber, u32, u32) -> Time + Send + Sync>,
    /// A function of the field.
    retrace: Arc<dyn Fn(PeriodNumber) -> Time + Send + Sync>,
}

/// A function of the step: which block comes.
#[derive(Clone)]
pub struct BlockOrder(Arc<dyn Fn(u64) -> RegionId + Send + Sync>);

impl Beam {
    /// A beam that is at (field, row of the field, pixel) when `when` says, and begins a field when `retrace` says.
    pub fn new(
        when: impl Fn(PeriodNumber, u32, u32) -> Time + Send + Sync + 'static,
        retrace: impl Fn(PeriodNumber) -> Time + Send + Sync + 'static,
    ) -> Self {
        Self { at: Arc::new(when), retrace: Arc::new(retrace) }
    }

    /// When the beam is at a pixel of a row of a field.
    #[must_use]
    pub fn at(&self, field: PeriodNumber, row: u32, x: u32) -> Time {
        (self.at)(field, row, x)
    }

    /// The retrace that begins a field.
    #[must_use]
    pub fn retrace(&self, field: PeriodNumber) -> Time {
        (self.retrace)(field)
    }
}

impl BlockOrder {
    /// An order in which `block` says what comes at a step, from 0.
    pub fn new(block: impl Fn(u64) -> RegionId + Send + Sync + 'static) -> Self {
        Self(Arc::new(block))
    }

    pub(crate) fn at(&self, step: u64) -> RegionId {
        (self.0)(step)
    }
}

impl fmt::Debug for Beam {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Beam")
    }
}

impl fmt::Debug for BlockOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("BlockOrder")
    }
}

/// What the master asks of the tracking data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// Number that the view gets: see [`JitpConfig::view_number`].
    pub number: ViewNumber,
    /// Reports that the host had by then have reached the master.
    pub known: Time,
    /// The moment that the view is drawn for.
    pub shown_at: Time,
}

/// The boards that take part, and the variant that they run.
#[derive(Clone, Debug)]
pub struct JitpConfig {
    /// Node of the host interface, which passes the tracker's reports on.
    pub host: NodeId,
    /// Node of the GP that follows the beam and orders strips or blocks.
    pub master: NodeId,
    /// Nodes of the slave GPs, at least one.
    pub slaves: Vec<NodeId>,
    /// Nodes of the renderers, at least one.
    pub renderers: Vec<NodeId>,
    /// Node of the frame buffer: the one of a mono display.
    pub frame_buffer: NodeId,
    /// The order in which regions are drawn, and for which moments.
    pub schedule: DrawingSchedule,
    /// When the beam is where.
    pub beam: Beam,
    /// For which instant of what is shown from it a view is drawn.
    pub aim: Aim,
    /// How the bits of pixel memory are divided among contexts.
    pub layout: Layout,
    /// Whether somebody may want pixels: without it no command words are made, and all times stay the same.
    pub pixels: bool,
    /// Times of this firmware beside those of the processor.
    pub timing: JitpTiming,
}

/// A machine or variant that cannot run.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum JitpConfigError {
    /// There is no slave.
    #[error("just-in-time pixels need a master and at least one slave GP, found no slave")]
    NoSlave,
    /// A strip or block has no possible size.
    #[error("strips or blocks must have {} to {} lines, found {found}", expected.0, expected.1)]
    Size {
        /// Smallest and largest number of lines.
        expected: (u32, u32),
        /// The number of lines asked for.
        found: u32,
    },
}

/// View numbers of a field: one for each strip, at most 240.
const VIEWS_PER_FIELD: u64 = 256;

impl JitpConfig {
    /// Checks the numbers.
    ///
    /// # Errors
    ///
    /// [`JitpConfigError`] says what was expected and what was found.
    pub fn check(&self) -> Result<(), JitpConfigError> {
        if self.slaves.is_empty() {
            return Err(JitpConfigError::NoSlave);
        }
        let (found, expected) = match self.schedule {
            DrawingSchedule::Beam { strip_rows, .. } => (strip_rows, (1, 128)),
            DrawingSchedule::Roam { block, .. } => (block, (4, 128)),
        };
        let fits = (expected.0..=expected.1).contains(&found);
        if fits { Ok(()) } else { Err(JitpConfigError::Size { expected, found }) }
    }

    /// The number of the view of a strip, of the whole field (strip 0), or of the begin (0) and the end (1) of a field.
    #[must_use]
    pub const fn view_number(field: PeriodNumber, strip: u64) -> ViewNumber {
        ViewNumber(field.0 * VIEWS_PER_FIELD + strip)
    }

    /// How a field (strips) or a frame (blocks) is cut into regions.
    #[must_use]
    pub fn grid(&self) -> RegionGrid {
        match self.schedule {
            DrawingSchedule::Beam { strip_rows, .. } => RegionGrid { region_height: strip_rows, ..RegionGrid::FIELD },
            DrawingSchedule::Roam { block, .. } => {
                RegionGrid { region_width: block, region_height: block, ..RegionGrid::FRAME }
            }
        }
    }

    /// The regions of a strip.
    pub(crate) fn strip_regions(&self, strip: u32) -> Vec<RegionId> {
        let columns = self.grid().columns();
        (strip * columns..(strip + 1) * columns).map(|region| RegionId(region as u16)).collect()
    }

    /// The part of the frame that a picture fills, and its lines: of a field, or the whole.
    pub(crate) fn extent(&self, picture: PictureNumber) -> (Viewport, Lines) {
        match self.schedule {
            DrawingSchedule::Beam { .. } => {
                let parity = FieldParity::of_field(picture.period_drawn_for());
                (Viewport::field(parity), Lines::Field(parity))
            }
            DrawingSchedule::Roam { .. } => (Viewport::FRAME, Lines::Frame),
        }
    }

    pub(crate) fn target(&self, picture: PictureNumber, region: RegionId) -> CopyTarget {
        let (_, lines) = self.extent(picture);
        CopyTarget { frame_buffer: self.frame_buffer, buffer: 0, lines, grid: self.grid(), region, picture }
    }

    pub(crate) fn renderer_of(&self, region: RegionId) -> NodeId {
        self.renderers[usize::from(region.0) % self.renderers.len()]
    }

    /// First and last row of a strip.
    pub(crate) fn rows(&self, strip: u32) -> (u32, u32) {
        let RegionGrid { height, region_height, .. } = self.grid();
        let first = strip * region_height;
        (first, (first + region_height - 1).min(height - 1))
    }

    /// When the first pixel of a strip is scanned, by which it must have arrived.
    pub(crate) fn deadline(&self, field: PeriodNumber, strip: u32) -> Time {
        self.beam.at(field, self.rows(strip).0, 0)
    }

    /// Whether a strip is the middle one, whose way through the machine stands for that of its field.
    pub fn is_middle(&self, strip: u32) -> bool {
        strip == self.grid().rows() / 2
    }

    /// The instant that a strip is drawn for.
    #[must_use]
    pub fn aimed_at_strip(&self, field: PeriodNumber, strip: u32) -> Time {
        let (first, last) = self.rows(strip);
        self.aimed_at(field, first, last)
    }

    /// The instant that a field of one view is drawn for.
    #[must_use]
    pub fn aimed_at_field(&self, field: PeriodNumber) -> Time {
        self.aimed_at(field, 0, self.grid().height - 1)
    }

    /// The instant that some rows of a field are drawn for.
    fn aimed_at(&self, field: PeriodNumber, first: u32, last: u32) -> Time {
        let shown = LightSpan {
            tick: self.beam.retrace(field),
            first: self.beam.at(field, first, 0),
            last: self.beam.at(field, last, self.grid().width - 1),
        };
        self.aim.instant(&shown)
    }

    /// The first and the last pixel of a field: T0 and T1.
    #[must_use]
    pub fn ends(&self, field: PeriodNumber) -> (Time, Time) {
        let RegionGrid { width, height, .. } = self.grid();
        (self.beam.at(field, 0, 0), self.beam.at(field, height - 1, width - 1))
    }

    /// How much of the way from T0 to T1 the instant is that a strip is drawn for; below 0 for the retrace, which is before T0.
    #[must_use]
    pub fn part(&self, field: PeriodNumber, strip: u32) -> f64 {
        let (begin, end) = self.ends(field);
        let from_begin = self.aimed_at_strip(field, strip).0 as f64 - begin.0 as f64;
        from_begin / end.since(begin).0 as f64
    }

    /// From the order of a strip to its beam: every slave has as many strip times as there are slaves, and a strip that does
    /// not race the beam is there a field earlier.
    ///
    /// A field has one place in the frame buffer, which holds the field two before it until the beam has passed. No strip is
    /// ordered before its lines of that field have been scanned, so that it cannot overwrite them.
    pub(crate) fn lead(&self, racing: bool) -> Span {
        let first = PeriodNumber::FIRST;
        let begin = self.deadline(first, 0);
        let strip = self.deadline(first, 1).since(begin);
        let work = strip * self.slaves.len() as u64 + Span::from_ns(self.timing.margin_ns);
        let next_of_its_lines = self.deadline(first.after(2), 0);
        let wanted = if racing { work } else { work + self.field_time() };
        wanted.min(next_of_its_lines.since(self.scanned(first, 0)))
    }

    /// From a field to the next one.
    pub(crate) fn field_time(&self) -> Span {
        let first = PeriodNumber::FIRST;
        self.deadline(first.after(2), 0).since(self.deadline(first, 0)) / 2
    }

    /// When the last pixel of a strip has been scanned.
    fn scanned(&self, field: PeriodNumber, strip: u32) -> Time {
        let RegionGrid { width, height, region_height, .. } = self.grid();
        let last = ((strip + 1) * region_height).min(height) - 1;
        self.beam.at(field, last, width - 1)
    }
}

#[cfg(test)]
mod tests;
