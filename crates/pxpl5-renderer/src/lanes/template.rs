//! Templates with which the fast array recognizes commands in a list of words.

use crate::command::{Command, CommandKind, PHONG_WORDS, TRIANGLE_WORDS};
use crate::isa::{head, opcode};
use crate::layout::Layout;
use pxpl5_wire::Word;

/// A template that recognizes a kind of command with `N` words. Each operand occupies a whole word, which the template
/// ignores.
#[derive(Clone, Debug)]
pub(super) struct Template<const N: usize> {
    words: [Word; N],
    /// Comparison mask for each word: zero for a word with an operand, and all ones for other words.
    fixed: [Word; N],
    pub(super) cost: CommandCost,
}

impl<const N: usize> Template<N> {
    /// Creates the template of a command. Returns `None` if the layout does not support the command.
    fn for_command(kind: CommandKind, layout: &Layout) -> Option<Self> {
        let program = Command::blank(kind).program(layout).ok()?;
        let mut words = Vec::new();
        let mut fixed = [0; N];
        for instruction in &program {
            *fixed.get_mut(words.len())? = Word::MAX;
            instruction.encode(&mut words);
        }
        Some(Self { words: words.try_into().ok()?, fixed, cost: CommandCost::for_command(kind, layout)? })
    }

    /// Splits `words` into the command at the start and the rest. Returns `None` if the first words do not match the
    /// template.
    #[inline(always)]
    pub(super) fn split<'a>(&self, words: &'a [Word]) -> Option<(&'a [Word; N], &'a [Word])> {
        words.split_first_chunk::<N>().filter(|(command, _)| self.fits(command))
    }

    #[inline(always)]
    pub(super) fn fits(&self, command: &[Word; N]) -> bool {
        let mut different = 0;
        for ((found, word), fixed) in command.iter().zip(&self.words).zip(&self.fixed) {
            different |= (found ^ word) & fixed;
        }
        different == 0
    }
}

#[derive(Clone, Debug)]
pub(super) struct Templates {
    pub(super) clear: Option<Template<CLEAR_WORDS>>,
    pub(super) triangle: Option<Template<TRIANGLE_WORDS>>,
    pub(super) phong_triangle: Option<Template<PHONG_WORDS>>,
    large: Vec<(CommandKind, CommandCost)>,
}

const CLEAR_WORDS: usize = CommandKind::Clear.words() as usize;

/// Numbers of instructions and clocks of one command, which the array adds to [`crate::Executed`].
#[derive(Clone, Copy, Debug)]
pub(super) struct CommandCost {
    pub(super) instructions: u32,
    pub(super) clocks: u64,
}

impl CommandCost {
    fn for_command(kind: CommandKind, layout: &Layout) -> Option<Self> {
        let program = Command::blank(kind).program(layout).ok()?;
        let clocks = program.iter().map(|i| u64::from(i.clocks())).sum();
        Some(Self { instructions: program.len() as u32, clocks })
    }
}

impl Templates {
    pub(super) fn new(layout: &Layout) -> Self {
        Self {
            clear: Template::for_command(CommandKind::Clear, layout),
            triangle: Template::for_command(CommandKind::Triangle, layout),
            phong_triangle: Template::for_command(CommandKind::PhongTriangle, layout),
            large: [CommandKind::Sphere, CommandKind::PhongSphere, CommandKind::Shade]
                .into_iter()
                .filter_map(|kind| Some((kind, CommandCost::for_command(kind, layout)?)))
                .collect(),
        }
    }

    pub(super) fn cost(&self, kind: CommandKind) -> Option<CommandCost> {
        self.large.iter().find(|(k, _)| *k == kind).map(|(_, cost)| *cost)
    }
}

/// Returns true if the next instruction is *enable all*. In this case, no instruction reads the current Enable
/// register.
pub(super) fn next_enables_all(next: Option<&Word>) -> bool {
    const LABEL: Word = 0xff << 16;
    next.is_some_and(|word| word & !LABEL == head(opcode::ENABLE_ALL, 0, 0))
}
