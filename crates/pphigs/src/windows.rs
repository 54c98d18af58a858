//! CPU work of a search for the primitives in *windows*, which are rectangles of the screen such as strips and blocks.
//!
//! [`Pass::keep`] stores the commands of TRANSFORM with their bounding boxes, without bins. [`WindowSearchWork`] finds
//! the primitives in each window, and lists the messages that draw the window. The code is kernels/windows.s. No paper
//! describes the code; kernels/windows_rules.md states its rules. In the timing table, each primitive that is found in
//! a window takes `bin_entry_ns`.

use crate::begin::PassStartWork;
use crate::bin_handoff::{
    BUDGET, BUDGET_OF_ENTRY, MAX_ENTRIES, MESSAGE_BYTES, MessagePieces, PIECE_BYTES, listed, token_source,
};
use crate::code::{Next, budget, sphere_kernel};
use crate::cost::TransformCost;
use crate::layout::{
    ENTRY_BYTES, ENVELOPES, KEPT, KEPT_BYTES, LISTS, MAX_KEPT, MAX_WINDOWS, PIECES, REGION_WINDOWS, STACK,
    TOKEN_PARAMETERS, WINDOW_LISTS, WINDOW_PLACES, WINDOWS, WINDOWS_CODE,
};
use crate::list::{PrimitiveCounts, Share};
use crate::pass::Pass;
use i860::Program;
use pxpl5_geometry::Viewport;
use pxpl5_geometry::kernel::Kernel;
use pxpl5_gp::{GpTiming, Processor, ProcessorFault, Work};
use pxpl5_renderer::CommandKind;
use pxpl5_sim::Span;
use pxpl5_wire::{MAX_MESSAGE_WORDS, RegionGrid, RegionId, Word};
use std::ops::Range;
use std::sync::{Arc, LazyLock};

const BOX_BYTES: u32 = 16;
const LINE: u32 = 32;

/// Number of words of the commands before a window's primitives.
const OPENING: u32 = CommandKind::SelectRegion.words() + CommandKind::Clear.words();
const CLOSING: u32 = CommandKind::CopyRegion.words();

/// One of several equal parts of a board's memory after the display list, for the result of TRANSFORM.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemoryPart {
    number: u8,
    of: u8,
}

impl MemoryPart {
    /// The only part: the memory after the display list is not divided.
    pub const WHOLE: Self = Self { number: 0, of: 1 };

    /// Returns part `number` (modulo `of`) of `of` equal parts. `of` is limited to 1 to 16.
    pub const fn of(number: usize, of: u8) -> Self {
        let of = if of == 0 { 1 } else { of };
        let of = if of as u32 > MAX_KEPT { MAX_KEPT as u8 } else { of };
        Self { number: (number % of as usize) as u8, of }
    }

    fn place(self, processor: &Processor, share: &Share) -> Range<u32> {
        let begin = share.end_of_list().next_multiple_of(LINE);
        let bytes = entries(processor).saturating_sub(begin) / u32::from(self.of) / LINE * LINE;
        let begin = begin + u32::from(self.number) * bytes;
        begin..begin + bytes
    }

    /// Returns the start address of the part, or an error if the part has fewer than `needed_bytes` bytes.
    pub(crate) fn checked(
        self,
        processor: &Processor,
        share: &Share,
        needed_bytes: u32,
    ) -> Result<u32, ProcessorFault> {
        let place = self.place(processor, share);
        let available_bytes = place.end - place.start;
        if needed_bytes > available_bytes {
            let gp = processor.node();
            return Err(ProcessorFault::NoRoom { gp, context: self.number, needed_bytes, available_bytes });
        }
        Ok(place.start)
    }

    const fn note(self) -> u32 {
        KEPT + self.number as u32 * KEPT_BYTES
    }
}

fn entries(processor: &Processor) -> u32 {
    processor.memory_bytes().saturating_sub(ENTRY_BYTES)
}

/// Successive commands of one kind: address and number of the commands, and address of their bounding boxes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct KeptCommands {
    first: u32,
    count: u32,
    boxes: u32,
}

/// The commands of triangles and of spheres in a part of memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Kept([KeptCommands; 2]);

impl Kept {
    fn note(&self, processor: &mut Processor, part: MemoryPart) -> Result<(), ProcessorFault> {
        let words = self.0.map(|KeptCommands { first, count, boxes }| [first, count, boxes]);
        processor.write(part.note(), words.as_flattened())
    }

