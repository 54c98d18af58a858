//! Effects of a command list on pixel memory that follow from the kinds of the commands alone, without the operands.

use crate::command::CommandKind;
use pxpl5_wire::CommandRun;

/// Largest number of region contexts (parts of pixel memory that each hold one region).
pub const MAX_CONTEXTS: usize = 8;

/// Returns true if a command list can change pixels. Only lists of select and copy commands change no pixels.
pub(crate) fn changes_pixels(runs: &[CommandRun]) -> bool {
    let kinds = [CommandKind::SelectRegion, CommandKind::CopyRegion];
    runs.iter().any(|run| CommandKind::from_opcode(run.opcode).is_none_or(|kind| !kinds.contains(&kind)))
}

/// Returns the number of words before the clear command of a list that clears its region context before it draws.
/// Returns `None` for other lists.
///
/// The clear command erases all earlier drawing in this part of pixel memory.
pub(crate) fn words_before_clear(runs: &[CommandRun]) -> Option<u64> {
    let mut words = 0;
    for run in runs {
        match CommandKind::from_opcode(run.opcode) {
            Some(CommandKind::Clear) => return Some(words),
            Some(CommandKind::SelectRegion) => words += u64::from(run.count) * u64::from(run.words_each),
            _ => return None,
        }
    }
    None
}

/// Returns the number of words before the first copy command of a list, or `None` if the list copies no region.
pub(crate) fn words_before_copy(runs: &[CommandRun]) -> Option<u64> {
    let is_copy = |run: &CommandRun| CommandKind::from_opcode(run.opcode) == Some(CommandKind::CopyRegion);
    let before = runs.iter().take(runs.iter().position(is_copy)?);
    Some(before.map(|run| u64::from(run.count) * u64::from(run.words_each)).sum())
}
