//! The document ACCURACY.md, generated from the figures.

use super::{FigureRow, Figures, MISS_PERCENT, Reading, mean_error_percent};
use crate::application_time::{ApplicationTime, Spread, published};
use crate::intervals::{Interval, SAMPLES};
use crate::levels::deviation_percent;
use crate::readings::{self, FigureFit, Fit, Readings};
use std::fmt::Write as _;

/// Returns ACCURACY.md: a table of all figures, then each miss with its cause.
#[must_use]
pub fn markdown(figures: &Figures) -> String {
    let mut text = String::new();
    let rows = &figures.rows;
    // The order of sections: table, misses, then the comparisons that qualify the table.
    head(&mut text, rows);
    rows.iter().for_each(|row| line(&mut text, row));
    misses(&mut text, rows);
    of_code(&mut text, rows, &figures.of_code);
    figures.groups.iter().for_each(|group| text.push_str(&group.markdown()));
    figures.families.iter().for_each(|family| text.push_str(&family.markdown()));
    of_readings(&mut text, &figures.readings);
    of_application(&mut text, &figures.application_times);
    sensitivity(&mut text, &figures.intervals);
    experiments(&mut text, rows);
    text
}

/// Minimum difference, in percent, between the timing table and executed code for a figure to be listed.
const MOVED_PERCENT: f64 = 0.05;

/// Writes the figures that change with the times of executed code, and the reason why these times are not the
/// default.
fn of_code(text: &mut String, rows: &[FigureRow], of_code: &[FigureRow]) {
    let _ = write!(
        text,
        "\n## Times of primitives from the code instead\n\n\
         The timing table above has published or fitted times of primitives: 21.7 us for a triangle of optimised PPHIGS (published\n\
         rate), 30.0 and 55.8 us for the Slats of 1994 and 1995 (fitted to figures 12 and 14). `machine.times = \"code\"` takes instead\n\
         what our i860 code takes, as a mean over the application scenes (docs/gp-timing.md), with nothing fitted. Figures that\n\
         differ, at the transaction level:\n\n\
         | # | figure | published | table | error | code | error |\n|---|---|---|---|---|---|---|\n"
    );
    // Figures that do not depend on the times are left out.
    let moved =
        |(table, code): &(&FigureRow, &FigureRow)| deviation_percent(code.simulated, table.simulated) > MOVED_PERCENT;
    for (table, code) in rows.iter().zip(of_code).filter(moved) {
        let _ = writeln!(
            text,
            "| {} | {} | {} {} | {} | {:+.1} % | {} | {:+.1} % |",
            table.id,
            table.statement,
            number(table.published),
            table.unit,
            number(table.simulated),
            table.error_percent,
            if code.simulated.is_finite() { number(code.simulated) } else { "none".to_owned() },
            if code.simulated.is_finite() { code.error_percent } else { -100.0 },
        );
    }
    let _ = write!(
        text,
        "\nMean error of the free checks: {:.1} % with the table, {:.1} % with the code (a figure without value counts 100 %). Most\n\
         moved are the limits of Slats, whose code takes other times than those that were fitted to them. No triangle of these figures is\n\
         clipped.\n\
         The published and fitted table stays the default: two of its three times are what the papers' limits of triangles say\n\
         of their own code, whose source nobody has; ours is other code for the same processor, under rules of freezing and memory\n\
         that are assumed in part. What it shows is how far a program of that time explains the figures without a fit.\n",
        mean_error_percent(rows),
        mean_error_percent(of_code),
    );
}

/// Number of interpretations listed.
const BEST: usize = 12;