    /// Reads which commands are stored in a part of memory, or returns `None` if the part is empty.
    fn noted(processor: &Processor, part: MemoryPart) -> Result<Option<Self>, ProcessorFault> {
        let words = processor.read(part.note(), 6)?;
        let mut kinds = words.as_chunks::<3>().0.iter().map(|[first, count, boxes]| KeptCommands {
            first: *first,
            count: *count,
            boxes: *boxes,
        });
        let kept = Self([kinds.next().unwrap_or_default(), kinds.next().unwrap_or_default()]);
        Ok(Some(kept).filter(|kept| kept.0[0].first > 0))
    }
}

impl Pass {
    /// Executes TRANSFORM without bins, and stores the command and the bounding box of every primitive in a part of
    /// memory.
    ///
    /// Returns `None` if no kernel can draw this kind of picture.
    ///
    /// # Errors
    ///
    /// Returns [`ProcessorFault`] if the i860 code of TRANSFORM does not end, or if its data do not fit.
    pub fn keep(
        &self,
        timing: &GpTiming,
        processor: &mut Processor,
        part: MemoryPart,
    ) -> Result<Option<Span>, ProcessorFault> {
        let kernel = self.kernel(processor.version()).filter(|kernel| !kernel.binned);
        let Some(kernel) = kernel.map(|kernel| Kernel { keeps_boxes: true, ..kernel }) else { return Ok(None) };
        let beginning = self.beginning_without_bins().by_code(timing, processor)?;
        let of_kernels = self.keep_commands(processor, kernel, part, |processor, first| {
            self.run_triangles(processor, kernel, first, None)
        })?;
        Ok(Some(beginning + of_kernels))
    }

    pub(crate) fn beginning_without_bins(&self) -> PassStartWork {
        PassStartWork::new(self.share().list(), vec![self.placed()], *self.picture()).without_bins()
    }

    /// Stores the output of `triangles` in a part of memory, followed by the commands of all spheres.
    pub(crate) fn keep_commands(
        &self,
        processor: &mut Processor,
        kernel: Kernel,
        part: MemoryPart,
        triangles: impl FnOnce(&mut Processor, Next) -> Result<(Span, Next), ProcessorFault>,
    ) -> Result<Span, ProcessorFault> {
        let first = self.room(processor, kernel, part)?;
        let (of_triangles, next) = triangles(processor, first)?;
        let (of_spheres, end) = self.run_spheres(processor, sphere_kernel(kernel), next, None)?;
        // The number of boxes follows from the two addresses of boxes. It equals the number of commands.
        let commands = |from: Next, to: Next| KeptCommands {
            first: from.command,
            count: (to.table - from.table) / BOX_BYTES,
            boxes: from.table,
        };
        Kept([commands(first, next), commands(next, end)]).note(processor, part)?;
        Ok(of_triangles + of_spheres)
    }

    /// Returns the addresses for bounding boxes (`table`) and commands (`command`).
    fn room(&self, processor: &Processor, kernel: Kernel, part: MemoryPart) -> Result<Next, ProcessorFault> {
        let given = self.transformed();
        let triangles = self.most_commands(given);
        let boxes = BOX_BYTES * (triangles + given.spheres);
        let sphere_bytes = 4 * sphere_kernel(kernel).command_words() as u32;
        let commands = kernel.command_bytes() * triangles + sphere_bytes * given.spheres;
        let begin = part.checked(processor, self.share(), boxes.next_multiple_of(LINE) + commands)?;
        Ok(Next { command: begin + boxes.next_multiple_of(LINE), table: begin })
    }
}

/// Work of a search for the primitives in windows, which are rectangles of the screen.
#[derive(Clone, Copy, Debug)]
pub struct WindowSearchWork<'a> {
    /// Part of memory with the stored commands and bounding boxes.
    pub part: MemoryPart,
    pub viewport: Viewport,
    pub grid: RegionGrid,
    /// Windows to search, by index in the grid.
    pub windows: &'a [RegionId],
    /// Numbers of primitives in each window.
    pub counts: &'a [PrimitiveCounts],
}

