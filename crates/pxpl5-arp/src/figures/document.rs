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
#[must_use]
pub fn markdown(all: &Experiments, rows: &[FigureRow]) -> String {
    let mut text = String::new();
    head(&mut text, rows);
    text.push_str(&table(rows));
    let _ = writeln!(text, "\n## Missed\n\n{}", missed(rows).trim_end());
    defined(&mut text);
    fits(&mut text, all);
    text.push_str(&interpretations(&all.interpretations));
    thresholds(&mut text, all);
    walks(&mut text, all);
    conservation(&mut text, all);
    slowed(&mut text, all);
    sizes(&mut text, all);
    size_limits(&mut text, &all.size_limits);
    let _ = writeln!(
        text,
        "\n## E9: a straight edge through the lens\n\nExperiment E9 shows a vertical edge, 20 degrees to the right, through a radial lens with k1 = 0.32. The display chooses\n\
         the texels for the radial lens. The edge bends by {:.1} pixels on the screen. Seen through the lens, the edge bends by\n\
         {:.2} pixels. The edge counts as straight if it bends by less than a pixel.",
        all.lens_px[0], all.lens_px[1]
    );
    pictures(&mut text);
    text
}

fn pictures(text: &mut String) {
    text.push_str(
        "\n## E10: Pictures\n\n\
         The command `pxpl5 arp figures --out DIR` makes the pictures. The command `pxpl5 arp figures --out DIR` also writes\n\
         pictures of the effect of a lens, of the errors, and of the updates of the memories. The papers' pictures cannot be\n\
         reproduced, because their scene is not known. The project's pictures show the same effects in the scene `gallery`.\n\n\
         | experiment | figures of the papers | pictures |\n|---|---|---|\n",
    );
    for (experiment, figures, names) in OF_FIGURES {
        let _ = writeln!(text, "| {experiment} | {figures} | {} |", names.join(", "));
    }
    text.push_str(
        "\n![Six faces](pictures/arp-faces.png)\n\nThe picture shows the six faces around the eye, all drawn at the same time. The face PosY is above NegZ. The faces\n\
         NegX, NegZ, PosX and PosZ form the middle row. The face NegY is below NegZ.\n\n\
         ![Memories](pictures/arp-memories.png)\n\nThe colour of each pixel shows from which display memory the content of the pixel comes. Memory 0 (60 Hz) is red,\n\
         memory 1 is yellow, memory 2 is green, and the slowest memory 3 is blue. Black pixels are tears.\n\n\
         ![Tears](pictures/arp-tears.png)\n\nThe scene is cut into segments, and vertices are not warped. The background is white, so white gaps appear between\n\
         segments that were drawn from different positions.\n\n\
         ![Warped](pictures/arp-warped.png)\n\nThe picture *Warped* shows the same frame as the picture *Tears*, drawn with warped vertices.\n\n\
         ![Errors](pictures/arp-error.png)\n\nThe picture shows the error of each pixel, which arises because the memory was drawn from another position of the eye.\n\
         The scale of the colours ends at an error of two pixels.\n",
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
         The command `pxpl5 arp figures --write docs/address-recalculation.md` generates this file. A test fails if the file is out of date.\n\n\
         The experiments use the scene `gallery`, a hall with a floor of 20 m x 20 m (`walk.hall_scale=0.5`). The eye follows\n\
         the path of the scene at 1 m/s for {EXPERIMENT_FRAMES} frames of 1/60 s. The renderer is ideal: it draws without delay.\n\
         The column *provenance* has these values:\n\n\
         - *checked*: The row is simulated, and no number was fitted.\n\n\
         - *fitted*: One number of the model was chosen so that the model reproduces the row.\n\n\
         - *depends on the interpretation*: The row is met if the printed number lies between the smallest and the largest\n  \
           result of all interpretations of the papers.\n\n\
         - *cannot be reproduced, shape checked*: The row depends on conditions that the papers do not print.\n\n\
         The papers do not print their scene, path, cells, threshold and resolution. For rows whose conditions are not printed,\n\
         only the following properties (the *shape*) are checked: The update rates fall from memory to memory. Cutting the scene\n\
         moves segments to slower memories and saves drawing, and the cuts cause tears.\n\n\
         The table has only rows for which the code under test could have given another value. The section\n\
         [Definitions](#definitions) lists the numbers that follow from other numbers by arithmetic.\n\n\
         The model reproduces {met} of the {} rows that can be reproduced. Of the {} rows that cannot be reproduced, {shown} have the printed shape.\n\n",
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
#[must_use]
pub fn table(rows: &[FigureRow]) -> String {
    figures::table(&COLUMNS, rows)
}

/// Returns as a Markdown list the rows whose simulated numbers miss the published numbers, with their known causes.
#[must_use]
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
        "\n## Definitions\n\nThe numbers in the table of definitions follow from printed or assumed numbers alone. No simulation could change a\n\
         definition, so a definition is neither met nor missed.\n\n{}",
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
        "\n## E5: table 1\n\nThe scene is `gallery`. The side of a cell (its length in metres) was fitted so that the update rate of memory 1 is as\n\
         near as possible to 39.25 Hz. The side of a cell also determines the update rates of the other memories.\n\n\
         | rules | side | rates of memories 0 to 3, Hz | errors of 1 (fitted), 2 and 3 |\n|---|---|---|---|\n\
         | published | | {} | |\n",
        rates(&RATES_HZ)
    );
    for CellFit { rules, cell_m, rates_hz } in &all.fits {
        let _ = writeln!(text, "| {} | {cell_m:.1} m | {} | {} |", rules.text(), rates(rates_hz), errors(rates_hz));
    }
}

/// Returns the interpretations of table 1 of the paper CPR05 (update rates) as Markdown, ranked by their error.
#[must_use]
pub fn interpretations(all: &Interpretations) -> String {
    let mut text = "\n## Interpretations of table 1\n\n\
         The paper CPR05 does not print the widths of the rings of cells or the rule by which distances are measured. The paper\n\
         also does not print the hall and the viewer's path through the hall. The table of rules combines each set of rules with\n\
         each of four pairs of a hall and a path. For each combination, the side of a cell is fitted to the rates of memories 1\n\
         to 3. The error of a fit is the root mean square over memories 1 to 3. For the column *left out*, each rate is predicted\n\
         with the side of a cell that fits the other two rates best. The rules are ranked by their mean error over all four\n\
         pairs, because the paper's hall and path are unknown.\n\n"
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
    text.push_str(&chosen(all));
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
            "\nThe best single fit has the rules \"{}\" and the path \"{}\". The cells of the best fit have a side of {cell_m:.2} m, the\n\
             rates are {} Hz, and the error is {:.1} %.",
            best.rules.text(),
            best.situation.text(),
            rates(&rates_hz),
            best.error_percent
        );
    }
    text.push_str(
        "\nEach row of the next table leaves out one rate. For each rate that is left out, the rules, the path, the hall and the\n\
         side of a cell are chosen to fit the other two rates.\n\n\
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
        format!(
            "The rules of the project have rank {place} of the rules without cascade, and their mean error is {:.1} %.",
            ranked.mean_error_percent
        )
    });
    format!(
        "\nThe project uses the rules **{}**. {place} The project has these reasons:\n\n\
         - *Rings that double*: The paper prints update rates of 60, 30 and 15 Hz, and so on (statement A5). If an object is\n  \
           twice as far away, its picture stays correct for twice the time. The cells of each memory therefore begin at twice the\n  \
           distance of the cells of the previous memory.\n\n\
         - *No cascade*: The cascade is a derived rule for warping, and the paper gives table 1 before it introduces warping.\n\n\
         - *To the block's border*: If distances are measured to occupied cells instead and all rings of cells have equal width,\n  \
           the rates come nearer to the printed rates. If the widths of the rings of cells double, the rates differ more from the\n  \
           printed rates. The parameter `priority.to_held_cells` selects one of the two rules for distances.\n\n\
         - *Reliability*: Three rates are little data. A rate is often 60 Hz divided by a whole number, so it stays constant over\n  \
           a range of sides of a cell. Two rates may therefore predict the third rate badly, as the table of left-out rates\n  \
           shows. If the rules are chosen by the rates of memories 2 and 3, the predicted rate of memory 1 equals the rate of\n  \
           memory 0.\n",
        Rules::USUAL.text()
    )
}

