//! Parser of the debugger's command lines.

use super::condition::Condition;
use super::words::{board, number, time};
use pxpl5::{Board, PeriodNumber, Time};

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Command {
    /// An empty line or a comment.
    Nothing,
    RunToEnd,
    RunTo(Time),
    RunToField(PeriodNumber),
    RunUntil(Condition),
    /// Runs until the next event of a board.
    Next(Board),
    Step(u64, StepOf),
    Show(Pane),
    ShowBoard(Board),
    /// Sets a breakpoint at a label or address. Without a label or address, the command lists all breakpoints.
    Break(Option<String>),
    Delete(String),
    Registers(Board),
    Disassemble(Board, Option<String>, u64),
    Memory(Board, String, u64),
    /// Shows the bits of a pixel. The three numbers are the renderer, the column and the row.
    Pixel(u64, u64, u64),
    /// Shows a map of the enabled pixels of a renderer.
    Enabled(u64),
    /// Shows or saves the picture that the display's beam has drawn on a surface. The texts are the surface's label and
    /// the name of a file, if any.
    Seen(String, Option<String>),
    /// Shows or saves the ideal picture of a surface. The texts are the surface's label and the name of a file, if any.
    Ideal(String, Option<String>),
    Help,
    Quit,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StepOf {
    Event,
    Line,
    Field,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pane {
    Time,
    Boards,
    Waits,
    Ring,
    Timeline,
}

impl Pane {
    pub(super) const ALL: [(&'static str, Self); 5] = [
        ("time", Self::Time),
        ("boards", Self::Boards),
        ("waits", Self::Waits),
        ("ring", Self::Ring),
        ("timeline", Self::Timeline),
    ];
}

/// Syntax and explanation of each command. A test compares this list with the table in the guide.
pub(super) const HELP: [(&str, &str); 19] = [
    ("run", "run to the end, or until code reaches a breakpoint"),
    ("run to TIME", "run to a time: 12.5ms, 300us, 40ns, or +1ms from now"),
    ("run to field N", "run to the retrace at which field N begins"),
    (
        "run until CONDITION",
        "run until: swap; region; picture N; fifo R >= N; inbox GP >= N; channels >= N; waits BOARD for WORDS",
    ),
    ("next BOARD", "run to the next event of host, gp N, renderer N, display N or ring"),
    ("step [N] [event|line|field]", "run one or N events; lines and fields are those of the first display"),
    ("show time|boards|waits|ring|timeline", "show one part of the machine"),
    ("show BOARD", "show the state of one board"),
    (
        "break [PLACE]",
        "stop when an i860 reaches a label or address (--level cycle); without a place: list breakpoints",
    ),
    ("delete PLACE", "remove a breakpoint"),
    ("registers BOARD", "registers of an i860 after the last call, or at the last breakpoint"),
    ("disassemble BOARD [PLACE [N]]", "show N instructions of the code of a board"),
    ("memory BOARD PLACE [N]", "show N words of the memory of a board"),
    ("pixel R X Y", "show the fields of a pixel's memory in renderer R, and if the pixel is enabled"),
    ("enabled R", "show a map of the enabled pixels of renderer R"),
    ("seen SURFACE [FILE.png]", "show or save the picture so far of the left or right eye"),
    ("ideal SURFACE [FILE.png]", "show or save the ideal picture of this surface now"),
    ("help", "show this list"),
    ("quit", "leave the debugger"),
];

/// Splits a text into commands at line ends and semicolons. The result has no comments and no empty commands.
pub(super) fn split(text: &str) -> Vec<String> {
    let commands = text.lines().flat_map(|line| line.split('#').next().unwrap_or_default().split(';'));
    commands.map(|command| command.trim().to_owned()).filter(|command| !command.is_empty()).collect()
}

/// Parses a command. A time with a leading `+` is counted from `now`. An error states the expected syntax and the text
/// found.
pub(super) fn parse(text: &str, now: Time) -> Result<Command, String> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let Some((name, rest)) = words.split_first() else { return Ok(Command::Nothing) };
    // Forms with fixed words come before forms that parse the remaining words.
    match (*name, rest) {
        ("run", []) => Ok(Command::RunToEnd),
        ("run", ["to", "field", field]) => Ok(Command::RunToField(PeriodNumber(number("run to field", field)?))),
        ("run", ["to", at]) => Ok(Command::RunTo(time(at, now)?)),
        ("run", ["until", condition @ ..]) => Condition::parse(condition).map(Command::RunUntil),
        ("next", words) => whole(board(words)?).map(Command::Next),
        ("step", words) => step(words),
        ("show", [pane]) if pane_of(pane).is_some() => Ok(pane_of(pane).map_or(Command::Nothing, Command::Show)),
        ("show", words) => show(words),
        ("break", []) => Ok(Command::Break(None)),
        ("break", [place]) => Ok(Command::Break(Some((*place).to_owned()))),
        ("delete", [place]) => Ok(Command::Delete((*place).to_owned())),
        ("registers", words) => whole(board(words)?).map(Command::Registers),
        ("disassemble", words) => disassemble(words),
        ("memory", words) => memory(words),
        ("pixel", [renderer, x, y]) => {
            Ok(Command::Pixel(number("renderer", renderer)?, number("column", x)?, number("row", y)?))
        }
        ("enabled", [renderer]) => Ok(Command::Enabled(number("renderer", renderer)?)),
        ("seen", [surface]) => Ok(Command::Seen((*surface).to_owned(), None)),
        ("seen", [surface, file]) => Ok(Command::Seen((*surface).to_owned(), Some((*file).to_owned()))),
        ("ideal", [surface]) => Ok(Command::Ideal((*surface).to_owned(), None)),
        ("ideal", [surface, file]) => Ok(Command::Ideal((*surface).to_owned(), Some((*file).to_owned()))),
        ("help", _) => Ok(Command::Help),
        ("quit", []) => Ok(Command::Quit),
        (name, _) => Err(unknown(name, text)),
    }
}

/// Returns the error message for a line that is not a command. The message shows the syntax of the command `name`, or
/// all command names if `name` is unknown.
fn unknown(name: &str, text: &str) -> String {
    let forms: Vec<&str> =
        HELP.iter().map(|(form, _)| *form).filter(|form| form.split(' ').next() == Some(name)).collect();
    // An unknown name gets the list of all commands.
    if forms.is_empty() {
        let mut names: Vec<&str> = HELP.iter().filter_map(|(form, _)| form.split(' ').next()).collect();
        names.dedup();
        return format!("expected a command ({}), found `{text}`", names.join(", "));
    }
    format!("expected {}, found `{text}`", forms.join(" or "))
}

/// Returns the board if no words follow its name. Otherwise returns an error.
fn whole((board, rest): (Board, &[&str])) -> Result<Board, String> {
    match rest {
        [] => Ok(board),
        rest => Err(format!("expected nothing after {board}, found `{}`", rest.join(" "))),
    }
}

fn pane_of(name: &str) -> Option<Pane> {
    // The pane shows all that a board named "ring" could show, so "show ring" names the pane.
    Pane::ALL.iter().find(|(candidate, _)| *candidate == name).map(|(_, pane)| *pane)
}

fn show(words: &[&str]) -> Result<Command, String> {
    let found = board(words).and_then(whole);
    let names = Pane::ALL.map(|(name, _)| name).join(", ");
    found.map(Command::ShowBoard).map_err(|error| format!("show: expected {names} or a board; {error}"))
}

fn step(words: &[&str]) -> Result<Command, String> {
    let (count, kind) = match words {
        [] => (1, "event"),
        [one] if one.starts_with(|c: char| c.is_ascii_digit()) => (number("step", one)?, "event"),
        [kind] => (1, *kind),
        [count, kind] => (number("step", count)?, *kind),
        _ => return Err(format!("step: expected [N] [event|line|field], found `{}`", words.join(" "))),
    };
    // Plural forms are accepted: `step 2 lines`.
    let kind = match kind.trim_end_matches('s') {
        "event" => StepOf::Event,
        "line" => StepOf::Line,
        "field" => StepOf::Field,
        _ => return Err(format!("step: expected event, line or field, found `{kind}`")),
    };
    Ok(Command::Step(count, kind))
}

/// Default number of instructions or memory words that a command shows.
const SHOWN: u64 = 16;
/// Maximum number of instructions or memory words that a command shows.
const MOST: u64 = 4_096;

fn count(words: &[&str]) -> Result<u64, String> {
    match words {
        [] => Ok(SHOWN),
        [text] => {
            let found = number("count", text)?;
            let refused = || format!("count: expected 1 to {MOST}, found {found}");
            Some(found).filter(|found| (1..=MOST).contains(found)).ok_or_else(refused)
        }
        more => Err(format!("expected one number, found `{}`", more.join(" "))),
    }
}

fn disassemble(words: &[&str]) -> Result<Command, String> {
    let (board, rest) = board(words)?;
    let place = rest.first().map(|place| (*place).to_owned());
    Ok(Command::Disassemble(board, place, count(rest.get(1..).unwrap_or_default())?))
}

fn memory(words: &[&str]) -> Result<Command, String> {
    let (board, rest) = board(words)?;
    let [place, rest @ ..] = rest else {
        return Err("memory: expected BOARD PLACE [N], found no place".to_owned());
    };
    Ok(Command::Memory(board, (*place).to_owned(), count(rest)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_divided_by_semicolons_and_lines_and_comments_are_dropped() {
        assert_eq!(split("run ; step 3\n# nothing\n show ring # now\n"), ["run", "step 3", "show ring"]);
    }

    #[test]
    fn every_debugger_command_in_the_help_is_parsed() {
        let examples = [
            ("run", Command::RunToEnd),
            ("run to +1us", Command::RunTo(Time(1_000_007))),
            ("run to field 4", Command::RunToField(PeriodNumber(4))),
            ("next renderer 3", Command::Next(Board::Renderer(3))),
            ("step", Command::Step(1, StepOf::Event)),
            ("step 20", Command::Step(20, StepOf::Event)),
            ("step 2 lines", Command::Step(2, StepOf::Line)),
            ("step field", Command::Step(1, StepOf::Field)),
            ("show ring", Command::Show(Pane::Ring)),
            ("show gp 0", Command::ShowBoard(Board::Gp(0))),
            ("break start", Command::Break(Some("start".to_owned()))),
            ("registers gp1", Command::Registers(Board::Gp(1))),
            ("disassemble gp 0 0x1000 4", Command::Disassemble(Board::Gp(0), Some("0x1000".to_owned()), 4)),
            ("memory host 0x40", Command::Memory(Board::Host, "0x40".to_owned(), SHOWN)),
            ("pixel 1 2 3", Command::Pixel(1, 2, 3)),
            ("seen left", Command::Seen("left".to_owned(), None)),
            ("quit", Command::Quit),
        ];
        for (text, expected) in examples {
            assert_eq!(parse(text, Time(7)), Ok(expected), "{text}");
        }
    }

    #[test]
    fn an_unknown_command_is_refused_with_expected_and_found() {
        for (text, words) in [
            ("jump", ["expected a command (run,", "found `jump`"]),
            ("run backwards", ["expected run or run to TIME", "found `run backwards`"]),
            ("run to soon", ["expected a time such as 12.5ms", "found `soon`"]),
            ("step 3 pixels", ["expected event, line or field", "found `pixels`"]),
            ("step -1", ["expected event, line or field", "found `-1`"]),
            ("show cpu", ["expected time, boards, waits, ring, timeline or a board", "found \"cpu\""]),
            ("next gp", ["expected host, ring, gp N", "found \"gp\""]),
            ("memory gp 0", ["expected BOARD PLACE", "found no place"]),
            ("memory gp 0 0x10 9999999", ["expected 1 to 4096", "found 9999999"]),
            ("pixel a 0 0", ["renderer: expected a whole number", "found `a`"]),
        ] {
            let error = parse(text, Time::ZERO).expect_err(text);
            words.iter().for_each(|word| assert!(error.contains(word), "{text}: {error}"));
        }
    }
}
