//! Numbers that are computed from numbers printed in the paper CPR05 (Chow, Pose and Regan, ACSC 2005). No simulation
//! could change these results, so they are no evidence for the model.

use super::fit::RATES_HZ;
use address_recalculation::ArpTiming;
use address_recalculation::priority::{draws_per_s, saved_percent};
use pxpl5_sim::figures::Definition;
use pxpl5_sim::parameters::Provenance;

/// Number of segments (parts of objects) in each display memory, from table 2 of the paper CPR05. The first row is for
/// objects that are cut at the borders of cells, and the second row for uncut objects.
pub const SEGMENTS: [[u64; 4]; 2] = [[87, 14, 20, 62], [160, 8, 3, 42]];

fn definition(id: &'static str, statement: String, value: f64, unit: &'static str) -> Definition {
    Definition { id, statement: statement.into(), source: "derived", value, unit, provenance: Provenance::Derived }
}

/// Returns all numbers that follow from printed numbers.
pub fn definitions() -> Vec<Definition> {
    let mut all = Vec::new();
    // Statements A4 and A17 follow from the order of the stages: no drawing stage lies between the latch and the light.
    let drawn = "share of rendering and buffer swap in rotational latency, by the order of the stages".to_owned();
    all.push(definition("A4", drawn, 0.0, "ms"));
    let stages =
        "from the latch to the light: 26 stages, whose clock is assumed so that this is below the printed 1 us"
            .to_owned();
    all.push(definition("A17", stages, ArpTiming::PAPERS.depth().0 as f64 / 1e6, "us"));
    // Definition D1 follows from the rates of table 1.
    for (memory, rate) in RATES_HZ.into_iter().enumerate() {
        all.push(definition("D1", format!("mean period of memory {memory}: 60 / A12"), 60.0 / rate, "frames"));
        all.push(definition("D1", format!("way walked in one period of memory {memory}: A9 / A12"), 1e3 / rate, "mm"));
    }
    // Definitions D2 to D4 follow from tables 1 and 2.
    for (segments, (id, kind)) in SEGMENTS.iter().zip([("A13", "cut"), ("A14", "uncut")]) {
        let sum = segments.iter().sum::<u64>() as f64;
        let draws = draws_per_s(&RATES_HZ, segments);
        all.push(definition("D2", format!("sum of {id}"), sum, "1"));
        all.push(definition("D3", format!("draws a second, {kind}: sum of A12 x {id}"), draws, "1/s"));
        let saved = saved_percent(draws, sum * 60.0);
        all.push(definition("D4", format!("saved against all at 60 Hz by tables 1 and 2, {kind}"), saved, "%"));
    }
    // Savings by segmentation.
    let [cut, uncut] = SEGMENTS;
    let saved = saved_percent(draws_per_s(&RATES_HZ, &cut), draws_per_s(&RATES_HZ, &uncut));
    all.push(definition("D3", "saved by cutting, by tables 1 and 2".to_owned(), saved, "%"));
    let first = saved_percent(cut[0] as f64, uncut[0] as f64);
    all.push(definition("D5", "saved in memory 0 by table 2".to_owned(), first, "%"));
    all
}
