use super::PlotArgs;
use super::question::{Group, text};
use pxpl5::views::charts::{AxisScale, Chart, ChartAxes, ChartPoint, ChartSeries, ChartSize, SeriesStyle};

/// Returns the chart of groups of rows, in which each group is one point of a curve. Numbers on the x axis are sorted.
/// Names on the x axis have the order of the rows.
pub(super) fn chart(args: &PlotArgs, groups: &[Group]) -> Chart {
    let names = names_across(groups);
    let mut curves: Vec<&[String]> = Vec::new();
    for group in groups {
        if !curves.contains(&group.by.as_slice()) {
            curves.push(&group.by);
        }
    }
    // A curve without points is left out, because its name in the legend would suggest hidden points.
    let series = curves.iter().map(|by| series_of(by, groups, names.as_deref())).filter(has_a_point).collect();
    let axes = ChartAxes {
        title: args.title.clone(),
        across: args.x_label.clone().unwrap_or_else(|| args.question.x.clone()),
        up: args.y_label.clone().unwrap_or_else(|| args.question.y.clone()),
    };
    let across = names.map_or_else(|| args.x_scale.scale(), AxisScale::Names);
    Chart { axes, across, up: args.y_scale.scale(), series, size: ChartSize::Column { width_mm: args.width } }
}

/// Returns the distinct names on the x axis in the order of the rows, or `None` if all x values are numbers.
fn names_across(groups: &[Group]) -> Option<Vec<String>> {
    if groups.iter().all(|group| group.x.is_number() || group.x.is_null()) {
        return None;
    }
    let mut names: Vec<String> = Vec::new();
    for name in groups.iter().map(|group| text(&group.x)) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    Some(names)
}

fn has_a_point(series: &ChartSeries) -> bool {
    series.points.iter().any(|point| point.at.0.is_finite() && point.at.1.is_finite())
}

fn series_of(by: &[String], groups: &[Group], names: Option<&[String]>) -> ChartSeries {
    let across = |group: &Group| match names {
        Some(names) => {
            let name = text(&group.x);
            names.iter().position(|candidate| *candidate == name).map_or(f64::NAN, |place| place as f64)
        }
        None => group.x.as_f64().unwrap_or(f64::NAN),
    };
    let own = groups.iter().filter(|group| group.by == by && group.n > 0);
    let mut points: Vec<ChartPoint> = own.map(|group| point(group, across(group))).collect();
    points.sort_by(|one, other| one.at.0.total_cmp(&other.at.0));
    let is_curve = names.is_none() && points.len() > 1;
    let style = if is_curve { SeriesStyle::Band } else { SeriesStyle::Points };
    ChartSeries { name: by.join(", "), points, style }
}

/// Returns the point of a group. The point is hollow if some due pictures of the group were not shown, because the mean
/// covers only shown pictures.
fn point(group: &Group, across: f64) -> ChartPoint {
    ChartPoint { at: (across, group.mean), interval: group.interval, is_hollow: group.counts.has_missing_pictures() }
}
