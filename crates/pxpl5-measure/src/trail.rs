//! Follows a picture backwards in time, through the work for which the picture waited.

use crate::resource::Resource;
use pxpl5_gp::{Stage, StageEdge};
use pxpl5_machine::{Arrival, Board, Record};
use pxpl5_renderer::DrawnRegion;
use pxpl5_run::PictureTimes;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{CopyTarget, NodeId, PictureNumber, SurfaceId};
use std::collections::{BTreeMap, HashMap, HashSet};

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Step {
    pub(crate) resource: Resource,
    pub(crate) board: Option<Board>,
    pub(crate) from: Time,
    pub(crate) to: Time,
    pub(crate) what: String,
}

impl Step {
    pub(crate) fn span(&self) -> Span {
        self.to.since(self.from)
    }
}

#[derive(Clone, Copy, Debug)]
struct StageWork {
    node: NodeId,
    picture: PictureNumber,
    surface: Option<SurfaceId>,
    stage: Stage,
    begin: Time,
    end: Time,
}

/// Times that differ by less than this duration count as one instant (assumed). A signal or a hop of the ring takes a
/// few cycles. A region's transfer takes 780 us (TR94).
const NEAR: Span = Span::from_us(20);

/// A display port counts as busy if it was free for less than 1/`SLACK` of the time of a region's transfer (assumed).
/// Without this rule, the token would count as the cause of a wait whenever port and token become free at nearly the
/// same time.
const SLACK: u64 = 4;

/// Largest number of earlier arrivals of regions among which the cause of a wait is searched (assumed). This number
/// covers several pictures of 40 regions.
const ARRIVALS_SEARCHED: usize = 512;

/// Largest number of steps that are followed for one picture. The part of the latency before these steps is assigned to
/// [`Resource::Other`].
const MAX_STEPS: usize = 20_000;

/// The work of a run from a chosen instant on, sorted by end time.
pub(crate) struct Trail<'a> {
    record: &'a Record,
    message: Span,
    /// Time to copy a region into the renderer's backing store.
    store: Span,
    arrivals: Vec<&'a Arrival>,
    drawn: Vec<(usize, DrawnRegion)>,
    of_target: HashMap<CopyTarget, Vec<usize>>,
    of_renderer: BTreeMap<usize, Vec<usize>>,
    surface_of_port: BTreeMap<NodeId, SurfaceId>,
    stages: Vec<StageWork>,
    /// Earliest start of RENDER on any renderer, for each picture and surface.
    render_begins: BTreeMap<(PictureNumber, Option<SurfaceId>), Time>,
    render_ends: Vec<(Time, PictureNumber, Option<SurfaceId>)>,
    swaps: Vec<Time>,
}

/// Current position while a picture is followed backwards through the events before it. The number in a variant is
/// called `index` below.
#[derive(Clone, Copy, Debug)]
enum At {
    /// Start of the transfer of the region `arrivals[index]` to a display.
    Arrival(usize),
    /// End of the commands of the region `drawn[index]` on a renderer.
    Drawn(usize),
    /// End of the stage `stages[index]` on a board, or an instant within the stage.
    Stage(usize),
    /// Start of the latency, where the path ends.
    Begin,
}

/// Steps found so far, from the end of the latency backwards. Each step ends where the preceding step of the list
/// begins.
struct Way {
    steps: Vec<Step>,
    cursor: Time,
    floor: Time,
}

impl Way {
    /// Assigns the time from `from` to the current position (`cursor`) to a resource, as a new step of the path.
    fn charge(&mut self, resource: Resource, board: Option<Board>, from: Time, what: impl FnOnce() -> String) {
        let from = from.max(self.floor);
        if from >= self.cursor {
            return;
        }
        self.steps.push(Step { resource, board, from, to: self.cursor, what: what() });
        self.cursor = from;
    }

    fn messages(&mut self, from: Time) {
        self.charge(Resource::Messages, None, from, || "messages".to_owned());
    }

    fn is_over(&self) -> bool {
        self.cursor <= self.floor || self.steps.len() >= MAX_STEPS
    }
}

