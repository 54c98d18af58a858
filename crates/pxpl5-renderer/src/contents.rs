//! What a list of commands does to pixel memory, told by the kinds of its commands.

use crate::command::CommandKind;
use pxpl5_wire::CommandRun;

/// Region contexts that pixel memory can be divided into.
pub const MAX_CONTEXTS: usize = 8;

/// Whether a list changes pixels, and does not only select and copy.
pub(crate) fn changes_pixels(runs: &[CommandRun]) -> bool {
    let kinds = [CommandKind::SelectRegion, CommandKind::CopyRegion];
    runs.iter().any(|run| CommandKind::from_opcode(run.opcode).is_none_or(|kind| !kinds.contains(&kind)))
}

/// Words before the clear with which a list overwrites its whole context, so that nothing sent before can be seen once it has started;
/// `None` of a list that begins otherwise.
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
