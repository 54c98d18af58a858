//! All rows that compare published numbers with simulated numbers, by experiment.

use super::definitions::SEGMENTS;
use super::experiments::Experiments;
use super::fit::{RATE_FITTED, RATES_HZ};
use super::interpretations::PIXEL_DEG;
use super::row::{limit, row, shape};
use address_recalculation::priority::saved_percent;
use pxpl5_sim::figures::{Basis, FigureRow};

/// Returns the rows of the experiments E1 to E9. The rows of E1 that need a simulated machine are not included.
///
/// Numbers that follow from printed numbers alone are in [`definitions`](super::definitions()).
pub fn rows(all: &Experiments) -> Vec<FigureRow> {
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
    let named = experiments
        .into_iter()
        .flat_map(|(name, rows)| rows.into_iter().map(move |row| FigureRow { experiment: name, ..row }));
    named.collect()
}

fn rotation(all: &Experiments) -> Vec<FigureRow> {
    let turned = "pixels that a stalled renderer changes in what is seen after turns of 12, 90 and 180 degrees";
    vec![row("A4", turned, "px", [0.0, all.turned_differ as f64], Basis::Free)]
}

fn composition(all: &Experiments) -> Vec<FigureRow> {
    let statement = "texels of the composite of four memories drawn from one place that are not those of one memory (fig. 2, 12, 14)";
    vec![row("fig. 2", statement, "texels", [0.0, all.composite_differs as f64], Basis::Free)]
}

/// Compares statement A8 of the papers on priority rendering with the limits of size for spheres. The statement gives a
/// size of "around ten times the distance". The distance of a sphere is measured to its nearest point.
fn sizes(all: &Experiments) -> Vec<FigureRow> {
    let limits = all.size_limits.iter().map(|limit| limit.of_nearest);
    let [least, most] = [limits.clone().fold(f64::INFINITY, f64::min), limits.fold(0.0, f64::max)];
    let ours = all.size_limits.iter().find(|limit| limit.factor == 1.0).map_or(f64::NAN, |limit| limit.of_nearest);
    let statement = format!(
        "size over the distance of the nearest point above which size may decide (interpretations: {least:.1} to {most:.1})"
    );
    let of_size = row("A8", &statement, "1", [10.0, ours], Basis::Unprinted);
    vec![FigureRow { is_met: (least..=most).contains(&10.0), ..of_size }]
}

fn reductions(all: &Experiments) -> Vec<FigureRow> {
    // Statement A5 requires that slower memories have fewer updates.
    let ratios = &all.walks[0].tally.memories;
    let falls = ratios.windows(2).all(|pair| pair[0].updates >= pair[1].updates);
    let fastest = all.walks[0].report.memories[0].updates_hz;
    let statements = [
        "fewer draws of point objects, 4 memories at 1 m/s (expected 6.01; printed: an order of magnitude)",
        "fewer draws of point objects, 5 memories at 0.37 m/s (expected 13.40)",
    ];
    let harmonics = "rate of the fastest memory; each further one is slower";
    let mut rows = vec![shape("A5", harmonics, "Hz", [60.0, fastest], falls && fastest == 60.0)];
    for (i, expected) in [6.01, 13.40].into_iter().enumerate() {
        rows.push(row("A18", statements[i], "1", [expected, all.reductions[i]], Basis::Free));
    }
    rows
}

fn table_1(all: &Experiments) -> Vec<FigureRow> {
    (0..4).map(|memory| rate(all, memory)).collect()
}

fn rate(all: &Experiments, memory: usize) -> FigureRow {
    let basis = if memory == RATE_FITTED { Basis::Fitted("priority.cell_m") } else { Basis::Free };
    row(
        "A12",
        &format!("update rate of memory {memory}"),
        "Hz",
        [RATES_HZ[memory], all.fits[0].rates_hz[memory]],
        basis,
    )
}

