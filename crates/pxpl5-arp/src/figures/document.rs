//! The published figures and the simulated values as a Markdown document.

use super::definitions::{SEGMENTS, definitions};
use super::experiments::{CellFit, EXPERIMENT_FRAMES, Experiments, NamedWalk, SizeLimit, SlowRendererResult};
use super::fit::RATES_HZ;
use super::interpretations::{Interpretations, LeftOutRate, RankedRules, Situation, ThresholdRow, Trial};
use super::row::verdict;
use super::rules::Rules;
use crate::pictures::OF_FIGURES;
use pxpl5_sim::figures::column::{ERROR, NUMBER, four};
use pxpl5_sim::figures::{self, Basis, Definition, FigureRow, TableColumn};
use std::fmt::Write as _;

/// Returns the text of docs/address-recalculation.md: the rows with the provenance of each number, then the detailed
/// tables.
pub fn markdown(all: &Experiments, rows: &[FigureRow]) -> String {
    let mut text = String::new();
    head(&mut text, rows);
    text.push_str(&table(rows));
    let _ = writeln!(text, "\n## Missed\n\n{}", missed(rows).trim_end());
    defined(&mut text);
    fits(&mut text, all);
    text.push_str(&best_of_all(&all.interpretations));
    text.push_str(&chosen(&all.interpretations));
    thresholds(&mut text, all);
    walks(&mut text, all);
    conservation(&mut text, all);
    slowed(&mut text, all);
    size_limits(&mut text, &all.size_limits);
    let _ = writeln!(
        text,
        "\n\
         ## E9: a straight edge through the lens\n\n\
         A vertical edge, 20 degrees to the right, is seen through a radial lens with k1 = 0.32, for which the display\n\
         chooses the texels. It bends by {:.1} pixels on the screen but only by {:.2} through the lens, where anything\n\
         below a pixel counts as straight.",
        all.lens_px[0], all.lens_px[1]
    );
    pictures(&mut text);
    text
}

fn pictures(text: &mut String) {
    text.push_str(
        "\n\
         ## E10: Pictures\n\n\
         `pxpl5 arp figures --out DIR` draws these pictures, and others of the effect of a lens, of the errors, and of\n\
         the memories' updates. The papers' own pictures cannot be reproduced, because their scene is not known. Ours\n\
         show the same effects in `gallery`.\n\n\
         | experiment | figures of the papers | pictures |\n|---|---|---|\n",
    );
    for (experiment, figures, names) in OF_FIGURES {
        let _ = writeln!(text, "| {experiment} | {figures} | {} |", names.join(", "));
    }
    text.push_str(
        "\n\
         ![Six faces](pictures/arp-faces.png)\n\n\
         The six faces around the eye, all drawn at the same time: PosY above NegZ, then NegX, NegZ, PosX and PosZ in\n\
         the middle row, and NegY below NegZ.\n\n\
         ![Memories](pictures/arp-memories.png)\n\n\
         Each pixel's colour shows the memory from which it comes: red is memory 0 (60 Hz), yellow 1, green 2, and blue\n\
         the slowest, 3. Black pixels are tears.\n\n\
         ![Tears](pictures/arp-tears.png)\n\n\
         A scene that is cut into segments, without warping. White is the background: gaps appear between segments that\n\
         were drawn from different positions.\n\n\
         ![Warped](pictures/arp-warped.png)\n\n\
         The same frame with warped vertices.\n\n\
         ![Errors](pictures/arp-error.png)\n\n\
         The error of each pixel, which arises because its memory was drawn from another position of the eye. Colours\n\
         end at two pixels.\n",
    );
}

