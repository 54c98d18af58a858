//! Rows: what is printed, what comes out.

use super::experiments::{Experiments, Fit};
use super::fit::{RATE_FITTED, RATES_HZ};
use priority_rendering::{draws_per_s, saved_percent};
use serde::Serialize;

/// How a row came to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Standing {
    /// Computed from what is printed.
    Formula,
    /// Simulated, with nothing fitted to it.
    Checked,
    /// Simulated with a number that was chosen so that this row agrees.
    Fitted,
    /// Its conditions are not printed: the number cannot be reproduced, its shape is checked.
    Shape,
}

impl Standing {
    /// As the document says it.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Formula => "formula",
            Self::Checked => "checked",
            Self::Fitted => "fitted",
            Self::Shape => "cannot be reproduced, shape checked",
        }
    }
}

/// A published or derived number beside ours.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Its name in the specification.
    pub id: &'static str,
    /// What it is.
    pub statement: String,
    /// Unit of both numbers.
    pub unit: &'static str,
    /// As printed, or as derived from what is printed.
    pub published: f64,
    /// Ours.
    pub ours: f64,
    /// How it came to be.
    pub standing: Standing,
    /// Whether ours agrees: within 1 percent; of what cannot be reproduced, whether its shape is as printed.
    pub is_met: bool,
}

impl Row {
    /// Of numbers that should be the same to a percent.
    fn number(id: &'static str, statement: &str, unit: &'static str, both: [f64; 2], standing: Standing) -> Self {
        let [published, ours] = both;
        let is_met = (ours - published).abs() <= 0.01 * published.abs();
        Self { id, statement: statement.to_owned(), unit, published, ours, standing, is_met }
    }

    /// Of a number that cannot be reproduced, with what holds of its shape.
    fn shape(id: &'static str, statement: &str, unit: &'static str, both: [f64; 2], holds: bool) -> Self {
        Self { is_met: holds, ..Self::number(id, statement, unit, both, Standing::Shape) }
    }

    /// Ours against the published, percent; none of a published 0.
    #[must_use]
    pub fn error_percent(&self) -> Option<f64> {
        (self.published != 0.0).then(|| 100.0 * (self.ours / self.published - 1.0))
    }
}

/// Segments drawn, with segmentation and without (table 2).
const SEGMENTS: [[u64; 4]; 2] = [[87, 14, 20, 62], [160, 8, 3, 42]];

/// All rows, A4 to A18, then D1 to D5.
pub(super) fn rows(all: &Experiments) -> Vec<Row> {
    let mut rows = rotation(all);
    rows.extend(table_1(all));
    rows.extend(table_2(all));
    rows.extend(tears(all));
    rows.extend(limits(all));
    rows.extend(derived());
    rows
}

fn rotation(all: &Experiments) -> Vec<Row> {
    let render = |part: &str| all.walks[0].report.rotation_latency_ms.parts.get(part).copied().flatten().unwrap_or(0.0);
    let rendered = render("render") + render("retrace");
    let statement = "share of rendering and buffer swap in rotational latency";
    let first = Row::shape("A4", statement, "ms", [0.0, rendered], rendered == 0.0);
    let ratios = &all.walks[0].tally.memories;
    let harmonic = ratios.windows(2).all(|pair| pair[0].updates >= pair[1].updates);
    let fastest = all.walks[0].report.memories[0].updates_hz;
    vec![
        Row { standing: Standing::Checked, ..first },
        Row::shape(
            "A5",
            "rate of the fastest memory; each further one is slower",
            "Hz",
            [60.0, fastest],
            harmonic && fastest == 60.0,
        ),
        Row::number(
            "A8",
            "size over distance above which size may decide (discs: never)",
            "1",
            [10.0, first_size(all)],
            Standing::Checked,
        ),
    ]
}

