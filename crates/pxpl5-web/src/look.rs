//! What the page shows of the machine, as JSON.

use pxpl5_gp::{GpLook, Priority};
use pxpl5_machine::Board;
use pxpl5_run::Stepper;
use serde_json::{Value, json};

/// Everything that is shown at once, but pictures.
pub(crate) fn state(stepper: &Stepper, is_over: bool) -> Value {
    let record = stepper.record();
    let surfaces = record
        .surfaces()
        .map(|(_, surface)| json!({"label": surface.label, "width": surface.width, "height": surface.height}));
    json!({
        "now_ps": stepper.now().0,
        "end_ps": stepper.end().0,
        "field": stepper.period().0,
        "fields": stepper.experiment().length(),
        "line": line(stepper),
        "over": is_over,
        "failure": stepper.failure().map(ToString::to_string),
        "last": stepper.last().map(|last| format!("{}: {}", last.board, last.what)),
        "trace_hash": record.trace_hash().to_string(),
        "config_hash": stepper.experiment().config_hash().to_string(),
        "channels": channels(stepper),
        "boards": boards(stepper),
        "surfaces": surfaces.collect::<Vec<_>>(),
    })
}

/// The last line of the first display that has begun to light in its period.
fn line(stepper: &Stepper) -> Option<u32> {
    let display = stepper.record().display();
    let lines = display.surfaces().first()?.height;
    (0..lines).rev().find(|line| display.lights(0, 0, *line, stepper.period()).is_some_and(|at| at <= stepper.now()))
}

/// A message or nothing for each channel of the ring.
fn channels(stepper: &Stepper) -> Vec<Value> {
    let ports = stepper.record().ports();
    let on = stepper.channels();
    let channel = |number| {
        let message = on.iter().find(|message| message.channel == number)?;
        let [from, to] = [message.source, message.destination].map(|node| ports.board(node).to_string());
        Some(json!({"from": from, "to": to, "words": message.words}))
    };
    (0..stepper.record().config().ring.channels as usize).map(|number| channel(number).unwrap_or(Value::Null)).collect()
}

/// A line for each board.
fn boards(stepper: &Stepper) -> Vec<Value> {
    let record = stepper.record();
    let gps = (0..record.ports().gps.len()).map(Board::Gp);
    let processors = [Board::Host].into_iter().chain(gps).filter_map(|board| {
        let look = stepper.processor(board)?;
        let works = look.programs.iter().any(|program| program.work_left.is_some());
        Some(json!({"name": board.to_string(), "kind": "processor", "works": works, "does": does(&look), "inbox": look.inbox.len()}))
    });
    let renderers = (0..record.renderers().len()).filter_map(|number| {
        let look = stepper.renderer(number)?;
        let fifo = look.fifo_words.unwrap_or_default();
        let sends = look.copying.map(|order| order.target.region.0);
        Some(json!({
            "name": Board::Renderer(number).to_string(), "kind": "renderer", "fifo": fifo, "depth": look.fifo_depth_words,
            "sends_region": sends, "works": fifo > 0 || sends.is_some(), "does": renderer_does(fifo, sends, look.stands_at_copy),
        }))
    });
    processors.chain(renderers).collect()
}

/// What the programs of a processor do, in words.
fn does(look: &GpLook) -> String {
    let program = |program: &pxpl5_gp::ProgramLook| {
        let level = if program.priority == Priority::Interrupt { "interrupt " } else { "" };
        match program.work_left {
            Some(left) => format!("{level}works, {:.1} us left", left.0 as f64 / 1e6),
            None if program.waits_for.is_empty() => format!("{level}has not begun"),
            None => format!("{level}waits for {}", program.waits_for),
        }
    };
    let programs: Vec<String> = look.programs.iter().map(program).collect();
    if programs.is_empty() { "has no program".to_owned() } else { programs.join("; ") }
}

fn renderer_does(fifo: u32, sends: Option<u16>, stands_at_copy: bool) -> String {
    let copy = sends.map_or_else(String::new, |region| format!("; sends region {region}"));
    let stands = if stands_at_copy { "; commands wait for the copy" } else { "" };
    format!("{fifo} words wait{copy}{stands}")
}

/// Everything of one board, line by line; `None` where the machine has no such board.
pub(crate) fn board(stepper: &Stepper, board: Board) -> Option<Vec<String>> {
    match board {
        Board::Host | Board::Gp(_) => {
            let look = stepper.processor(board)?;
            let mut lines = vec![does(&look)];
            lines.extend(processor(stepper, board, &look));
            Some(lines)
        }
        Board::Renderer(number) => {
            let look = stepper.renderer(number)?;
            let fifo = look.fifo_words.unwrap_or_default();
            let sends = look.copying.map(|order| order.target.region.0);
            Some(vec![
                renderer_does(fifo, sends, look.stands_at_copy),
                format!("input FIFO: {fifo} of {} words", look.fifo_depth_words),
                format!("regions in the backing store: {}", look.stored_regions),
                format!("executing commands so far: {:.3} ms", look.busy.as_ms()),
            ])
        }
        Board::Display(number) => {
            let display = stepper.record().displays().get(number)?;
            Some(display.counters().iter().map(|counter| format!("{}: {}", counter.name, counter.count)).collect())
        }
        Board::Ring => Some(vec![format!("occupied channels: {}", stepper.channels().len())]),
    }
}

fn processor(stepper: &Stepper, board: Board, look: &GpLook) -> Vec<String> {
    let ports = stepper.record().ports();
    let mail = look.inbox.iter().map(|mail| format!("message from {} waits", ports.board(mail.source)));
    let sent = look.unaccepted.iter().map(|node| format!("message to {} not accepted yet", ports.board(*node)));
    let memory =
        look.memory.iter().filter(|(_, bytes)| *bytes > 0).map(|(account, bytes)| format!("{account}: {bytes} bytes"));
    let busy = format!("CPU busy so far: {:.3} ms", look.busy.as_ms());
    let mut lines: Vec<String> = mail.chain(sent).chain(memory).chain([busy]).collect();
    let state = stepper.machine().board(board).and_then(|gp| gp.with_processor(|i860| i860.state().clone()));
    if let Some(state) = state {
        lines.push(format!("i860 after its last call: pc {:#010x}, psr {:#010x}", state.pc, state.psr));
        let rows = state.r.chunks(8).enumerate();
        lines.extend(rows.map(|(row, eight)| {
            let words: Vec<String> = eight.iter().map(|word| format!("{word:08x}")).collect();
            format!("r{:<2} {}", 8 * row, words.join(" "))
        }));
    }
    lines
}