impl<'a> Trail<'a> {
    pub(crate) fn of(record: &'a Record, earliest: Time) -> Self {
        let observation = record.observation();
        let mut arrivals: Vec<&Arrival> = observation.arrivals.iter().filter(|a| a.last_part_at >= earliest).collect();
        arrivals.sort_by_key(|arrival| arrival.last_part_at);
        // A renderer may have stored a region long before its transfer, so the instant of the store is not enough.
        let arrived: HashSet<CopyTarget> = arrivals.iter().map(|arrival| arrival.target).collect();
        let is_followed = |region: &DrawnRegion| region.copy_at >= earliest || arrived.contains(&region.target);
        let drawn: Vec<(usize, DrawnRegion)> =
            observation.drawn.iter().filter(|(_, region)| is_followed(region)).copied().collect();
        // Index the drawn regions by destination and by renderer, because the search follows both.
        let mut of_target: HashMap<CopyTarget, Vec<usize>> = HashMap::with_capacity(drawn.len());
        let mut of_renderer: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (place, (renderer, region)) in drawn.iter().enumerate() {
            of_target.entry(region.target).or_default().push(place);
            of_renderer.entry(*renderer).or_default().push(place);
        }
        let surface_of_port = arrivals.iter().map(|a| (a.target.frame_buffer, a.surface)).collect();
        let mut swaps: Vec<Time> = observation.swaps.iter().map(|swap| record.tick(swap.tick)).collect();
        swaps.sort_unstable();
        let mut trail = Self {
            record,
            message: record.message_span(),
            store: record.config().renderer.backing_block(),
            arrivals,
            drawn,
            of_target,
            of_renderer,
            surface_of_port,
            stages: Vec::new(),
            render_begins: BTreeMap::new(),
            render_ends: Vec::new(),
            swaps,
        };
        trail.take_marks(earliest);
        trail
    }

    /// Collects the stages of each board. The records of a stage's start and of its end are joined into one stage.
    fn take_marks(&mut self, earliest: Time) {
        let mut open: BTreeMap<(NodeId, PictureNumber, Option<SurfaceId>, Stage), Time> = BTreeMap::new();
        let mut ends: BTreeMap<(PictureNumber, Option<SurfaceId>), Time> = BTreeMap::new();
        for mark in &self.record.observation().marks {
            let of_all = (mark.picture, mark.surface);
            let key = (mark.node, mark.picture, mark.surface, mark.stage);
            match (mark.stage, mark.edge) {
                (Stage::Render, StageEdge::Begin) => {
                    let begin = self.render_begins.entry(of_all).or_insert(mark.time);
                    *begin = mark.time.min(*begin);
                }
                (Stage::Render, StageEdge::End) => {
                    let end = ends.entry(of_all).or_insert(mark.time);
                    *end = mark.time.max(*end);
                }
                (Stage::Send | Stage::Edit | Stage::Transform, StageEdge::Begin) => {
                    open.insert(key, mark.time);
                }
                (Stage::Send | Stage::Edit | Stage::Transform, StageEdge::End) => {
                    if let Some(begin) = open.remove(&key).filter(|_| mark.time >= earliest) {
                        let (node, picture, surface, stage) = key;
                        self.stages.push(StageWork { node, picture, surface, stage, begin, end: mark.time });
                    }
                }
                _ => {}
            }
        }
        // A picture can also wait for a stage that has not ended.
        let still = open.into_iter().map(|((node, picture, surface, stage), begin)| {
            let end = Time(u64::MAX);
            StageWork { node, picture, surface, stage, begin, end }
        });
        self.stages.extend(still);
        self.stages.sort_by_key(|work| work.end);
        self.render_ends = ends.into_iter().map(|((picture, surface), end)| (end, picture, surface)).collect();
        self.render_ends.sort_unstable();
    }

    /// Follows a picture from the screen back to the start of its TRANSFORM.
    pub(crate) fn follow(&self, times: &PictureTimes) -> Vec<Step> {
        let mut way = Way { steps: Vec::new(), cursor: times.shown_at, floor: times.transform_at };
        let of_picture = |arrival: &&Arrival| arrival.target.picture == times.picture;
        // The chain starts at the last region of the picture that arrived before the picture was shown.
        let last = self.arrivals[..self.arrivals_by(times.shown_at)].iter().rposition(of_picture);
        let mut at = match last {
            Some(last) => {
                self.wait_for_retrace(&mut way, self.arrivals[last].last_part_at);
                At::Arrival(last)
            }
            None => At::Begin,
        };
        let mut steps = 0;
        // Each step moves the cursor back in time to the end of the work that was waited for.
        while !way.is_over() && !matches!(at, At::Begin) && steps < MAX_STEPS {
            at = match at {
                At::Arrival(place) => self.before_arrival(&mut way, place),
                At::Drawn(place) => self.before_drawn(&mut way, place),
                At::Stage(place) => self.before_stage(&mut way, place),
                At::Begin => At::Begin,
            };
            steps += 1;
        }
        let floor = way.floor;
        way.charge(Resource::Other, None, floor, || "no record".to_owned());
        way.steps
    }