/// The least size over distance of a sphere at which its size decides.
fn first_size(all: &Experiments) -> f64 {
    let deciding = all.sizes.iter().find(|row| row.size_s[1] < row.translation_s);
    deciding.map_or(f64::INFINITY, |row| row.size_over_distance)
}

fn table_1(all: &Experiments) -> Vec<Row> {
    (0..4).map(|memory| rate(all, memory)).collect()
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
    rows
}

fn tears(all: &Experiments) -> Vec<Row> {
    let widest = |walk: usize| all.walks[walk].report.tears_px.after.map_or(0.0, |tears| tears.max);
    let torn = widest(0);
    let warped = widest(1);
    vec![
        Row::shape(
            "A15",
            "widest tear before warping (printed: \"a few\")",
            "texels",
            [3.0, torn],
            torn > 0.5 && torn < 5.0,
        ),
        Row {
            is_met: warped < 1e-6,
            ..Row::number(
                "A16",
                "widest tear left after warping, with cascade",
                "texels",
                [0.0, warped],
                Standing::Checked,
            )
        },
    ]
}

fn limits(all: &Experiments) -> Vec<Row> {
    let pipeline_us = all.walks[0].report.pipeline_ns / 1e3;
    vec![
        Row {
            is_met: pipeline_us < 1.0,
            ..Row::number(
                "A17",
                "orientation is known before an update's first pixel (less than)",
                "us",
                [1.0, pipeline_us],
                Standing::Checked,
            )
        },
        Row::number(
            "A18",
            "fewer draws of point objects, 4 memories at 1 m/s (expected 6.01; printed: an order of magnitude)",
            "1",
            [6.01, all.reductions[0]],
            Standing::Checked,
        ),
        Row::number(
            "A18",
            "fewer draws of point objects, 5 memories at 0.37 m/s (expected 13.40)",
            "1",
            [13.40, all.reductions[1]],
            Standing::Checked,
        ),
    ]
}

/// What follows from tables 1 and 2 alone.
fn derived() -> Vec<Row> {
    let mut rows = Vec::new();
    for (memory, (frames, mm)) in [(1.0, 16.67), (1.529, 25.48), (2.127, 35.45), (3.715, 61.92)].into_iter().enumerate()
    {
        let statement = format!("mean period of memory {memory}");
        rows.push(Row::number("D1", &statement, "frames", [frames, 60.0 / RATES_HZ[memory]], Standing::Formula));
        let statement = format!("way walked in one period of memory {memory}");
        rows.push(Row::number("D1", &statement, "mm", [mm, 1e3 / RATES_HZ[memory]], Standing::Formula));
    }
    let sums = SEGMENTS.map(|segments| segments.iter().sum::<u64>());
    rows.push(Row::number("D2", "sum of A13", "1", [183.0, sums[0] as f64], Standing::Formula));
    rows.push(Row::number("D2", "sum of A14", "1", [213.0, sums[1] as f64], Standing::Formula));
    let draws = SEGMENTS.map(|segments| draws_per_s(&RATES_HZ, &segments));
    rows.push(Row::number("D3", "sum of A12 x A13", "1/s", [7_335.0, draws[0]], Standing::Formula));
    rows.push(Row::number("D3", "sum of A12 x A14", "1/s", [10_676.9, draws[1]], Standing::Formula));
    let against = sums.map(|sum| sum as f64 * 60.0);
    rows.push(Row::number(
        "D4",
        "saved by table 2, cut",
        "%",
        [33.2, saved_percent(draws[0], against[0])],
        Standing::Formula,
    ));
    rows.push(Row::number(
        "D4",
        "saved by table 2, uncut",
        "%",
        [16.5, saved_percent(draws[1], against[1])],
        Standing::Formula,
    ));
    rows.push(Row::number(
        "D5",
        "saved in memory 0 by table 2",
        "%",
        [45.6, saved_percent(87.0, 160.0)],
        Standing::Formula,
    ));
    rows
}
