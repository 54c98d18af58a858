//! Regions of a strip or of a batch of blocks: their windows and their commands.

use crate::config::Config;
use crate::drawing::{Drawing, Window};
use pphigs::Counts;
use pxpl5_geometry::Viewport;
use pxpl5_renderer::{Clear, Command, CommandKind, CopyRegion, Layout, SelectRegion};
use pxpl5_wire::{CommandList, CommandRun, CommandWords, CopyOrder, CopyTarget, MAX_MESSAGE_WORDS, RegionId, Word};
use std::ops::Range;
use std::sync::Arc;

/// The pixels of a region.
pub(crate) fn window(config: &Config, viewport: &Viewport, region: RegionId) -> Window {
    let [left, top, width, height] = config.grid().rectangle(region).map(|v| v as i32);
    let line = |row: i32| viewport.first_line() as i32 + row * viewport.line_step() as i32;
    Window { across: [left, left + width - 1], lines: [line(top), line(top + height - 1)] }
}

/// What one message holds of a region.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Part {
    first: bool,
    triangles: Range<u32>,
    spheres: Range<u32>,
    last: bool,
}

const OPENING: u32 = CommandKind::SelectRegion.words() + CommandKind::Clear.words();
const CLOSING: u32 = CommandKind::CopyRegion.words();

/// Triangles, then spheres, in as few messages as their length allows.
fn parts(counts: Counts) -> Vec<Part> {
    let (mut parts, mut triangle, mut sphere) = (Vec::new(), 0, 0);
    loop {
        let first = parts.is_empty();
        let mut room = MAX_MESSAGE_WORDS - CLOSING - if first { OPENING } else { 0 };
        let mut take = |from: u32, of: u32, words: u32| {
            let n = (of - from).min(room / words);
            room -= n * words;
            from..from + n
        };
        let triangles = take(triangle, counts.triangles, CommandKind::Triangle.words());
        let spheres = take(sphere, counts.spheres, CommandKind::Sphere.words());
        (triangle, sphere) = (triangles.end, spheres.end);
        let last = (triangle, sphere) == (counts.triangles, counts.spheres);
        parts.push(Part { first, triangles, spheres, last });
        if last {
            return parts;
        }
    }
}

impl Part {
    fn runs(&self) -> Vec<CommandRun> {
        let all = [
            (CommandKind::SelectRegion, u32::from(self.first)),
            (CommandKind::Clear, u32::from(self.first)),
            (CommandKind::Triangle, self.triangles.len() as u32),
            (CommandKind::Sphere, self.spheres.len() as u32),
            (CommandKind::CopyRegion, u32::from(self.last)),
        ];
        let run =
            |(kind, count): (CommandKind, u32)| CommandRun { opcode: kind.opcode(), words_each: kind.words(), count };
        all.into_iter().filter(|(_, count)| *count > 0).map(run).collect()
    }
}

/// The messages that draw a region and copy it to the frame buffer.
pub(crate) fn messages(
    config: &Config,
    drawing: &Arc<Drawing>,
    window: Window,
    counts: Counts,
    target: CopyTarget,
) -> Vec<CommandList> {
    let list = |part: Part| {
        let runs = part.runs();
        let copies = if part.last {
            vec![CopyOrder { target, context: 0, through_backing: false, acknowledge: None }]
        } else {
            Vec::new()
        };
        let [left, top, _, _] = config.grid().rectangle(target.region).map(|v| v as u16);
        let origin = SelectRegion { context: 0, left, top };
        let words = PieceWords { drawing: Arc::clone(drawing), layout: config.layout, window, origin, target, part };
        let content = config.pixels.then(|| Arc::new(words) as Arc<dyn CommandWords>);
        CommandList { runs, context: 0, copies, content }
    };
    parts(counts).into_iter().map(list).collect()
}

/// Makes the words of one message.
#[derive(Debug)]
struct PieceWords {
    drawing: Arc<Drawing>,
    layout: Layout,
    window: Window,
    origin: SelectRegion,
    target: CopyTarget,
    part: Part,
}

impl CommandWords for PieceWords {
    fn append_words(&self, out: &mut Vec<Word>) {
        // A layout that lacks what a command needs is refused when the machine is configured.
        let mut put = |command: Command| {
            let encoded = command.encode(&self.layout, out);
            debug_assert!(encoded.is_ok(), "{encoded:?}");
        };
        if self.part.first {
            put(Command::SelectRegion(self.origin));
            let [r, g, b] = self.drawing.background().map(u32::from);
            put(Command::Clear(Clear { colour: r << 16 | g << 8 | b }));
        }
        let mut chosen = |range: &Range<u32>, number: &mut u32, command| {
            if range.contains(number) {
                put(command);
            }
            *number += 1;
        };
        let (mut triangle, mut sphere) = (0, 0);
        if !self.part.triangles.is_empty() {
            self.drawing.triangle_commands(&self.window, |c| chosen(&self.part.triangles, &mut triangle, c));
        }
        if !self.part.spheres.is_empty() {
            self.drawing.sphere_commands(&self.window, |c| chosen(&self.part.spheres, &mut sphere, c));
        }
        if self.part.last {
            put(Command::CopyRegion(CopyRegion { target: self.target }));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_hold_every_primitive_once_and_none_is_too_long() {
        for (triangles, spheres) in [(0, 0), (1, 0), (33, 0), (34, 0), (500, 77), (0, 40)] {
            let parts = parts(Counts { triangles, spheres });
            let sum = |range: fn(&Part) -> &Range<u32>| parts.iter().map(|p| range(p).len() as u32).sum::<u32>();
            assert_eq!((sum(|p| &p.triangles), sum(|p| &p.spheres)), (triangles, spheres));
            assert!(parts[0].first && parts[1..].iter().all(|p| !p.first));
            assert_eq!(parts.iter().filter(|p| p.last).count(), 1);
            for part in &parts {
                let words: u32 = part.runs().iter().map(|run| run.count * run.words_each).sum();
                assert!(words <= MAX_MESSAGE_WORDS, "{words}");
            }
        }
    }
}