/// Writes the table of interpretations: the figures that each explains, and the confidence of the choice.
fn of_readings(text: &mut String, readings: &Readings) {
    // State how likely the default interpretation is, compared with the most likely one.
    let fits = &readings.analytic;
    let likeliest = fits.iter().map(|fit| fit.log_likelihood).fold(f64::NEG_INFINITY, f64::max);
    let usual = fits.iter().find(|fit| fit.reading == Reading::USUAL).map_or(f64::NAN, |fit| fit.log_likelihood);
    let place = |reading: &Reading| fits.iter().position(|fit| fit.reading == *reading).map_or(0, |place| place + 1);
    let _ = write!(
        text,
        "\n## Readings: what the papers leave open\n\n\
         Whose latency a printed mean is of, how fields were counted, how many finished regions a renderer keeps, what the\n\
         master does with it meanwhile, which machine drew the application scenes, whether back faces were culled, and whether\n\
         the bins were full with one eye's triangles or with both: {} combinations, each with one machine for all figures,\n\
         at the analytic level (`pxpl5 readings` measures the best ones with events too). *Mean* and *worst* are errors in\n\
         percent; *log L* the logarithm of the likelihood of the printed means and deviations with an error of 2 % for what no\n\
         paper gives. The figures of theory (3 and 5) are derived from the rules, not measured, so they are compared with the\n\
         rules alone and tell no reading from another; nor do 4b and 17.\n\n\
         | mean | worst | log L | {} | reading |\n|---|---|---|{}---|\n",
        fits.len(),
        readings::FIGURES.join(" | "),
        "---|".repeat(readings::FIGURES.len()),
    );
    // The table lists only the best interpretations.
    fits.iter().take(BEST).for_each(|fit| text.push_str(&fitted(fit)));
    let _ = write!(
        text,
        "\nChosen: **{}**, number {} of them. The likeliest of all is {:.1} times as likely;\n\
         {} readings are as good as the first one within the digits that the papers print ({:.2} % of a mean error). What decides:\n\n\
         - *each eye, whole fields*: the application figures are printed in fields, and a mean of 4.47 with a deviation of 0.502 is\n  \
           what samples of 4 and 5 give, half and half (4.61 with 0.589 needs a few of 6). The first eyes alone deviate by 0.1.\n\
         - *room for all*: 4,096 bits a pixel hold 128 regions of 32 bits; a smaller number would have to be a rule of the software.\n\
         - *wait*: with room for all, `store` makes figure 4 6 % late and `wait` 1 to 2 %; the text reads either way.\n\
         - *large, culled*: on the small machine, or with all faces, the head takes twice the printed time.\n\
         - *bins of one eye*: else 7,700 triangles take 454 ms for the printed 293. No text says so; it is chosen for figures 16b\n  \
           and 16c and counts for no other.\n\n\
         Each figure left out in turn and predicted by the reading that the others choose:\n\n\
         | # | error | the others' choice |\n|---|---|---|\n",
        Reading::USUAL,
        place(&Reading::USUAL),
        (likeliest - usual).exp(),
        readings.as_good,
        readings.rounding_percent,
    );
    // Each figure is predicted without its own data.
    for left_out in &readings.left_out {
        let _ = writeln!(text, "| {} | {:+.1} % | {} |", left_out.id, left_out.error_percent, left_out.words);
    }
}

