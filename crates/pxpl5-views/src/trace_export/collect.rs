use super::flows::connect;
use super::groups::{Group, groups, named};
use super::model::{Events, Slice, Trace, Track};
use super::slices::{apart, message_slice, region_slice, stage_name, stage_slice};
use crate::ports::{display_of, display_ports, shown as shown_by};
use crate::results::origin;
use pxpl5_gp::{Mark, Stage, StageEdge};
use pxpl5_machine::{Record, Traffic};
use pxpl5_measure::Report;
use pxpl5_run::{Outcome, PictureTimes};
use pxpl5_sim::Time;
use pxpl5_wire::display::Display;
use pxpl5_wire::{NodeId, PeriodNumber, PictureNumber, SurfaceId};
use std::collections::BTreeMap;

impl Trace {
    /// Collects the tracks of a run.
    pub fn of(outcome: &Outcome) -> Self {
        let mut trace = Self { origin: origin(&Report::of(outcome)), groups: Vec::new(), tracks: Vec::new() };
        let traffic = outcome.observation().traffic.as_deref();
        // Each board or surface is a group with its own tracks.
        let groups = groups(outcome.record());
        for group in &groups {
            let index = trace.group(group.name.clone());
            if let Some(node) = group.node {
                trace.port(outcome, &groups, index, node);
            }
            if let Some(surface) = group.surface {
                trace.regions(outcome, index, surface);
            }
        }
        if let Some(traffic) = traffic {
            trace.ring(traffic);
        }
        trace.videos(outcome);
        connect(&mut trace, outcome);
        // Tracks without events are left out of the trace.
        trace.tracks.retain(|track| !track.is_empty());
        trace
    }

    fn group(&mut self, name: String) -> usize {
        self.groups.push(name);
        self.groups.len() - 1
    }

    fn track(&mut self, group: usize, name: &str, events: Events) {
        self.tracks.push(Track { group, name: name.to_owned(), events });
    }

    fn port(&mut self, outcome: &Outcome, groups: &[Group], group: usize, node: NodeId) {
        self.stages(outcome, group, node);
        if display_ports(outcome.record()).iter().any(|port| port.node == node) {
            self.memory(outcome, group, node);
        }
        let Some(traffic) = outcome.observation().traffic.as_deref() else { return };
        self.messages(traffic, groups, group, node);
        self.fifo(outcome.record(), traffic, group, node);
    }

    /// Adds the data received by a port that swaps independently, and the pictures that the port showed.
    fn memory(&mut self, outcome: &Outcome, group: usize, node: NodeId) {
        let message = outcome.record().message_span();
        let arrivals = outcome.observation().arrivals.iter().filter(|arrival| arrival.target.frame_buffer == node);
        self.track(group, "COPY", Events::Slices(apart(arrivals.map(|arrival| region_slice(arrival, message)))));
        // A swap is an instant, and the displayed picture is a slice.
        let shown = shown_by(&outcome.final_results(), node);
        let swaps = shown.iter().map(|shown| (shown.begin, "swap".to_owned()));
        self.track(group, "swaps", Events::Instants(swaps.collect()));
        let slices = shown.iter().map(|shown| Slice {
            name: format!("shows {}", shown.picture),
            begin: shown.begin,
            end: shown.end,
            picture: Some(shown.picture),
            flow: None,
        });
        self.track(group, "shown", Events::Slices(slices.collect()));
    }

    /// Adds the stages for which a board has set time stamps. A stage without an end is left out.
    fn stages(&mut self, outcome: &Outcome, group: usize, node: NodeId) {
        let mut begun: BTreeMap<(Stage, PictureNumber, Option<SurfaceId>), Time> = BTreeMap::new();
        let mut slices: BTreeMap<Stage, Vec<Slice>> = BTreeMap::new();
        for mark in outcome.observation().marks.iter().filter(|mark| mark.node == node) {
            let key = (mark.stage, mark.picture, mark.surface);
            // Match each end with the begin of the same stage, picture and surface.
            match mark.edge {
                StageEdge::Begin => drop(begun.insert(key, mark.time)),
                StageEdge::End => {
                    let slice = begun.remove(&key).map(|begin| ended(outcome.record(), mark, begin));
                    slices.entry(mark.stage).or_default().extend(slice);
                }
            }
        }
        for (stage, slices) in slices {
            self.track(group, &stage_name(stage), Events::Slices(apart(slices.into_iter())));
        }
    }