impl Work for WindowSearchWork<'_> {
    fn by_table(&self, timing: &GpTiming) -> Span {
        TransformCost { entries: u64::from(self.entries()), ..TransformCost::default() }.span(timing)
    }

    fn by_code(&self, timing: &GpTiming, processor: &mut Processor) -> Result<Span, ProcessorFault> {
        Ok(self.run_code(processor)?.map_or_else(|| self.by_table(timing), |listed| listed.span))
    }
}

/// Time of a search, and the number of messages for each window.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SearchOutput {
    pub span: Span,
    /// Simulated time to list the messages, which is included in `span`.
    pub handoff_span: Span,
    /// Number of messages of each window.
    pub messages: Vec<u32>,
}

impl SearchOutput {
    /// Returns the messages that the search has listed, in the order of the windows.
    ///
    /// # Errors
    ///
    /// Returns [`ProcessorFault::Unmapped`] on a board that has not run the code.
    pub fn listed(&self, processor: &Processor) -> Result<Vec<MessagePieces>, ProcessorFault> {
        listed(processor, self.messages.iter().sum())
    }
}

impl WindowSearchWork<'_> {
    fn entries(&self) -> u32 {
        self.counts.iter().map(|counts| counts.total()).sum()
    }

    /// Executes the i860 code of the search. The board's memory must already contain the commands that [`Pass::keep`]
    /// stores. Returns `None` if there are no stored commands.
    ///
    /// # Errors
    ///
    /// Returns [`ProcessorFault`] if the code does not end, or has no room for the result.
    pub fn run_code(&self, processor: &mut Processor) -> Result<Option<SearchOutput>, ProcessorFault> {
        let Some(kept) = Kept::noted(processor, self.part)? else { return Ok(None) };
        self.check_room(processor)?;
        let mut output = SearchOutput { span: Span::ZERO, handoff_span: Span::ZERO, messages: Vec::new() };
        // In a window across regions, the search can find primitives that touch none of the window's regions. The
        // search therefore also tests the regions.
        if self.lies_across_regions() {
            output.span +=
                make_windows(processor, self.viewport.grid(), &self.viewport, &self.all_regions(), REGION_WINDOWS)?;
        }
        let mut next = [PIECES, LISTS];
        let chunks = MAX_WINDOWS as usize;
        for (windows, counts) in self.windows.chunks(chunks).zip(self.counts.chunks(chunks)) {
            output.span += make_windows(processor, self.grid, &self.viewport, windows, WINDOWS)?;
            output.span += self.search(processor, &kept, counts)?;
            for window in 0..windows.len() {
                let span = hand_over(processor, window as u32, &mut next, counts.get(window))?;
                output.handoff_span += span;
                output.span += span;
                output.messages.push(processor.register(16));
            }
        }
        Ok(Some(output))
    }

    /// Checks that the found primitives and the messages fit into the memory that is reserved for a region's messages.
    fn check_room(&self, processor: &Processor) -> Result<(), ProcessorFault> {
        let entries = self.entries() + 2 * self.windows.len() as u32;
        let fits =
            entries <= MAX_ENTRIES && (entries / 20 + 2 * self.windows.len() as u32) * MESSAGE_BYTES <= PIECES - LISTS;
        if fits {
            return Ok(());
        }
        Err(ProcessorFault::NoRoom {
            gp: processor.node(),
            context: self.part.number,
            needed_bytes: entries * PIECE_BYTES,
            available_bytes: MAX_ENTRIES * PIECE_BYTES,
        })
    }

    /// Returns true if a window can contain pixels of several regions of the picture.
    fn lies_across_regions(&self) -> bool {
        let regions = self.viewport.grid();
        !regions.region_width.is_multiple_of(self.grid.region_width)
            || !regions.region_height.is_multiple_of(self.grid.region_height)
    }

    fn all_regions(&self) -> Vec<RegionId> {
        (0..self.viewport.grid().regions() as u16).map(RegionId).collect()
    }

    /// Searches the bounding boxes of all stored primitives. The number of primitives in each window is known, so the
    /// lists of the windows follow each other without gaps.
    fn search(
        &self,
        processor: &mut Processor,
        Kept([triangles, spheres]): &Kept,
        counts: &[PrimitiveCounts],
    ) -> Result<Span, ProcessorFault> {
        // Reserve a list for each window, with the known number of entries.
        let mut place = entries(processor);
        let mut lists = vec![spheres.first];
        for counts in counts {
            lists.extend([place; 2]);
            place += 4 * counts.total();
        }
        processor.write(WINDOW_LISTS, &lists)?;
        let windows = counts.len() as u32;
        let (regions, n_regions) = match self.lies_across_regions() {
            true => (REGION_WINDOWS, self.viewport.grid().regions()),
            false => (0, 0),
        };
        let of_lines = line_registers(&self.viewport, 24);
        let mut span = Span::ZERO;
        // One call searches all triangles, and one call searches all spheres.
        for (entry, KeptCommands { first, count, boxes }) in [("triangles", *triangles), ("spheres", *spheres)] {
            if count == 0 {
                continue;
            }
            let data = [(2, STACK), (16, first), (17, count), (18, boxes)];
            let tables = [(19, WINDOWS), (20, windows), (21, WINDOW_LISTS), (22, regions), (23, n_regions)];
            let registers = [data.as_slice(), &tables, &of_lines].concat();
            span += processor.call(&PROGRAM, entry, &registers, budget(count * (windows + n_regions)))?;
        }
        Ok(span)
    }
}