    fn wait_for_retrace(&self, way: &mut Way, from: Time) {
        way.charge(Resource::Retrace, Some(Board::Display(0)), from, || "retrace".to_owned());
    }

    fn arrivals_by(&self, at: Time) -> usize {
        self.arrivals.partition_point(|arrival| arrival.last_part_at <= at)
    }

    /// Assigns the time of a region's transfer to resources. Returns the earlier work whose end allowed the transfer to
    /// begin.
    fn before_arrival(&self, way: &mut Way, place: usize) -> At {
        let arrival = self.arrivals[place];
        let begin = arrival.begins_at(self.message);
        let drawn = self.drawn_for(&arrival.target, begin + NEAR);
        self.charge_copy(way, arrival, drawn);
        let by_port = self
            .arrival_before(place, begin + NEAR, |before| before.target.frame_buffer == arrival.target.frame_buffer);
        let Some(place_drawn) = drawn else { return self.to_arrival(way, by_port) };
        // A port that was free only for a moment is the limit: a region that had come earlier would have waited for the
        // port.
        let slack = Span(arrival.last_part_at.since(begin).0 / SLACK);
        if by_port.is_some_and(|before| self.arrivals[before].last_part_at + slack >= begin) {
            return self.to_arrival(way, by_port);
        }
        let (renderer, region) = self.drawn[place_drawn];
        // If the copy command started long before, the region has waited for its port, for the previous transfer, or in
        // the backing store for the permission to leave.
        if begin > region.copy_at + self.store * 2 + NEAR {
            let by_renderer = self.arrival_before(place, begin + NEAR, |before| {
                let of = self.drawn_for(&before.target, begin);
                of.is_some_and(|of| self.drawn[of].0 == renderer)
            });
            let before = by_port.max(by_renderer).filter(|before| self.arrivals[*before].last_part_at > region.copy_at);
            if before.is_some_and(|before| self.arrivals[before].last_part_at + slack >= begin) {
                return self.to_arrival(way, before);
            }
            if let Some(at) = self.before_permission(way, place, region.copy_at, begin) {
                return at;
            }
        }
        let stored = self.store.min(Span(begin.0.saturating_sub(region.copy_at.0)));
        way.charge(Resource::BackingStore, Some(Board::Renderer(renderer)), Time(begin.0 - stored.0), || {
            format!("backing store of renderer {renderer}")
        });
        if region.copy_at <= region.finished_at + NEAR {
            return At::Drawn(place_drawn);
        }
        self.before_late_copy(way, place, place_drawn)
    }

    /// Finds the reason for a late copy command. Either no frame buffer was free, or the picture of another eye was
    /// copied first.
    fn before_late_copy(&self, way: &mut Way, place: usize, place_drawn: usize) -> At {
        let (_, region) = self.drawn[place_drawn];
        self.before_permission(way, place, region.finished_at, region.copy_at).unwrap_or_else(|| {
            way.messages(region.finished_at);
            At::Drawn(place_drawn)
        })
    }

    /// Assigns the wait for the permission to copy, from the latest event that can have given it: a swap, or the end of
    /// another region's transfer. Returns `None` if no such event lies after `from` and at or before `by`.
    fn before_permission(&self, way: &mut Way, place: usize, from: Time, by: Time) -> Option<At> {
        let arrived = self.arrival_before(place, by, |_| true);
        let arrived_at = arrived.map(|arrived| self.arrivals[arrived].last_part_at);
        let swaps = self.swaps.partition_point(|swap| *swap <= by);
        let swapped_at = swaps.checked_sub(1).map(|last| self.swaps[last]);
        arrived_at.max(swapped_at).filter(|latest| *latest > from)?;
        if swapped_at > arrived_at {
            way.messages(swapped_at.unwrap_or_default());
            self.wait_for_retrace(way, arrived_at.unwrap_or_default());
        }
        Some(self.to_arrival(way, arrived))
    }

    /// Continues at an earlier arrival of a region. The time from this arrival to the current position is assigned to
    /// [`Resource::Messages`].
    fn to_arrival(&self, way: &mut Way, place: Option<usize>) -> At {
        let Some(place) = place else { return At::Begin };
        way.messages(self.arrivals[place].last_part_at);
        At::Arrival(place)
    }

