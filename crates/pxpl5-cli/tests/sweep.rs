//! Tests of sweeps as a user runs them: killed, resumed, divided into shards, and joined.

use crate::support::{Folder, command, err, names, out};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// Text of a sweep with 64 points that take some milliseconds each.
const FILE: &str = "pipeline = \"slats\"\nscene = \"mig\"\nfields = 20\n\
    [sweep]\nseeds = 2\n[sweep.grid]\ncopy = [\"whole\", \"split\"]\ntriangles = { from = 1, to = 151, step = 10 }\n";
const POINTS: usize = 2 * 2 * 16;

fn folder() -> Folder {
    let folder = Folder::new();
    folder.file("s.toml", FILE);
    folder
}

fn sweep(folder: &Folder, args: &[&str]) -> std::process::Output {
    folder.run(&[&["sweep", "s.toml", "--quiet"], args].concat())
}

fn succeeds(output: &std::process::Output) {
    assert!(output.status.success(), "{}", err(output));
}

fn read(folder: &Folder, name: &str) -> String {
    fs::read_to_string(folder.path.join(name)).expect(name)
}

/// Returns the complete lines of a JSON lines file, without its header. An incomplete last line is left out.
fn lines(path: &Path) -> Vec<String> {
    let text = fs::read_to_string(path).unwrap_or_default();
    let whole = text.split_inclusive('\n').filter(|line| line.ends_with('\n')).skip(1);
    whole.map(str::to_owned).collect()
}

fn points(path: &Path) -> Vec<u64> {
    lines(path).iter().map(|line| point_of(line)).collect()
}

fn point_of(line: &str) -> u64 {
    let row: serde_json::Value = serde_json::from_str(line).expect("JSON");
    row["point"].as_u64().expect("a number")
}

/// Kills a process after some time, like `kill -9`.
fn killed_after(mut child: Child, time: Duration) -> bool {
    std::thread::sleep(time);
    let running = child.try_wait().expect("it can be asked").is_none();
    child.kill().expect("it can be killed");
    child.wait().expect("it ends");
    running
}

#[test]
fn a_sweep_killed_repeatedly_loses_and_repeats_no_finished_point() {
    let folder = folder();
    let rows = folder.path.join("killed/rows.jsonl");
    let mut kills = 0;
    let mut finished = BTreeSet::new();
    for attempt in 0u64.. {
        let mut child = command(&["sweep", "s.toml", "--out", "killed", "--resume", "--quiet"]);
        let child = child.current_dir(&folder.path).stdout(Stdio::null()).spawn().expect("the command starts");
        if !killed_after(child, Duration::from_millis(20 + 17 * (attempt % 7))) {
            break;
        }
        kills += 1;
        let now = lines(&rows);
        let kept: BTreeSet<String> = now.iter().cloned().collect();
        assert_eq!(kept.len(), now.len(), "no row twice");
        assert!(kept.is_superset(&finished), "every finished row stays as it was");
        finished = kept;
        assert!(attempt < 2_000, "it gets on: {} points", finished.len());
    }
    assert!(kills > 2, "killed {kills} times");
    succeeds(&sweep(&folder, &["--out", "killed", "--resume"]));
    succeeds(&sweep(&folder, &["--out", "whole"]));
    assert!(read(&folder, "killed/rows.jsonl") == read(&folder, "whole/rows.jsonl"));
    // Every computed point adds a line to times.jsonl. A kill between a row and its time may lose one line.
    let times = points(&folder.path.join("killed/times.jsonl"));
    assert_eq!(times.iter().collect::<BTreeSet<_>>().len(), times.len(), "no point was computed twice");
    assert!(times.len() + kills >= POINTS);
}

#[test]
fn results_are_neither_overwritten_nor_mixed_with_those_of_another_sweep() {
    let folder = folder();
    succeeds(&sweep(&folder, &["--out", "a"]));
    let before = read(&folder, "a/rows.jsonl");
    let again = sweep(&folder, &["--out", "a"]);
    assert_eq!(again.status.code(), Some(2));
    assert!(err(&again).contains("--resume"), "{}", err(&again));
    let other = sweep(&folder, &["--out", "a", "--resume", "--set", "fields=31"]);
    assert_eq!(other.status.code(), Some(2));
    assert!(err(&other).contains("results of another sweep: config_hash"), "{}", err(&other));
    assert!(read(&folder, "a/rows.jsonl") == before);
}

