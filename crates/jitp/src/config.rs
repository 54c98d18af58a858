//! Settings of just-in-time pixels: the boards, and the variant of the pipeline.

use crate::timing::JitpTiming;
use pxpl5_geometry::Viewport;
use pxpl5_renderer::Layout;
use pxpl5_sim::parameters::SettingError;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::display::{Aim, LightTimes};
use pxpl5_wire::{
    CopyTarget, FieldParity, Lines, NodeId, PeriodNumber, PictureNumber, RegionGrid, RegionId, ViewNumber,
};
use std::fmt;
use std::sync::Arc;

/// The coordinates in which vertices are interpolated between the views at the start and at the end of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Interpolation {
    /// Positions on the screen, after the division by depth.
    Screen,
    /// Positions in eye space, before the division by depth.
    View,
}

/// The instants for which the parts of a field are drawn.
///
/// Each part shows the scene as the viewer sees it at one instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Viewpoint {
    /// The whole field shows one instant.
    Field,
    /// Each strip of lines shows its own instant and is transformed separately.
    Strip,
    /// Each strip shows its own instant. The vertices of a strip are interpolated between the start and the end of the
    /// field.
    Dual(Interpolation),
}

/// The parts in which a picture is drawn, and their order.
#[derive(Clone, Debug)]
pub enum DrawingSchedule {
    /// Strips of lines, from the top to the bottom of each field.
    Beam {
        viewpoint: Viewpoint,
        /// True if strips reach the frame buffer just before the beam. False if strips arrive one field earlier.
        racing: bool,
        /// Number of lines of a strip: 1 to 128.
        strip_rows: u32,
    },
    /// Square blocks of the whole video frame, in an endless random order.
    Roam {
        /// Width and height of a block, 4 to 128 pixels.
        block: u32,
        /// Number of blocks in one order to a slave.
        batch: u32,
        order: BlockOrder,
    },
}

/// The times at which the beam of the display reaches each pixel.
#[derive(Clone)]
pub struct Beam {
    /// Function that returns the time at which the beam reaches a pixel. The arguments are the field, the row of the
    /// field, and the pixel of the row.
    at: Arc<dyn Fn(PeriodNumber, u32, u32) -> Time + Send + Sync>,
    retrace: Arc<dyn Fn(PeriodNumber) -> Time + Send + Sync>,
}

/// The random order of blocks. Each step draws one block.
#[derive(Clone)]
pub struct BlockOrder(Arc<dyn Fn(u64) -> RegionId + Send + Sync>);

impl Beam {
    /// Creates a beam from two functions. `when` returns the time at which the beam reaches a pixel, for a field, a row
    /// of this field and a pixel of this row. `retrace` returns the time at which a field begins.
    pub fn new(
        when: impl Fn(PeriodNumber, u32, u32) -> Time + Send + Sync + 'static,
        retrace: impl Fn(PeriodNumber) -> Time + Send + Sync + 'static,
    ) -> Self {
        Self { at: Arc::new(when), retrace: Arc::new(retrace) }
    }

    /// Returns the time at which the beam reaches pixel `x` of a row of a field.
    pub fn at(&self, field: PeriodNumber, row: u32, x: u32) -> Time {
        (self.at)(field, row, x)
    }

    /// Returns the time of the retrace that begins a field.
    pub fn retrace(&self, field: PeriodNumber) -> Time {
        (self.retrace)(field)
    }
}

impl BlockOrder {
    /// Creates an order from a function that returns the block for each step, counted from 0.
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

/// The master's request for a view that is predicted from the tracker's reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// Number of the view: see [`JitpConfig::view_number`].
    pub number: ViewNumber,
    /// Instant until which reports count. The view must depend only on reports that the host received before this
    /// instant, because later reports have not reached the master.
    pub reports_until: Time,
    /// Instant for which the pose of the view is predicted.
    pub shown_at: Time,
}

/// The boards and the variant of just-in-time pixels.
#[derive(Clone, Debug)]
pub struct JitpConfig {
    /// Ring port of the host, which forwards the tracker's reports.
    pub host: NodeId,
    /// Ring port of the graphics processor that follows the beam and orders strips or blocks.
    pub master: NodeId,
    /// Ring ports of the slaves, at least one.
    pub slaves: Vec<NodeId>,
    /// Ring ports of the renderers, at least one.
    pub renderers: Vec<NodeId>,
    /// Ring port of the frame buffer. The pipeline draws for one eye only.
    pub frame_buffer: NodeId,
    pub schedule: DrawingSchedule,
    pub beam: Beam,
    /// Choice of the instant for which a part is drawn, such as the middle of the time in which the part lights.
    pub aim: Aim,
    pub layout: Layout,
    /// True if the run can compute pixels. If false, no command words are made, but all times stay the same.
    pub pixels: bool,
    /// Times of this pipeline that the processor's timing table lacks.
    pub timing: JitpTiming,
}

/// Distance between the view numbers of two fields. A field has at most 240 strips.
const VIEWS_PER_FIELD: u64 = 256;