/// Returns the values of two registers, from number `first` on: the frame line of row 0, and the distance between rows
/// in lines, minus one.
fn line_registers(viewport: &Viewport, first: usize) -> [(usize, Word); 2] {
    [(first, viewport.first_line()), (first + 1, viewport.line_step() - 1)]
}

/// Executes the code that computes the first and last columns and rows of the windows. Windows are cut off at the edges
/// of the picture.
fn make_windows(
    processor: &mut Processor,
    grid: RegionGrid,
    viewport: &Viewport,
    windows: &[RegionId],
    to: u32,
) -> Result<Span, ProcessorFault> {
    let pair = |columns: u32, rows: u32| rows << 16 | columns;
    let places = windows.iter().map(|window| {
        let [left, top, _, _] = grid.rectangle(*window);
        pair(left, top)
    });
    // The code computes the limits of each window from its upper left pixel and the common size.
    processor.write(WINDOW_PLACES, &places.collect::<Vec<_>>())?;
    let picture = viewport.grid();
    let data = [(16, WINDOW_PLACES), (17, windows.len() as u32), (18, to)];
    let sizes = [(19, pair(grid.region_width, grid.region_height)), (20, pair(picture.width, picture.height))];
    let registers = [data.as_slice(), &sizes, &line_registers(viewport, 21)].concat();
    processor.call(&PROGRAM, "windows", &registers, BUDGET + BUDGET_OF_ENTRY * windows.len() as u64)
}

/// Executes the code that lists the messages of one window. In memory, the list follows the lists of earlier windows.
fn hand_over(
    processor: &mut Processor,
    window: u32,
    [pieces, lists]: &mut [u32; 2],
    counts: Option<&PrimitiveCounts>,
) -> Result<Span, ProcessorFault> {
    let words = [CommandKind::Triangle, CommandKind::Sphere].map(CommandKind::words);
    let enclosing = [ENVELOPES, OPENING, ENVELOPES + 0x40, 0, ENVELOPES + 0x80, CLOSING, 0];
    processor.write(TOKEN_PARAMETERS, &[words.as_slice(), &enclosing].concat())?;
    let data = [(16, window), (17, WINDOW_LISTS), (18, *pieces), (19, *lists), (20, TOKEN_PARAMETERS)];
    let entries = u64::from(counts.copied().unwrap_or_default().total());
    let span = processor.call(&PROGRAM, "token", &data, BUDGET + BUDGET_OF_ENTRY * entries)?;
    [*pieces, *lists] = [18, 19].map(|number| processor.register(number));
    Ok(span)
}

#[cfg(test)]
pub(crate) fn program() -> Arc<Program> {
    Arc::clone(&PROGRAM)
}

/// The i860 code that finds the primitives in windows and lists the messages. Every message has room for the copy
/// command, as in the messages that the simulator makes without code.
static PROGRAM: LazyLock<Arc<Program>> = LazyLock::new(|| {
    let token = token_source([MAX_MESSAGE_WORDS - CLOSING, MAX_MESSAGE_WORDS]);
    let sources = [("windows", include_str!("../kernels/windows.s")), ("token", token.as_str())];
    match i860::link(WINDOWS_CODE, &sources) {
        Ok(program) => Arc::new(program),
        Err(errors) => unreachable!("it is assembled by the tests: {errors}"),
    }
});
