//! Texts that describe the state of boards, for the debugger and the live page.

use crate::stepper::Stepper;
use pxpl5_gp::{GpSnapshot, Priority, ProgramSnapshot};
use pxpl5_machine::Board;
use pxpl5_renderer::{FieldRange, PixelArray, Plane};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::REGION_SIZE;
use std::fmt::Write as _;

impl Stepper {
    /// Returns the boards whose state can be described: host, graphics processors, renderers and displays.
    pub fn boards(&self) -> impl Iterator<Item = Board> + use<> {
        let record = self.record();
        let [gps, renderers, displays] = [record.ports().gps.len(), record.renderers().len(), record.displays().len()];
        let processors = [Board::Host].into_iter().chain((0..gps).map(Board::Gp));
        processors.chain((0..renderers).map(Board::Renderer)).chain((0..displays).map(Board::Display))
    }

    /// Returns one line of text about what a board does now. Returns `None` for the ring, and for a board that the
    /// machine does not have.
    pub fn description(&self, board: Board) -> Option<String> {
        match board {
            Board::Host | Board::Gp(_) => Some(processor_line(&self.processor(board)?)),
            Board::Renderer(number) => self.renderer_line(number),
            Board::Display(number) => self.display_line(number),
            Board::Ring => None,
        }
    }

    /// Returns lines of text about a processor: its messages, memory, busy time and code. Returns no lines for boards
    /// of other kinds.
    pub fn details(&self, board: Board) -> Vec<String> {
        let Some(snapshot) = self.processor(board) else { return Vec::new() };
        let ports = self.record().ports();
        // Messages that have arrived, that are being sent, and that wait.
        let mut lines: Vec<String> = Vec::new();
        lines.extend(
            snapshot
                .inbox
                .iter()
                .map(|mail| format!("inbox   from {}, arrived {}", ports.board(mail.source), in_ms(mail.arrived))),
        );
        lines.extend(
            snapshot.unaccepted.iter().map(|node| format!("sent    to {}, not accepted yet", ports.board(*node))),
        );
        let chains = snapshot.chains.iter().enumerate();
        lines.extend(chains.map(|(place, messages)| format!("queued  chain {place}: messages {messages}")));
        // Memory use and busy time, then the loaded program.
        let memory = snapshot.memory.iter().filter(|(_, bytes)| *bytes > 0);
        lines.extend(memory.map(|(account, bytes)| format!("memory  {account}: {bytes} bytes")));
        lines.push(format!("busy    {} of {}", in_us(snapshot.busy), in_us(self.now().since(Time::ZERO))));
        let gp = self.machine().board(board);
        let program = gp.and_then(|gp| gp.with_processor(|processor| processor.program().cloned())).flatten();
        lines.extend(program.map(|code| format!("code    {} bytes at {:#010x}", code.bytes.len(), code.base)));
        lines
    }

    /// Returns the line that the beam of the first display draws now. Returns `None` before the first line of a period.
    pub fn beam_line(&self) -> Option<u32> {
        let display = self.record().display();
        let lines = display.surfaces().first()?.height;
        let lit = |line: &u32| display.lights(0, 0, *line, self.period()).is_some_and(|at| at <= self.now());
        (0..lines).rev().find(lit)
    }

    /// Returns the memory of one pixel of a renderer, divided into bit fields, after all commands that have started.
    ///
    /// Returns `None` under the same conditions as [`Stepper::array`], and for `x` or `y` outside the array.
    pub fn pixel_fields(&self, renderer: usize, x: u32, y: u32) -> Option<Vec<PixelField>> {
        if x >= REGION_SIZE || y >= REGION_SIZE {
            return None;
        }
        let array = self.array(renderer)?;
        let layout = self.experiment().pipeline().properties().layout;
        let ranges = layout.ranges().into_iter();
        let fields = ranges.map(|FieldRange { name, first, width }| {
            let bits = (0..width).map(|n| u128::from(bit_of(&array.plane((first + n) as usize), x, y)) << n);
            PixelField { name, first, width, value: bits.take(128).sum() }
        });
        Some(fields.collect())
    }

    fn renderer_line(&self, number: usize) -> Option<String> {
        let snapshot = self.renderer(number)?;
        // The level of the FIFO comes first, then activities of the renderer.
        let mut text = format!("fifo {}/{}", snapshot.fifo_words.unwrap_or_default(), snapshot.fifo_depth_words);
        if let Some(order) = snapshot.copying {
            let display = self.record().ports().board(order.target.frame_buffer);
            let (region, picture) = (order.target.region.0, order.target.picture);
            let _ = write!(text, "; sends region {region} of picture {picture} to {display}");
        }
        if snapshot.stands_at_copy {
            text.push_str("; commands wait for a copy");
        }
        if snapshot.stored_regions > 0 {
            let _ = write!(text, "; {} in the backing store", snapshot.stored_regions);
        }
        Some(text)
    }

    fn display_line(&self, number: usize) -> Option<String> {
        let display = self.record().displays().get(number)?;
        let counters: Vec<String> =
            display.counters().iter().map(|counter| format!("{} {}", counter.name, counter.count)).collect();
        let (faults, _) = display.faults();
        let faults = if faults > 0 { format!("; {faults} faults") } else { String::new() };
        Some(format!("{}: {}{faults}", display.name(), counters.join(", ")))
    }
}

/// A group of successive bits in a pixel's memory, with its value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PixelField {
    /// Name of the bits in the layout of pixel memory.
    pub name: String,
    /// Index of the first bit, from 0 to 207.
    pub first: u32,
    /// Number of bits.
    pub width: u32,
    /// Value of the bits. The first bit is the least significant bit.
    pub value: u128,
}

/// Returns the bit of the pixel in column `x` and row `y` of a renderer's array. `plane` holds one bit of every pixel.
pub const fn bit_of(plane: &Plane, x: u32, y: u32) -> bool {
    plane[(2 * y + x / 64) as usize] >> (x % 64) & 1 == 1
}

fn processor_line(snapshot: &GpSnapshot) -> String {
    let mut parts: Vec<String> = snapshot.programs.iter().map(program).collect();
    if parts.is_empty() {
        return "no program".to_owned();
    }
    if !snapshot.inbox.is_empty() {
        parts.push(format!("inbox {}", snapshot.inbox.len()));
    }
    let sending = snapshot.unaccepted.len() + snapshot.chains.iter().sum::<usize>();
    if sending > 0 {
        parts.push(format!("sends {sending}"));
    }
    parts.join("; ")
}

fn program(program: &ProgramSnapshot) -> String {
    let level = if program.priority == Priority::Interrupt { "interrupt " } else { "" };
    match program.work_left {
        Some(left) => format!("{level}works, {} left", in_us(left)),
        None if program.waits_for.is_empty() => format!("{level}has not begun"),
        None => format!("{level}waits for {}", program.waits_for),
    }
}

/// Formats an instant in milliseconds, to the nanosecond: `16.683333 ms`.
pub fn in_ms(at: Time) -> String {
    format!("{}.{:06} ms", at.0 / 1_000_000_000, at.0 % 1_000_000_000 / 1_000)
}

/// Formats a span in microseconds, to the nanosecond: `21.700 us`.
pub fn in_us(span: Span) -> String {
    format!("{}.{:03} us", span.0 / 1_000_000, span.0 % 1_000_000 / 1_000)
}