fn head(text: &mut String, rows: &[FigureRow]) {
    let numbers = rows.iter().filter(|row| row.basis != Basis::Shape);
    let met = numbers.clone().filter(|row| row.is_met).count();
    let shapes = rows.iter().filter(|row| row.basis == Basis::Shape);
    let shown = shapes.clone().filter(|row| row.is_met).count();
    let _ = write!(
        text,
        "# Address recalculation and priority rendering: the papers' figures\n\n\
         The model reproduces {met} of the {} rows that can be reproduced; [the others](#missed) are listed with their\n\
         causes. Of the {} rows that depend on a scene, path, cells, threshold and resolution that no paper prints,\n\
         {shown} have the printed *shape*. This means that update rates fall from memory to memory, and that cutting\n\
         the scene moves segments to slower memories, saves drawing and causes tears. Turning the head costs nothing:\n\
         even a stalled renderer changes no pixel of what is seen. Two numbers were fitted, and the printed table 2\n\
         [contradicts itself](#table-2-what-the-conservation-of-sections-demands).\n\n\
         `pxpl5 arp figures --write docs/address-recalculation.md` generates this page, and a test fails if it is out\n\
         of date. The eye walks through `gallery`, a hall with a floor of 20 m x 20 m (`walk.hall_scale=0.5`), at 1 m/s\n\
         for {EXPERIMENT_FRAMES} frames of 1/60 s. The renderer draws without delay. Rows have one of four provenances:\n\n\
         - *checked*: simulated, without a fitted number.\n\n\
         - *fitted*: one number of the model was chosen so that the row is reproduced.\n\n\
         - *depends on the interpretation*: met if the printed number lies between the smallest and the largest result\n  \
         of all interpretations of the papers.\n\n\
         - *cannot be reproduced, shape checked*: the papers do not print the conditions.\n\n\
         Numbers that follow from others by arithmetic are no rows, because no code could have given another value;\n\
         they are under [Definitions](#definitions).\n\n",
        numbers.count(),
        shapes.count()
    );
}

const COLUMNS: [TableColumn<FigureRow>; 9] = [
    ("", |row| row.experiment.to_owned()),
    NUMBER,
    ("statement", |row| row.statement.to_string()),
    ("published", |row| four(row.published)),
    ("ours", |row| four(row.simulated)),
    ("unit", |row| row.unit.to_owned()),
    ERROR,
    ("provenance", |row| if row.basis == Basis::Free { "checked" } else { row.basis.name() }.to_owned()),
    ("", |row| verdict(row).to_owned()),
];

/// Returns the figures as a Markdown table.
pub fn table(rows: &[FigureRow]) -> String {
    figures::table(&COLUMNS, rows)
}

/// Returns as a Markdown list the rows whose simulated numbers miss the published numbers, with their known causes.
pub fn missed(rows: &[FigureRow]) -> String {
    let mut text = String::new();
    for row in rows.iter().filter(|row| !row.is_met) {
        let both = [row.published, row.simulated].map(four);
        let _ = writeln!(
            text,
            "- Row **{}** (\"{}\") is missed: the papers print {} {}, and the model gives {}. {}\n",
            row.id,
            row.statement,
            both[0],
            row.unit,
            both[1],
            row.cause_or_unknown()
        );
    }
    text
}

fn defined(text: &mut String) {
    let columns: [TableColumn<Definition>; 4] = [
        ("#", |one| one.id.to_owned()),
        ("what", |one| one.statement.to_string()),
        ("value", |one| four(one.value)),
        ("unit", |one| one.unit.to_owned()),
    ];
    let _ = write!(
        text,
        "\n\
         ## Definitions\n\n\
         These numbers follow from printed or assumed numbers alone. No simulation could change them, so they are\n\
         neither met nor missed.\n\n\
         {}",
        figures::table(&columns, &definitions())
    );
}

/// Returns the relative errors of the update rates of display memories 1 to 3 as text, in percent.
fn errors(rates_hz: &[f64]) -> String {
    let error = |memory: usize| format!("{:+.1} %", 100.0 * (rates_hz[memory] / RATES_HZ[memory] - 1.0));
    [1, 2, 3].map(error).join(", ")
}

fn rates(rates_hz: &[f64]) -> String {
    rates_hz.iter().map(|rate| format!("{rate:.2}")).collect::<Vec<_>>().join(", ")
}

fn fits(text: &mut String, all: &Experiments) {
    let _ = write!(
        text,
        "\n\
         ## E5: table 1\n\n\
         CPR05 prints neither the widths of the rings of cells nor how distances are measured, and neither the hall nor\n\
         the viewer's path. We fit the side of a cell, so that memory 1 comes as near as possible to 39.25 Hz in\n\
         `gallery`. It also determines the other rates:\n\n\
         | rules | side | rates of memories 0 to 3, Hz | errors of 1 (fitted), 2 and 3 |\n|---|---|---|---|\n\
         | published | | {} | |\n",
        rates(&RATES_HZ)
    );
    for CellFit { rules, cell_m, rates_hz } in &all.fits {
        let _ = writeln!(text, "| {} | {cell_m:.1} m | {} | {} |", rules.text(), rates(rates_hz), errors(rates_hz));
    }
}

