//! Text views of the state of a run, for the screen of the debugger and for debugger scripts.

use super::words::address;
use i860::Program;
use pxpl5::run::{in_ms as ms, in_us as us};
use pxpl5::snapshots::GpBoard;
use pxpl5::{Board, Stepper};
use std::fmt::Write as _;
use std::sync::Arc;

/// Returns one line with the current time, the display field, and the last event if there is one.
pub(super) fn place(stepper: &Stepper) -> String {
    let last = stepper.last().map_or_else(String::new, |last| format!(", {}: {}", last.board, last.what));
    format!("{}, field {}{last}\n", ms(stepper.now()), stepper.period())
}

/// Returns the time, the line that the display's beam scans, the next event, and the hash of the trace so far.
pub(super) fn time(stepper: &Stepper) -> String {
    let mut text = String::new();
    let fields = stepper.experiment().fields;
    let beam = stepper.beam_line().map_or_else(String::new, |line| format!(", beam in line {line}"));
    let _ = writeln!(text, "now     {}, field {} of {fields}{}", ms(stepper.now()), stepper.period(), beam);
    // Lines for a failure, the last event and the next event appear only if they exist.
    if let Some(error) = stepper.failure() {
        let _ = writeln!(text, "failed  {error}");
    }
    if let Some(last) = stepper.last() {
        let _ = writeln!(text, "last    {}: {}", last.board, last.what);
    }
    if let Some(next) = stepper.machine().next_event_description() {
        let _ = writeln!(text, "next    {} {}: {}", ms(next.time), next.board, next.what);
    }
    let _ = writeln!(text, "events  {}", stepper.machine().events());
    let _ = writeln!(text, "trace   {}", stepper.record().trace_hash());
    text
}

pub(super) fn boards(stepper: &Stepper) -> String {
    let lines = stepper.boards().filter_map(|board| Some((board.to_string(), stepper.description(board)?)));
    lines.map(|(name, says)| format!("{name:<12} {says}\n")).collect()
}

pub(super) fn board(stepper: &Stepper, board: Board) -> Result<String, String> {
    check(stepper, board)?;
    let Some(says) = stepper.description(board) else { return Ok(ring(stepper)) };
    let details: String = stepper.details(board).iter().map(|line| format!("{line}\n")).collect();
    Ok(format!("{board}  {says}\n{details}"))
}

/// Returns one line for each blocked board, with the board or event that it waits for.
pub(super) fn waits(stepper: &Stepper) -> String {
    let blocked = stepper.machine().blocked();
    blocked.iter().map(|wait| format!("{:<12} waits for {}\n", wait.board.to_string(), wait.waits_for)).collect()
}

/// Returns one line for each channel of the ring, and one line for each message that waits for a channel.
pub(super) fn ring(stepper: &Stepper) -> String {
    let ports = stepper.record().ports();
    let on = stepper.channels();
    let mut text = String::new();
    // One line for each channel: the message on the channel, or "-" if the channel is free.
    for channel in 0..stepper.record().config().ring.channels as usize {
        let Some(message) = on.iter().find(|message| message.channel == channel) else {
            let _ = writeln!(text, "{channel}  -");
            continue;
        };
        let since = us(stepper.now().since(message.granted));
        let end = message.ends_at.map_or_else(
            || "until the receiver has room".to_owned(),
            |end| format!("{} to go", us(end.since(stepper.now()))),
        );
        let [from, to] = [message.source, message.destination].map(|node| ports.board(node));
        let _ = writeln!(text, "{channel}  {from} -> {to}, {} words, since {since}, {end}", message.words);
    }
    // Messages that have no channel yet, with the reason.
    for message in stepper.record().ring().waiting() {
        let waits_for = message.waits_for(|node| ports.board(node));
        let _ = writeln!(text, "   {} waits for {waits_for}", ports.board(message.source));
    }
    text
}

const STAGES: usize = 12;

/// Returns the most recent stages of pictures, newest first. Stages with a start in the future are left out.
pub(super) fn timeline(stepper: &Stepper) -> String {
    let record = stepper.record();
    let mut stages = record.stages();
    // Leave out stages in the future, then show the most recent stages.
    stages.retain(|stage| stage.begin <= stepper.now());
    stages.sort_by_key(|stage| stage.begin);
    let first = stages.len().saturating_sub(STAGES);
    let mut text = String::new();
    for stage in stages[first..].iter().rev() {
        let surface = stage.surface.and_then(|id| record.surface(id)).map_or("", |surface| surface.label);
        let end = stage.end.map_or_else(|| "goes on".to_owned(), ms);
        let name = format!("{:?}", stage.stage).to_uppercase();
        let _ = writeln!(
            text,
            "picture {:<4} {name:<10} {surface:<6} {} to {end}",
            stage.picture.to_string(),
            ms(stage.begin)
        );
    }
    text
}

