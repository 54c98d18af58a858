//! The state of the machine as JSON and SVG, in the form that the page needs.

use crate::code;
use crate::diagram;
use crate::pictures;
use pxpl5_machine::Board;
use pxpl5_measure::{CriticalPath, Registration, Utilisation};
use pxpl5_run::{LATENCY_PARTS, PictureTimes, Stepper, WARM_UP_PICTURES};
use pxpl5_sim::Time;
use pxpl5_views::timeline::{self, TimelineOptions};
use serde_json::{Value, json};

pub(crate) fn state(stepper: &Stepper, is_over: bool) -> Value {
    let record = stepper.record();
    let surfaces = record
        .surfaces()
        .map(|(_, surface)| json!({"label": surface.label, "width": surface.width, "height": surface.height}));
    json!({
        "now_ps": stepper.now().0,
        "end_ps": stepper.end().0,
        "back_ps": back(stepper).map(|at| at.0),
        "field": stepper.period().0,
        "fields": stepper.experiment().fields,
        "line": stepper.beam_line(),
        "over": is_over,
        "failure": stepper.failure().map(ToString::to_string),
        "last": stepper.last().map(|last| format!("{}: {}", last.board, last.what)),
        "trace_hash": record.trace_hash().to_string(),
        "config_hash": stepper.experiment().config_hash().to_string(),
        "surfaces": surfaces.collect::<Vec<_>>(),
        "field_of_view_deg": stepper.experiment().hmd.config().horizontal_fov_deg,
        "memories": pictures::memories(stepper),
        "turn_deg_s": stepper.head().map(|head| head.head().motion().angular_velocity(stepper.now().0).length().to_degrees()),
    })
}

/// Returns the target of the page's step backwards, which lies one display period before the present instant. Both
/// instants have the same distance from the beginning of their periods. Within the first period, the target is time
/// zero. Returns `None` at time zero.
fn back(stepper: &Stepper) -> Option<Time> {
    let (now, period) = (stepper.now(), stepper.period());
    let tick = |period| stepper.record().tick(period);
    if now == Time::ZERO {
        return None;
    }
    let Some(before) = period.before(1) else { return Some(Time::ZERO) };
    Some(tick(before) + now.since(tick(period)))
}

pub(crate) fn misses_all(stepper: &Stepper) -> bool {
    let pictures = stepper.pictures();
    pictures.len() > WARM_UP_PICTURES && !pictures.iter().any(PictureTimes::is_shown)
}

/// Returns, as JSON, the share of time for which each kind of board was busy, the waits that delayed the last pictures,
/// and the load of the regions that were drawn lately. Shares are 0 to 1. `utilisation` is null at time zero, and `path`
/// is null before the first complete picture.
pub(crate) fn limits(stepper: &Stepper) -> Value {
    let path = CriticalPath::so_far(stepper);
    let path = path.map(|path| {
        let parts = path.parts.iter();
        let parts: Vec<Value> = parts
            .map(|part| json!({"what": part.resource.about(), "share": part.share, "ms": part.ms, "board": part.board}))
            .collect();
        json!({
            "pictures": path.pictures, "latency_ms": path.latency_ms, "limited_by": path.limited_by, "parts": parts,
            "chain": path.chain,
        })
    });
    json!({"utilisation": Utilisation::so_far(stepper), "path": path, "regions": diagram::loads(stepper)})
}

/// Returns the time for which each renderer has executed commands so far, and then the time of copies of each renderer,
/// in picoseconds.
pub(crate) fn busy(stepper: &Stepper) -> Vec<f64> {
    let (boards, now) = (stepper.record().renderers(), stepper.now());
    let spans = boards.iter().map(|board| board.busy_at(now)).chain(boards.iter().map(|board| board.copying_at(now)));
    spans.map(|span| span.0 as f64).collect()
}

pub(crate) fn misregistration(stepper: &Stepper) -> Value {
    let pictures = stepper.pictures();
    let found = Registration::so_far(stepper.results(&pictures))
        .and_then(|registration| registration.in_the_middle(stepper.now()));
    found.map_or(Value::Null, |error| json!({"pixels": error.pixels, "degrees": error.degrees}))
}

pub(crate) fn channels(stepper: &Stepper) -> Value {
    let ports = stepper.record().ports();
    let on = stepper.channels();
    let channel = |number| {
        let message = on.iter().find(|message| message.channel == number)?;
        let [from, to] = [message.source, message.destination].map(|node| ports.board(node).to_string());
        Some(json!({"from": from, "to": to, "words": message.words}))
    };
    let all = 0..stepper.record().config().ring.channels as usize;
    all.map(|number| channel(number).unwrap_or(Value::Null)).collect()
}

pub(crate) fn boards(stepper: &Stepper) -> Value {
    stepper.boards().filter_map(|board| Some(line(stepper, board, &stepper.description(board)?))).collect()
}

