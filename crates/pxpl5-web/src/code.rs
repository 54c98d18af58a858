//! Text with the state of an i860 processor on one board. The text has the registers, and the instructions around the
//! address at which the processor stopped.

use i860::disassemble;
use pxpl5_gp::Processor;
use pxpl5_machine::Board;
use pxpl5_run::Stepper;

const BEFORE: u32 = 8;
const AFTER: u32 = 8;

/// Returns lines of text with the registers and the code of a board's processor. The list is empty for a board without
/// a processor, and at any level of detail except the cycle level.
pub(crate) fn lines(stepper: &Stepper, board: Board) -> Vec<String> {
    stepper.machine().board(board).and_then(|gp| gp.with_processor(of)).unwrap_or_default()
}

fn of(processor: &Processor) -> Vec<String> {
    let state = processor.state();
    let mut lines = vec![format!("i860 after its last call: pc {:#010x}, psr {:#010x}", state.pc, state.psr)];
    // Four rows show eight registers each.
    let rows = state.r.chunks(8).enumerate();
    lines.extend(rows.map(|(row, eight)| {
        let words: Vec<String> = eight.iter().map(|word| format!("{word:08x}")).collect();
        format!("r{:<2} {}", 8 * row, words.join(" "))
    }));
    let Some(program) = processor.program() else { return lines };
    // A call ends at its return address, which lies outside the code. In this case, the beginning of the code is shown.
    let end = program.base + program.bytes.len() as u32;
    let at = if (program.base..end).contains(&state.pc) { state.pc & !3 } else { program.base };
    // Show the instructions around this address with their labels, and mark the address.
    let begin = at.saturating_sub(4 * BEFORE).max(program.base);
    for address in (begin..end.min(at + 4 * AFTER)).step_by(4) {
        let Ok(words) = processor.read(address, 1) else { break };
        let labels = program.labels.iter().filter(|(_, place)| *place == address);
        lines.extend(labels.map(|(name, _)| format!("{name}:")));
        let mark = if address == at { '>' } else { ' ' };
        lines.push(format!("{mark} {address:#010x}  {:08x}  {}", words[0], disassemble(words[0], address)));
    }
    lines
}
