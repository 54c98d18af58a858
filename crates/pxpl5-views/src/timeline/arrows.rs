//! Dependencies between the stages of one picture, from the sample of the pose until the picture is lit.

use super::model::{Arrow, Bar, DrawingPlace, Timeline};
use pxpl5_gp::Stage;
use pxpl5_run::PictureTimes;
use pxpl5_sim::Time;
use pxpl5_wire::SurfaceId;
use pxpl5_wire::display::Display;

/// Returns the dependencies between the stages of the picture `chosen` as arrows. Arrows outside the drawn time are
/// left out.
pub(super) fn arrows(timeline: &Timeline, display: &dyn Display, chosen: Option<&PictureTimes>) -> Vec<Arrow> {
    let Some(chosen) = chosen else { return Vec::new() };
    let bars = located(timeline);
    let mut arrows = Vec::new();
    arrows.extend(from_tracker(timeline, &bars));
    // Each bar of the picture depends on an earlier bar.
    for to in &bars {
        arrows.extend(cause(&bars, to.bar).map(|from| follow(from, *to)));
    }
    // The end of each COPY leads to the beam.
    for copy in bars.iter().filter(|located| located.bar.stage == Stage::Copy) {
        let end = light(display, chosen, copy.bar);
        arrows.push(Arrow { from: copy.place, begin: copy.bar.end.min(end), to: DrawingPlace::Beam, end });
    }
    // Arrows that leave the drawn time are left out.
    arrows.retain(|arrow| arrow.begin >= timeline.from && arrow.end <= timeline.to);
    arrows
}

/// A bar of a timeline with its row and its lane. If bars of a row overlap, the row is divided into lanes, one below
/// the other.
#[derive(Clone, Copy)]
struct Located<'a> {
    place: DrawingPlace,
    bar: &'a Bar,
}

fn located(timeline: &Timeline) -> Vec<Located<'_>> {
    let mut located = Vec::new();
    for (row, bars) in timeline.rows.iter().map(|row| &row.bars).enumerate() {
        let chosen = bars.iter().filter(|bar| timeline.is_chosen(bar));
        located.extend(chosen.map(|bar| Located { place: DrawingPlace::Lane { row, lane: bar.lane }, bar }));
    }
    located
}

fn from_tracker(timeline: &Timeline, bars: &[Located<'_>]) -> Option<Arrow> {
    timeline.samples.as_ref()?;
    let send = bars.iter().find(|located| located.bar.stage == Stage::Send)?;
    Some(Arrow { from: DrawingPlace::Tracker, begin: send.bar.begin, to: send.place, end: send.bar.begin })
}

/// Returns the bar on which `bar` depends. Usually this is the bar of the previous stage for the same surface.
///
/// There are three other cases. If the previous stage has a single bar for all surfaces, the function returns this bar.
/// The TRANSFORM of the second surface depends on the TRANSFORM of the first surface. The bottom half of a picture
/// depends on the top half.
fn cause<'a>(bars: &[Located<'a>], bar: &Bar) -> Option<Located<'a>> {
    let sibling = bars.iter().find(|other| other.bar.stage == bar.stage && is_sequel(other.bar, bar)).copied();
    if sibling.is_some() {
        return sibling;
    }
    let before: &[Stage] = match bar.stage {
        Stage::Edit => &[Stage::Send],
        Stage::Transform => &[Stage::Edit, Stage::Send],
        Stage::Render => &[Stage::Transform],
        Stage::Copy => &[Stage::Render],
        Stage::Sample | Stage::Send | Stage::Swap => &[],
    };
    before.iter().find_map(|stage| of_stage(bars, *stage, bar.surface))
}

fn of_stage<'a>(bars: &[Located<'a>], stage: Stage, surface: Option<SurfaceId>) -> Option<Located<'a>> {
    let mut of_stage = bars.iter().filter(|located| located.bar.stage == stage);
    of_stage.find(|located| concerns(located.bar.surface, surface)).copied()
}

/// Returns true if two bars have a surface in common. `one` and `other` are the surfaces of the bars. `None` stands for
/// all surfaces.
fn concerns(one: Option<SurfaceId>, other: Option<SurfaceId>) -> bool {
    one.is_none() || other.is_none() || one == other
}

fn is_sequel(first: &Bar, second: &Bar) -> bool {
    match second.stage {
        Stage::Transform => first.surface < second.surface && first.surface.is_some(),
        Stage::Copy => first.surface == second.surface && first.bottom == Some(false) && second.bottom == Some(true),
        _ => false,
    }
}

/// Returns the arrow from the bar of an earlier stage to the bar of a later stage.
///
/// The later stage may begin before the earlier stage ends, because it needs only a part of the earlier stage's result.
/// The arrow is then vertical.
fn follow(earlier: Located<'_>, later: Located<'_>) -> Arrow {
    let from = earlier.place;
    let to = later.place;
    if later.bar.begin < earlier.bar.begin {
        return Arrow { from, begin: earlier.bar.end, to, end: earlier.bar.end };
    }
    Arrow { from, begin: earlier.bar.end.min(later.bar.begin), to, end: later.bar.begin }
}

/// Returns the time at which the display lights the first line of a COPY bar, in the period that first shows the
/// picture.
///
/// The result is never earlier than the time from which the picture counts as shown (`shown_at`).
fn light(display: &dyn Display, chosen: &PictureTimes, bar: &Bar) -> Time {
    let period = display.period_at(chosen.shown_at);
    let surface = bar.surface.map_or(0, SurfaceId::index);
    display.line_lights(surface, 0, bar.first_line, period).unwrap_or_default().max(chosen.shown_at)
}
