//! The regions of a strip or of a batch of blocks, and the messages that draw these regions.

use crate::config::JitpConfig;
use crate::drawing::{DrawnList, Window};
use pphigs::PrimitiveCounts;
use pxpl5_geometry::Viewport;
use pxpl5_renderer::{Clear, Command, CommandKind, CopyRegion, Layout, SelectRegion};
use pxpl5_wire::{
    CommandContent, CommandList, CommandRun, CommandSink, CommandWords, CopyContent, CopyOrder, CopyPath, CopyTarget,
    MAX_MESSAGE_WORDS, RegionId, RegionPlace, Word,
};
use std::ops::Range;
use std::sync::{Arc, OnceLock};

pub(crate) fn window(config: &JitpConfig, viewport: &Viewport, region: RegionId) -> Window {
    let [left, top, width, height] = config.grid().rectangle(region).map(|v| v as i32);
    Window {
        across: [left, left + width - 1],
        lines: [line_of_row(viewport, top), line_of_row(viewport, top + height - 1)],
    }
}

/// Returns the line of the video frame for a row of the picture. The rows of a field are every second line.
fn line_of_row(viewport: &Viewport, row: i32) -> i32 {
    viewport.first_line() as i32 + row * viewport.line_step() as i32
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Part {
    first: bool,
    triangles: Range<u32>,
    spheres: Range<u32>,
    last: bool,
}

const OPENING: u32 = CommandKind::SelectRegion.words() + CommandKind::Clear.words();
const CLOSING: u32 = CommandKind::CopyRegion.words();

/// Divides a region's primitives into messages, triangles first. Each message has room for the copy command, because it
/// may be the last message.
fn parts(counts: PrimitiveCounts) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut triangle = 0;
    let mut sphere = 0;
    loop {
        let first = parts.is_empty();
        // Every message keeps room for the copy command, because it can be the last message.
        let mut room_words = MAX_MESSAGE_WORDS - CLOSING - if first { OPENING } else { 0 };
        let triangles = take_run(triangle..counts.triangles, CommandKind::Triangle.words(), &mut room_words);
        let spheres = take_run(sphere..counts.spheres, CommandKind::Sphere.words(), &mut room_words);
        triangle = triangles.end;
        sphere = spheres.end;
        let last = triangle == counts.triangles && sphere == counts.spheres;
        parts.push(Part { first, triangles, spheres, last });
        if last {
            return parts;
        }
    }
}

/// Takes the first primitives of `remaining`: as many commands of `words_each` words as fit into `room_words`.
/// Subtracts their words from `room_words`.
fn take_run(remaining: Range<u32>, words_each: u32, room_words: &mut u32) -> Range<u32> {
    let n = (remaining.end - remaining.start).min(*room_words / words_each);
    *room_words -= n * words_each;
    remaining.start..remaining.start + n
}

impl Part {
    fn draws(&self) -> bool {
        !self.triangles.is_empty() || !self.spheres.is_empty()
    }

    fn runs(&self) -> Vec<CommandRun> {
        let all = [
            (CommandKind::SelectRegion, u32::from(self.first)),
            (CommandKind::Clear, u32::from(self.first)),
            (CommandKind::Triangle, self.triangles.len() as u32),
            (CommandKind::Sphere, self.spheres.len() as u32),
            (CommandKind::CopyRegion, u32::from(self.last)),
        ];
        let present = all.into_iter().filter(|(_, count)| *count > 0);
        present.map(|(kind, count)| CommandRun { opcode: kind.opcode(), words_each: kind.words(), count }).collect()
    }
}

pub(crate) fn messages(
    config: &JitpConfig,
    drawing: &Arc<DrawnList>,
    window: Window,
    counts: PrimitiveCounts,
    target: CopyTarget,
) -> Vec<CommandList> {
    let [left, top, _, _] = config.grid().rectangle(target.region).map(|v| v as u16);
    let parts = parts(counts);
    let words = || RegionWords {
        drawing: Arc::clone(drawing),
        layout: config.layout,
        window,
        origin: SelectRegion { context: 0, left, top },
        target,
        parts: parts.clone(),
        primitives: OnceLock::new(),
    };
    // Without pixels, the messages need no words.
    let words = config.pixels.then(|| Arc::new(words()) as Arc<dyn CommandWords>);
    let lists = (0..).zip(&parts).map(|(number, part)| {
        let runs = part.runs();
        let copies = if part.last {
            vec![CopyOrder {
                target,
                context: 0,
                way: CopyPath::FromPixelMemory,
                acknowledge: None,
                content: CopyContent::Colour,
            }]
        } else {
            Vec::new()
        };
        let content = words.as_ref().map(|words| CommandContent::new(Arc::clone(words), number));
        CommandList { runs, context: 0, copies, content }
    });
    lists.collect()
}

/// The words of a region's messages, which are computed only when a message is read.
#[derive(Debug)]
struct RegionWords {
    drawing: Arc<DrawnList>,
    layout: Layout,
    window: Window,
    origin: SelectRegion,
    target: CopyTarget,
    parts: Vec<Part>,
    primitives: OnceLock<[Vec<Word>; 2]>,
}

