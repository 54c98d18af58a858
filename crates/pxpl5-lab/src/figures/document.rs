//! Writer of ACCURACY.md from the published figures and the model's values.

use super::{Alternatives, Basis, FigureRow, Figures, Interpretation, MISS_PERCENT, mean_error_percent};
use crate::application_time::{ApplicationTime, FlyThroughLatency, published};
use crate::interpretations::{self, FigureFit, Fit, Interpretations};
use crate::intervals::{Interval, SAMPLES};
use crate::levels::deviation_percent;
use pxpl5_sim::figures::column::{
    DETAILS, EXPERIMENT, INTERVAL, NUMBER, PROVENANCE, PUBLISHED, SIMULATED, STATEMENT, error, four, range,
};
use pxpl5_sim::figures::{TableColumn, table};
use std::fmt::Write as _;

/// Returns the text of ACCURACY.md: a table of all figures, and the cause of each missed figure.
pub fn markdown(figures: &Figures, alternatives: &Alternatives) -> String {
    let mut text = String::new();
    let rows = &figures.rows;
    // The order of sections: table, misses, then the comparisons that qualify the table.
    head(&mut text, rows);
    text.push_str(&table(&COLUMNS, rows));
    misses(&mut text, rows);
    of_code(&mut text, rows, &alternatives.of_code);
    figures.groups.iter().for_each(|group| text.push_str(&group.markdown()));
    figures.families.iter().for_each(|family| text.push_str(&family.markdown()));
    of_interpretations(&mut text, &alternatives.interpretations);
    of_application(&mut text, &alternatives.application_times);
    sensitivity(&mut text, &figures.intervals);
    let _ = write!(text, "\n## Experiments\n\n{}", table(&[NUMBER, EXPERIMENT, DETAILS], rows));
    text
}

/// Minimum change of a figure, in percent, for which the document lists the figure. The change results if the times of
/// primitives are measured by executing i860 code instead of taken from the timing table.
const MOVED_PERCENT: f64 = 0.05;

/// Writes the figures that change if the times of primitives are measured by executing i860 code. Also writes why these
/// times are not the default.
fn of_code(text: &mut String, rows: &[FigureRow], of_code: &[FigureRow]) {
    let _ = write!(
        text,
        "\n## Times of primitives from the code instead\n\n\
         The timing table takes 21.7 us for a triangle of optimised PPHIGS, which is the published rate. For a triangle of Slats,\n\
         the timing table takes 30.0 us in 1994 and 55.8 us in 1995. The two times of Slats were fitted to figures 12 and 14.\n\n\
         With `machine.times = \"code\"`, the simulator uses the times that the project's own i860 code needs. Each time from the\n\
         code is a mean over the application scenes, and no time is fitted. The page docs/gp-timing.md describes how the times of\n\
         the code were measured. The following table lists the figures that change with the times of the code, at the transaction\n\
         level.\n\n\
         | # | figure | published | table | error | code | error |\n|---|---|---|---|---|---|---|\n"
    );
    // Figures that do not depend on the times are left out.
    let moved =
        |(table, code): &(&FigureRow, &FigureRow)| deviation_percent(code.simulated, table.simulated) > MOVED_PERCENT;
    for (table, code) in rows.iter().zip(of_code).filter(moved) {
        let of_code = if code.simulated.is_finite() { error(code) } else { "-100.0 %".to_owned() };
        let _ = writeln!(
            text,
            "| {} | {} | {} {} | {} | {} | {} | {of_code} |",
            table.id,
            table.statement,
            four(table.published),
            table.unit,
            four(table.simulated),
            error(table),
            four(code.simulated),
        );
    }
    let _ = write!(
        text,
        "\nThe mean error of the free checks is {:.1} % with the timing table and {:.1} % with the times of the code. A figure that\n\
         cannot be computed with the times of the code counts with an error of 100 %. The limits of Slats change most, because\n\
         the times of the project's code differ from the fitted times. No triangle of the figures in this table is clipped.\n\n\
         The timing table with published and fitted times stays the default. Two of the three times in the timing table follow\n\
         from the limits of triangles in the papers. The published limits depend on the code of the papers, which is not\n\
         available. The project's code is different code for the same processor, and some rules for waits of the i860 (freezes)\n\
         and for memory are assumed. The comparison of timing table and code shows how well the project's code reproduces the\n\
         figures without any fitted number.\n",
        mean_error_percent(rows),
        mean_error_percent(of_code),
    );
}

