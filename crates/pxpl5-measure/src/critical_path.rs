//! The chain of waits that ends with a picture on the screen.
//!
//! The chain is followed backwards, from the picture on the screen to the start of its TRANSFORM. Each step leads from
//! a piece of work to the earlier work whose end allowed this piece to begin. Each instant of the latency belongs to
//! one resource, so the shares add up to 1.

use crate::resource::Resource;
use crate::trail::{Step, Trail};
use pxpl5_machine::{Board, Record};
use pxpl5_run::{Outcome, PictureTimes, Stepper};
use pxpl5_sim::Span;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// The share of a latency in which a picture waits for one resource.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PathPart {
    /// The resource that the picture waits for.
    pub resource: Resource,
    /// Share of the latency for which the picture waits for the resource, 0 to 1.
    pub share: f64,
    /// Mean waiting time over the followed pictures, in milliseconds.
    pub ms: f64,
    /// The board that causes the largest share of this waiting time. `None` if the records name no board.
    pub board: Option<String>,
    /// Share of this waiting time that the board causes, 0 to 1.
    pub share_of_board: Option<f64>,
}

/// The waits of the last complete pictures of a run, from the screen back to the start of TRANSFORM.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CriticalPath {
    /// Number of pictures that were followed: the last complete pictures of the result window, at most
    /// [`PICTURES_FOLLOWED`].
    pub pictures: usize,
    /// Mean latency of the followed pictures from the start of TRANSFORM to the screen, in milliseconds.
    pub latency_ms: f64,
    /// The waits of the followed pictures for each resource, with the largest share first.
    pub parts: Vec<PathPart>,
    /// The wait with the largest share, as a sentence.
    pub limited_by: String,
    /// Waits of the last followed picture as text, from the screen back to the start of TRANSFORM.
    pub chain: Vec<String>,
}

/// Largest number of pictures whose chains of waits are followed back from the screen to TRANSFORM.
///
/// A long run discards old records, but keeps all records of its last 24 pictures.
pub const PICTURES_FOLLOWED: usize = 24;

const LINKS_PRINTED: usize = 16;

impl CriticalPath {
    /// Returns the chain of waits of a run's last complete pictures. Returns `None` if no picture was complete, or if
    /// the total latency is zero.
    pub fn of(outcome: &Outcome) -> Option<Self> {
        let all: Vec<&PictureTimes> = outcome.complete_pictures().collect();
        Self::of_last(outcome.record(), &all)
    }

    /// Returns the chain of waits of one picture, back from the instant at which it is shown or was due. Returns `None`
    /// if its latency is zero.
    pub fn of_picture(outcome: &Outcome, times: &PictureTimes) -> Option<Self> {
        Self::of_last(outcome.record(), &[times])
    }

    /// Returns the chain of waits of the last complete pictures of a run so far. Returns `None` before the first
    /// complete picture.
    pub fn so_far(run: &Stepper) -> Option<Self> {
        let is_on_screen = |times: &&PictureTimes| times.is_shown() && times.shown_at <= run.now();
        let pictures = run.pictures();
        let all: Vec<&PictureTimes> = pictures.iter().filter(is_on_screen).collect();
        Self::of_last(run.record(), &all)
    }

    fn of_last(record: &Record, all: &[&PictureTimes]) -> Option<Self> {
        let pictures = &all[all.len().saturating_sub(PICTURES_FOLLOWED)..];
        let earliest = pictures.iter().map(|times| times.transform_at).min()?;
        let trail = Trail::of(record, earliest);
        let chains: Vec<Vec<Step>> = pictures.iter().map(|times| trail.follow(times)).collect();
        Self::of_chains(&chains)
    }

    fn of_chains(chains: &[Vec<Step>]) -> Option<Self> {
        let pictures = chains.len();
        let total: Span = chains.iter().flatten().map(Step::span).sum();
        if pictures == 0 || total == Span::ZERO {
            return None;
        }
        let mut parts: Vec<PathPart> =
            Resource::ALL.into_iter().filter_map(|resource| part(resource, chains, total)).collect();
        parts.sort_by(|a, b| b.share.total_cmp(&a.share));
        let limited_by = parts.first().map(ToString::to_string)?;
        let chain = chains.last().map(|steps| links_text(steps)).unwrap_or_default();
        Some(Self { pictures, latency_ms: total.as_ms() / pictures as f64, parts, limited_by, chain })
    }

    /// Returns the share of the latency in which pictures wait for a resource, 0 to 1.
    pub fn share(&self, resource: Resource) -> f64 {
        self.parts.iter().find(|part| part.resource == resource).map_or(0.0, |part| part.share)
    }
}