#[test]
fn merge_finds_missing_duplicate_and_contradicting_points() {
    let folder = folder();
    for shard in ["1/2", "2/2"] {
        succeeds(&sweep(&folder, &["--out", &shard[..1], "--shard", shard]));
    }
    let missing = folder.run(&["merge", "1", "--out", "joined"]);
    assert_eq!(missing.status.code(), Some(2));
    assert!(err(&missing).contains("32 of 64 points are missing: 1, 3, 5"), "{}", err(&missing));
    assert!(!folder.path.join("joined").exists(), "nothing half-written");
    let partial = folder.run(&["merge", "1", "--out", "part", "--partial"]);
    succeeds(&partial);
    assert_eq!(points(&folder.path.join("part/rows.jsonl")).len(), POINTS / 2);
    let twice = folder.run(&["merge", "1", "2", "1", "--out", "joined"]);
    succeeds(&twice);
    assert!(err(&twice).contains("32 points were found more than once; the first is point 0"), "{}", err(&twice));
    assert!(out(&twice).contains("64 points, 0 of them failed"), "{}", out(&twice));
    let rows = read(&folder, "1/rows.jsonl");
    fs::create_dir(folder.path.join("3")).expect("ours");
    fs::write(folder.path.join("3/rows.jsonl"), rows.replacen("\"missed_retraces\":0.0", "\"missed_retraces\":9.0", 1))
        .expect("ours");
    let contradiction = folder.run(&["merge", "1", "2", "3", "--out", "other"]);
    assert_eq!(contradiction.status.code(), Some(2));
    assert!(
        err(&contradiction).contains("point 0 has different rows in 1/rows.jsonl and 3/rows.jsonl"),
        "{}",
        err(&contradiction)
    );
    assert!(!folder.path.join("other").exists());
}

#[test]
fn a_point_that_fails_is_recorded_and_reported_and_the_sweep_continues() {
    let folder = Folder::new();
    folder.file(
        "s.toml",
        "pipeline = \"slats\"\nscene = \"full-screen:4\"\nfields = 10\n[sweep.grid]\nn_renderers = [4, 5]\n",
    );
    let output = folder.run(&["sweep", "s.toml", "--out", "o"]);
    succeeds(&output);
    assert!(err(&output).contains("1 of 2 points could not be simulated; point 0: "), "{}", err(&output));
    assert_eq!(names(&folder.path.join("o")), [".lock", "manifest.json", "results.csv", "rows.jsonl", "times.jsonl"]);
    let csv = read(&folder, "o/results.csv");
    assert!(csv.contains("\n0,failed,4,") && csv.contains("\n1,done,5,"), "{csv}");
    folder.file("s.toml", read(&folder, "s.toml").replace("[4, 5]", "[3, 4]"));
    let none = folder.run(&["sweep", "s.toml", "--out", "none"]);
    assert_eq!(none.status.code(), Some(1));
    assert!(err(&none).contains("no point could be simulated"), "{}", err(&none));
}

/// Runs the script from docs/guide/clusters.md that the repository contains.
fn script(folder: &Folder, args: &[&str], task: Option<&str>) -> std::process::Output {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../experiments/sweep-shards.sh");
    let mut command = Command::new("sh");
    command.arg(path).args(args).current_dir(&folder.path).env("PXPL5", env!("CARGO_BIN_EXE_pxpl5"));
    command.env_remove("SLURM_ARRAY_TASK_ID");
    if let Some(task) = task {
        command.env("SLURM_ARRAY_TASK_ID", task);
    }
    command.output().expect("sh is there")
}

