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

/// Whether a list overwrites its whole context, so that nothing sent before can be seen any more.
pub(crate) fn begins_with_clear(runs: &[CommandRun]) -> bool {
    let kinds = runs.iter().map(|run| CommandKind::from_opcode(run.opcode));
    kinds
        .take_while(|kind| matches!(kind, Some(CommandKind::SelectRegion | CommandKind::Clear)))
        .any(|kind| kind == Some(CommandKind::Clear))
}
