use super::*;
use crate::experiment_file::ExperimentFile;
use crate::study::Study;
use crate::study::tests::StopsAfter;
use std::collections::BTreeSet;
use tempfile::tempdir;

const BASE: &str =
    "pipeline = \"slats\"\nscene = \"full-screen:4\"\nfields = 10\nmeasure = [\"latency_ms.mean\", \"last_copy_ms\"]\n";

fn sweep(space: &str) -> Sweep {
    Sweep::new(ExperimentFile::parse(&format!("{BASE}{space}"), "test").expect("TOML")).expect("a sweep")
}

fn refusal(space: &str) -> String {
    let file = ExperimentFile::parse(&format!("{BASE}{space}"), "test").expect("TOML");
    Sweep::new(file).expect_err("no sweep").to_string()
}

fn rows(store: &mut Store, points: u64) -> Vec<SweepRow> {
    (0..points).map(|point| store.row(point).expect("readable").expect("finished")).collect()
}

fn all(sweep: &Sweep, store: &mut Store) {
    let options = RunOptions { shard: Shard::ALL, threads: 2 };
    SweepQuery::new(sweep, store, options).run(&mut ()).expect("it runs");
}

#[test]
fn the_points_are_all_combinations_each_once_and_the_last_axis_changes_fastest() {
    let sweep = sweep(
        "[sweep]\nseeds = 2\n[sweep.grid]\ncopy = [\"whole\", \"split\"]\ntriangles = {from = 1, to = 4, step = 2}\n",
    );
    let points: Vec<String> = (0..sweep.space().points()).map(|p| format!("{:?}", sweep.space().settings(p))).collect();
    assert_eq!(points.len(), 2 * 2 * 2);
    assert_eq!(points.iter().collect::<BTreeSet<_>>().len(), 8);
    let first = sweep.space().settings(0);
    let second = sweep.space().settings(1);
    assert_eq!(
        (first["copy"].as_str(), first["triangles"].as_integer(), first["seed"].as_integer()),
        (Some("whole"), Some(1), Some(1))
    );
    assert_eq!((second["triangles"].as_integer(), second["seed"].as_integer()), (Some(1), Some(2)));
}

#[test]
fn settings_in_the_table_together_form_one_axis_of_a_sweep() {
    let sweep = sweep("[sweep.together]\nmachine.n_gps = [1, 2]\nmachine.n_renderers = [5, 10]\n");
    let plans: Vec<_> = (0..2).map(|point| sweep.plan(point).expect("valid").machine).collect();
    assert_eq!((plans[0].n_gps, plans[0].n_renderers, plans[1].n_gps, plans[1].n_renderers), (1, 5, 2, 10));
    assert_eq!(sweep.space().points(), 2);
}

#[test]
fn a_header_lists_version_settings_quantities_and_axes_one_per_line() {
    let sweep = sweep("[sweep.grid]\nseed = [1, 2]\n");
    let header = sweep.header().expect("valid");
    let first = sweep.plan(0).expect("valid").fingerprint();
    let lines = [
        format!("version={}\nfirst={first}\n", header.version),
        "fields=10\nmeasure=[\"latency_ms.mean\",\"last_copy_ms\"]\npipeline=\"slats\"\nscene=\"full-screen:4\"\n"
            .to_owned(),
        "measure=latency_ms.mean\nmeasure=last_copy_ms\nmeasure=missed_retraces\nmeasure=pictures_due\nmeasure=error_px.n\naxis=seed\nstep=[1]\nstep=[2]\n".to_owned(),
    ];
    let expected = pxpl5_run::Fingerprint::of(lines.concat().as_bytes());
    assert_eq!(header.config_hash, expected.to_string());
}

#[test]
fn an_invalid_space_is_refused() {
    for (space, says) in [
        ("", "sweep is missing"),
        ("[sweep]", "at least one setting"),
        ("[sweep]\ngird = {seed = [1]}", "did you mean `sweep.grid`"),
        ("[sweep.grid]\nseeed = [1]", "did you mean `seed`"),
        ("[sweep.grid]\nseed = []", "a list with values"),
        ("[sweep.grid]\nseed = {from = 3, to = 1}", "from <= to"),
        ("[sweep.grid]\nseed = {from = 1, to = 9, stop = 2}", "whole numbers"),
        ("[sweep.grid]\nseed = {from = 0, to = 9223372036854775807}", "at most 10000000"),
        ("[sweep]\nseeds = 3\n[sweep.grid]\nseed = [1]", "found two"),
        ("[sweep.together]\nseed = [1, 2]\ntriangles = [1]", "2 values"),
        ("[sweep.grid]\nseed = {from = 1, to = 9999}\ntriangles = {from = 1, to = 9999}", "at most 10000000"),
    ] {
        let text = refusal(space);
        assert!(text.contains(says), "{space}: {text}");
        assert!(space.is_empty() || text.contains("test, line "), "{text}");
    }
}