#[cfg(unix)]
#[test]
fn the_script_divides_a_sweep_into_processes_or_array_tasks_and_merges_it() {
    let folder = folder();
    succeeds(&sweep(&folder, &["--out", "whole", "--threads", "1"]));
    succeeds(&script(&folder, &["s.toml", "all", "3"], None));
    assert_eq!(lines(&folder.path.join("whole/rows.jsonl")).len(), POINTS);
    for name in ["rows.jsonl", "results.csv"] {
        assert!(read(&folder, &format!("all/{name}")) == read(&folder, &format!("whole/{name}")), "{name}");
    }
    // Runs the script as Slurm does for an array of two tasks. The last command is the user's.
    for task in ["1", "2"] {
        succeeds(&script(&folder, &["s.toml", "array", "2"], Some(task)));
    }
    succeeds(&folder.run(&["merge", "array/shard-1", "array/shard-2", "--out", "array", "--quiet"]));
    assert!(read(&folder, "array/rows.jsonl") == read(&folder, "whole/rows.jsonl"));
}

#[test]
fn the_published_sweep_has_a_few_hundred_points() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../experiments/sweep-slats.toml");
    let sweep = pxpl5::sweep::Sweep::load(path).expect("a sweep");
    assert!((200..=900).contains(&sweep.space().points()), "{}", sweep.space().points());
    (0..sweep.space().points()).for_each(|point| drop(sweep.plan(point).expect("an experiment")));
}

/// Runs the two sweeps of docs/sweeps.md whose quantity is a limit.
#[test]
fn the_page_has_the_limits_of_its_sweeps() {
    let folder = Folder::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = fs::read_to_string(root.join("docs/sweeps.md")).expect("the page");
    let rows = |name: &str| -> Vec<[u64; 3]> {
        let file = root.join(format!("experiments/sweep-{name}.toml")).display().to_string();
        succeeds(&folder.run(&["sweep", &file, "--out", name, "--quiet"]));
        let csv = read(&folder, &format!("{name}/results.csv"));
        let cells = |line: &str| {
            [2, 3, 4].map(|n| line.split(',').nth(n).and_then(|cell| cell.parse().ok()).expect("a number"))
        };
        csv.lines().skip(1).map(cells).collect()
    };
    let all = rows("cheapest");
    let mut enough: Vec<&[u64; 3]> = all.iter().filter(|[.., triangles]| *triangles >= 5_000).collect();
    enough.sort_by_key(|[gps, renderers, _]| (gps + renderers, *gps));
    let line = |[gps, renderers, triangles]: &&[u64; 3]| format!("{} {gps} {renderers} {triangles}\n", gps + renderers);
    assert!(
        page.contains(&format!("```text\n{}```", enough.iter().take(3).map(line).collect::<String>())),
        "{enough:?}"
    );
    let boards = rows("boards");
    for renderers in [5, 10, 20] {
        let cells = boards.iter().filter(|row| row[1] == renderers).map(|row| format!(" {} |", row[2]));
        assert!(page.contains(&format!("| {renderers} |{}", cells.collect::<String>())), "{boards:?}");
    }
}