/// Returns an error if the machine does not have the board. The error states the range of boards of the machine.
pub(super) fn check(stepper: &Stepper, board: Board) -> Result<(), String> {
    let record = stepper.record();
    let (what, number, count) = match board {
        Board::Host | Board::Ring => return Ok(()),
        Board::Gp(number) => ("GP", number, record.ports().gps.len()),
        Board::Renderer(number) => ("renderer", number, record.renderers().len()),
        Board::Display(number) => ("display", number, record.displays().len()),
    };
    if number < count {
        return Ok(());
    }
    Err(format!("expected {what} 0 to {}, found {board}", count - 1))
}

/// Returns a processor board that executes i860 code. Fails for a run without `--level cycle`, because its boards
/// execute no code.
pub(super) fn with_code(stepper: &Stepper, board: Board) -> Result<&GpBoard, String> {
    check(stepper, board)?;
    let found = stepper.machine().board(board).filter(|gp| gp.with_processor(|_| ()).is_some());
    found.ok_or_else(|| format!("expected a graphics processor that runs code (--level cycle), found {board}"))
}

fn program_of(board: &GpBoard) -> Option<Arc<Program>> {
    board.with_processor(|processor| processor.program().cloned()).flatten()
}

/// Returns the programs in a board's memory, the most recently executed first.
fn programs_of(board: &GpBoard) -> Vec<Arc<Program>> {
    board.with_processor(|processor| processor.programs().cloned().collect()).unwrap_or_default()
}

/// Returns the base address of the code that a board executed last. Fails if the board has executed no code yet.
pub(super) fn base_of_code(stepper: &Stepper, board: Board) -> Result<u32, String> {
    let program = program_of(with_code(stepper, board)?);
    program.map(|program| program.base).ok_or_else(|| format!("{board} has run no code yet"))
}

/// Returns the address that `text` denotes, as a number or a label. The function searches for a label in the i860 code
/// of `board`, or of all graphics processors if `board` is `None`. An error lists the known labels.
pub(super) fn place_in_code(stepper: &Stepper, board: Option<Board>, text: &str) -> Result<u32, String> {
    let all = (0..stepper.record().ports().gps.len()).map(Board::Gp);
    let boards = board.map_or_else(|| all.collect(), |board| vec![board]);
    let with_code: Vec<&GpBoard> = boards.iter().filter_map(|board| with_code(stepper, *board).ok()).collect();
    if with_code.is_empty() {
        return Err("expected a machine whose processors run code: --level cycle".to_owned());
    }
    // Instructions are aligned to 4 bytes.
    if let Some(at) = address(text).map(|at| at & !3) {
        return Ok(at);
    }
    // Any other text must be a label of loaded code.
    let programs: Vec<Arc<Program>> = with_code.iter().flat_map(|board| programs_of(board)).collect();
    let found = programs.iter().find_map(|program| program.symbol(text));
    found.ok_or_else(|| {
        let own = with_code.first().map_or_else(Vec::new, |board| programs_of(board));
        let names: Vec<String> = own.iter().flat_map(|program| program.labels.clone()).map(|(name, _)| name).collect();
        let names = if names.is_empty() { "no code has run yet".to_owned() } else { names.join(", ") };
        format!("expected an address such as 0x1000 or a label ({names}), found `{text}`")
    })
}

pub(super) fn labels(board: &GpBoard, at: u32) -> Vec<String> {
    let programs = programs_of(board);
    let labels = programs.iter().flat_map(|program| program.labels.clone());
    labels.filter(|(_, place)| *place == at).map(|(name, _)| name).collect()
}

/// Returns `count` words of a board's memory from address `at` on. Fails if a word lies outside the memory.
pub(super) fn words(board: &GpBoard, at: u32, count: u64) -> Result<Vec<u32>, String> {
    let read = board.with_processor(|processor| processor.read(at, count as usize));
    read.ok_or("no processor")?.map_err(|error| error.to_string())
}
