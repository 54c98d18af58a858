//! Where outputs go: regular files are replaced, whole; devices, pipes and links stay what they are.
#![cfg(unix)]

mod support;

use std::fs;
use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
use std::path::Path;
use std::process::{Command, Stdio};
use support::{Folder, command, err, json, names};

const TRACE: [&str; 10] =
    ["trace", "--pipeline", "slats", "--scene", "full-screen:4", "--fields", "8", "--format", "perfetto", "--out"];
const SAVE: [&str; 11] =
    ["run", "--pipeline", "slats", "--scene", "full-screen:4", "--fields", "12", "--quiet", "--save-at", "4", "--save"];
const FILM: [&str; 11] =
    ["film", "--pipeline", "slats", "--scene", "full-screen:4", "--from", "4", "--length", "2", "--quiet", "--out"];
const ASSEMBLE: [&str; 4] = ["i860", "asm", "p.s", "-o"];

/// Every command that writes one file, without the file's name.
const COMMANDS: [&[&str]; 4] = [&TRACE, &SAVE, &FILM, &ASSEMBLE];

fn folder(name: &str) -> Folder {
    let folder = Folder::new(name);
    folder.file("p.s", "start: adds 1, r5, r5\nend: nop\n");
    folder
}

#[track_caller]
fn succeeds(folder: &Folder, args: &[&str], out: &str) {
    let output = folder.run(&[args, &[out]].concat());
    assert!(output.status.success(), "{args:?} {out}: {}", err(&output));
}