#[test]
fn an_error_of_a_sweep_names_the_line_of_its_key() {
    // Four lines of shared settings come before the space.
    for (space, line) in [
        ("[sweep]", 5),
        ("[sweep.grid]\n\nseeed = [1]", 7),
        ("[sweep]\nseeds = 3\n[sweep.grid]\nfields = [9]\nseed = []", 9),
        ("[sweep.grid]\nfields = [9]\n[sweep.together]\nseed = [1, 2]\ntriangles = [1]", 9),
        ("[sweep]\n\nseeds = 0", 7),
        ("[sweep]\nseeds = 1\ngird = {seed = [1]}", 7),
    ] {
        let text = refusal(space);
        assert!(text.starts_with(&format!("test, line {line}: ")), "{space}: {text}");
    }
}

#[test]
fn shards_are_disjoint_and_cover_all_points() {
    let shards: Vec<Shard> = (1..=7).map(|i| Shard::new(i, 7).expect("one of seven")).collect();
    assert!((0..1_000).all(|point| shards.iter().filter(|shard| shard.holds(point)).count() == 1));
    for points in [0, 1, 6, 7, 1_000] {
        assert!(
            shards.iter().all(|s| s.share_of(points) == (0..points).filter(|point| s.holds(*point)).count() as u64)
        );
    }
    assert_eq!((Shard::new(0, 7), Shard::new(8, 7)), (None, None));
}

#[test]
fn a_failed_point_is_recorded_and_the_others_continue() {
    // Slats binds 20 regions, four to a renderer. Fewer than five renderers cannot hold them.
    let sweep = sweep("[sweep.grid]\nmachine.n_renderers = [0, 4, 5]\n");
    let path = tempdir().expect("a folder");
    let mut store = Store::open(path.path(), sweep.header().expect("a valid point"), false).expect("writable");
    all(&sweep, &mut store);
    let rows = rows(&mut store, 3);
    let statuses: Vec<Status> = rows.iter().map(|row| row.status).collect();
    assert_eq!(statuses, [Status::Failed, Status::Failed, Status::Done]);
    assert!(rows[0].error.as_deref().is_some_and(|e| e.contains("n_renderers must be 1 to 1000, found 0")));
    assert!(rows[1].error.as_deref().is_some_and(|e| e.contains("expected at least 5 renderers")));
    // I3D95: COPY of half of the regions takes 3.9 ms.
    let half = rows[2].measured["last_copy_ms"].expect("it is copied");
    assert!((half / 3.9 - 1.0).abs() < 0.02, "{half} ms");
}

#[test]
fn rows_are_read_and_written_bit_for_bit() {
    let sweep = sweep("[sweep]\nseeds = 3\n");
    let path = tempdir().expect("a folder");
    let mut store = Store::open(path.path(), sweep.header().expect("valid"), false).expect("writable");
    all(&sweep, &mut store);
    let before = rows(&mut store, 3);
    drop(store);
    let mut store = Store::open(path.path(), sweep.header().expect("valid"), true).expect("ours");
    assert_eq!(rows(&mut store, 3), before);
    store.finish().expect("writable");
    let text = std::fs::read_to_string(path.path().join(ROWS_FILE)).expect("written");
    let lines: Vec<String> = before.iter().map(|row| serde_json::to_string(row).expect("JSON")).collect();
    assert_eq!(text.lines().skip(1).collect::<Vec<_>>(), lines);
}

#[test]
fn a_file_cut_at_any_byte_is_repaired_and_continued_to_the_same_bytes() {
    let sweep = sweep("[sweep]\nseeds = 2\n");
    let path = tempdir().expect("a folder");
    let header = sweep.header().expect("valid");
    let mut store = Store::open(path.path(), header.clone(), false).expect("writable");
    all(&sweep, &mut store);
    store.finish().expect("writable");
    let whole = std::fs::read(path.path().join(ROWS_FILE)).expect("written");
    let ends: Vec<usize> = whole.iter().enumerate().filter(|(_, b)| **b == b'\n').map(|(at, _)| at + 1).collect();
    for cut in (0..whole.len()).step_by(37).chain(ends) {
        std::fs::write(path.path().join(ROWS_FILE), &whole[..cut]).expect("writable");
        let mut store = Store::open(path.path(), header.clone(), true).expect("only the end is torn");
        all(&sweep, &mut store);
        store.finish().expect("writable");
        assert!(std::fs::read(path.path().join(ROWS_FILE)).expect("written") == whole, "cut at {cut}");
    }
}

