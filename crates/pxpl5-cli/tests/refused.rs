//! Tests of wrong inputs of every command: the exit code, the reason, and that nothing is printed or written.

use crate::support::{Folder, err, out, words};

/// Asserts that a command line is refused with the exit code `code`, and that standard error contains all texts in
/// `says`, which bars separate. A line of options alone belongs to a run of Slats.
#[track_caller]
fn refused(folder: &Folder, line: &str, code: i32, says: &str) {
    let before = folder.names();
    let run = "run --pipeline slats --scene full-screen:10 ";
    let line = if line.starts_with("--") { run.to_owned() + line } else { line.to_owned() };
    let args = words(&line);
    let output = folder.run(&args.iter().map(String::as_str).collect::<Vec<_>>());
    let text = err(&output);
    assert_eq!(output.status.code(), Some(code), "{line}: {text}");
    says.split('|').for_each(|part| assert!(text.contains(part), "{line} should say {part:?}: {text}"));
    assert!(!text.contains("panicked") && !text.contains('\u{1b}'), "{line}: {text}");
    assert_eq!((out(&output), folder.names()), (String::new(), before), "{line}");
}

/// Writes one wrong file for each reader.
fn wrong_files() -> Folder {
    let folder = Folder::new();
    folder.file("bad.toml", "pipeline = \"slats\"\nsceen = \"mig\"");
    folder.file("byte.toml", b"pipeline = \"slats\"\nscene = \"mig\"\n# caf\xe9\n");
    folder.file("name.toml", b"scene = \"caf\xe9\"\n");
    folder.file("escape.toml", "pipeline = \"slats\"\nscene = \"\\u001b]0;title\\u0007.obj\"\n");
    folder.file("run.toml", "pipeline = \"slats\"\nscene = \"mig\"\n");
    folder.file("s.toml", "pipeline = \"slats\"\nscene = \"mig\"\n[sweep.grid]\nseed = [1, 2]\n");
    folder.file("grid.toml", "scene = \"mig\"\n");
    folder.file("key.toml", "[sweep.grid]\nclip.bias = [1]\n");
    folder.file("range.toml", "[sweep.grid]\ntile.size = { from = 3, to = 1 }\n");
    folder.file("measure.toml", "measure = [\"lit\"]\n[sweep.grid]\ntile.size = [8]\n");
    folder.file("host.toml", "measure = [\"host_seconds\"]\n[sweep.grid]\ntile.size = [8]\n");
    folder.file("bad.obj", "v 1 2\nf 1 1 1\n");
    folder.file("index.obj", "v -1 -1 -5\nv 1 0 -5\nv 0 1 -5\nf 1 2 9\n");
    folder.file("late.csv", "time_s,x,y,z,qw,qx,qy,qz\n20,0,0,0,1,0,0,0\n20.1,0,0,0,1,0,0,0\n");
    folder.file("byte.csv", b"time_s,x,y,z\n\xe9");
    folder.file("head.bvh", "HIERARCHY\n");
    folder.file("zero.s", "start: adds 010, r0, r4\n");
    folder.file("nop.s", "nop\nnop 5\n");
    folder.file("byte.txt", b"show time\n\xe9\n");
    folder
}