    /// Assigns the time of a region's transfer to resources. Time beyond the minimum that the pixels need counts as a
    /// wait for ring channels.
    fn charge_copy(&self, way: &mut Way, arrival: &Arrival, drawn: Option<usize>) {
        let begin = arrival.begins_at(self.message);
        let board = Some(self.record.ports().board(arrival.target.frame_buffer));
        let timing = self.record.ring().timing();
        // The minimum time is the time of whole messages and one shorter message, without waits between the messages.
        let needed = drawn.map_or(way.cursor.since(begin.min(way.cursor)), |drawn| {
            let words = self.drawn[drawn].1.words;
            let whole = timing.occupancy(pxpl5_wire::MAX_MESSAGE_WORDS);
            let rest = words % pxpl5_wire::MAX_MESSAGE_WORDS;
            let of_rest = if rest == 0 { Span::ZERO } else { timing.occupancy(rest) };
            whole * u64::from(words / pxpl5_wire::MAX_MESSAGE_WORDS) + of_rest
        });
        let title = self.record.surface(arrival.surface).map_or("display", |surface| surface.title);
        let region = arrival.target.region.0;
        let moved = Time(way.cursor.0.saturating_sub(needed.0)).max(begin);
        way.charge(Resource::Ports, board, moved, || format!("COPY of region {region} to the {title}"));
        // A remainder of a few cycles comes from signals, so it belongs to the port.
        if way.cursor.since(begin.min(way.cursor)) <= NEAR {
            way.charge(Resource::Ports, board, begin, || format!("COPY of region {region} to the {title}"));
        } else {
            way.charge(Resource::Ring, Some(Board::Ring), begin, || format!("channels for region {region}"));
        }
    }

    /// Returns the index, in the list `drawn`, of the region that was drawn last for `target`. A region counts only if
    /// its copy command had started by the instant `by`.
    fn drawn_for(&self, target: &CopyTarget, by: Time) -> Option<usize> {
        self.of_target.get(target)?.iter().copied().rfind(|place| self.drawn[*place].1.copy_at <= by)
    }

    /// Returns the index of the last wanted arrival before the arrival `place` that had ended by the instant `by`.
    fn arrival_before(&self, place: usize, by: Time, is_wanted: impl Fn(&Arrival) -> bool) -> Option<usize> {
        let end = self.arrivals_by(by).min(place);
        let first = end.saturating_sub(ARRIVALS_SEARCHED);
        self.arrivals[first..end].iter().rposition(|arrival| is_wanted(arrival)).map(|found| first + found)
    }

    /// Assigns the time of a region's commands to resources. Returns the earlier work whose end let these commands
    /// begin.
    ///
    /// The returned work is the previous region on the same renderer, or the start of RENDER.
    fn before_drawn(&self, way: &mut Way, place: usize) -> At {
        let (renderer, region) = self.drawn[place];
        let board = Some(Board::Renderer(renderer));
        way.messages(region.finished_at);
        let surface = self.surface_of_port.get(&region.target.frame_buffer).copied();
        let picture = region.target.picture;
        let render = [surface, None].iter().find_map(|surface| self.render_begins.get(&(picture, *surface)).copied());
        let begin = render.unwrap_or(region.begun_at).max(region.begun_at).min(region.finished_at);
        let executed = region.executed.min(region.finished_at.since(begin));
        let number = region.target.region.0;
        way.charge(Resource::Renderers, board, Time(region.finished_at.0 - executed.0), || {
            format!("RENDER of region {number} on renderer {renderer}")
        });
        // In the remaining time, the renderer waited for commands. Either a graphics processor was in TRANSFORM, or
        // tokens and messages were on their way.
        let transform = self.transform_beside(picture, surface, begin, way.cursor);
        let transformed = Time(way.cursor.0.saturating_sub(transform.0)).max(begin);
        way.charge(Resource::Transform, None, transformed, || format!("TRANSFORM for region {number}"));
        way.charge(Resource::Messages, None, begin, || format!("tokens and messages for region {number}"));
        if region.begun_at >= begin
            && let Some(before) = self.drawn_before(renderer, place)
        {
            return self.before_next_region(way, before);
        }
        self.to_transform(way, picture, surface)
    }

    /// Continues at the earlier work on the same renderer for which the region's commands had to wait. The earlier work
    /// is the previous region's commands, or a copy that waited for room in the backing store.
    fn before_next_region(&self, way: &mut Way, place: usize) -> At {
        let (renderer, region) = self.drawn[place];
        let held = Span(way.cursor.0.saturating_sub(region.copy_at.0));
        if held > self.store * 2 + NEAR {
            let by = way.cursor + NEAR;
            let of_renderer =
                |arrival: &Arrival| self.drawn_for(&arrival.target, by).is_some_and(|of| self.drawn[of].0 == renderer);
            if let Some(arrived) = self.arrival_before(self.arrivals.len(), by, of_renderer) {
                return self.to_arrival(way, Some(arrived));
            }
        }
        way.charge(Resource::BackingStore, Some(Board::Renderer(renderer)), region.copy_at, || {
            format!("backing store of renderer {renderer}")
        });
        At::Drawn(place)
    }