fn line(stepper: &Stepper, board: Board, says: &str) -> Value {
    let name = board.to_string();
    match board {
        // A renderer is busy while it executes commands, or while a region is being copied. It can do both at a time.
        Board::Renderer(number) => {
            let snapshot = stepper.renderer(number);
            let fifo = snapshot.and_then(|snapshot| snapshot.fifo_words).unwrap_or_default();
            let copies = snapshot.is_some_and(|snapshot| snapshot.copying.is_some());
            let executes = snapshot.is_some_and(|snapshot| snapshot.works());
            let stages = [executes.then_some("render"), copies.then_some("copy")];
            let stages: Vec<&str> = stages.into_iter().flatten().collect();
            let works = !stages.is_empty();
            let depth = snapshot.map_or(0, |snapshot| snapshot.fifo_depth_words);
            json!({"name": name, "kind": "renderer", "does": says, "works": works, "stages": stages, "fifo": fifo, "depth": depth})
        }
        Board::Display(_) | Board::Ring => json!({"name": name, "kind": "display", "does": says, "works": true}),
        Board::Host | Board::Gp(_) => {
            let snapshot = stepper.processor(board);
            let works =
                snapshot.is_some_and(|snapshot| snapshot.programs.iter().any(|program| program.work_left.is_some()));
            let stages: Vec<&str> = diagram::stage(stepper, board).into_iter().collect();
            json!({"name": name, "kind": "processor", "does": says, "works": works, "stages": stages})
        }
    }
}

/// Returns the state of one board as lines of text, one fact per line. Returns `None` if the machine does not have this
/// board.
pub(crate) fn board(stepper: &Stepper, board: Board) -> Option<Vec<String>> {
    if board == Board::Ring {
        return Some(vec![format!("occupied channels: {}", stepper.channels().len())]);
    }
    let mut lines = vec![stepper.description(board)?];
    lines.extend(stepper.details(board));
    if let Board::Renderer(number) = board {
        let snapshot = stepper.renderer(number)?;
        lines.push(format!("executing commands so far: {}", pxpl5_run::in_us(snapshot.busy)));
    }
    lines.extend(code::lines(stepper, board));
    Some(lines)
}

/// Returns the parts of one pixel's memory in a renderer, such as colour and depth, with one part per line. Returns
/// `None` for a pixel that does not exist, or before the renderer's first command.
pub(crate) fn pixel(stepper: &Stepper, renderer: usize, x: u32, y: u32) -> Option<Vec<String>> {
    let fields = stepper.pixel_fields(renderer, x, y)?.into_iter();
    let lines = fields.map(|field| {
        let last = field.first + field.width - 1;
        let digits = field.width.div_ceil(4) as usize;
        format!("bits {:>3} to {last:>3}  {:<18} {:0digits$x}", field.first, field.name, field.value)
    });
    Some(lines.collect())
}

pub(crate) fn timeline(stepper: &Stepper, fields: u64) -> String {
    let pictures = stepper.pictures();
    let newest = pictures.iter().rev().find(|times| times.is_shown() && times.shown_at <= stepper.now());
    let options = TimelineOptions {
        picture: newest.map(|times| times.picture),
        first_field: stepper.period().before(fields.saturating_sub(1)).or(Some(pxpl5_wire::PeriodNumber::FIRST)),
        fields: Some(fields),
        ..TimelineOptions::default()
    };
    timeline::drawing(&stepper.results(&pictures), &options)
}

/// Returns the parts of the latency of the last complete pictures in milliseconds, the newest picture last.
pub(crate) fn latencies(stepper: &Stepper, most: usize) -> Value {
    let parts = LATENCY_PARTS.iter();
    let pictures = stepper.last_latencies(most);
    let rows = pictures.iter().map(|latency| {
        let spans: Vec<f64> = latency.spans.iter().map(|span| span.as_ms()).collect();
        json!({"picture": latency.picture.0, "ms": spans, "total_ms": latency.end().since(latency.begin).as_ms()})
    });
    json!({
        "parts": parts.map(|part| json!({"name": part.name, "definition": part.definition})).collect::<Vec<_>>(),
        "pictures": rows.collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::Files;
    use crate::session::Session;

    /// Tests the error in the middle of the picture with a head that turns by 20 degrees a second: 100 ms of added latency
    /// are 2 degrees more, in every pipeline and at any instant. The picture is 100 ms older.
    #[test]
    fn added_latency_is_seen_as_the_angle_that_the_head_turns_meanwhile() {
        for pipeline in ["slats", "rendering-control", "jitp-scanline", "arp-full-line"] {
            let display = if pipeline.starts_with("arp") { "arp" } else { "ntsc" };
            let shown = |added_ms: u32| {
                let settings = format!(
                    "pipeline={pipeline}\ndisplay={display}\nscene=full-screen:2\nfields=60\nhead.motion=pan:20\n\
                     head.tracker=ideal\nhead.predict=none\nhead.added_latency={added_ms}\n"
                );
                let mut session = Session::new(&settings, &Files::default()).expect("known settings");
                session.run_to(700_000_000_000);
                let [error, age] = [misregistration(&session.stepper), diagram::age(&session.stepper)];
                [&error["degrees"], &age["age_ms"]]
                    .map(|number| number.as_f64().unwrap_or_else(|| panic!("{pipeline}")))
            };
            let [[angle, age], [more, older]] = [0, 100].map(shown);
            assert!((more - angle - 2.0).abs() < 0.02, "{pipeline}: {angle} and {more} degrees");
            assert!((older - age - 100.0).abs() < 1e-3, "{pipeline}: {age} and {older} ms");
        }
    }
}