/// Returns the interpretations of table 1 of the paper CPR05 (update rates) as Markdown, ranked by their error.
pub fn interpretations(all: &Interpretations) -> String {
    let mut text = "\n\
         ## Interpretations of table 1\n\n\
         The paper CPR05 prints neither the widths of the rings of cells nor how distances are measured, and neither\n\
         the hall nor the viewer's path. Each set of rules is combined with four pairs of a hall and a path, and for\n\
         each the side of a cell is fitted to the rates of memories 1 to 3. Errors are root mean squares over these\n\
         memories. For the column *left out*, each rate is predicted with the side that fits the other two best. Since\n\
         hall and path are unknown, the rules are ranked by their mean error over all four pairs.\n\n"
        .to_owned();
    // The table has one column for each hall and path.
    let situations = Situation::ALL.map(Situation::text).join(" | ");
    let _ = writeln!(
        text,
        "| rules | mean | left out | {situations} |\n|---|---|---|{}",
        "---|".repeat(Situation::ALL.len())
    );
    for RankedRules { rules, mean_error_percent, mean_left_out_percent, tried } in &all.ranked {
        let each = tried.iter().map(|tried| format!("{:.1} % ({:.1} m)", tried.error_percent, tried.best.cell_m));
        let each = each.collect::<Vec<_>>().join(" | ");
        let mark = if *rules == Rules::USUAL { "**" } else { "" };
        let _ = writeln!(
            text,
            "| {mark}{}{mark} | {mean_error_percent:.1} % | {mean_left_out_percent:.1} % | {each} |",
            rules.text()
        );
    }
    text.push_str(&best_of_all(all));
    text
}

/// Returns two results as Markdown. The first is the best fit of one set of rules to all update rates. The second is
/// the prediction of each rate by a fit to the other rates.
fn best_of_all(all: &Interpretations) -> String {
    let mut text = String::new();
    // The best fit of all combinations of rules, hall and path.
    let every = all.ranked.iter().flat_map(|ranked| &ranked.tried);
    if let Some(best) = every.min_by(|a, b| a.error_percent.total_cmp(&b.error_percent)) {
        let Trial { cell_m, rates_hz } = best.best;
        let _ = writeln!(
            text,
            "\n\
             `pxpl5 arp interpretations` ranks 16 sets of rules, each with four pairs of a hall and a path. Its best single\n\
             fit has the rules \"{}\" and the path \"{}\".\n\
             With cells of {cell_m:.2} m it gives {} Hz, an error of {:.1} %.",
            best.rules.text(),
            best.situation.text(),
            rates(&rates_hz),
            best.error_percent
        );
    }
    text.push_str(
        "\n\
         A leave-one-out check shows how much three rates can tell: rules, path, hall and cell are fitted to two of\n\
         them, and predict the third.\n\n\
         | memory | predicted | error | the others' choice |\n|---|---|---|---|\n",
    );
    for LeftOutRate { memory, rules, situation, trial, error_percent } in &all.left_out {
        let predicted = trial.rates_hz[*memory];
        let _ = writeln!(
            text,
            "| {memory} | {predicted:.2} Hz | {error_percent:+.1} % | {}; {}; {:.2} m |",
            rules.text(),
            situation.text(),
            trial.cell_m
        );
    }
    text
}

fn chosen(all: &Interpretations) -> String {
    let place = all.usual().map_or_else(String::new, |(place, ranked)| {
        format!(" (rank {place} of those without cascade, mean error {:.1} %)", ranked.mean_error_percent)
    });
    format!(
        "\n\
         We use the rules\n\
         **{}**{place},\n\
         for these reasons:\n\n\
         - *Rings that double*: The paper prints update rates of 60, 30 and 15 Hz, and so on (statement A5). An object\n  \
         at twice the distance stays correct for twice the time, so each memory's cells begin at twice the distance\n  \
         of the previous one's.\n\n\
         - *No cascade*: It is a derived rule for warping, and the paper gives table 1 before it introduces warping.\n\n\
         - *To the block's border*: Distances to occupied cells come nearer to the printed rates if all rings are\n  \
         equal, but they go further away if the rings double. `priority.to_held_cells` selects them.\n\n\
         - *Reliability*: Three rates are little data. A rate is often 60 Hz divided by a whole number, so it stays\n  \
         constant over a range of sides, and two rates may predict the third badly. Rules that are chosen by memories\n  \
         2 and 3 give memory 1 the rate of memory 0.\n",
        Rules::USUAL.text()
    )
}

