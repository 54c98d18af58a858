//! Tests of the command with input files from other programs.

use crate::support::{Folder, err, out};
use serde_json::Value;

/// Text of a model file: a pyramid with a material, continued lines, and a comment in Latin-1.
const MODEL: &[u8] =
    b"# Gr\xf6\xdfe\nusemtl M\xe9tall\nv 0 0 0\nv 1 0 \\\n0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

#[test]
fn reading_a_model_prints_a_summary() {
    let folder = Folder::new();
    folder.file("model.obj", MODEL);
    let run = folder.run(&["check", "--pipeline", "slats", "--scene", "model.obj"]);
    assert!(run.status.success(), "{}", err(&run));
    let warning = "pxpl5: warning: model.obj: colours of materials (usemtl) are not read: faces have one colour\n";
    assert_eq!(err(&run), warning);
    let run = ["run", "--pipeline", "slats", "--scene", "model.obj", "--triangles", "3", "--fields", "40", "--json"];
    let run = folder.run(&run);
    assert_eq!(err(&run), warning);
    let report: Value = serde_json::from_slice(&run.stdout).expect("an object");
    assert_eq!(report["warnings"][0], warning.trim_start_matches("pxpl5: warning: ").trim_end());
}

/// Returns the text of a recording with a hundred poses per second for three seconds. It has no pose between 0.28 s and
/// 2.49 s, and one duplicate.
fn recording() -> String {
    let times = (0..300).map(|n| 10 * n).filter(|ms| !(281..2490).contains(ms));
    let rows = times.map(|ms| format!("{}.{:03} 0 0 0 0 0 0 1\n", 1000 + ms / 1000, ms % 1000));
    let mut text: String = rows.collect();
    text.insert_str(0, "1000.000 0.001 0 0 0 0 0 1\n");
    text
}

#[test]
fn recordings_with_repeated_times_or_gaps_are_reported_and_a_run_in_a_gap_is_refused() {
    let folder = Folder::new();
    folder.file("head.tum", recording());
    let run = |more: &[&str]| {
        let args =
            ["run", "--pipeline", "slats", "--scene", "full-screen:4", "--head", "head.tum", "--tracker", "ideal"];
        folder.run(&[&args[..], more].concat())
    };
    let refused = run(&["--fields", "60"]);
    assert!(!refused.status.success());
    let message = err(&refused);
    assert!(message.contains("warning: head.tum: line 2 repeats the time of the line before"), "{message}");
    assert!(message.contains("warning: head.tum: no pose for 2.210 s from 0.280 s on"), "{message}");
    assert!(
        message.contains("no pose from 0.280 s to 2.490 s") && message.contains("head.end = \"hold\""),
        "{message}"
    );
    let held = run(&["--fields", "60", "--set", "head.end=hold"]);
    assert!(held.status.success(), "{}", err(&held));
    let short = run(&["--fields", "14"]);
    assert!(!err(&short).contains("no pose from"), "{}", err(&short));
}

const SLATS: &str = "pipeline = \"slats\"\nscene = \"mig\"\n";

#[test]
fn check_refuses_the_sweeps_that_sweep_refuses_with_the_same_words() {
    let folder = Folder::new();
    for (name, sweep) in [
        ("range.toml", "[sweep.grid]\ntriangles = { from = 10, to = 5, step = 0 }\n"),
        ("key.toml", "[sweep.grid]\ntriangle = [1, 2]\n"),
        ("empty.toml", "[sweep.grid]\ntriangles = []\n"),
        ("table.toml", "[sweep.gird]\ntriangles = [1, 2]\n"),
        ("value.toml", "[sweep.grid]\nlevel = [\"none\"]\n"),
    ] {
        folder.file(name, format!("{SLATS}{sweep}"));
        let [check, swept] = [&["check", name][..], &["sweep", name, "--out", "o"]].map(|args| folder.run(args));
        assert!(!check.status.success() && !swept.status.success(), "{name}");
        assert_eq!(err(&check), err(&swept), "{name}");
        assert!(!err(&check).is_empty());
    }
}

#[test]
fn check_prints_the_first_experiment_of_a_sound_sweep() {
    let folder = Folder::new();
    folder.file("s.toml", format!("{SLATS}[sweep.grid]\ntriangles = [10, 20, 9999]\nseed = [1, 2]\n"));
    let check = folder.run(&["check", "s.toml"]);
    assert!(check.status.success(), "{}", err(&check));
    let text = out(&check);
    assert!(text.starts_with("# sweep of 6 points, of which 6 were checked; point 0:\n"), "{text}");
    assert!(text.contains("#   triangles: 3 values\n") && text.contains("triangles = 10"), "{text}");
    folder.file("again.toml", &text);
    let again = folder.run(&["check", "again.toml"]);
    assert_eq!(
        out(&again).lines().find(|line| line.contains("config_hash")),
        text.lines().find(|line| line.contains("config_hash"))
    );
}

#[test]
fn assembler_listings_have_source_lines_and_warnings_can_be_turned_off() {
    let folder = Folder::new();
    folder.file(
        "a.s",
        b"start:\tadds 1,r0,r4;\tadds 2,r0,r5 // Gr\xf6\xdfe\n\tpfmul.ss f4,f5,f4\nend:\tnop\ntable:\t.long 7, 8\n",
    );
    let listed = folder.run(&["i860", "asm", "a.s"]);
    assert!(listed.status.success(), "{}", err(&listed));
    let text = out(&listed);
    let first = "00001000  94040001  adds 1, r0, r4                      1  start:\tadds 1,r0,r4;\tadds 2,r0,r5 // Gr";
    assert!(text.contains(first), "{text}");
    assert!(text.contains("00001004  94050002  adds 2, r0, r5\n"), "{text}");
    assert!(
        text.contains("table:\n00001010  00000007  .long 0x7                           4  table:\t.long 7, 8\n"),
        "{text}"
    );
    let warning =
        "pxpl5: warning: a.s:2: a pipelined multiply must not have its first source as destination [multiply-source]\n";
    assert_eq!(err(&listed), warning);
    for allow in [&["--allow", "multiply-source"][..], &["--allow", "lost-result,multiply-source"], &["--allow", "all"]]
    {
        assert_eq!(err(&folder.run(&[&["i860", "asm", "a.s"], allow].concat())), "", "{allow:?}");
    }
    let run = folder.run(&["i860", "run", "a.s", "--allow", "all", "--json"]);
    let json: Value = serde_json::from_slice(&run.stdout).expect("an object");
    assert_eq!((&json["r"][4], &json["r"][5]), (&"00000001".into(), &"00000002".into()));
    let wrong = folder.run(&["i860", "asm", "a.s", "--allow", "everything"]);
    assert!(!wrong.status.success() && err(&wrong).contains("lost-result"));
}
