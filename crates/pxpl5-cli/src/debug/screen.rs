//! The debugger's terminal screen: panes that show the machine's state, command output, and an input line.

use super::command::Pane;
use super::session::Session;
use ratatui::Frame;
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use ratatui::layout::{Constraint, Layout, Position, Rect};
use ratatui::widgets::{Block, Paragraph};
use std::io;
use std::time::Duration;

#[derive(Default)]
struct ScreenState {
    /// Lines of output, oldest first.
    log: Vec<String>,
    line: String,
    /// Executed command lines, oldest first.
    history: Vec<String>,
    /// Number of command lines by which the user has gone back in the history.
    back: usize,
    scroll: u16,
}

/// Minimum width of the terminal, in columns, at which panes are placed side by side.
const WIDE: u16 = 100;

/// Maximum number of output lines that are kept.
const LOG: usize = 2_000;

/// Shows the screen and executes the user's commands until the user quits. Fails when the terminal cannot be used.
pub(super) fn run(session: Session) -> io::Result<()> {
    let mut session = session.interrupted_by(key_waits);
    let mut terminal = ratatui::try_init()?;
    let mut talk = ScreenState {
        log: vec!["help lists the commands; F7 steps an event, F8 a line, F9 a field".to_owned()],
        ..ScreenState::default()
    };
    // The closure collects every terminal error, so that the terminal is restored before the error is returned.
    let result = (|| {
        // Redraw after every event, even if no key was pressed.
        while !session.is_over() {
            terminal.draw(|frame| draw(frame, &session, &talk))?;
            if let Event::Key(key) = event::read()?
                && key.kind == KeyEventKind::Press
            {
                pressed(&mut session, &mut talk, key);
            }
        }
        Ok(())
    })();
    ratatui::try_restore()?;
    result
}

fn key_waits() -> bool {
    event::poll(Duration::ZERO).unwrap_or(false)
}

fn pressed(session: &mut Session, talk: &mut ScreenState, key: KeyEvent) {
    // Letters edit the input line. Function keys stand for steps.
    match key.code {
        KeyCode::Char('c' | 'd') if key.modifiers.contains(KeyModifiers::CONTROL) => say(session, talk, "quit"),
        KeyCode::Char(letter) => talk.line.push(letter),
        KeyCode::Backspace => drop(talk.line.pop()),
        KeyCode::Esc => talk.line.clear(),
        KeyCode::Enter => {
            let line = std::mem::take(&mut talk.line);
            talk.history.push(line.clone());
            talk.back = 0;
            say(session, talk, &line);
        }
        KeyCode::Up => recall(talk, talk.back + 1),
        KeyCode::Down => recall(talk, talk.back.saturating_sub(1)),
        KeyCode::PageDown => talk.scroll = talk.scroll.saturating_add(5),
        KeyCode::PageUp => talk.scroll = talk.scroll.saturating_sub(5),
        KeyCode::F(7) => say(session, talk, "step"),
        KeyCode::F(8) => say(session, talk, "step line"),
        KeyCode::F(9) => say(session, talk, "step field"),
        _ => {}
    }
}

/// Copies a line of the history into the input line. `back` counts from the newest line; 0 clears the input line.
fn recall(talk: &mut ScreenState, back: usize) {
    talk.back = back.min(talk.history.len());
    let place = talk.history.len() - talk.back;
    talk.line = talk.history.get(place).cloned().unwrap_or_default();
}

fn say(session: &mut Session, talk: &mut ScreenState, line: &str) {
    talk.log.push(format!("> {line}"));
    let answer = session.execute_line(line).unwrap_or_else(|error| error);
    talk.log.extend(answer.lines().map(str::to_owned));
    // Keep the log bounded by dropping its oldest lines.
    let gone = talk.log.len().saturating_sub(LOG);
    talk.log.drain(..gone);
}