/// Number of interpretations in the document.
const BEST: usize = 12;

/// Writes the table of interpretations with the figures that each interpretation explains, and the confidence of the
/// choice.
fn of_interpretations(text: &mut String, interpretations: &Interpretations) {
    // State how likely the default interpretation is, compared with the most likely one.
    let fits = &interpretations.analytic;
    let likeliest = fits.iter().map(|fit| fit.log_likelihood).fold(f64::NEG_INFINITY, f64::max);
    let usual =
        fits.iter().find(|fit| fit.interpretation == Interpretation::USUAL).map_or(f64::NAN, |fit| fit.log_likelihood);
    let place = |interpretation: &Interpretation| {
        fits.iter().position(|fit| fit.interpretation == *interpretation).map_or(0, |place| place + 1)
    };
    let _ = write!(
        text,
        "\n## Interpretations: questions that the papers leave open\n\n\
         The papers leave seven questions open:\n\n\
         - Does a printed mean latency average the first eyes of the frames, or all eyes?\n\n\
         - Is a latency in fields an exact time, or a whole number of retraces?\n\n\
         - How many finished regions does a renderer keep?\n\n\
         - Does the master wait while the frame buffer is not available, or does it assign the next region?\n\n\
         - Which machine drew the application scenes?\n\n\
         - Were back faces culled?\n\n\
         - Were the bins full with the triangles of one eye, or with the triangles of both eyes?\n\n\
         The possible answers to the questions give {} combinations, which are called *interpretations*. In each interpretation,\n\
         all figures use the same machine parameters. The table of interpretations has results of the analytic level. The command\n\
         `pxpl5 interpretations` also measures the best interpretations with events.\n\n\
         In the table of interpretations, the columns *mean* and *worst* give the mean and the largest error of the figures in\n\
         percent. The column *log L* is the logarithm of the likelihood of the printed means and standard deviations. The\n\
         likelihood allows an error of 2 % for the conditions that the papers do not print.\n\n\
         The paper TR94 derives figures 3 and 5 from its rules and did not measure these figures. The table of interpretations\n\
         therefore compares figures 3 and 5 with the rules alone. Figures 3, 4b, 5 and 17 do not distinguish one interpretation\n\
         from another.\n\n\
         | mean | worst | log L | {} | interpretation |\n|---|---|---|{}---|\n",
        fits.len(),
        interpretations::FIGURES.join(" | "),
        "---|".repeat(interpretations::FIGURES.len()),
    );
    // The table lists only the best interpretations.
    fits.iter().take(BEST).for_each(|fit| text.push_str(&fitted(fit)));
    let _ = write!(
        text,
        "\nThe project uses the interpretation **{}**, which has rank {} in the list. The most likely interpretation is {:.2} times as likely as\n\
         the interpretation of the project.\n\
         The number of interpretations that equal the best interpretation within the printed digits ({:.2} % of a mean error) is {}.\n\n\
         The following reasons decide the choice of the interpretation:\n\n\
         - *each eye, whole fields*: The papers print the latencies of application scenes in fields. Equal numbers of latencies\n  \
           of 4 and 5 fields give a mean of 4.5 and a standard deviation of 0.5. The paper TR94 prints a mean of 4.47 and a\n  \
           deviation of 0.502. The other printed mean and deviation, 4.61 and 0.589, also need a few latencies of 6 fields. The\n  \
           latencies of the first eyes alone have a deviation of 0.1.\n\n\
         - *room for all*: The backing store of a renderer has 4,096 bits for each pixel, enough for 128 regions of 32 bits. A\n  \
           renderer could keep fewer regions only if a rule of the software limited the number of regions.\n\n\
         - *wait*: With the rule `store`, a renderer that has finished a region begins its next region at once. With this rule and\n  \
           room for all regions, the latency of figure 4 is 6 % too long. With the rule `wait`, a renderer first waits for its\n  \
           frame buffer, and this latency is 1 to 2 % too long. The text of the paper allows both rules.\n\n\
         - *large, culled*: The scene `head` takes twice the printed time on the small machine. The scene `head` also takes\n  \
           twice the printed time if back faces are drawn.\n\n\
         - *bins of one eye*: If the bins hold the triangles of both eyes, 7,700 triangles take 454 ms instead of the printed 293\n  \
           ms. No paper states the rule of bins for one eye, which was chosen for figures 16b and 16c and affects no other\n  \
           figure.\n\n\
         Each row of the next table leaves out one figure. The interpretation is chosen by the other figures and then predicts\n\
         the figure that was left out.\n\n\
         | # | error | the others' choice |\n|---|---|---|\n",
        Interpretation::USUAL,
        place(&Interpretation::USUAL),
        (likeliest - usual).exp(),
        interpretations.rounding_percent,
        interpretations.as_good,
    );
    // Each figure is predicted without its own data.
    for left_out in &interpretations.left_out {
        let _ = writeln!(text, "| {} | {:+.1} % | {} |", left_out.id, left_out.error_percent, left_out.words);
    }
}

