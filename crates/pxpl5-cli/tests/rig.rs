//! Tests of `pxpl5 rig` as a user runs it.

use crate::support::Folder;

#[test]
fn external_and_internal_latencies_are_printed_with_count_and_spread() {
    let folder = Folder::new("rig");
    let output = folder.run(&["rig", "--pipeline", "slats", "--tracker", "fastrak", "--passes", "3", "--json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON and nothing else");
    assert_eq!((&json["n"], &json["agrees"]), (&serde_json::json!(3), &serde_json::json!(true)), "{json}");
    for side in ["outside_ms", "inside_ms"] {
        for latency in ["tracking", "rendering", "total"] {
            let latency = &json[side][latency];
            assert!(latency["mean"].as_f64() > Some(0.0) && latency["sd"].as_f64() >= Some(0.0), "{json}");
            assert_eq!(latency["n"], 3);
        }
    }
    // Rendering takes one field, from TRANSFORM to the retrace.
    assert!((json["inside_ms"]["rendering"]["mean"].as_f64().expect("a number") - 16.683).abs() < 1e-3, "{json}");
}

#[test]
fn settings_that_the_rig_defines_are_refused() {
    let folder = Folder::new("rig-refused");
    for option in [["--scene", "mig"], ["--head", "pan:200"], ["--fields", "60"], ["--aim", "retrace"]] {
        let output = folder.run(&["rig", "--pipeline", "slats", option[0], option[1]]);
        assert_eq!(output.status.code(), Some(2), "{option:?}");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(message.contains("does not apply to the rig"), "{message}");
    }
}

#[test]
fn head_mounted_displays_are_refused_with_the_reason() {
    let folder = Folder::new("rig-turning");
    for pipeline in ["arp-full-line", "frameless"] {
        let output = folder.run(&["rig", "--pipeline", pipeline, "--tracker", "ideal", "--passes", "2"]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{message}");
        assert!(message.contains("expected a pipeline whose frames a photodiode can distinguish"), "{message}");
    }
}