fn table_2(all: &Experiments) -> Vec<FigureRow> {
    let mut rows = Vec::new();
    // In walk 0 the objects are cut into segments, and in walk 2 they are uncut.
    let ours = [0, 2].map(|walk: usize| {
        let memories = all.walks[walk].report.memories.iter();
        memories.map(|memory| memory.segments).collect::<Vec<f64>>()
    });
    let moves_outwards = ours[0][0] < ours[1][0];
    for (i, (id, kind)) in [("A13", "cut"), ("A14", "uncut")].into_iter().enumerate() {
        for memory in 0..4 {
            let statement = format!("segments in memory {memory}, {kind}");
            let both = [SEGMENTS[i][memory] as f64, ours[i][memory]];
            rows.push(shape(id, &statement, "1", both, moves_outwards));
        }
    }
    // Draws per second, with and without segmentation.
    let draws = [0, 2].map(|walk: usize| all.walks[walk].report.priority.draws_per_s);
    let saves = draws[0] < draws[1];
    rows.push(shape("D3", "draws a second, cut", "1/s", [7_335.0, draws[0]], saves));
    rows.push(shape("D3", "draws a second, uncut", "1/s", [10_676.93, draws[1]], saves));
    rows.push(shape("D3", "saved by cutting", "%", [31.3, saved_percent(draws[0], draws[1])], saves));
    // Savings relative to drawing everything at 60 Hz.
    let saved = [0, 2].map(|walk: usize| all.walks[walk].report.priority.saved_percent);
    rows.push(shape("D4", "saved against all at 60 Hz, cut", "%", [33.197, saved[0]], saved[0] > saved[1]));
    rows.push(shape("D4", "saved against all at 60 Hz, uncut", "%", [16.456, saved[1]], saved[0] > saved[1]));
    let in_first = 100.0 * (1.0 - ours[0][0] / ours[1][0]);
    rows.push(shape("D5", "saved in memory 0", "%", [45.6, in_first], in_first > 0.0));
    rows
}

fn tears(all: &Experiments) -> Vec<FigureRow> {
    // Walk 0 has tears, walk 1 has warped segments, and walk 2 has uncut objects.
    let widest = |walk: usize| all.walks[walk].report.tears_texels.after.map_or(0.0, |tears| tears.max);
    let [warped, uncut] = [1, 2].map(widest);
    let pixels = widest(0) * all.walks[0].settings.texel_deg() / PIXEL_DEG;
    let before =
        "widest tear before warping, 2 to 5 pixels of the display (printed: \"a few\"; the threshold was chosen so)";
    let torn = row("A15", before, "px", [3.0, pixels], Basis::Fitted("priority.theta_deg"));
    let after = "widest tear left after warping, with cascade";
    vec![
        FigureRow { is_met: (2.0..=5.0).contains(&pixels), ..torn },
        limit("A16", after, "texels", [0.0, warped], warped < 1e-6),
        row("fig. 15", "widest tear without segmentation", "texels", [0.0, uncut], Basis::Free),
    ]
}

fn slowed(all: &Experiments) -> Vec<FigureRow> {
    let rising = |missed: &[u64]| missed.windows(2).all(|pair| pair[0] <= pair[1]);
    let ordered = all.slowed.iter().all(|slowed| rising(&slowed.missed));
    let misses = all.slowed.iter().filter(|slowed| slowed.missed.last() > Some(&0)).count();
    let first = format!(
        "renderers of {} that are too slow for memory 3; faster memories never miss more often",
        all.slowed.len()
    );
    vec![shape("2.1", &first, "1", [f64::NAN, misses as f64], ordered && misses > 0)]
}

fn lens(all: &Experiments) -> Vec<FigureRow> {
    let [screen, seen] = all.lens_px;
    let bent = "bend of a straight edge on the screen before a lens of k1 = 0.32";
    let straight = "the same as it is seen through that lens (less than a pixel: straight)";
    vec![
        shape("RP93", bent, "px", [f64::NAN, screen], screen > 1.0),
        limit("RP93", straight, "px", [0.0, seen], seen < 1.0),
    ]
}