fn part(resource: Resource, chains: &[Vec<Step>], total: Span) -> Option<PathPart> {
    let of = || chains.iter().flatten().filter(|step| step.resource == resource);
    let span: Span = of().map(Step::span).sum();
    if span == Span::ZERO {
        return None;
    }
    // Sum the time of each board, to name the board that causes most of the wait.
    let mut boards: BTreeMap<Board, Span> = BTreeMap::new();
    of().filter_map(|step| Some((step.board?, step.span()))).for_each(|(board, span)| {
        *boards.entry(board).or_default() += span;
    });
    let most = boards.into_iter().max_by_key(|(_, span)| *span);
    Some(PathPart {
        resource,
        share: span.0 as f64 / total.0 as f64,
        ms: span.as_ms() / chains.len() as f64,
        board: most.map(|(board, _)| board.to_string()),
        share_of_board: most.map(|(_, of_board)| of_board.0 as f64 / span.0 as f64),
    })
}

/// If one board causes at least this share of the wait for a resource, the text names the board. The value affects only
/// the printed text.
const NAMED_ALONE: f64 = 0.75;

impl fmt::Display for PathPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {:.0} % of the latency", self.resource.about(), self.share * 100.0)?;
        // A machine usually has one display and one ring, so their names give no information.
        let is_shared = matches!(self.resource, Resource::Ports | Resource::Retrace | Resource::Ring);
        let is_of_one = !is_shared && self.share_of_board.is_some_and(|share| share >= NAMED_ALONE);
        match &self.board {
            Some(board) if is_of_one => {
                write!(f, " ({:.0} % of that: {board})", self.share_of_board.unwrap_or_default() * 100.0)
            }
            _ => Ok(()),
        }
    }
}

/// Joins consecutive waits for the same resource and board. Returns the first [`LINKS_PRINTED`] joined waits as text.
fn links_text(steps: &[Step]) -> Vec<String> {
    let mut links: Vec<(String, Span, usize)> = Vec::new();
    let mut last: Option<(Resource, Option<Board>)> = None;
    // A link is a sequence of steps with the same resource and board.
    for step in steps {
        let kind = (step.resource, step.board);
        match links.last_mut().filter(|_| last == Some(kind)) {
            Some((_, span, count)) => {
                *span += step.span();
                *count += 1;
            }
            None => links.push((step.what.clone(), step.span(), 1)),
        }
        last = Some(kind);
    }
    let more = links.len().saturating_sub(LINKS_PRINTED);
    let mut lines: Vec<String> = links.into_iter().take(LINKS_PRINTED).map(|link| line(&link)).collect();
    if more > 0 {
        lines.push(format!("and {more} links before"));
    }
    lines
}

fn line((what, span, count): &(String, Span, usize)) -> String {
    let others = if *count > 1 { format!(" and {} before", count - 1) } else { String::new() };
    format!("{what}{others}: {:.3} ms", span.as_ms())
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_sim::Time;

    fn step(resource: Resource, board: Option<Board>, from: u64, to: u64) -> Step {
        let ms = 1_000_000_000;
        Step { resource, board, from: Time(from * ms), to: Time(to * ms), what: format!("{resource:?}") }
    }

    #[test]
    fn the_shares_of_a_critical_path_add_up_and_the_largest_share_is_the_limit() {
        let renderer = Some(Board::Renderer(3));
        let chain = vec![
            step(Resource::Retrace, None, 90, 100),
            step(Resource::Ports, Some(Board::Display(0)), 70, 90),
            step(Resource::Renderers, renderer, 10, 70),
            step(Resource::Transform, Some(Board::Gp(4)), 0, 10),
        ];
        let path = CriticalPath::of_chains(&[chain]).expect("a picture");
        let shares: Vec<f64> = path.parts.iter().map(|part| part.share).collect();
        assert_eq!(shares, [0.6, 0.2, 0.1, 0.1]);
        assert_eq!(
            path.limited_by,
            "execution of commands in the renderers, 60 % of the latency (100 % of that: renderer 3)"
        );
        assert!((path.latency_ms - 100.0).abs() < 1e-9);
        assert_eq!(path.share(Resource::Ring), 0.0);
    }

    #[test]
    fn no_board_is_named_if_several_share_the_part() {
        let half = |number, from, to| step(Resource::Renderers, Some(Board::Renderer(number)), from, to);
        let path = CriticalPath::of_chains(&[vec![half(0, 50, 100), half(1, 0, 50)]]).expect("a picture");
        assert_eq!(path.limited_by, "execution of commands in the renderers, 100 % of the latency");
    }

    #[test]
    fn adjacent_links_of_one_kind_are_joined_in_the_text_of_a_critical_path() {
        let port = Some(Board::Display(0));
        let chain = vec![
            step(Resource::Ports, port, 20, 30),
            step(Resource::Ports, port, 10, 20),
            step(Resource::Transform, Some(Board::Gp(1)), 0, 10),
        ];
        assert_eq!(links_text(&chain), ["Ports and 1 before: 20.000 ms", "Transform: 10.000 ms"]);
    }

    #[test]
    fn without_a_picture_there_is_no_critical_path() {
        assert_eq!(CriticalPath::of_chains(&[]), None);
    }
}