fn draw(frame: &mut Frame<'_>, session: &Session, talk: &ScreenState) {
    let rows = Layout::vertical([Constraint::Fill(3), Constraint::Fill(2), Constraint::Length(1)]);
    let [machine, log, line] = rows.areas(frame.area());
    // Draw the five panes. Only the pane of boards scrolls.
    for ((title, pane), area) in Pane::ALL.iter().zip(panes(machine)) {
        let scroll = if *pane == Pane::Boards { talk.scroll } else { 0 };
        let text = Paragraph::new(session.pane(*pane)).scroll((scroll, 0)).block(Block::bordered().title(*title));
        frame.render_widget(text, area);
    }
    // Show the newest log lines that fit, then the input line with its cursor.
    let shown = usize::from(log.height.saturating_sub(1));
    let last = talk.log[talk.log.len().saturating_sub(shown)..].join("\n");
    frame.render_widget(Paragraph::new(last).block(Block::new().title("commands")), log);
    frame.render_widget(Paragraph::new(format!("> {}", talk.line)), line);
    let column = 2 + talk.line.chars().count() as u16;
    frame.set_cursor_position(Position::new(column.min(line.width.saturating_sub(1)), line.y));
}

/// Returns the screen areas of the panes in this order: time, boards, waits, ring, timeline.
fn panes(area: Rect) -> [Rect; 5] {
    if area.width < WIDE {
        let rows =
            [Constraint::Length(8), Constraint::Fill(2), Constraint::Fill(1), Constraint::Fill(1), Constraint::Fill(1)];
        return Layout::vertical(rows).areas(area);
    }
    // A wide terminal has two columns.
    let [left, right] = Layout::horizontal([Constraint::Fill(1), Constraint::Fill(1)]).areas(area);
    let [time, boards] = Layout::vertical([Constraint::Length(8), Constraint::Fill(1)]).areas(left);
    let thirds = [Constraint::Fill(1), Constraint::Fill(1), Constraint::Fill(1)];
    let [waits, ring, timeline] = Layout::vertical(thirds).areas(right);
    [time, boards, waits, ring, timeline]
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5::{Experiment, MachineConfig, Slats, scene};
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;

    fn session() -> Session {
        let scene = scene::builtin("full-screen:2").expect("built in");
        let experiment = Experiment::new(MachineConfig::slats(), Slats::whole(), scene).fields(8).record_traffic(true);
        Session::new(experiment.stepper().expect("it can be built"))
    }

    fn shown(session: &Session, talk: &ScreenState, (width, height): (u16, u16)) -> String {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).expect("a screen of characters");
        terminal.draw(|frame| draw(frame, session, talk)).expect("it can be drawn");
        terminal.backend().to_string()
    }

    fn type_in(session: &mut Session, talk: &mut ScreenState, text: &str) {
        text.chars().for_each(|letter| pressed(session, talk, KeyEvent::from(KeyCode::Char(letter))));
        pressed(session, talk, KeyEvent::from(KeyCode::Enter));
    }

    #[test]
    fn typed_commands_are_executed_and_every_pane_shows_the_machine() {
        let mut session = session();
        let mut talk = ScreenState::default();
        type_in(&mut session, &mut talk, "run to field 4");
        for size in [(80, 40), (160, 50)] {
            let screen = shown(&session, &talk, size);
            for words in [
                "time",
                "66.733333 ms, field 4 of 8",
                "boards",
                "GP 0",
                "waits",
                "ring",
                "timeline",
                "> run to field 4",
            ] {
                assert!(screen.contains(words), "{size:?} {words}:\n{screen}");
            }
        }
    }

    #[test]
    fn an_unknown_command_prints_an_error_and_the_session_continues() {
        let mut session = session();
        let mut talk = ScreenState::default();
        type_in(&mut session, &mut talk, "jump");
        assert!(talk.log.iter().any(|line| line.contains("found `jump`")) && !session.is_over());
        pressed(&mut session, &mut talk, KeyEvent::from(KeyCode::Up));
        assert_eq!(talk.line, "jump");
        pressed(&mut session, &mut talk, KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL));
        assert!(session.is_over());
    }

    #[test]
    fn a_screen_of_any_size_can_be_drawn() {
        let session = session();
        for size in [(1, 1), (3, 2), (20, 5), (100, 9), (400, 120)] {
            shown(&session, &ScreenState::default(), size);
        }
    }
}
