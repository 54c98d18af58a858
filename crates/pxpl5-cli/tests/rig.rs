//! Tests of `pxpl5 rig` as a user runs it.

use crate::support::Folder;

#[test]
fn external_and_internal_latencies_are_printed_with_count_and_spread() {
    let folder = Folder::new();
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
