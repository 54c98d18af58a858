//! Tests of `pxpl5 debug`: scripts, their output, and refused commands. The sessions in the guide must match the
//! actual output.

use crate::support::{Folder, command, err, out, words};
use pxpl5::{ExperimentFile, PeriodNumber};
use std::path::{Path, PathBuf};

const SLATS: [&str; 9] =
    ["debug", "--pipeline", "slats", "--scene", "full-screen:2", "--fields", "8", "--machine", "slats"];

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/guide/debugger.md")
}

/// Runs the debugger sessions of the guide again. A session is a block of text whose first line is a command after `$`.
fn made_anew(text: &str) -> (String, usize) {
    let mut made = String::new();
    let mut sessions = 0;
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        made.push_str(line);
        made.push('\n');
        let Some(session) = line.strip_prefix("$ pxpl5 ") else { continue };
        let args = words(session);
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        let output = command(&args).output().expect("it starts");
        assert!(output.status.success(), "{session}: {}", err(&output));
        made.push_str(&out(&output));
        made.push_str("```\n");
        sessions += 1;
        lines.by_ref().find(|line| *line == "```").expect("the end of the block");
    }
    (made, sessions)
}

#[test]
fn the_debugger_prints_the_sessions_of_the_guide() {
    let text = std::fs::read_to_string(page()).expect("the page");
    let (made, sessions) = made_anew(&text);
    assert!(sessions >= 2, "{sessions}");
    if std::env::var_os("PXPL5_UPDATE_GUIDE").is_some() {
        std::fs::write(page(), &made).expect("the page can be written");
        return;
    }
    assert!(made == text, "stale: PXPL5_UPDATE_GUIDE=1 cargo test -p pxpl5-cli --test main debug::");
}

fn session(commands: &str) -> std::process::Output {
    command(&[&SLATS[..], &["--do", commands]].concat()).output().expect("it starts")
}

#[test]
fn a_script_runs_to_times_fields_boards_and_conditions() {
    let output = session(
        "run to 20ms; run to field 3; next renderer 1; step 2 lines; run until fifo 0 >= 20; run until swap; run",
    );
    let text = out(&output);
    assert!(output.status.success(), "{}", err(&output));
    // An NTSC field is 1001/60000 s: three of them are 50.05 ms.
    for line in
        ["20.000000 ms, field 1\n", "50.050000 ms, field 3\n", "renderer 1: message announced\n", "the run is over"]
    {
        assert!(text.contains(line), "{line}: {text}");
    }
    assert_eq!(text.lines().filter(|line| line.starts_with("> ")).count(), 7, "{text}");
}

#[test]
fn debugger_commands_do_not_change_the_trace_of_the_run() {
    // The hash at the start of field 5 of the same run without a debugger.
    let text = "pipeline = \"slats\"\nscene = \"full-screen:2\"\nmachine.preset = \"slats\"\nfields = 8\n";
    let plan = ExperimentFile::parse(text, "test").and_then(|file| file.resolve()).expect("an experiment");
    let mut line = String::new();
    let run = plan.experiment(plan.load_scene().expect("built in")).run_stopping(&[PeriodNumber(5)], |field, run| {
        if field == PeriodNumber(5) {
            line = format!("trace   {}\n", run.record().trace_hash());
        }
        Ok(())
    });
    run.expect("six pictures, more than the warm-up has");
    for commands in [
        "run to field 5; show time",
        "step 500; next gp 0; show boards; run until region; seen left; enabled 0; step 3 lines; run to field 5; show time",
    ] {
        let text = out(&session(commands));
        assert!(text.contains(&line), "{line}: {text}");
    }
}

#[test]
fn a_wrong_command_is_reported_with_expected_and_found() {
    for (commands, expected) in [
        ("jump", "expected a command (run, next, step,"),
        ("run to field 3; run to 10ms", "expected an instant not before now, 50.050000 ms, found 10.000000 ms"),
        ("run until fifo 99 > 3", "renderer: expected 0 to"),
        ("run until inbox ring > 3", "expected the host or a graphics processor of this machine, found ring"),
        ("break start", "--level cycle"),
        ("registers gp 0", "--level cycle"),
        ("pixel 0 128 0", "column: expected 0 to 127, found 128"),
        ("seen middle", "surface: expected left or right, found `middle`"),
    ] {
        let output = session(commands);
        assert_eq!(output.status.code(), Some(2), "{commands}");
        assert!(err(&output).contains(expected), "{commands}: {}", err(&output));
    }
}

#[test]
fn the_debugger_executes_a_script_file_and_writes_pictures() {
    let folder = Folder::new();
    folder.file("session.txt", "run to field 6   # the first pictures\nseen left left.png\nideal left ideal.png\n");
    let output = folder.run(&[&SLATS[..], &["--do-file", "session.txt"]].concat());
    assert!(output.status.success(), "{}", err(&output));
    assert_eq!(folder.names(), ["ideal.png", "left.png", "session.txt"]);
}

#[test]
fn a_fault_of_the_machine_does_not_end_the_session() {
    let args = ["debug", "--pipeline", "slats", "--scene", "full-screen:200000", "--fields", "8", "--pixels", "off"];
    let output =
        command(&[&args[..], &["--do", "run; show time; show waits; step"]].concat()).output().expect("it starts");
    let text = out(&output);
    assert!(output.status.success(), "{}", err(&output));
    assert_eq!(text.matches("the machine cannot go on: GP").count(), 2, "{text}");
    assert!(text.contains("failed  "), "{text}");
}

#[test]
fn code_stops_at_breakpoints_and_shows_registers_code_and_memory() {
    let args =
        ["debug", "--pipeline", "slats", "--scene", "mig", "--triangles", "8", "--fields", "6", "--level", "cycle"];
    let script = "run to field 2; break start; run; registers gp 0; disassemble gp 0 start 4; memory gp 0 start 4; delete start; run";
    let output = command(&[&args[..], &["--do", script]].concat()).output().expect("it starts");
    let text = out(&output);
    assert!(output.status.success(), "{}", err(&output));
    for words in
        ["breakpoint: GP 0 at 0x", "at the breakpoint: pc 0x", "start:\n* 0x", "no breakpoints", "the run is over"]
    {
        assert!(text.contains(words), "{words}: {text}");
    }
}