/// Returns a row of the table of interpretations. Figures that the interpretation does not explain are bold.
fn fitted(fit: &Fit) -> String {
    let value = |figure: &FigureFit| {
        let sd = figure.simulated_sd.map_or(String::new(), |sd| format!(" ({sd:.2})"));
        let text = format!("{}{sd}", number(figure.simulated));
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

/// Writes the effect of the application's time on the mean and deviation of the fly-throughs.
fn of_application(text: &mut String, times: &[ApplicationTime]) {
    text.push_str(
        "\n## The application's time a frame\n\n\
         The host of a viewer ran an application, which took its time before it asked for the next frame. No paper prints that time. The\n\
         presets ask at once. Here it moves (`host.application_ns`, `host.application_jitter_ns`) up to 40 ms, spread by up to the 30 ms in which\n\
         a Unix host polls its serial lines (TR94); both ends are assumed. Mean latency in fields, with the deviation in brackets, at the\n\
         analytic level. Nothing is fitted. What fits between two frames of 33.4 ms changes nothing, since the host is a frame ahead.\n\n\
         | mean of the application | evenly spread by | 7 | 7b | 7c |\n|---|---|---|---|---|\n",
    );
    let cells = |figures: &[Spread]| {
        let cells = figures.iter().map(|figure| format!("{} ({:.3})", number(figure.mean), figure.sd));
        cells.collect::<Vec<_>>().join(" | ")
    };
    let _ = writeln!(text, "| printed latencies | | {} |", cells(&published()));
    // One line for each setting of the application's time.
    for time in times {
        let _ = writeln!(text, "| {} ms | +- {} ms | {} |", time.mean_ms, time.jitter_ms, cells(&time.figures));
    }
}

/// Number of parameters listed for each figure.
const STRONGEST: usize = 4;

fn sensitivity(text: &mut String, intervals: &[Interval]) {
    let _ = write!(
        text,
        "\n## Which parameter moves which figure\n\n\
         Every derived or assumed parameter moved to the ends of its range, one at a time, and {SAMPLES} machines with\n\
         all of them drawn from their ranges; then every open question of the papers answered otherwise, one at a time (*rules*).\n\
         All at the analytic level. In brackets the figure at the low and the high\n\
         end, then the elasticity (relative change of the figure over relative change of the parameter).\n\n\
         | # | one at a time | joint | 5 % to 95 % | moved by | rules |\n|---|---|---|---|---|---|\n"
    );
    // Only the strongest parameters of each figure are listed.
    for i in intervals {
        let strongest = i.effects.iter().take(STRONGEST);
        let effects: Vec<_> = strongest
            .map(|e| format!("`{}` ({}, {}; {:+.2})", e.path, number(e.ends[0]), number(e.ends[1]), e.elasticity))
            .collect();
        let moved = if effects.is_empty() { "nothing".to_owned() } else { effects.join(", ") };
        let single = range(i.one_at_a_time);
        let joint = range(i.joint);
        let likely = range(i.likely);
        let rules: Vec<_> = i.rules.iter().map(|(rule, value)| format!("{rule}: {}", number(*value))).collect();
        let rules = if rules.is_empty() { "nothing".to_owned() } else { rules.join(", ") };
        let _ = writeln!(text, "| {} | {single} | {joint} | {likely} | {moved} | {rules} |", i.id);
    }
}

fn range([low, high]: [f64; 2]) -> String {
    format!("{} to {}", number(low), number(high))
}

fn head(text: &mut String, rows: &[FigureRow]) {
    let free = rows.iter().filter(|row| row.standing == "free").count();
    let missed = rows.iter().filter(|row| row.misses()).count();
    let _ = write!(
        text,
        "# Accuracy\n\n\
         Generated by `pxpl5 figures --write ACCURACY.md`; `pxpl5 figures --check ACCURACY.md` fails when it is stale.\n\n\
         Every published figure beside what the model gives, all from the same machine parameters. *Free*: nothing was\n\
         chosen so that the figure comes out. *Fitted*: a parameter was. *Rule*: a rule of the model was. A *miss* is\n\
         outside of the printed range, or off by more than {MISS_PERCENT} % where none is printed. In brackets behind a simulated value:\n\
         least and greatest over a condition that the paper does not print. The error is that of the condition that is assumed; a\n\
         *miss* is one for every value of the condition.\n\n\
         The interval is what the figure does when parameters that are not published move within their allowed ranges, and when\n\
         what the papers leave open is read otherwise (see Readings). It is\n\
         computed at the analytic level and stands as computed; *analytic* is that level with the presets' numbers, so that\n\
         its distance from *simulated* is the level's own error. A figure is *out of reach* when it lies outside of the\n\
         interval even if this is widened by that distance on both sides: an error of the model's rules, not of a number.\n\
         A figure that is *not varied* is a property of the scenes or of a motion, which no parameter moves. The intervals of figures 17,\n\
         19 and 19b are measured with events: the depth of a renderer's FIFO and the channels of a sender move in them, in that of 17 the\n\
         photodiode's place on the screen and the readings too.\n\n\
         {} figures, {free} of them free checks with a mean absolute error of {:.1} %; {missed} are missed.\n\n\
         | # | figure | published | simulated | error | analytic | interval | standing |\n\
         |---|---|---|---|---|---|---|---|\n",
        rows.len(),
        mean_error_percent(rows),
    );
}

fn line(text: &mut String, row: &FigureRow) {
    let analytic = row.analytic.map_or("-".to_owned(), number);
    // A figure out of reach shows an error of the rules, not of a parameter.
    let interval = row.interval.map_or("not varied".to_owned(), |bounds| {
        let outside = if row.is_out_of_reach() { ", **out of reach**" } else { "" };
        format!("{}{outside}", range(bounds))
    });
    let spread = row.spread.map_or(String::new(), |spread| format!(" +- {}", number(spread)));
    let miss = if row.misses() { " **miss**" } else { "" };
    let unprinted = row.unprinted.map_or(String::new(), |bounds| format!(" ({})", range(bounds)));
    let _ = writeln!(
        text,
        "| {} | {} ({}) | {}{spread} {} | {} {}{unprinted} | {:+.1} %{miss} | {analytic} | {interval} | {} |",
        row.id,
        row.statement,
        row.source,
        number(row.published),
        row.unit,
        number(row.simulated),
        row.unit,
        row.error_percent,
        standing(row),
    );
}

fn standing(row: &FigureRow) -> String {
    if row.fitted.is_empty() { row.standing.to_owned() } else { format!("{}: {}", row.standing, row.fitted) }
}

fn misses(text: &mut String, rows: &[FigureRow]) {
    let _ = writeln!(text, "\n## Misses, and what is known of their causes\n");
    for row in rows.iter().filter(|row| row.misses()) {
        let cause = if row.cause.is_empty() { "the cause is not known" } else { row.cause };
        let out =
            if row.is_out_of_reach() { " A modelling error: no allowed parameter values give the figure." } else { "" };
        let _ = writeln!(text, "- **{}**, {:+.1} %: {cause}.{out}", row.id, row.error_percent);
    }
}

fn experiments(text: &mut String, rows: &[FigureRow]) {
    let _ = writeln!(text, "\n## Experiments\n");
    for row in rows {
        let details: Vec<_> =
            row.details.iter().map(|d| format!("{} {} {}", d.name, number(d.value), d.unit)).collect();
        let also = if details.is_empty() { String::new() } else { format!(" Also: {}.", details.join(", ")) };
        let _ = writeln!(text, "- **{}**: {}.{also}", row.id, row.experiment);
    }
}

/// Formats a number with four significant digits and without trailing zeros.
fn number(value: f64) -> String {
    // The number of decimals follows from the magnitude.
    let digits = if value == 0.0 { 0 } else { (3 - value.abs().log10().floor() as i32).max(0) as usize };
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    #[test]
    fn numbers_have_four_significant_digits() {
        let texts = [54.116, 780.0, 1.0, 0.0, 16_800.0].map(super::number);
        assert_eq!(texts, ["54.12", "780", "1", "0", "16800"]);
    }
}