impl JitpConfig {
    /// Checks the number of slaves and the size of strips or blocks.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] with the expected and the found value.
    pub fn check(&self) -> Result<(), SettingError> {
        if self.slaves.is_empty() {
            let reason = "just-in-time pixels need a master and at least one slave GP, found no slave";
            return Err(SettingError::combination(reason));
        }
        let (found, expected) = match self.schedule {
            DrawingSchedule::Beam { strip_rows, .. } => (strip_rows, (1, 128)),
            DrawingSchedule::Roam { block, .. } => (block, (4, 128)),
        };
        if (expected.0..=expected.1).contains(&found) {
            return Ok(());
        }
        let (low, high) = expected;
        Err(SettingError::combination(format_args!("strips or blocks must have {low} to {high} lines, found {found}")))
    }

    /// Returns the number of the view for strip `strip` of a field.
    ///
    /// If all strips share one view, the view has the number of strip 0. The views for the start and the end of a field
    /// have the numbers of strips 0 and 1.
    pub const fn view_number(field: PeriodNumber, strip: u64) -> ViewNumber {
        ViewNumber(field.0 * VIEWS_PER_FIELD + strip)
    }

    /// Returns the regions into which a field (strips) or a video frame (blocks) is divided.
    pub fn grid(&self) -> RegionGrid {
        match self.schedule {
            DrawingSchedule::Beam { strip_rows, .. } => RegionGrid { region_height: strip_rows, ..RegionGrid::FIELD },
            DrawingSchedule::Roam { block, .. } => {
                RegionGrid { region_width: block, region_height: block, ..RegionGrid::FRAME }
            }
        }
    }

    pub(crate) fn strip_regions(&self, strip: u32) -> Vec<RegionId> {
        let columns = self.grid().columns();
        (strip * columns..(strip + 1) * columns).map(|region| RegionId(region as u16)).collect()
    }

    /// Returns the screen area and the lines of a picture: a field for strips, the whole video frame for blocks.
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

    pub(crate) fn rows(&self, strip: u32) -> (u32, u32) {
        let RegionGrid { height, region_height, .. } = self.grid();
        let first = strip * region_height;
        (first, (first + region_height - 1).min(height - 1))
    }

    /// Returns the deadline of a strip: the time at which the beam reaches its first pixel.
    pub(crate) fn deadline(&self, field: PeriodNumber, strip: u32) -> Time {
        self.beam.at(field, self.rows(strip).0, 0)
    }

    /// Returns true for the middle strip of a field. In the trace, the drawing of this strip stands for the whole
    /// field.
    pub fn is_middle(&self, strip: u32) -> bool {
        strip == self.grid().rows() / 2
    }

    /// Returns the instant for which a strip is drawn, such as the middle of its scan ([`JitpConfig::aim`]).
    pub fn aimed_at_strip(&self, field: PeriodNumber, strip: u32) -> Time {
        let (first, last) = self.rows(strip);
        self.aimed_at(field, first, last)
    }

    /// Returns the instant for which a field is drawn if all strips share one view.
    pub fn aimed_at_field(&self, field: PeriodNumber) -> Time {
        self.aimed_at(field, 0, self.grid().height - 1)
    }

    fn aimed_at(&self, field: PeriodNumber, first: u32, last: u32) -> Time {
        let shown = LightTimes {
            tick: self.beam.retrace(field),
            first: self.beam.at(field, first, 0),
            last: self.beam.at(field, last, self.grid().width - 1),
        };
        self.aim.instant(&shown)
    }

    /// Returns the times at which the beam reaches the first and the last pixel of a field.
    pub fn ends(&self, field: PeriodNumber) -> (Time, Time) {
        let RegionGrid { width, height, .. } = self.grid();
        (self.beam.at(field, 0, 0), self.beam.at(field, height - 1, width - 1))
    }

    /// Returns the instant for which a strip is drawn, as a part of the field. The part is 0 when the beam reaches the
    /// first pixel, and 1 when the beam reaches the last pixel. The result is negative if [`JitpConfig::aim`] is the
    /// retrace.
    pub fn part(&self, field: PeriodNumber, strip: u32) -> f64 {
        let (begin, end) = self.ends(field);
        let from_begin = self.aimed_at_strip(field, strip).0 as f64 - begin.0 as f64;
        from_begin / end.since(begin).0 as f64
    }

    /// Returns the time from the order of a strip to the strip's deadline.
    ///
    /// Each of n slaves draws every n-th strip, so a slave has the time that the beam needs for n strips. Without
    /// racing, the master orders strips one field earlier.
    ///
    /// Fields n - 2 and n use the same lines of the frame buffer. The master therefore orders a strip of field n only
    /// after the beam has scanned its lines in field n - 2.
    pub(crate) fn lead(&self, racing: bool) -> Span {
        let first = PeriodNumber::FIRST;
        let begin = self.deadline(first, 0);
        let strip = self.deadline(first, 1).since(begin);
        let work = strip * self.slaves.len() as u64 + Span::from_ns(self.timing.margin_ns);
        let next_of_its_lines = self.deadline(first.after(2), 0);
        let wanted = if racing { work } else { work + self.field_time() };
        wanted.min(next_of_its_lines.since(self.scanned(first, 0)))
    }

    pub(crate) fn field_time(&self) -> Span {
        let first = PeriodNumber::FIRST;
        self.deadline(first.after(2), 0).since(self.deadline(first, 0)) / 2
    }

    fn scanned(&self, field: PeriodNumber, strip: u32) -> Time {
        let RegionGrid { width, height, region_height, .. } = self.grid();
        let last = ((strip + 1) * region_height).min(height) - 1;
        self.beam.at(field, last, width - 1)
    }
}

#[cfg(test)]
mod tests;
