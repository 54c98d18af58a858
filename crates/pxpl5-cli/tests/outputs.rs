//! Tests of output files. Regular files are replaced as a whole. Data for devices and pipes are written into them.
#![cfg(unix)]

use crate::support::{Folder, command, err, json, names};
use std::fs;
use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
use std::path::Path;
use std::process::{Command, Stdio};

const TRACE: [&str; 8] = ["trace", "--pipeline", "slats", "--scene", "full-screen:4", "--fields", "8", "--out"];
const FILM: [&str; 11] =
    ["film", "--pipeline", "slats", "--scene", "full-screen:4", "--from", "4", "--length", "2", "--quiet", "--out"];
const ASSEMBLE: [&str; 4] = ["i860", "asm", "p.s", "-o"];

/// Commands that write one file each, without the name of the file.
const COMMANDS: [&[&str]; 3] = [&TRACE, &FILM, &ASSEMBLE];

fn folder() -> Folder {
    let folder = Folder::new();
    folder.file("p.s", "start: adds 1, r5, r5\nend: nop\n");
    folder
}

#[track_caller]
fn succeeds(folder: &Folder, args: &[&str], out: &str) {
    let output = folder.run(&[args, &[out]].concat());
    assert!(output.status.success(), "{args:?} {out}: {}", err(&output));
}

