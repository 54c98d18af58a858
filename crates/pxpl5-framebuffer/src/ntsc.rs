//! The NTSC display: one frame buffer for each eye. All frame buffers scan in lock-step.

use crate::{FrameBuffer, FrameBufferConfig, FrameBufferEvent, FrameBufferOutput, ScannedField, Video};
use image::RgbImage;
use pxpl5_sim::parameters::{ParameterTable, SettingError};
use pxpl5_sim::{Context, Span, Time};
use pxpl5_wire::display::{Counter, Display, DisplayConfig, DisplayContext, DisplayEvent, DisplayOutput, Surface};
use pxpl5_wire::{Body, Eye, FieldParity, NodeId, PeriodNumber, read_swap_request};
use std::ops::Range;

/// Frame buffers that share a sync generator: one board for a single picture, or two boards for the eyes of a stereo
/// pair.
///
/// The periods of the display are fields. Each surface is the picture of one eye.
#[derive(Debug)]
pub struct NtscDisplay {
    video: Video,
    boards: Vec<FrameBuffer>,
    nodes: Vec<NodeId>,
    surfaces: Vec<Surface>,
    context: Context<FrameBufferEvent, FrameBufferOutput>,
}

impl NtscDisplay {
    /// Returns the video signal of the boards, which gives the place of the beam at any time.
    pub const fn video(&self) -> &Video {
        &self.video
    }

    /// Returns the frame buffer boards, the left eye first.
    pub fn boards(&self) -> &[FrameBuffer] {
        &self.boards
    }

    fn board_event(&mut self, board: usize, event: FrameBufferEvent, context: &mut DisplayContext) {
        self.boards[board].handle(event, self.context.at(context.now()));
        for (time, output) in self.context.drain_outputs() {
            context.output(time, passed_on(board, output));
        }
    }

    fn sum(&self, count: fn(&FrameBuffer) -> u64) -> u64 {
        self.boards.iter().map(count).sum()
    }
}

const fn passed_on(board: usize, output: FrameBufferOutput) -> DisplayOutput {
    match output {
        FrameBufferOutput::RegionArrived { target, first_part_at, last_part_at } => {
            DisplayOutput::RegionArrived { surface: board, target, first_part_at, last_part_at }
        }
        FrameBufferOutput::Swapped { buffer, field } => DisplayOutput::Swapped { surface: board, buffer, tick: field },
    }
}

/// Converts a ring message to an event of a frame buffer. An invalid message becomes a request for a buffer that does
/// not exist, which the board counts as a fault.
fn received(body: Body) -> FrameBufferEvent {
    match body {
        Body::Pixels(pixels) => FrameBufferEvent::Pixels(pixels),
        Body::Words(words) => FrameBufferEvent::SwapRequested { buffer: read_swap_request(&words).unwrap_or(u8::MAX) },
        Body::Commands(_) => FrameBufferEvent::SwapRequested { buffer: u8::MAX },
    }
}

impl Display for NtscDisplay {
    fn name(&self) -> &'static str {
        NAME
    }

    fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }

    fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    fn tick(&self, period: PeriodNumber) -> Time {
        self.video.retrace(period)
    }

    fn period_at(&self, time: Time) -> PeriodNumber {
        self.video.field_at(time)
    }

    fn handle(&mut self, event: DisplayEvent, context: &mut DisplayContext) {
        match event {
            DisplayEvent::Tick(field) => {
                for board in 0..self.boards.len() {
                    self.board_event(board, FrameBufferEvent::Retrace { field }, context);
                }
            }
            DisplayEvent::Delivered { port, body } => self.board_event(port, received(body), context),
            DisplayEvent::Timer(_) => {}
        }
    }

    fn lights(&self, _surface: usize, x: u32, y: u32, period: PeriodNumber) -> Option<Time> {
        self.video.when(x, y, period)
    }

    fn shown(&self, surface: usize) -> Option<RgbImage> {
        Some(self.boards.get(surface)?.displayed_frame().picture())
    }

    fn seen(&self, surface: usize, period: PeriodNumber) -> Option<RgbImage> {
        let board = self.boards.get(surface)?;
        let now = board.seen(period)?;
        // The picture has the lines of this field and of the previous field.
        let before = period.before(1).and_then(|field| board.seen(field));
        Some(now.interlaced_with(before.as_ref().unwrap_or(&now)))
    }

    fn seen_pixel(&self, surface: usize, pixel: [u32; 2], period: PeriodNumber) -> Option<[u8; 3]> {
        let board = self.boards.get(surface)?;
        let now = board.seen(period)?;
        let before = || board.seen(period.before(1)?)?.pixel(pixel);
        let is_inside = pixel[0] < self.video.width() && pixel[1] < self.video.height();
        is_inside.then(|| now.pixel(pixel).or_else(before).unwrap_or_default())
    }

    fn seen_at(&self, surface: usize, time: Time) -> Option<RgbImage> {
        let board = self.boards.get(surface)?;
        let now = self.video.field_at(time);
        board.seen(now)?;
        // At any instant, the screen shows lines of up to three fields.
        let oldest = now.before(2).unwrap_or(PeriodNumber::FIRST);
        let fields: Vec<ScannedField> = oldest.until(now.next()).filter_map(|field| board.seen(field)).collect();
        Some(seen_at(&self.video, time, &fields))
    }

    fn picture_so_far(&self, surface: usize, now: Time) -> Option<RgbImage> {
        let board = self.boards.get(surface)?;
        let period = self.video.field_at(now);
        let oldest = period.before(2).unwrap_or(PeriodNumber::FIRST);
        let before = oldest.until(period).filter_map(|field| board.seen(field));
        let fields: Vec<ScannedField> = before.chain(board.current_scan(now)).collect();
        Some(seen_at(&self.video, now, &fields))
    }

    fn last_seen(&self) -> Option<PeriodNumber> {
        Some(self.boards.first()?.last_seen()?.field())
    }

    fn rows_lit(&self, period: PeriodNumber) -> (u32, u32) {
        (FieldParity::of_field(period).first_line(), 2)
    }

    fn counters(&self) -> Vec<Counter> {
        vec![
            Counter { name: "fields", count: self.boards.first().map_or(0, |board| board.stats().fields) },
            Counter { name: "messages", count: self.sum(|board| board.stats().messages) },
            Counter { name: "regions", count: self.sum(|board| board.stats().regions) },
            Counter { name: "swaps", count: self.sum(|board| board.stats().swaps) },
            Counter { name: Counter::LINES_NEVER_SHOWN, count: self.sum(|board| board.stats().lines_never_shown) },
        ]
    }

    fn faults(&self) -> (u64, Option<String>) {
        let count = self.boards.iter().map(|board| board.faults().count).sum();
        let first = self.boards.iter().filter_map(|board| board.faults().first.as_ref()).min_by_key(|fault| fault.0);
        (count, first.map(|(time, fault)| format!("{time}: {fault}")))
    }
}