fn read(folder: &Folder, name: &str) -> Vec<u8> {
    fs::read(folder.0.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn is_link(path: &Path) -> bool {
    path.symlink_metadata().is_ok_and(|found| found.is_symlink())
}

/// As `mknod NAME c 1 3`: true where this process may do it.
fn null_device(path: &Path) -> bool {
    Command::new("mknod").arg(path).args(["c", "1", "3"]).stderr(Stdio::null()).status().is_ok_and(|s| s.success())
}

#[test]
fn a_device_stays_a_device() {
    let folder = folder("device");
    let device = folder.0.join("nul");
    let made = null_device(&device);
    symlink("/dev/null", folder.0.join("link")).expect("ours");
    for args in COMMANDS {
        if made {
            succeeds(&folder, args, "nul");
            assert!(fs::metadata(&device).expect("there").file_type().is_char_device(), "{args:?}");
        }
        succeeds(&folder, args, "link");
        assert!(is_link(&folder.0.join("link")), "{args:?}");
        assert!(fs::metadata("/dev/null").expect("there").file_type().is_char_device(), "{args:?}");
    }
}

#[test]
fn a_pipe_gets_what_a_file_would() {
    let folder = folder("pipe");
    let pipe = folder.0.join("pipe");
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
fn a_link_is_followed_whether_its_file_is_there_or_not() {
    let folder = folder("links");
    fs::create_dir(folder.0.join("else")).expect("ours");
    symlink("else/where", folder.0.join("one")).expect("ours");
    symlink("one", folder.0.join("two")).expect("ours");
    for args in COMMANDS {
        succeeds(&folder, args, "plain");
        let _ = fs::remove_file(folder.0.join("else/where"));
        for round in ["none yet", "there"] {
            succeeds(&folder, args, "two");
            assert!(is_link(&folder.0.join("one")) && is_link(&folder.0.join("two")), "{args:?}, {round}");
            assert!(!is_link(&folder.0.join("else/where")), "{args:?}, {round}");
            assert!(read(&folder, "else/where") == read(&folder, "plain"), "{args:?}, {round}");
        }
    }
    symlink("circle", folder.0.join("circle")).expect("ours");
    let output = folder.run(&[&TRACE[..], &["circle"]].concat());
    assert_eq!(output.status.code(), Some(1), "{}", err(&output));
    assert_eq!(names(&folder.0.join("else")), ["where"]);
}

#[test]
fn standard_output_by_another_name_gets_the_file_and_nothing_else() {
    let folder = folder("stdout");
    for args in COMMANDS {
        succeeds(&folder, args, "file");
        let piped = folder.run(&[args, &["/dev/stdout"]].concat());
        assert!(piped.status.success() && piped.stdout == read(&folder, "file"), "{args:?}: {}", err(&piped));
        let redirected = fs::File::create(folder.0.join("redirected")).expect("ours");
        let mut child = command(&[args, &["/dev/stdout"]].concat());
        assert!(child.current_dir(&folder.0).stdout(redirected).status().expect("it starts").success());
        assert!(read(&folder, "redirected") == read(&folder, "file"), "{args:?}");
    }
}

#[test]
fn a_full_device_is_told() {
    let folder = folder("full");
    for args in COMMANDS {
        let output = folder.run(&[args, &["/dev/full"]].concat());
        assert_eq!(output.status.code(), Some(1), "{args:?}");
        assert!(err(&output).contains("/dev/full cannot be written"), "{}", err(&output));
    }
    let full = || fs::OpenOptions::new().write(true).open("/dev/full").expect("Linux has it");
    fs::write(folder.0.join("v.jsonl"), "").expect("ours");
    fs::write(folder.0.join("w.bin"), [0, 0, 0, 0xA0]).expect("ours");
    for args in [&["asm", "p.s"][..], &["disasm", "w.bin"], &["run", "p.s"], &["vectors", "v.jsonl"]] {
        let mut child = command(&[&["i860"], args].concat());
        let output = child.current_dir(&folder.0).stdout(full()).output().expect("it starts");
        assert_eq!(output.status.code(), Some(1), "{args:?}");
        assert!(err(&output).contains("standard output cannot be written"), "{args:?}: {}", err(&output));
    }
}

#[test]
fn a_replaced_file_keeps_its_permissions() {
    let folder = folder("permissions");
    let path = folder.file("secret", "old");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).expect("ours");
    succeeds(&folder, &TRACE, "secret");
    assert_eq!(fs::metadata(&path).expect("there").permissions().mode() & 0o777, 0o600);
    assert!(read(&folder, "secret").len() > 100);
}

const RUN: [&str; 9] = ["run", "--pipeline", "slats", "--scene", "full-screen:4", "--fields", "12", "--out", "r"];

#[test]
fn where_one_file_cannot_be_written_none_is() {
    let folder = folder("one-of-many");
    fs::create_dir_all(folder.0.join("r/left.png/inner")).expect("ours");
    folder.file("r/report.json", "old");
    let output = folder.run(&RUN);
    assert_eq!(output.status.code(), Some(1));
    assert!(err(&output).contains("left.png cannot be written: it is a folder"), "{}", err(&output));
    assert_eq!(names(&folder.0.join("r")), ["left.png", "report.json"]);
    assert_eq!(read(&folder, "r/report.json"), b"old");
}

/// A device that takes nothing comes last, when all others have their names: they get their old contents back.
#[test]
fn what_was_given_its_name_gets_its_old_contents_back() {
    let folder = folder("back");
    fs::create_dir(folder.0.join("r")).expect("ours");
    folder.file("r/report.json", "old");
    symlink("/dev/full", folder.0.join("r/experiment.toml")).expect("ours");
    let output = folder.run(&RUN);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(names(&folder.0.join("r")), ["experiment.toml", "report.json"]);
    assert_eq!(read(&folder, "r/report.json"), b"old");
}

#[test]
fn of_runs_that_write_into_one_folder_at_once_one_is_there_whole() {
    let folder = folder("together");
    for round in 0..4 {
        let start = |seed: u32| {
            let mut child = command(&[&RUN[..], &["--quiet", "--seed", &seed.to_string()]].concat());
            child.current_dir(&folder.0).spawn().expect("it starts")
        };
        let children: Vec<_> = (1..=4).map(start).collect();
        for mut child in children {
            assert!(child.wait().expect("it ends").success(), "round {round}");
        }
        let report: serde_json::Value = serde_json::from_slice(&read(&folder, "r/report.json")).expect("JSON");
        let hash = report["config_hash"].as_str().expect("text");
        let all = names(&folder.0.join("r"));
        assert!(all.iter().all(|name| !name.starts_with('.')), "{all:?}");
        // Tables do not name their configuration.
        for name in ["experiment.toml", "timeline.svg", "left.png", "right.png"] {
            let bytes = read(&folder, &format!("r/{name}"));
            assert!(bytes.windows(hash.len()).any(|part| part == hash.as_bytes()), "{name} is of another run, {round}");
        }
    }
    assert!(json(&folder.run(&["run", "r/experiment.toml", "--json"]))["config_hash"].is_string());
}

/// A model that lay beside the command is found again, wherever the written experiment is run.
#[test]
fn what_was_written_runs_again_from_anywhere() {
    let folder = folder("again");
    fs::create_dir(folder.0.join("elsewhere")).expect("ours");
    folder.file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let args = ["run", "--pipeline", "slats", "--scene", "m.obj", "--fields", "12", "--json", "--out", "r"];
    let first = json(&folder.run(&args));
    let mut again = command(&["run", "../r/experiment.toml", "--json"]);
    let second = json(&again.current_dir(folder.0.join("elsewhere")).output().expect("it starts"));
    assert_eq!((&first["trace_hash"], &first["config_hash"]), (&second["trace_hash"], &second["config_hash"]));
}

/// What takes long to compute is not computed for a file that cannot be written.
#[test]
fn a_path_that_cannot_be_written_is_told_before_the_work() {
    let folder = folder("early");
    for args in [["levels", "--chart"], ["levels", "--scaling"], ["figures", "--write"]] {
        let output = folder.run(&[&args[..], &["p.s/below"]].concat());
        assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0), "{args:?}");
        assert!(err(&output).contains("p.s/below cannot be written"), "{args:?}: {}", err(&output));
    }
}