fn read(folder: &Folder, name: &str) -> Vec<u8> {
    fs::read(folder.path.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn is_link(path: &Path) -> bool {
    path.symlink_metadata().is_ok_and(|found| found.is_symlink())
}

/// Creates a null device like `mknod NAME c 1 3`. Returns true if this process has the permission.
fn null_device(path: &Path) -> bool {
    Command::new("mknod").arg(path).args(["c", "1", "3"]).stderr(Stdio::null()).status().is_ok_and(|s| s.success())
}

#[test]
fn writing_to_a_device_does_not_replace_the_device_by_a_file() {
    let folder = folder();
    let device = folder.path.join("nul");
    let made = null_device(&device);
    symlink("/dev/null", folder.path.join("link")).expect("ours");
    for args in COMMANDS {
        if made {
            succeeds(&folder, args, "nul");
            assert!(fs::metadata(&device).expect("there").file_type().is_char_device(), "{args:?}");
        }
        succeeds(&folder, args, "link");
        assert!(is_link(&folder.path.join("link")), "{args:?}");
        assert!(fs::metadata("/dev/null").expect("there").file_type().is_char_device(), "{args:?}");
    }
}

#[test]
fn a_pipe_gets_the_same_bytes_as_a_file() {
    let folder = folder();
    let pipe = folder.path.join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo is there").success());
    for args in COMMANDS {
        succeeds(&folder, args, "file");
        let at = pipe.clone();
        let reader = std::thread::spawn(move || fs::read(at).expect("a pipe"));
        succeeds(&folder, args, "pipe");
        assert!(fs::metadata(&pipe).expect("there").file_type().is_fifo(), "{args:?}");
        assert!(reader.join().expect("it reads") == read(&folder, "file"), "{args:?}");
    }
}

#[test]
fn writing_through_a_link_keeps_the_link_even_if_its_target_is_missing() {
    let folder = folder();
    fs::create_dir(folder.path.join("else")).expect("ours");
    symlink("else/where", folder.path.join("one")).expect("ours");
    symlink("one", folder.path.join("two")).expect("ours");
    for args in COMMANDS {
        succeeds(&folder, args, "plain");
        let _ = fs::remove_file(folder.path.join("else/where"));
        for round in ["none yet", "there"] {
            succeeds(&folder, args, "two");
            assert!(is_link(&folder.path.join("one")) && is_link(&folder.path.join("two")), "{args:?}, {round}");
            assert!(!is_link(&folder.path.join("else/where")), "{args:?}, {round}");
            assert!(read(&folder, "else/where") == read(&folder, "plain"), "{args:?}, {round}");
        }
    }
    symlink("circle", folder.path.join("circle")).expect("ours");
    let output = folder.run(&[&TRACE[..], &["circle"]].concat());
    assert_eq!(output.status.code(), Some(1), "{}", err(&output));
    assert_eq!(names(&folder.path.join("else")), ["where"]);
}

#[test]
fn writing_to_dev_stdout_puts_only_the_bytes_of_the_file_there() {
    let folder = folder();
    for args in COMMANDS {
        succeeds(&folder, args, "file");
        let piped = folder.run(&[args, &["/dev/stdout"]].concat());
        assert!(piped.status.success() && piped.stdout == read(&folder, "file"), "{args:?}: {}", err(&piped));
        let redirected = fs::File::create(folder.path.join("redirected")).expect("ours");
        let mut child = command(&[args, &["/dev/stdout"]].concat());
        assert!(child.current_dir(&folder.path).stdout(redirected).status().expect("it starts").success());
        assert!(read(&folder, "redirected") == read(&folder, "file"), "{args:?}");
    }
}

#[test]
fn writing_to_a_full_device_is_reported_as_an_error() {
    let folder = folder();
    for args in COMMANDS {
        let output = folder.run(&[args, &["/dev/full"]].concat());
        assert_eq!(output.status.code(), Some(1), "{args:?}");
        assert!(err(&output).contains("/dev/full cannot be written"), "{}", err(&output));
    }
    let full = || fs::OpenOptions::new().write(true).open("/dev/full").expect("Linux has it");
    fs::write(folder.path.join("v.jsonl"), "").expect("ours");
    fs::write(folder.path.join("w.bin"), [0, 0, 0, 0xA0]).expect("ours");
    for args in [&["asm", "p.s"][..], &["disasm", "w.bin"], &["run", "p.s"], &["vectors", "v.jsonl"]] {
        let mut child = command(&[&["i860"], args].concat());
        let output = child.current_dir(&folder.path).stdout(full()).output().expect("it starts");
        assert_eq!(output.status.code(), Some(1), "{args:?}");
        assert!(err(&output).contains("standard output cannot be written"), "{args:?}: {}", err(&output));
    }
}

#[test]
fn a_replaced_file_keeps_its_permissions() {
    let folder = folder();
    let path = folder.file("secret", "old");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).expect("ours");
    succeeds(&folder, &TRACE, "secret");
    assert_eq!(fs::metadata(&path).expect("there").permissions().mode() & 0o777, 0o600);
    assert!(read(&folder, "secret").len() > 100);
}

const RUN: [&str; 9] = ["run", "--pipeline", "slats", "--scene", "full-screen:4", "--fields", "12", "--out", "r"];

#[test]
fn if_one_file_cannot_be_written_none_is_written() {
    let folder = folder();
    fs::create_dir_all(folder.path.join("r/left.png/inner")).expect("ours");
    folder.file("r/report.json", "old");
    let output = folder.run(&RUN);
    assert_eq!(output.status.code(), Some(1));
    assert!(err(&output).contains("left.png cannot be written: it is a folder"), "{}", err(&output));
    assert_eq!(names(&folder.path.join("r")), ["left.png", "report.json"]);
    assert_eq!(read(&folder, "r/report.json"), b"old");
}

/// Tests a device that accepts no data. It must be written before any file gets its new name.
#[test]
fn a_file_keeps_its_content_if_a_device_cannot_be_written() {
    let folder = folder();
    fs::create_dir(folder.path.join("r")).expect("ours");
    folder.file("r/report.json", "old");
    symlink("/dev/full", folder.path.join("r/experiment.toml")).expect("ours");
    let output = folder.run(&RUN);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(names(&folder.path.join("r")), ["experiment.toml", "report.json"]);
    assert_eq!(read(&folder, "r/report.json"), b"old");
}

/// Tests that an experiment file written by a command still finds the model file, whatever the current folder is.
#[test]
fn a_written_experiment_runs_again_from_any_folder() {
    let folder = folder();
    fs::create_dir(folder.path.join("elsewhere")).expect("ours");
    folder.file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let args = ["run", "--pipeline", "slats", "--scene", "m.obj", "--fields", "12", "--json", "--out", "r"];
    let first = json(&folder.run(&args));
    let mut again = command(&["run", "../r/experiment.toml", "--json"]);
    let second = json(&again.current_dir(folder.path.join("elsewhere")).output().expect("it starts"));
    assert_eq!((&first["trace_hash"], &first["config_hash"]), (&second["trace_hash"], &second["config_hash"]));
}

/// Tests two runs into the same folder. Only the files of the second run must remain.
#[test]
fn a_run_replaces_the_previous_run_as_a_whole() {
    let folder = folder();
    let run = |pipeline: &str, more: &[&str]| {
        let args = ["run", "--pipeline", pipeline, "--scene", "full-screen:2", "--fields", "20", "--quiet"];
        let output = folder.run(&[&args[..], more, &["--out", "r"]].concat());
        assert!(output.status.success(), "{}", err(&output));
    };
    run("slats", &[]);
    folder.file("r/notes.txt", "mine");
    assert!(folder.run(&["report", "r", "--quiet"]).status.success());
    for name in ["right.png", "timeline.svg", "report.html"] {
        assert!(folder.path.join("r").join(name).exists(), "{name}");
    }
    // A single screen for both eyes has one picture. The timeline is turned off.
    run("jitp-field", &["--set", "output.timeline=false"]);
    let alone = folder.path.join("alone");
    let args = ["run", "--pipeline", "jitp-field", "--scene", "full-screen:2", "--fields", "20", "--quiet"];
    assert!(folder.run(&[&args[..], &["--set", "output.timeline=false", "--out", "alone"]].concat()).status.success());
    let mut expected = names(&alone);
    expected.push("notes.txt".to_owned());
    expected.sort();
    assert_eq!(names(&folder.path.join("r")), expected);
    // A file that the user has changed since the run is kept.
    run("slats", &[]);
    folder.file("r/right.png", "mine");
    run("jitp-field", &[]);
    assert_eq!(read(&folder, "r/right.png"), b"mine");
    assert!(folder.run(&["report", "r", "--quiet"]).status.success());
    let page = String::from_utf8(read(&folder, "r/report.html")).expect("text");
    assert_eq!(page.matches("data:image/png;base64,").count(), 1, "the changed picture is of no run");
}

#[test]
fn rows_of_a_sweep_are_not_replaced_and_a_sweep_replaces_no_run() {
    let folder = folder();
    folder.file("s.toml", "pipeline = \"slats\"\nscene = \"full-screen:2\"\nfields = 12\n[sweep.grid]\nseed = [1]\n");
    assert!(folder.run(&["sweep", "s.toml", "--out", "r", "--quiet"]).status.success());
    for command in [&RUN[..], &["compare", "--fields", "20", "--out", "r"], &["volume", "run", "--out", "r"]] {
        let output = folder.run(command);
        assert_eq!(output.status.code(), Some(2), "{command:?}: {}", err(&output));
        assert!(err(&output).contains("rows of a sweep"), "{}", err(&output));
    }
    assert!(folder.run(&[&RUN[..8], &["q"]].concat()).status.success());
    let output = folder.run(&["sweep", "s.toml", "--out", "q"]);
    assert_eq!(output.status.code(), Some(2), "{}", err(&output));
    assert!(err(&output).contains("files of `pxpl5 run`"), "{}", err(&output));
}

#[test]
fn a_manifest_of_another_program_is_left_alone() {
    let folder = folder();
    fs::create_dir(folder.path.join("r")).expect("ours");
    folder.file("r/manifest.json", "{\"name\": \"page\"}");
    let output = folder.run(&RUN);
    assert_eq!(output.status.code(), Some(2), "{}", err(&output));
    assert!(err(&output).contains("manifest.json: expected a manifest of pxpl5"), "{}", err(&output));
    assert_eq!(read(&folder, "r/manifest.json"), b"{\"name\": \"page\"}");
}

#[test]
fn a_trace_that_is_killed_leaves_no_file() {
    let folder = folder();
    let args = ["trace", "--pipeline", "slats", "--scene", "full-screen:4", "--fields", "100000", "--out", "a/b.json"];
    let mut child = command(&[&args[..], &["--quiet", "--max-memory", "1000000"]].concat());
    let mut child = child.current_dir(&folder.path).stderr(Stdio::null()).spawn().expect("it starts");
    std::thread::sleep(std::time::Duration::from_secs(2));
    assert!(child.try_wait().expect("ours").is_none(), "it still runs");
    child.kill().expect("it is killed");
    assert!(!child.wait().expect("it ends").success());
    assert_eq!(folder.names(), ["p.s"]);
}

#[test]
fn an_error_names_the_file_and_the_option_that_were_given() {
    let folder = folder();
    fs::create_dir(folder.path.join("d")).expect("ours");
    let read_only = |is: bool| {
        fs::set_permissions(folder.path.join("d"), fs::Permissions::from_mode(if is { 0o555 } else { 0o755 }))
    };
    for (args, option) in [
        (&["levels", "--chart"][..], "--chart"),
        (&FILM, "--out"),
        (&["figures", "--write"], "--write"),
        (&ASSEMBLE, "-o"),
    ] {
        let output = folder.run(&[args, &["p.s/below"]].concat());
        assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0), "{args:?}");
        assert!(err(&output).contains("p.s/below cannot be written"), "{args:?}: {}", err(&output));
        assert!(err(&output).contains(&format!("choose another place with {option}")), "{args:?}: {}", err(&output));
    }
    read_only(true).expect("ours");
    // A process with permission to write everywhere gets no error.
    if fs::write(folder.path.join("d/mine"), "").is_err() {
        let output = folder.run(&[&FILM[..], &["d/s.png"]].concat());
        assert!(err(&output).contains("d/s.png cannot be written"), "{}", err(&output));
    }
    read_only(false).expect("ours");
}