#[test]
fn every_wrong_input_ends_with_exit_code_2_and_the_reason() {
    let folder = wrong_files();
    for (line, says) in [
        // Options that do not belong to the pipeline, or exclude each other.
        ("--mono", "--mono|does not apply to the pipeline slats"),
        ("run --pipeline rendering-control --scene mig --copy whole", "--copy|to the pipeline rendering-control"),
        ("run --pipeline rendering-control --scene mig --code 1994", "--code|to the pipeline rendering-control"),
        ("run --pipeline rendering-control --scene mig --binning all", "--binning|to the pipeline rendering-control"),
        ("--code 1995 --set gp.triangle_ns=1000", "machine.gp.triangle_ns|code = 1995|leave one out"),
        ("check --pipeline slats --scene mig --no-fit", "--no-fit"),
        ("rig --pipeline slats --scene mig", "does not apply to the rig"),
        ("rig --pipeline slats --head pan:200", "does not apply to the rig"),
        ("rig --pipeline slats --fields 60", "does not apply to the rig"),
        ("rig --pipeline slats --aim retrace", "does not apply to the rig"),
        ("rig --pipeline arp-full-line --tracker ideal --passes 2", "whose frames a photodiode can distinguish"),
        ("rig --pipeline frameless --tracker ideal --passes 2", "whose frames a photodiode can distinguish"),
        ("compare --pipeline slats", "pxpl5 run --pipeline"),
        ("run s.toml", "describes a sweep"),
        ("sweep run.toml --out o", "sweep is missing"),
        ("volume view --latency 5 --out o.png", "--head"),
        // Missing options.
        ("run --pipeline slats", "scene is missing|pxpl5 scenes"),
        ("run --scene mig", "pipeline is missing"),
        ("sweep s.toml", "--out"),
        ("merge --out o", "<DIR>"),
        ("debug --pipeline slats --scene full-screen:2", "expected --do COMMANDS or --do-file FILE"),
        // Names.
        ("rum", "rum|run"),
        ("--machine slat", "--machine|`slat`|`slats`"),
        ("--set gp.triangel_ns=1", "--set|`gp.triangle_ns`"),
        ("--set gp=3", "did you mean `gp."),
        ("--set gp.tri=3", "did you mean `gp.triangle_ns`"),
        ("--set machine.gp=3", "did you mean `machine.gp."),
        ("--copy splitt", "--copy|whole, split|did you mean `split`?"),
        ("run --pipeline slat --scene mig", "rendering-control, slats|did you mean `slats`?"),
        ("run --pipeline slats --scene mgi", "`mgi`|did you mean `mig`?"),
        ("--head jumped", "there is no motion `jumped`"),
        ("compare --head dance", "expected still, pan:DEG_PER_S"),
        ("compare --only slats,vdtr", "there is no row `vdtr`; did you mean `vdrt`?"),
        ("limit --scene mig --over gps", "there is no key `gps`"),
        ("volume run --clip cone", "--clip|prism, user-planes|cone"),
        ("volume run --projection fisheye", "--projection|orthographic|fisheye"),
        ("volume run --set clip.bias=1", "clip.bias|did you mean"),
        ("volume run --set gp=3", "did you mean `gpu."),
        ("volume view --head jump --out o", "synthetic:SEED"),
        // Numbers.
        ("--renderers 0", "n_renderers must be 1 to 1000, found 0"),
        ("--gps -1", "--gps|whole number|found -1"),
        ("run --pipeline rendering-control --scene mig --gps 1", "n_gps of Rendering Control"),
        ("--fields 0", "--fields|from 1 to 10000000|0"),
        ("--fields 10000001", "--fields|from 1 to 10000000|10000001"),
        ("--fields 99999999999999999999", "--fields|from 1 to 10000000"),
        ("--seed 9223372036854775808", "--seed|from 0 to 9223372036854775807"),
        ("--triangles 0", "--triangles|from 1 to"),
        ("--threads 1025", "--threads|1025"),
        ("--threads -1", "--threads"),
        ("--threads 99999999999999999999", "from 0 to 1024"),
        ("--max-memory 0", "from 1 to 1000000000"),
        ("--set gp.triangle_ns=9223372036854775808", "from 0 to 9223372036854775807"),
        ("--set video.line_pixels=9223372036854775807", "video.line_pixels"),
        ("--set video.top_blanking=1000000", "video.top_blanking"),
        ("--set gp.memory_bytes=1000000000000", "gp.memory_bytes"),
        // The papers' pipelines for single fields draw 640 x 480 pixels on every screen.
        ("--set video.visible_pixels=639", "640 x 480|639"),
        ("run --pipeline frameless --scene mig --set video.visible_lines=239", "640 x 480|239"),
        ("run --pipeline slats --scene full-screen:0", "from 1 to 1000000"),
        ("limit --pipeline slats --fields 9", "at least 10"),
        ("limit --fields 99999999999999999999", "from 1 to 10000000"),
        ("limit --pipeline rendering-control --rate 90", "at most 59.94, the rate of the display ntsc"),
        ("compare --seeds 99999999999999999999", "from 1 to 1000"),
        ("compare --edge-pan=nan --fields 30", "edge-pan"),
        ("compare --edge-pan=inf --fields 30", "edge-pan"),
        ("compare --edge-pan=1e308 --fields 30", "edge-pan"),
        ("sweep s.toml --out o --shard 3/2", "1/8 to 8/8"),
        ("sweep s.toml --out o --shard 0/2", "found `0/2`"),
        ("volume run --set clip.bias_px2", "--set|equals sign"),
        ("volume slice 396 --out o.png", "0 to 395|396"),
        ("volume view --cut 90 --out o.png", "0:90|90"),
        ("volume view --distance 1 --out o.png", "distance|outside of the display|384"),
        ("volume view --exposure -1 --out o.png", "--exposure|above 0|-1"),
        ("volume view --head still --size 100 --out o", "multiple of 8"),
        ("volume view --head still --latency -1 --out o", "0 to 10000"),
        ("volume view --head still --seconds 0 --out o", "above 0 s"),
        // Files.
        ("run none.toml", "none.toml|readable experiment file"),
        ("run bad.toml", "bad.toml|line 2|did you mean `scene`"),
        ("run byte.toml", "byte.toml|line 3, byte 6|0xe9"),
        ("check byte.toml", "byte.toml|line 3, byte 6"),
        ("sweep byte.toml --out o", "byte.toml|line 3, byte 6"),
        ("volume sweep name.toml --out o", "name.toml|line 1, byte 13"),
        ("volume sweep grid.toml --out o", "sweep.grid"),
        ("volume sweep key.toml --out o", "clip.bias"),
        ("volume sweep range.toml --out o", "from <= to"),
        ("volume sweep measure.toml --out o", "lit_voxels"),
        ("volume sweep host.toml --out o", "host_seconds"),
        ("arp run name.toml", "name.toml|line 1, byte 13"),
        ("arp run none.toml", "cannot be read"),
        ("run escape.toml", "\\u{1b}]0;title\\u{7}.obj"),
        ("run --pipeline slats --scene none.obj", "none.obj: expected a readable file"),
        ("run --pipeline slats --scene bad.obj", "bad.obj: line 1"),
        ("run --pipeline slats --scene model.fbx", "expected an extension .ply, .obj, .stl, .gltf, .glb or .pdb"),
        ("volume run --scene bad.obj --out o", "bad.obj"),
        ("volume run --scene index.obj --out o", "index.obj"),
        ("--head byte.csv", "byte.csv|line 1: expected the columns time_s,x,y,z,qw,qx,qy,qz"),
        ("--head late.csv", "no pose from 0.000 s to 20.000 s"),
        ("--head head.bvh", "ends in .csv, .txt, .tum or .jsonl, found `head.bvh`"),
        ("volume view --head nowhere.csv --out o", "nowhere.csv"),
        ("report none", "report.json"),
        ("diff none none", "expected a report.json"),
        ("plot none --x a --y b --out p.svg", "neither rows.jsonl nor comparison.json"),
        ("i860 asm zero.s", "`010` has a leading zero"),
        ("i860 asm nop.s -o x", "nop.s:2|`nop` takes no operand"),
        ("debug --pipeline slats --scene mig --do-file none.txt", "none.txt"),
        ("debug --pipeline slats --scene mig --do-file byte.txt", "byte.txt|line 2, byte 1"),
        ("film --pipeline slats --scene mig --out z.gif", "ends in .png or .apng, found .gif"),
    ] {
        refused(&folder, line, 2, says);
    }
}

#[test]
fn a_million_triangles_do_not_fit_and_the_error_names_options_that_help() {
    let folder = Folder::new();
    let says = "GP 0|bytes|--gps|--triangles";
    refused(&folder, "run --pipeline slats --scene full-screen:1000000 --pixels off", 1, says);
}

#[test]
fn a_folder_that_cannot_be_written_is_refused_before_anything_is_computed() {
    let folder = wrong_files();
    for path in ["bad.toml", "bad.toml/below", "/proc/pxpl5"] {
        // A run of this length would take hours.
        let says = format!("{path}|cannot be written|--out");
        refused(&folder, &format!("run --pipeline slats --scene mig --fields 10000000 --out {path}"), 1, &says);
        refused(&folder, &format!("sweep s.toml --out {path}"), 1, path);
    }
}