#[test]
fn only_one_process_may_write_into_a_folder() {
    let sweep = sweep("[sweep]\nseeds = 1\n");
    let path = tempdir().expect("a folder");
    let header = sweep.header().expect("valid");
    let first = Store::open(path.path(), header.clone(), false).expect("writable");
    let error = Store::open(path.path(), header.clone(), true).expect_err("in use");
    assert!(error.to_string().contains("another process"), "{error}");
    drop(first);
    Store::open(path.path(), header, true).expect("free again");
}

#[test]
fn files_named_in_a_sweep_file_or_in_its_axes_are_found_beside_the_sweep_file() {
    let place = tempdir().expect("a folder");
    let poses = "time_s,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n9,0,0,0,1,0,0,0\n";
    for name in ["base.csv", "axis.csv"] {
        std::fs::write(place.path().join(name), poses).expect("written");
    }
    let text = format!(
        "{BASE}head.motion = \"base.csv\"\n[sweep.grid]\nhead.motion = [\"base.csv\", \"axis.csv\"]\nseed = [1, 2]\n"
    );
    let path = place.path().join("sweep.toml");
    std::fs::write(&path, text).expect("written");
    let sweep = Sweep::load(&path).expect("a sweep");
    for point in 0..4 {
        let plan = sweep.plan(point).unwrap_or_else(|error| panic!("point {point}: {error}"));
        assert!(plan.head.is_some());
    }
}

/// Tests that a sweep stores ranges and not their values. An earlier version stored the values, and needed 9 GB for 13
/// axes of ten million values.
#[test]
fn a_sweep_stores_ranges_without_memory_for_each_value() {
    let keys = "gp.triangle_ns gp.message_ns gp.bin_entry_ns gp.sphere_ns gp.edit_ns gp.pass_ns ring.word_ns";
    let axes = keys.split(' ').map(|key| format!("machine.{key} = {{ from = 1, to = 10000000 }}\n"));
    let axes: String = axes.collect();
    let text = refusal(&format!("[sweep.grid]\n{axes}"));
    assert!(text.contains("at most 10000000 points"), "{text}");
    let seeds = sweep("[sweep]\nseeds = 10000000\n");
    assert_eq!(seeds.space().points(), 10_000_000);
    assert_eq!(seeds.space().settings(9_999_999)["seed"].as_integer(), Some(10_000_000));
    assert!(matches!(seeds.space().axes()[0].values[..], [AxisValues::Range { from: 1, step: 1, count: 10_000_000 }]));
    let header = serde_json::to_string(&seeds.header().expect("a valid point")).expect("JSON");
    assert!(header.contains("\"ranges\":[[1,1,10000000]]") && header.len() < 10_000, "{} bytes", header.len());
    let read: Header = serde_json::from_str(&header).expect("as it was written");
    assert_eq!(read, seeds.header().expect("a valid point"));
}

#[test]
fn a_range_and_a_list_can_form_one_axis() {
    let sweep = sweep("[sweep.together]\nseed = { from = 3, to = 7, step = 2 }\ntriangles = [4, 2, 1]\n");
    let seeds: Vec<_> = (0..3).map(|point| sweep.space().settings(point)["seed"].as_integer()).collect();
    assert_eq!(seeds, [Some(3), Some(5), Some(7)]);
}

#[test]
fn a_row_that_belongs_to_no_point_is_refused() {
    let sweep = sweep("[sweep]\nseeds = 2\n");
    let path = tempdir().expect("a folder");
    let header = sweep.header().expect("valid");
    let mut store = Store::open(path.path(), header.clone(), false).expect("writable");
    all(&sweep, &mut store);
    drop(store);
    let rows = std::fs::read_to_string(path.path().join(ROWS_FILE)).expect("written");
    let line = rows.lines().position(|line| line.contains("\"point\":1,")).expect("there") + 1;
    std::fs::write(path.path().join(ROWS_FILE), rows.replace("\"point\":1,", "\"point\":9999,")).expect("ours");
    let error = Store::open(path.path(), header, true).expect_err("no such point").to_string();
    assert!(error.ends_with(&format!("line {line}: expected a row of a sweep, found point 9999 of 2")), "{error}");
}