fn thresholds(text: &mut String, all: &Experiments) {
    let _ = write!(
        text,
        "\n## The threshold in pixels\n\n\
         Table 1 determines only the product of threshold and side of a cell, which is {:.2} degrees x metres. Two statements of\n\
         the papers limit the threshold. By statement A7, the threshold is the distance between neighbouring pixels of the\n\
         display memory or of the display. By statement A15, tears are a few pixels wide, which the project interprets as 2 to 5\n\
         pixels.\n\n\
         If each memory is shown as soon as it is due, a tear is as wide as the threshold. If the memory with the lower update\n\
         rate is shown one frame late, the tear is wider by the movement of the content in one frame. A pixel is 60 degrees /\n\
         640, and a texel is 90 degrees / 512.\n\n\
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
        "\nThe project uses a threshold of 2 texels, which is one texel of the machine's faces of 256 texels. The project compared\n\
         whole texels of faces with 128, 256, 384 and 512 texels. The chosen threshold is the widest threshold whose tears are 2\n\
         to 5 pixels wide. With a threshold of 2 texels, the hall has a side of 20 m, and eight cells lie along a side. With\n\
         eight cells along a side, the objects of the hall have about as many sections as table 2 prints.\n",
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
        "\n## Table 2: what the conservation of sections demands\n\n\
         A *section* is the part of an object in one cell. Segmentation cuts the objects into sections but does not change the\n\
         number of sections. Without segmentation, each section is in the same memory as with segmentation, or in a faster\n\
         memory. Two constraints follow:\n\n\
         1. The columns with and without segmentation have the same sum. The paper prints the sums {} and {}, so there are {:.0}\n   \
            more sections without segmentation. In the model, the sums of sections are {:.0} and {:.0}.\n\n\
         2. Memory 0 is the fastest memory. Without segmentation, the fastest memories 0 to k together therefore hold at least as\n   \
            many sections as with segmentation, for every k. The printed numbers and the model's numbers satisfy this constraint:\n\n\
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
        "\nThe printed numbers violate the first constraint, because the sums of the two columns differ. So the two columns do not\n\
         describe the same set of sections.\n\
         The printed saving of draws is 31.3 %. One part of the saving of draws comes from {:.0} missing sections. The other part of\n\
         the saving of draws is the saving for each section. With segmentation, a section needs {with:.1} draws per second. Without\n\
         segmentation, a section needs {without:.1}, so the saving is {:.1} %. Three of the four numbers of a column are independent,\n\
         because the sum of the column determines the fourth number.\n",
        uncut.iter().sum::<f64>() - cut.iter().sum::<f64>(),
        100.0 * (1.0 - with / without)
    );
}