    fn messages(&mut self, traffic: &Traffic, groups: &[Group], group: usize, node: NodeId) {
        let into = traffic.transfers.iter().filter(|transfer| transfer.destination == node);
        let slices = into.map(|t| message_slice(t, &format!("from {}", name_of(groups, t.source))));
        self.track(group, "messages in", Events::Slices(apart(slices)));
        let out = traffic.transfers.iter().filter(|transfer| transfer.source == node);
        let slices = out.map(|t| message_slice(t, &format!("to {}", name_of(groups, t.destination))));
        self.track(group, "messages out", Events::Slices(apart(slices)));
    }

    fn fifo(&mut self, record: &Record, traffic: &Traffic, group: usize, node: NodeId) {
        if let Ok(renderer) = record.ports().renderers.binary_search(&node) {
            let name = format!("FIFO words of renderer {renderer}");
            self.track(group, &name, Events::Counter(traffic.fifo_words(renderer)));
        }
    }

    fn regions(&mut self, outcome: &Outcome, group: usize, surface: SurfaceId) {
        let record = outcome.record();
        let message = record.message_span();
        let arrivals = outcome.observation().arrivals.iter().filter(|arrival| arrival.surface == surface);
        let slices = arrivals.map(|arrival| region_slice(arrival, message));
        self.track(group, "COPY", Events::Slices(apart(slices)));
        let Some(display) = display_of(record, surface) else { return };
        let swaps = outcome.observation().swaps_of(surface);
        let swaps = swaps.map(|swap| (display.tick(swap.tick), "swap".to_owned()));
        self.track(group, "swaps", Events::Instants(swaps.collect()));
    }

    fn ring(&mut self, traffic: &Traffic) {
        let group = self.group("ring".to_owned());
        let values = traffic.busy_channels.iter().map(|(time, busy)| (*time, i64::from(*busy)));
        self.track(group, "busy channels", Events::Counter(values.collect()));
    }

    /// Adds the tracks of the displays. Only the first display has picture numbers.
    fn videos(&mut self, outcome: &Outcome) {
        let record = outcome.record();
        for (i, display) in record.displays().iter().enumerate() {
            let pictures = if i == 0 { outcome.pictures() } else { &[] };
            let group = self.group(named(record, "video", display.as_ref()));
            self.video(group, display.as_ref(), pictures, display.period_at(outcome.end()));
        }
    }

    fn video(&mut self, group: usize, display: &dyn Display, pictures: &[PictureTimes], end: PeriodNumber) {
        let retraces = PeriodNumber::FIRST.until(end.next()).map(|n| (display.tick(n), format!("retrace {n}")));
        self.track(group, "retraces", Events::Instants(retraces.collect()));
        let slices = PeriodNumber::FIRST.until(end).map(|period| period_slice(display, pictures, period));
        self.track(group, "displayed", Events::Slices(slices.collect()));
    }
}

fn ended(record: &Record, mark: &Mark, begin: Time) -> Slice {
    let surface = mark.surface.and_then(|id| record.surface(id));
    stage_slice(mark.stage, mark.picture, surface.map(|surface| surface.label), [begin, mark.time])
}

fn name_of(groups: &[Group], node: NodeId) -> &str {
    groups.iter().find(|group| group.node == Some(node)).map_or("", |group| &group.name)
}

fn period_slice(display: &dyn Display, pictures: &[PictureTimes], period: PeriodNumber) -> Slice {
    let begin = display.tick(period);
    let picture = shown(pictures, begin);
    let shown = picture.map_or_else(String::new, |picture| format!(": picture {picture}"));
    Slice { name: format!("field {period}{shown}"), begin, end: display.tick(period.next()), picture, flow: None }
}

fn shown(pictures: &[PictureTimes], retrace: Time) -> Option<PictureNumber> {
    let after = pictures.partition_point(|times| times.shown_at <= retrace);
    after.checked_sub(1).map(|last| pictures[last].picture)
}