fn thresholds(text: &mut String, all: &Experiments) {
    let _ = write!(
        text,
        "\n\
         ## The threshold in pixels\n\n\
         Table 1 determines only the product of threshold and side of a cell, which is {:.2} degrees x metres. Two\n\
         statements limit the threshold itself. By A7, it is the distance between neighbouring pixels of the display\n\
         memory or of the display. By A15, tears are a few pixels wide, which we take as 2 to 5.\n\n\
         If each memory is shown as soon as it is due, a tear is as wide as the threshold. If the slower one comes a\n\
         frame late, its content has moved on, and the tear is wider by this movement. A pixel is 60 degrees / 640, and\n\
         a texel 90 degrees / 512.\n\n\
         | threshold | degrees | side | hall of 8 cells | tear, shown at once | tear, a frame late |\n|---|---|---|---|---|---|\n",
        all.fits[0].cell_m * address_recalculation::priority::PriorityTiming::PAPERS.theta_deg
    );
    for ThresholdRow { threshold, theta_deg, cell_m, at_once_px, frame_late_px } in &all.thresholds {
        let _ = writeln!(
            text,
            "| {threshold} | {theta_deg:.3} | {cell_m:.2} m | {:.0} m | {at_once_px:.1} px | {frame_late_px:.1} px |",
            8.0 * cell_m
        );
    }
    text.push_str(
        "\n\
         We use 2 texels (one texel of the machine's faces of 256 texels). Among whole texels of faces with 128, 256,\n\
         384 and 512 texels, it is the widest threshold whose tears are 2 to 5 pixels wide. The hall then has a side of\n\
         20 m, and with eight cells along it, its objects have about as many sections as table 2 prints.\n",
    );
}

/// Writes two constraints on table 2 of the paper CPR05, which prints the number of segments in each memory. Both
/// constraints follow from one fact: the same segments are drawn with and without cutting, only in different memories.
fn conservation(text: &mut String, all: &Experiments) {
    let ours = [0, 2].map(|walk: usize| {
        let memories = all.walks[walk].report.memories.iter();
        memories.map(|memory| memory.segments).collect::<Vec<f64>>()
    });
    let [cut, uncut] = SEGMENTS.map(|segments| segments.map(|count| count as f64));
    // Mean number of draws per second that a section needs at the printed rates.
    let per_section = |segments: &[f64]| {
        let draws: f64 = segments.iter().zip(RATES_HZ).map(|(segments, rate)| segments * rate).sum();
        draws / segments.iter().sum::<f64>()
    };
    let [with, without] = [per_section(&cut), per_section(&uncut)];
    let _ = write!(
        text,
        "\n\
         ## Table 2: what the conservation of sections demands\n\n\
         A *section* is the part of an object in one cell. Segmentation cuts objects into sections but does not change\n\
         their number, and it never moves one to a faster memory. Two constraints follow:\n\n\
         1. Both columns have the same sum. The paper prints {} and {}, so there are {:.0} more sections without\n   \
         segmentation; the model has {:.0} and {:.0}.\n\n\
         2. Without segmentation, memories 0 to k together hold at least as many sections as with it, for every k. The\n   \
         printed numbers and ours satisfy this:\n\n\
         | memories | printed, cut | printed, uncut | ours, cut | ours, uncut |\n|---|---|---|---|---|\n",
        cut.iter().sum::<f64>(),
        uncut.iter().sum::<f64>(),
        uncut.iter().sum::<f64>() - cut.iter().sum::<f64>(),
        ours[0].iter().sum::<f64>(),
        ours[1].iter().sum::<f64>()
    );
    // The sums over the fastest memories give the second constraint.
    let up_to = |segments: &[f64], memory: usize| segments[..=memory].iter().sum::<f64>();
    for memory in 0..4 {
        let [a, b, c, d] = [&cut[..], &uncut[..], &ours[0], &ours[1]].map(|segments| up_to(segments, memory));
        let _ = writeln!(text, "| 0 to {memory} | {a:.0} | {b:.0} | {c:.1} | {d:.1} |");
    }
    let _ = write!(
        text,
        "\n\
         Since the printed sums differ, the two columns do not describe the same sections. One part of the printed\n\
         saving of 31.3 % of all draws comes from the {:.0} missing ones. The other part is the saving for each\n\
         section: {with:.1} instead of {without:.1} draws a second, which is {:.1} %. Only three of the four numbers of\n\
         a column are independent, because its sum determines the fourth.\n",
        uncut.iter().sum::<f64>() - cut.iter().sum::<f64>(),
        100.0 * (1.0 - with / without)
    );
}

