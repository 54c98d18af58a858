//! All rows, experiment by experiment.

use super::experiments::{Experiments, Fit};
use super::fit::{RATE_FITTED, RATES_HZ};
use super::row::{Row, Standing};
use priority_rendering::{draws_per_s, saved_percent};

/// Segments drawn, with segmentation and without (table 2).
const SEGMENTS: [[u64; 4]; 2] = [[87, 14, 20, 62], [160, 8, 3, 42]];

/// Rows of E1 to E9; those of E1 that need a machine are not among them.
#[must_use]
pub fn rows(all: &Experiments) -> Vec<Row> {
    let experiments = [
        ("E1", rotation(all)),
        ("E2", composition(all)),
        ("E3", sizes(all)),
        ("E4", reductions(all)),
        ("E5", table_1(all)),
        ("E6", table_2(all)),
        ("E7", tears(all)),
        ("E8", slowed(all)),
        ("E9", lens(all)),
    ];
    let named = experiments.into_iter().flat_map(|(name, rows)| rows.into_iter().map(move |row| row.of(name)));
    named.collect()
}

fn rotation(all: &Experiments) -> Vec<Row> {
    let render = |part: &str| all.walks[0].report.rotation_latency_ms.parts.get(part).copied().flatten().unwrap_or(0.0);
    let rendered = render("render") + render("retrace");
    let pipeline_us = all.walks[0].report.pipeline_ns / 1e3;
    let share = "share of rendering and buffer swap in rotational latency";
    let known = "orientation is known before an update's first pixel (less than)";
    vec![
        Row::number("A4", share, "ms", [0.0, rendered], Standing::Checked),
        Row::limit("A17", known, "us", [1.0, pipeline_us], pipeline_us < 1.0),
    ]
}

fn composition(all: &Experiments) -> Vec<Row> {
    let statement = "texels of the composite of four memories drawn from one place that are not those of one memory (fig. 2, 12, 14)";
    vec![Row::number("fig. 2", statement, "texels", [0.0, all.composite_differs as f64], Standing::Checked)]
}

fn sizes(all: &Experiments) -> Vec<Row> {
    let statement = "size over distance above which size may decide (discs: never)";
    vec![Row::number("A8", statement, "1", [10.0, first_size(all)], Standing::Checked)]
}

/// The least size over distance of a sphere at which its size decides.
fn first_size(all: &Experiments) -> f64 {
    let deciding = all.sizes.iter().find(|row| row.size_s[1] < row.translation_s);
    deciding.map_or(f64::INFINITY, |row| row.size_over_distance)
}

fn reductions(all: &Experiments) -> Vec<Row> {
    let ratios = &all.walks[0].tally.memories;
    let falls = ratios.windows(2).all(|pair| pair[0].updates >= pair[1].updates);
    let fastest = all.walks[0].report.memories[0].updates_hz;
    let statements = [
        "fewer draws of point objects, 4 memories at 1 m/s (expected 6.01; printed: an order of magnitude)",
        "fewer draws of point objects, 5 memories at 0.37 m/s (expected 13.40)",
    ];
    let harmonics = "rate of the fastest memory; each further one is slower";
    let mut rows = vec![Row::shape("A5", harmonics, "Hz", [60.0, fastest], falls && fastest == 60.0)];
    for (i, expected) in [6.01, 13.40].into_iter().enumerate() {
        rows.push(Row::number("A18", statements[i], "1", [expected, all.reductions[i]], Standing::Checked));
    }
    rows
}

/// Table 1, and what follows from it alone.
fn table_1(all: &Experiments) -> Vec<Row> {
    let mut rows: Vec<Row> = (0..4).map(|memory| rate(all, memory)).collect();
    let periods = [(1.0, 16.67), (1.529, 25.48), (2.127, 35.45), (3.715, 61.92)];
    for (memory, (frames, mm)) in periods.into_iter().enumerate() {
        let period = format!("mean period of memory {memory}");
        let way = format!("way walked in one period of memory {memory}");
        rows.push(Row::number("D1", &period, "frames", [frames, 60.0 / RATES_HZ[memory]], Standing::Formula));
        rows.push(Row::number("D1", &way, "mm", [mm, 1e3 / RATES_HZ[memory]], Standing::Formula));
    }
    rows
}

fn rate(all: &Experiments, memory: usize) -> Row {
    let standing = if memory == RATE_FITTED { Standing::Fitted } else { Standing::Checked };
    let Fit { cell_m, rates_hz, .. } = &all.fits[1];
    let statement = format!("update rate of memory {memory} (q = 1, cells of {cell_m:.1} m)");
    Row::number("A12", &statement, "Hz", [RATES_HZ[memory], rates_hz[memory]], standing)
}

