//! Runs all published conformance vectors.

use flate2::read::GzDecoder;
use i860::{Config, vectors};
use std::io::Read;

fn open_vectors() -> Vec<vectors::TestVector> {
    let packed = include_bytes!("data/i860-open.jsonl.gz");
    let mut text = String::new();
    GzDecoder::new(packed.as_slice()).read_to_string(&mut text).expect("the file is gzip");
    vectors::parse(&text).expect("the file holds vectors")
}

fn assert_all_pass(config: Config) {
    let summary = vectors::run(&open_vectors(), config);
    let shown: Vec<String> =
        summary.failures.iter().take(20).map(|(id, what, why)| format!("{id} {what}: {why}")).collect();
    assert_eq!((summary.passed, summary.failed()), (2175, 0), "\n{}", shown.join("\n"));
}

#[test]
fn every_vector_ends_with_its_expected_registers_and_memory() {
    assert_all_pass(Config::functional());
}

#[test]
fn counting_clocks_changes_no_result() {
    assert_all_pass(Config::cycle());
}