/// Returns a row of the table of interpretations. Figures that the interpretation does not explain are bold.
fn fitted(fit: &Fit) -> String {
    let value = |figure: &FigureFit| {
        let sd = figure.simulated_sd.map_or(String::new(), |sd| format!(" ({sd:.2})"));
        let text = format!("{}{sd}", four(figure.simulated));
        if fit.unexplained.contains(&figure.id) { format!("**{text}**") } else { text }
    };
    let values: Vec<String> = fit.figures.iter().map(value).collect();
    format!(
        "| {:.2} | {:.1} | {:.1} | {} | {} |\n",
        fit.mean_error_percent,
        fit.greatest_error_percent,
        fit.log_likelihood,
        values.join(" | "),
        fit.words
    )
}

/// Writes the effect of the application's time on the mean and standard deviation of the fly-throughs' latencies.
fn of_application(text: &mut String, times: &[ApplicationTime]) {
    text.push_str(
        "\n## The application's time a frame\n\n\
         The host ran the viewer's application. For each frame, the application took some time before it requested the next\n\
         frame. No paper prints the time of the application, and the presets set the time to zero. The parameters\n\
         `host.application_ns` and `host.application_jitter_ns` set the time of the application and its spread.\n\n\
         In the following table, the mean time of the application is 0 to 40 ms, and its spread is 0 to 30 ms. A Unix host polls\n\
         its serial lines every 30 ms (TR94). The largest mean (40 ms) and the largest spread (30 ms) are assumed. The following\n\
         table gives the mean latency in fields at the analytic level, with the deviation in brackets. No number is fitted. If\n\
         the application always needs less than the 33.4 ms between two frames, the application hardly changes the latency. The\n\
         reason for the small change is that the host works on the next frame while the machine draws the current frame.\n\n\
         | mean of the application | evenly spread by | 7 | 7b | 7c |\n|---|---|---|---|---|\n",
    );
    let cells = |figures: &[FlyThroughLatency]| {
        let cells = figures.iter().map(|figure| format!("{} ({:.3})", four(figure.mean), figure.sd));
        cells.collect::<Vec<_>>().join(" | ")
    };
    let _ = writeln!(text, "| printed latencies | | {} |", cells(&published()));
    // One line for each setting of the application's time.
    for time in times {
        let _ = writeln!(text, "| {} ms | +- {} ms | {} |", time.mean_ms, time.jitter_ms, cells(&time.figures));
    }
}

/// Maximum number of parameters that the document lists for each figure.
const STRONGEST: usize = 4;

fn sensitivity(text: &mut String, intervals: &[Interval]) {
    let _ = write!(
        text,
        "\n## Which parameter moves which figure\n\n\
         For the column *one at a time*, each derived or assumed parameter is set to both ends of its range, and the others keep\n\
         their values. For the column *joint*, random values within the ranges are chosen for all parameters of {SAMPLES} machines. For\n\
         the column *rules*, one answer to an open question of the papers changes at a time. All results about parameters come\n\
         from the analytic level. In the column *moved by*, the brackets give the figure at the low end and at the high end of\n\
         the parameter's range, and then the elasticity. The elasticity is the relative change of the figure divided by the\n\
         relative change of the parameter.\n\n\
         | # | one at a time | joint | 5 % to 95 % | moved by | rules |\n|---|---|---|---|---|---|\n"
    );
    // Only the strongest parameters of each figure are listed.
    for i in intervals {
        let strongest = i.effects.iter().take(STRONGEST);
        let effects: Vec<_> = strongest
            .map(|e| format!("`{}` ({}, {}; {:+.2})", e.path, four(e.ends[0]), four(e.ends[1]), e.elasticity))
            .collect();
        let moved = if effects.is_empty() { "nothing".to_owned() } else { effects.join(", ") };
        let single = range(i.one_at_a_time);
        let joint = range(i.joint);
        let likely = range(i.likely);
        let rules: Vec<_> = i.rules.iter().map(|(rule, value)| format!("{rule}: {}", four(*value))).collect();
        let rules = if rules.is_empty() { "nothing".to_owned() } else { rules.join(", ") };
        let _ = writeln!(text, "| {} | {single} | {joint} | {likely} | {moved} | {rules} |", i.id);
    }
}