/// Returns the screen as a viewer sees it at `time`. `fields` should contain the field that is scanned at `time`, and
/// the two fields before it. Lines of a missing field are black.
///
/// Half of the lines belong to the previous field. Of the others, those above the beam belong to the current field, and
/// those below it to the field two fields earlier. The model's phosphor does not fade until the beam returns.
pub fn seen_at(video: &Video, time: Time, fields: &[ScannedField]) -> RgbImage {
    let now = video.field_at(time);
    let ages = [0, 1, 2].map(|age| picture_of(fields, now.before(age)));
    let mut screen = RgbImage::new(video.width(), video.height());
    let row_bytes = video.width() as usize * 3;
    // Take each line from the field whose beam passed it last.
    for (y, row) in (0..).zip(screen.chunks_exact_mut(row_bytes)) {
        let mut copy = |age: usize, bytes: Range<usize>| {
            if let Some(field) = &ages[age] {
                let first = (y / 2) as usize * row_bytes;
                row[bytes.clone()].copy_from_slice(&field.as_raw()[first..][bytes]);
            }
        };
        // The current field does not scan this line.
        if video.when(0, y, now).is_none() {
            copy(1, 0..row_bytes);
            continue;
        }
        // The beam moves from left to right, so the pixels that it has passed are at the start of the line.
        let has_been = |x: u32| video.when(x, y, now).is_some_and(|scanned_at| scanned_at <= time);
        let scanned = first_without(video.width(), has_been) as usize * 3;
        copy(0, 0..scanned);
        copy(2, scanned..row_bytes);
    }
    screen
}

/// Returns the lowest number below `count` for which `has` is false, or `count` if there is none. `has` must be true
/// for all lower numbers and false for all higher ones. This finds the first pixel that the beam has not reached.
fn first_without(count: u32, has: impl Fn(u32) -> bool) -> u32 {
    let (mut low, mut high) = (0, count);
    while low < high {
        let middle = low.midpoint(high);
        if has(middle) { low = middle + 1 } else { high = middle }
    }
    low
}

/// Returns the picture of field `wanted`, with only its scanned lines, if `fields` contains this field.
fn picture_of(fields: &[ScannedField], wanted: Option<PeriodNumber>) -> Option<RgbImage> {
    fields.iter().find(|field| Some(field.field()) == wanted).map(ScannedField::picture)
}

const NAME: &str = "ntsc";

impl DisplayConfig for FrameBufferConfig {
    fn name(&self) -> &'static str {
        NAME
    }

    fn about(&self) -> &'static str {
        "NTSC frame buffers of 640 x 480, two fields of 240 lines at 59.94 Hz, one for each eye (TR94)"
    }

    fn tables(&self) -> Vec<(&'static str, &dyn ParameterTable)> {
        vec![("video", &self.video)]
    }

    fn tables_mut(&mut self) -> Vec<(&'static str, &mut dyn ParameterTable)> {
        vec![("video", &mut self.video)]
    }

    fn ports(&self, pictures: usize) -> usize {
        pictures.clamp(1, Eye::BOTH.len())
    }

    fn check(&self) -> Result<(), SettingError> {
        Self::check(self)
    }

    fn build(&self, nodes: &[NodeId], word: Span) -> Result<Box<dyn Display>, SettingError> {
        let video = self.video.video()?;
        let boards = nodes.iter().map(|node| FrameBuffer::new(*self, *node, word)).collect::<Result<Vec<_>, _>>();
        let surfaces = Surface::of_frame_buffers(nodes.len(), video.width(), video.height());
        let context = Context::default();
        Ok(Box::new(NtscDisplay { video, boards: boards?, nodes: nodes.to_vec(), surfaces, context }))
    }

    fn boxed(&self) -> Box<dyn DisplayConfig> {
        Box::new(*self)
    }

    fn remember(&mut self, periods: u64) {
        self.fields_kept = periods;
    }
}