impl RegionWords {
    fn primitives(&self) -> &[Vec<Word>; 2] {
        self.primitives.get_or_init(|| {
            let [mut triangles, mut spheres] = [const { Vec::new() }; 2];
            self.drawing.triangle_commands(&self.window, |command| self.append(command, &mut triangles));
            self.drawing.sphere_commands(&self.window, |command| self.append(command, &mut spheres));
            [triangles, spheres]
        })
    }

    /// Appends the words of a command. Encoding cannot fail, because the machine's configuration refuses a layout of
    /// pixel memory that lacks a bit field of the commands.
    fn append(&self, command: Command, out: &mut Vec<Word>) {
        let encoded = command.encode(&self.layout, out);
        debug_assert!(encoded.is_ok(), "{encoded:?}");
    }
}

impl CommandWords for RegionWords {
    fn append_words(&self, part: u32, out: &mut Vec<Word>) {
        let Some(part) = self.parts.get(part as usize) else { return };
        if part.first {
            self.append(Command::SelectRegion(self.origin), out);
            let [r, g, b] = self.drawing.background().map(u32::from);
            self.append(Command::Clear(Clear { colour: r << 16 | g << 8 | b }), out);
        }
        if part.draws() {
            let [triangles, spheres] = self.primitives();
            out.extend_from_slice(words_of(triangles, &part.triangles, CommandKind::Triangle));
            out.extend_from_slice(words_of(spheres, &part.spheres, CommandKind::Sphere));
        }
        if part.last {
            self.append(Command::CopyRegion(CopyRegion { target: self.target }), out);
        }
    }

    fn append_visible(&self, part: u32, out: &mut dyn CommandSink) -> bool {
        self.append_words(part, out.words());
        self.parts.get(part as usize).is_some_and(Part::draws)
    }

    fn place(&self) -> Option<RegionPlace> {
        let CopyTarget { frame_buffer, lines, grid, region, .. } = self.target;
        Some(RegionPlace { frame_buffer: Some(frame_buffer), lines, grid, region })
    }
}

/// Returns the words of the commands with the indices `numbers`. `all` has the words of all commands of one kind.
fn words_of<'a>(all: &'a [Word], numbers: &Range<u32>, kind: CommandKind) -> &'a [Word] {
    let [begin, end] = [numbers.start, numbers.end].map(|number| (number * kind.words()) as usize);
    debug_assert!(end <= all.len(), "as many commands as were counted");
    all.get(begin..end).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_wire::FieldParity;

    #[test]
    fn a_field_has_every_second_line_of_its_frame() {
        for parity in [FieldParity::Even, FieldParity::Odd] {
            let viewport = Viewport::field(parity);
            let lines = [0, 1, 239].map(|row| line_of_row(&viewport, row));
            let first = parity.first_line() as i32;
            assert_eq!(lines, [first, first + 2, first + 478]);
        }
        assert_eq!([0, 1, 479].map(|row| line_of_row(&Viewport::FRAME, row)), [0, 1, 479]);
    }

    #[test]
    fn all_messages_but_the_last_are_full() {
        let of = CommandKind::Triangle.words();
        let parts = parts(PrimitiveCounts { triangles: 500, spheres: 77 });
        for part in parts.iter().filter(|part| !part.last) {
            let words: u32 = part.runs().iter().map(|run| run.count * run.words_each).sum();
            assert!(words + CLOSING + of.max(CommandKind::Sphere.words()) > MAX_MESSAGE_WORDS, "{words}");
        }
        assert!(parts.iter().all(Part::draws));
        assert!(!Part { first: true, triangles: 0..0, spheres: 0..0, last: true }.draws());
        assert!(Part { first: true, triangles: 0..0, spheres: 0..1, last: true }.draws());
    }

    #[test]
    fn commands_cut_out_of_a_list_have_exactly_their_own_words() {
        let of = CommandKind::Sphere.words();
        let all: Vec<Word> = (0..5 * of).collect();
        let expected: Vec<Word> = (2 * of..4 * of).collect();
        assert_eq!(words_of(&all, &(2..4), CommandKind::Sphere), expected);
    }

    #[test]
    fn messages_have_each_primitive_once_and_no_message_is_too_long() {
        for (triangles, spheres) in [(0, 0), (1, 0), (33, 0), (34, 0), (500, 77), (0, 40)] {
            let parts = parts(PrimitiveCounts { triangles, spheres });
            assert_eq!(parts.iter().map(|p| p.triangles.len()).sum::<usize>(), triangles as usize);
            assert_eq!(parts.iter().map(|p| p.spheres.len()).sum::<usize>(), spheres as usize);
            assert!(parts[0].first && parts[1..].iter().all(|p| !p.first));
            assert_eq!(parts.iter().filter(|p| p.last).count(), 1);
            for part in &parts {
                let words: u32 = part.runs().iter().map(|run| run.count * run.words_each).sum();
                assert!(words <= MAX_MESSAGE_WORDS, "{words}");
            }
        }
    }
}