#[test]
fn only_temporary_files_of_a_killed_process_are_removed() {
    let sweep = sweep("[sweep]\nseeds = 1\n");
    let path = tempdir().expect("a folder");
    for name in [".pxpl5-a1B2c3.tmp", "mine.tmp", ".pxpl5-mine"] {
        std::fs::write(path.path().join(name), "x").expect("writable");
    }
    drop(Store::open(path.path(), sweep.header().expect("valid"), false).expect("writable"));
    let entries = std::fs::read_dir(path.path()).expect("there").map(|entry| entry.expect("entry").file_name());
    let names: BTreeSet<_> = entries.map(|name| name.to_string_lossy().into_owned()).collect();
    let expected = [".lock", ".pxpl5-mine", "manifest.json", "mine.tmp", "rows.jsonl", "times.jsonl"];
    assert_eq!(names, expected.map(str::to_owned).into());
}

/// Returns two sweeps with the model `file`: as the scene of all points, and as a value of an axis.
fn sweeps_with(file: &str) -> [String; 2] {
    [
        format!("pipeline = \"slats\"\nscene = \"{file}\"\nfields = 10\n[sweep]\nseeds = 2\n"),
        format!("pipeline = \"slats\"\nfields = 10\n[sweep.grid]\nscene = [\"mig\", \"{file}\"]\n"),
    ]
}

/// Returns the hash of a sweep whose file lies in the folder `place`.
fn hash_in(place: &Path, text: &str) -> String {
    let path = place.join("sweep.toml");
    std::fs::write(&path, text).expect("written");
    Sweep::load(&path).expect("a sweep").header().expect("valid").config_hash
}

#[test]
fn editing_the_model_file_changes_the_hash_of_a_sweep() {
    let place = tempdir().expect("a folder");
    let model = |x: i32| {
        std::fs::write(place.path().join("m.obj"), format!("v 0 0 0\nv {x} 0 0\nv 0 1 0\nf 1 2 3\n")).expect("written")
    };
    for text in sweeps_with("m.obj") {
        model(1);
        let before = hash_in(place.path(), &text);
        assert_eq!(before, hash_in(place.path(), &text));
        model(2);
        assert_ne!(before, hash_in(place.path(), &text), "{text}");
    }
}

/// Tests that a change of a glTF scene's binary file changes the hash of a sweep, although the glTF file stays the
/// same. A build without the glTF reader cannot read the scene and keeps the hash.
#[test]
fn editing_the_buffer_file_of_a_model_changes_the_hash_of_a_sweep() {
    let place = tempdir().expect("a folder");
    let triangle = r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"m.bin"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[9,9,0]}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}]}"#;
    std::fs::write(place.path().join("m.gltf"), triangle).expect("written");
    let hash_of = |text: &str, x: f32| {
        let corners: Vec<u8> = [0., 0., 0., x, 0., 0., 0., 1., 0.].iter().flat_map(|n: &f32| n.to_le_bytes()).collect();
        std::fs::write(place.path().join("m.bin"), corners).expect("written");
        hash_in(place.path(), text)
    };
    for text in sweeps_with("m.gltf") {
        let before = hash_of(&text, 1.0);
        assert_eq!(before, hash_of(&text, 1.0));
        // The reader of glTF is a feature of the scene crate.
        let read = pxpl5_scene::load(place.path().join("m.gltf"));
        let is_read = read.is_ok_and(|scene| !scene.triangles().is_empty());
        assert_eq!(before != hash_of(&text, 2.0), is_read, "{text}");
    }
}

#[test]
fn a_stopped_sweep_keeps_its_finished_rows_and_continues_to_the_same_rows() {
    let sweep = sweep("[sweep.grid]\nseed = [1, 2, 3, 4, 5, 6, 7, 8]\n");
    let folders = [0, 1].map(|_| tempdir().expect("a folder"));
    let open = |n: usize| Store::open(folders[n].path(), sweep.header().expect("valid"), true).expect("a folder");
    let mut whole = open(0);
    all(&sweep, &mut whole);
    // A sweep that was stopped before it began has no row.
    let mut store = open(1);
    let mut watcher = StopsAfter::default();
    let options = RunOptions { shard: Shard::ALL, threads: 1 };
    assert_eq!(SweepQuery::new(&sweep, &mut store, options).run(&mut watcher).expect("it stops"), 0);
    // A stop after the second row leaves rows without a result. No row says that its run was stopped.
    let mut watcher = StopsAfter { parts: 2, ..StopsAfter::default() };
    let found = SweepQuery::new(&sweep, &mut store, options).run(&mut watcher).expect("it stops");
    assert!((2..8).contains(&found) && found == watcher.rows && store.failed(Shard::ALL).count() == 0);
    all(&sweep, &mut store);
    assert_eq!(rows(&mut store, 8), rows(&mut whole, 8));
}