fn walks(text: &mut String, all: &Experiments) {
    let _ = write!(
        text,
        "\n## E6, E7: the path walked four times\n\nWith the fitted cells, the gallery has {} segments. A vertex on the border of two cells can be in two memories, with a\n\
         different direction in each memory. A tear is the angle between the two directions of a vertex, in texels of 90 degrees\n\
         / 512.\n\n\
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
        "\n## E8: a renderer that is too slow\n\nExperiment E8 uses the walk \"cut, torn\" for 1,800 frames. The renderer of experiment E8 draws due memories in the order\n\
         of their numbers. The display chooses the texel of each pixel at scan-out, so the speed of the renderer does not affect\n\
         the error for a rotation of the head.\n\n| triangles a second | rates, Hz | retraces missed |\n|---|---|---|\n"
    );
    for SlowRendererResult { triangles_per_s: rate, rates_hz, missed } in &all.slowed {
        let rates: Vec<String> = rates_hz.iter().map(|rate| format!("{rate:.1}")).collect();
        let missed: Vec<String> = missed.iter().map(u64::to_string).collect();
        let _ = writeln!(text, "| {rate:.0} | {} | {} |", rates.join(", "), missed.join(", "));
    }
}

fn sizes(text: &mut String, all: &Experiments) {
    let _ = write!(
        text,
        "\n## E3: size against translation\n\nThe centre of an object is 10 m away, and the eye approaches the object at 1 m/s. The following table gives the time in\n\
         ms for which the picture of the object stays correct, for a threshold of 90/512 degrees.\n\n\
         | size/distance | translation | size, disc | size, sphere | decides (disc, sphere) |\n|---|---|---|---|---|\n"
    );
    for row in &all.sizes {
        let who = row.size_s.map(|size| if size < row.translation_s { "size" } else { "translation" });
        let [translation, disc, sphere] =
            [row.translation_s, row.size_s[0], row.size_s[1]].map(|s| format!("{:.2}", s * 1e3));
        let _ =
            writeln!(text, "| {} | {translation} | {disc} | {sphere} | {} |", row.size_over_distance, who.join(", "));
    }
}

/// Writes the ratios of size to distance that belong to statement A8 of the papers on priority rendering. For larger
/// ratios, the growth of the object on the screen determines the validity period.
fn size_limits(text: &mut String, limits: &[SizeLimit]) {
    text.push_str(
        "\nStatement A8, \"about ten times the distance\", leaves two questions open. One question is which angle describes the size\n\
         of an object, and by how much this angle may change. The other question is whether the distance is measured to the\n\
         centre of the object or to its nearest point. The following table is for a sphere whose centre moves. A larger sphere\n\
         stays correct for a shorter time because of its size than because of its movement. The table gives the size of a sphere\n\
         for which size and movement give equal times.\n\n\
         | angle of the size | diameter over the distance of the middle | over that of the nearest point |\n|---|---|---|\n",
    );
    for SizeLimit { angle, of_middle, of_nearest, .. } in limits {
        let _ = writeln!(text, "| {angle} | {of_middle:.2} | {of_nearest:.2} |");
    }
    text.push_str(
        "\nFor the size of an object, the project uses the distance to the nearest point and the angle under which the radius\n\
         appears. The patent US5841439 names a second angle for the size, without its value. If the second angle is 1.5 times the\n\
         threshold theta, the model gives the printed factor of ten. The size of a disc never shortens the time for which its\n\
         picture stays correct.\n",
    );
}