fn head(text: &mut String, rows: &[FigureRow]) {
    let free = rows.iter().filter(|row| row.basis == Basis::Free).count();
    let missed = rows.iter().filter(|row| !row.is_met).count();
    let _ = write!(
        text,
        "# Accuracy\n\n\
         The command `pxpl5 figures --write ACCURACY.md` generates this file. The command `pxpl5 figures --check ACCURACY.md`\n\
         fails if the file is out of date.\n\n\
         This file compares each published figure with the result of the model. All results come from the same machine\n\
         parameters. The column *provenance* states whether a parameter or a rule of the model was chosen to reproduce the\n\
         published figure of a row:\n\n\
         - *free*: No parameter and no rule was chosen to reproduce the figure.\n\n\
         - *fitted*: One parameter was chosen so that the model reproduces the figure.\n\n\
         - *rule*: One rule of the model was chosen so that the model reproduces the figure.\n\n\
         A simulated value is a *miss* if it lies outside of the range that the paper prints. If the paper prints no range, an\n\
         error of more than {MISS_PERCENT} % is a miss.\n\n\
         Some papers do not print a condition of an experiment, for example the position of a sensor. For an experiment with an\n\
         unprinted condition, the brackets after the simulated value give the minimum and the maximum over all possible\n\
         conditions. The column *error* uses the value for one assumed condition. A figure with an unprinted condition is a miss\n\
         only if the model misses the figure under every condition.\n\n\
         The column *interval* gives the smallest and the largest value of the figure when unpublished parameters and the\n\
         interpretation of the papers vary. The parameters vary within their allowed ranges. The section \"Interpretations\" lists\n\
         the interpretations of the papers. The analytic level (formulas instead of events) computes the interval. The column\n\
         *analytic* gives the result of the analytic level with the normal parameters of the machines. The difference between\n\
         *analytic* and *simulated* is the error of the analytic level.\n\n\
         A published figure is *out of reach* if it lies outside of the interval by more than the error of the analytic level. A\n\
         figure that is out of reach shows an error in the rules of the model, because no allowed parameter reproduces the\n\
         figure. The interval of a figure is marked *not varied* if no parameter of the machine changes the figure. Such a\n\
         figure depends only on the scenes or on a motion.\n\n\
         The intervals of figures 17, 19 and 19b come from simulations with events. The simulations of figures 17, 19 and 19b\n\
         vary the depth of a renderer's FIFO and the number of channels that a sender can use. The interval of figure 17 also\n\
         covers the positions of the photodiode on the screen and the interpretations.\n\n\
         The table has {} figures, {free} of them free checks with a mean absolute error of {:.1} %; {missed} are missed.\n\n",
        rows.len(),
        mean_error_percent(rows),
    );
}

const COLUMNS: [TableColumn<FigureRow>; 8] = [
    NUMBER,
    STATEMENT,
    PUBLISHED,
    SIMULATED,
    ("error", |row| format!("{}{}", error(row), if row.is_met { "" } else { " **miss**" })),
    ("analytic", |row| row.analytic.map_or("-".to_owned(), four)),
    // A figure out of reach shows an error of the rules, not of a parameter.
    ("interval", |row| INTERVAL.1(row) + if row.is_out_of_reach() { ", **out of reach**" } else { "" }),
    PROVENANCE,
];

fn misses(text: &mut String, rows: &[FigureRow]) {
    let _ = writeln!(text, "\n## Misses and their causes");
    for row in rows.iter().filter(|row| !row.is_met) {
        let cause = row.cause_or_unknown().trim_end_matches('.');
        let out = if row.is_out_of_reach() {
            " This is a modelling error, because no allowed parameter values reproduce the figure."
        } else {
            ""
        };
        let _ = writeln!(text, "\n- Figure **{}** has an error of {}. {cause}.{out}", row.id, error(row));
    }
}