fn walks(text: &mut String, all: &Experiments) {
    let _ = write!(
        text,
        "\n\
         ## E6, E7: the path walked four times\n\n\
         With the fitted cells, the gallery has {} segments. A vertex on the border of two cells can be in two\n\
         memories, in a different direction in each. The angle between the two is a tear, measured in texels of 90\n\
         degrees / 512.\n\n\
         | walk | rates, Hz | segments | draws/s | saved | redeals | tears: half, 95 %, widest | stretch: widest |\n|---|---|---|---|---|---|---|---|\n",
        all.segments
    );
    all.walks.iter().for_each(|walked| walk_line(text, walked));
}

fn walk_line(text: &mut String, walked: &NamedWalk) {
    let report = &walked.report;
    let joined = |numbers: Vec<String>| numbers.join(", ");
    let rates = joined(report.memories.iter().map(|memory| format!("{:.2}", memory.updates_hz)).collect());
    let segments = joined(report.memories.iter().map(|memory| format!("{:.1}", memory.segments)).collect());
    let tears = report.tears_texels.after.map_or_else(
        || "none".to_owned(),
        |tears| format!("{}, {}, {}", texels(tears.p50), texels(tears.p95), texels(tears.max)),
    );
    let stretch = report.tears_texels.stretch.map_or_else(|| "-".to_owned(), |stretch| texels(stretch.max));
    let _ = writeln!(
        text,
        "| {} | {rates} | {segments} | {:.0} | {:.1} % | {} | {tears} | {stretch} |",
        walked.name,
        report.priority.draws_per_s,
        report.priority.saved_percent,
        report.priority.redeals.unwrap_or(0)
    );
}

/// Formats the width of a tear (gap between two memories) in texels. Widths below a millionth of a texel are rounding
/// errors and count as 0.
fn texels(width: f64) -> String {
    if width < 1e-6 { "0".to_owned() } else { format!("{width:.2}") }
}

fn slowed(text: &mut String, all: &Experiments) {
    let _ = write!(
        text,
        "\n\
         ## E8: a renderer that is too slow\n\n\
         On the walk \"cut, torn\", for 1,800 frames, the renderer draws due memories in the order of their numbers. Its\n\
         speed does not affect the error for a rotation of the head, because the display chooses the texel of each\n\
         pixel at scan-out.\n\n\
         | triangles a second | rates, Hz | retraces missed |\n|---|---|---|\n"
    );
    for SlowRendererResult { triangles_per_s: rate, rates_hz, missed } in &all.slowed {
        let rates: Vec<String> = rates_hz.iter().map(|rate| format!("{rate:.1}")).collect();
        let missed: Vec<String> = missed.iter().map(u64::to_string).collect();
        let _ = writeln!(text, "| {rate:.0} | {} | {} |", rates.join(", "), missed.join(", "));
    }
}

/// Writes the ratios of size to distance that belong to statement A8 of the papers on priority rendering. For larger
/// ratios, the growth of the object on the screen determines the validity period.
fn size_limits(text: &mut String, limits: &[SizeLimit]) {
    text.push_str(
        "\n\
         ## E3: size against translation\n\n\
         The image of an object becomes wrong because the object shifts or because its size changes. For a large\n\
         sphere, the change of size becomes visible before the shift does; statement A8 says that this begins at \"about\n\
         ten times the distance\". It leaves open which angle describes the size, and by how much it may change. It also\n\
         leaves open whether the distance is that of the centre or of the nearest point. A sphere for which both take\n\
         the same time has this diameter:\n\n\
         | angle of the size | diameter over the distance of the middle | over that of the nearest point |\n|---|---|---|\n",
    );
    for SizeLimit { angle, of_middle, of_nearest, .. } in limits {
        let _ = writeln!(text, "| {angle} | {of_middle:.2} | {of_nearest:.2} |");
    }
    text.push_str(
        "\n\
         We use the nearest point and the angle under which the radius appears. The patent US5841439 names a second\n\
         angle for the size without its value; 1.5 times the threshold theta would give the printed factor of ten. For\n\
         a disc, the shift always comes first.\n",
    );
}