    fn drawn_before(&self, renderer: usize, place: usize) -> Option<usize> {
        let of = self.of_renderer.get(&renderer)?;
        let own = of.binary_search(&place).ok()?;
        own.checked_sub(1).map(|before| of[before])
    }

    /// Returns the time between `from` and `to` in which at least one graphics processor executed TRANSFORM for a
    /// picture.
    fn transform_beside(&self, picture: PictureNumber, surface: Option<SurfaceId>, from: Time, to: Time) -> Span {
        let of = self.transforms(picture, surface);
        let begin = of.iter().map(|work| work.begin).min().unwrap_or(to).max(from);
        let end = of.iter().map(|work| work.end).max().unwrap_or(from).min(to);
        Span(end.0.saturating_sub(begin.0))
    }

    fn transforms(&self, picture: PictureNumber, surface: Option<SurfaceId>) -> Vec<&StageWork> {
        let is_of = |work: &&StageWork| {
            work.stage == Stage::Transform
                && work.picture == picture
                && (work.surface.is_none() || work.surface == surface)
        };
        self.stages.iter().filter(is_of).collect()
    }

    /// Continues at the last TRANSFORM of a surface. The last TRANSFORM counts, because RENDER begins when all graphics
    /// processors have ended TRANSFORM.
    fn to_transform(&self, way: &mut Way, picture: PictureNumber, surface: Option<SurfaceId>) -> At {
        let is_of = |work: &StageWork| {
            work.stage == Stage::Transform
                && work.picture == picture
                && (work.surface.is_none() || work.surface == surface)
                && work.begin < way.cursor
        };
        let ended = self.stages.iter().rposition(|work| is_of(work) && work.end <= way.cursor + NEAR);
        // Some pipelines render while they transform.
        let found = ended.or_else(|| self.stages.iter().position(is_of));
        let Some(found) = found else { return At::Begin };
        way.messages(self.stages[found].end);
        At::Stage(found)
    }

    /// Assigns the time of a stage to resources. Returns the earlier work whose end allowed the stage to begin.
    fn before_stage(&self, way: &mut Way, place: usize) -> At {
        let work = self.stages[place];
        let board = self.record.ports().board(work.node);
        let resource = if work.stage == Stage::Send { Resource::Host } else { Resource::Transform };
        way.charge(resource, Some(board), work.begin, || {
            format!("{} on {board}", work.stage.to_string().to_uppercase())
        });
        let by = work.begin;
        let own = self.stages[..place].iter().rposition(|before| before.node == work.node && before.end <= by);
        if let Some(own) = own.filter(|own| self.stages[*own].end + NEAR >= by) {
            return At::Stage(own);
        }
        // Find the latest end among all the work that a pipeline's rules can wait for.
        let stage = self.stages[..place].iter().rposition(|before| before.end <= by);
        let arrival = self.arrivals_by(by).checked_sub(1);
        let render = self.render_ends.partition_point(|(end, ..)| *end <= by).checked_sub(1);
        let ends = [
            stage.map(|place| self.stages[place].end),
            arrival.map(|place| self.arrivals[place].last_part_at),
            render.map(|place| self.render_ends[place].0),
        ];
        let latest = ends.into_iter().max().flatten();
        way.messages(latest.unwrap_or(by));
        match (stage, arrival, render) {
            (Some(stage), ..) if ends[0] == latest => At::Stage(stage),
            (_, Some(arrival), _) if ends[1] == latest => At::Arrival(arrival),
            (.., Some(render)) => self.last_drawn(self.render_ends[render]),
            _ => At::Begin,
        }
    }

    fn last_drawn(&self, (end, picture, surface): (Time, PictureNumber, Option<SurfaceId>)) -> At {
        let is_of = |region: &DrawnRegion| {
            let own = self.surface_of_port.get(&region.target.frame_buffer).copied();
            region.target.picture == picture
                && (surface.is_none() || own == surface)
                && region.finished_at <= end + NEAR
        };
        let all = self.drawn.iter().enumerate().filter(|(_, (_, region))| is_of(region));
        all.max_by_key(|(_, (_, region))| region.finished_at).map_or(At::Begin, |(place, _)| At::Drawn(place))
    }
}