fn table_2(all: &Experiments) -> Vec<Row> {
    let mut rows = Vec::new();
    let ours = [0, 2].map(|walk: usize| {
        let memories = all.walks[walk].report.memories.iter();
        memories.map(|memory| memory.segments).collect::<Vec<f64>>()
    });
    let moves_outwards = ours[0][0] < ours[1][0];
    for (i, (id, kind)) in [("A13", "cut"), ("A14", "uncut")].into_iter().enumerate() {
        for memory in 0..4 {
            let statement = format!("segments in memory {memory}, {kind} (ours: mean of all frames)");
            let both = [SEGMENTS[i][memory] as f64, ours[i][memory]];
            rows.push(Row::shape(id, &statement, "1", both, moves_outwards));
        }
    }
    let draws = [0, 2].map(|walk: usize| all.walks[walk].report.priority.draws_per_s);
    let saves = draws[0] < draws[1];
    rows.push(Row::shape("D3", "draws a second, cut", "1/s", [7_335.0, draws[0]], saves));
    rows.push(Row::shape("D3", "draws a second, uncut", "1/s", [10_676.93, draws[1]], saves));
    rows.push(Row::shape("D3", "saved by cutting", "%", [31.3, saved_percent(draws[0], draws[1])], saves));
    let saved = [0, 2].map(|walk: usize| all.walks[walk].report.priority.saved_percent);
    rows.push(Row::shape("D4", "saved against all at 60 Hz, cut", "%", [33.197, saved[0]], saved[0] > saved[1]));
    rows.push(Row::shape("D4", "saved against all at 60 Hz, uncut", "%", [16.456, saved[1]], saved[0] > saved[1]));
    let in_first = 100.0 * (1.0 - ours[0][0] / ours[1][0]);
    rows.push(Row::shape("D5", "saved in memory 0", "%", [45.6, in_first], in_first > 0.0));
    rows.extend(printed_in_table_2());
    rows
}

/// What follows from tables 1 and 2 alone.
fn printed_in_table_2() -> Vec<Row> {
    let mut rows = Vec::new();
    let kinds = [("A13", "cut", 183.0, 7_335.0, 33.2), ("A14", "uncut", 213.0, 10_676.9, 16.5)];
    for (segments, (id, kind, sum, draws, saved)) in SEGMENTS.iter().zip(kinds) {
        let all = segments.iter().sum::<u64>() as f64;
        let ours = draws_per_s(&RATES_HZ, segments);
        let row = |id, statement: &str, unit, both| Row::number(id, statement, unit, both, Standing::Formula);
        rows.push(row("D2", &format!("sum of {id}"), "1", [sum, all]));
        rows.push(row("D3", &format!("sum of A12 x {id}"), "1/s", [draws, ours]));
        rows.push(row("D4", &format!("saved by table 2, {kind}"), "%", [saved, saved_percent(ours, all * 60.0)]));
    }
    let first = saved_percent(SEGMENTS[0][0] as f64, SEGMENTS[1][0] as f64);
    rows.push(Row::number("D5", "saved in memory 0 by table 2", "%", [45.6, first], Standing::Formula));
    rows
}

fn tears(all: &Experiments) -> Vec<Row> {
    let widest = |walk: usize| all.walks[walk].report.tears_px.after.map_or(0.0, |tears| tears.max);
    let [torn, warped, uncut] = [0, 1, 2].map(widest);
    let before = "widest tear before warping (printed: \"a few\")";
    let after = "widest tear left after warping, with cascade";
    vec![
        Row::shape("A15", before, "texels", [3.0, torn], torn > 0.5 && torn < 5.0),
        Row::limit("A16", after, "texels", [0.0, warped], warped < 1e-6),
        Row::number("fig. 15", "widest tear without segmentation", "texels", [0.0, uncut], Standing::Checked),
    ]
}

fn slowed(all: &Experiments) -> Vec<Row> {
    let rising = |missed: &[u64]| missed.windows(2).all(|pair| pair[0] <= pair[1]);
    let ordered = all.slowed.iter().all(|slowed| rising(&slowed.missed));
    let misses = all.slowed.iter().filter(|slowed| slowed.missed.last() > Some(&0)).count();
    let first = format!(
        "renderers of {} that are too slow for memory 3; faster memories never miss more often",
        all.slowed.len()
    );
    let turned = "pixels that a stalled renderer changes in what is seen after turns of 12, 90 and 180 degrees";
    vec![
        Row::shape("2.1", &first, "1", [f64::NAN, misses as f64], ordered && misses > 0),
        Row::number("2.1", turned, "px", [0.0, all.turned_differ as f64], Standing::Checked),
    ]
}

fn lens(all: &Experiments) -> Vec<Row> {
    let [screen, seen] = all.lens_px;
    let bent = "bend of a straight edge on the screen before a lens of k1 = 0.32";
    let straight = "the same as it is seen through that lens (less than a pixel: straight)";
    vec![
        Row::shape("RP93", bent, "px", [f64::NAN, screen], screen > 1.0),
        Row::limit("RP93", straight, "px", [0.0, seen], seen < 1.0),
    ]
}