/// A substitute for `sbatch`. The script records its options, and runs the submitted tasks one by one.
const SBATCH: &str = "#!/bin/bash
script=${@: -1}
echo \"$@\" >> calls
tasks=$(sed -n 's/^#SBATCH --array=1-//p' \"$script\")
if [ -n \"$tasks\" ]; then
    for task in $(seq \"$tasks\"); do SLURM_ARRAY_TASK_ID=$task bash \"$script\" >&2 || exit; done
    echo '41;a-cluster'
else
    bash \"$script\" >&2 && echo 42
fi
";

#[cfg(unix)]
#[test]
fn slurm_jobs_write_the_rows_of_the_whole_sweep() {
    let folder = folder();
    succeeds(&sweep(&folder, &["--out", "whole", "--set", "title=it's one"]));
    let written =
        folder.run(&["sweep", "s.toml", "--out", "a b", "--set", "title=it's one", "--slurm", "jobs", "--tasks", "3"]);
    succeeds(&written);
    assert!(out(&written).starts_with("3 tasks of 1 thread,") && out(&written).ends_with("bash jobs/submit.sh\n"));
    assert_eq!(names(&folder.path.join("jobs")), ["array.sh", "merge.sh", "submit.sh"]);
    assert!(!folder.path.join("a b").exists(), "nothing is run");
    for script in ["array.sh", "merge.sh", "submit.sh"] {
        let path = folder.path.join("jobs").join(script);
        assert!(Command::new("bash").arg("-n").arg(&path).status().expect("bash").success(), "{script}");
    }
    let array = read(&folder, "jobs/array.sh");
    for line in ["#SBATCH --array=1-3", "#SBATCH --cpus-per-task=1", "#SBATCH --requeue", "#SBATCH --open-mode=append"]
    {
        assert!(array.lines().any(|found| found == line), "{line}");
    }

    let sbatch = folder.file("sbatch", SBATCH);
    let executable = std::os::unix::fs::PermissionsExt::from_mode(0o755);
    fs::set_permissions(&sbatch, executable).expect("ours");
    let path = format!("{}:{}", folder.path.display(), std::env::var("PATH").expect("a path"));
    let submit = |options: &[&str]| {
        let mut submit = Command::new("bash");
        submit.arg("jobs/submit.sh").args(options).current_dir(&folder.path).env("PATH", &path).output().expect("bash")
    };
    let submitted = submit(&["--partition", "long"]);
    succeeds(&submitted);
    assert_eq!(out(&submitted), "array 41, merging 42\n");
    let calls = "--parsable --partition long array.sh\n--parsable --dependency=afterany:41 --partition long merge.sh\n";
    assert_eq!(read(&folder, "jobs/calls"), calls);
    for name in ["rows.jsonl", "results.csv"] {
        assert!(read(&folder, &format!("a b/{name}")) == read(&folder, &format!("whole/{name}")), "{name}");
    }
    // A second submission computes no point again.
    let before = read(&folder, "a b/shard-2/times.jsonl");
    succeeds(&submit(&[]));
    assert_eq!(read(&folder, "a b/shard-2/times.jsonl"), before);
}

#[test]
fn a_folder_in_use_is_distinguished_from_permanent_errors() {
    let folder = folder();
    fs::create_dir(folder.path.join("a")).expect("ours");
    let lock = fs::File::create(folder.path.join("a/.lock")).expect("ours");
    lock.lock().expect("no other thread holds it");
    let refused = sweep(&folder, &["--out", "a", "--resume"]);
    assert_eq!(refused.status.code(), Some(75));
    assert!(err(&refused).contains("another process is writing here"), "{}", err(&refused));
    drop(lock);
    succeeds(&sweep(&folder, &["--out", "a", "--resume"]));
}

#[test]
fn a_header_with_too_many_points_is_reported_as_damage() {
    let folder = folder();
    succeeds(&sweep(&folder, &["--out", "a"]));
    let rows = read(&folder, "a/rows.jsonl").replacen("\"points\":64", "\"points\":9000000000000000000", 1);
    fs::write(folder.path.join("a/rows.jsonl"), rows).expect("ours");
    let output = folder.run(&["merge", "a", "--out", "b"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(err(&output).contains("a/rows.jsonl, line 1: "), "{}", err(&output));
}

/// Two fields of Slats need 5 renderers; the analytic level and a run without a head evaluate no pixel.
#[test]
fn every_row_of_a_sweep_counts_due_pictures_missed_pictures_and_evaluated_pixels() {
    let folder = folder();
    folder.file(
        "s.toml",
        "pipeline = \"slats\"\nscene = \"full-screen:2\"\nfields = 30\nmeasure = [\"latency_ms.mean\"]\nhead.motion = \"pan:40\"\n\
         head.predict = \"none\"\n[sweep.grid]\nmachine.n_gps = [1, 2]\n",
    );
    succeeds(&folder.run(&["sweep", "s.toml", "--out", "o"]));
    let csv = read(&folder, "o/results.csv");
    let mut lines = csv.lines();
    let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let number =
            |name: &str| cells[names.iter().position(|it| *it == name).expect(name)].parse::<f64>().expect(name);
        assert!(number("pictures_due") > 0.0 && number("error_px.n") > 0.0, "{line}");
        assert_eq!(number("missed_retraces"), 0.0, "{line}");
    }
}
