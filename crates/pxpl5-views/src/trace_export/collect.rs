//! Tracks from what was observed.

use super::flows::connect;
use super::{Events, Slice, Trace, Track};
use crate::experiment::Outcome;
use crate::pipelines::PictureTimes;
use crate::results::origin;
use crate::traffic::{Traffic, Transfer};
use pxpl5_gp::{Edge, Stage};
use pxpl5_sim::Time;
use pxpl5_wire::{Eye, MAX_MESSAGE_WORDS, NodeId};
use std::collections::BTreeMap;

impl Trace {
    /// Collects the tracks of a run.
    #[must_use]
    pub fn of(outcome: &Outcome) -> Self {
        let mut trace = Self { origin: origin(&outcome.report()), groups: Vec::new(), tracks: Vec::new() };
        let traffic = outcome.observation().traffic.as_deref();
        for (node, name) in boards(outcome) {
            let group = trace.group(name);
            trace.stages(outcome, group, node);
            trace.messages(outcome, traffic, group, node);
            trace.fifo(outcome, traffic, group, node);
            trace.regions(outcome, group, node);
        }
        trace.ring(traffic);
        trace.video(outcome);
        connect(&mut trace, outcome);
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

    /// The stages that a board marked; one without an end is left out.
    fn stages(&mut self, outcome: &Outcome, group: usize, node: NodeId) {
        let mut begun: BTreeMap<(Stage, u64, Option<Eye>), Time> = BTreeMap::new();
        let mut slices: BTreeMap<Stage, Vec<Slice>> = BTreeMap::new();
        for mark in outcome.observation().marks.iter().filter(|mark| mark.node == node) {
            let key = (mark.stage, mark.picture, mark.eye);
            match mark.edge {
                Edge::Begin => drop(begun.insert(key, mark.time)),
                Edge::End => {
                    let slice = begun.remove(&key).map(|begin| stage_slice(key, begin, mark.time));
                    slices.entry(mark.stage).or_default().extend(slice);
                }
            }
        }
        for (stage, slices) in slices {
            self.track(group, stage_name(stage), Events::Slices(apart(slices)));
        }
    }

    fn messages(&mut self, outcome: &Outcome, traffic: Option<&Traffic>, group: usize, node: NodeId) {
        let Some(traffic) = traffic else { return };
        let names: BTreeMap<NodeId, String> = boards(outcome).into_iter().collect();
        let name = |node| names.get(&node).cloned().unwrap_or_default();
        let into = traffic.transfers.iter().filter(|transfer| transfer.destination == node);
        let slices = into.map(|t| message_slice(t, format!("{} words from {}", t.words, name(t.source))));
        self.track(group, "messages in", Events::Slices(apart(slices.collect())));
        let out = traffic.transfers.iter().filter(|transfer| transfer.source == node);
        let slices = out.map(|t| message_slice(t, format!("{} words to {}", t.words, name(t.destination))));
        self.track(group, "messages out", Events::Slices(apart(slices.collect())));
    }

    fn fifo(&mut self, outcome: &Outcome, traffic: Option<&Traffic>, group: usize, node: NodeId) {
        let renderer = outcome.machine().ports().renderers.binary_search(&node);
        if let (Some(traffic), Ok(renderer)) = (traffic, renderer) {
            self.track(
                group,
                &format!("FIFO words of renderer {renderer}"),
                Events::Counter(traffic.fifo_words(renderer)),
            );
        }
    }

    fn regions(&mut self, outcome: &Outcome, group: usize, node: NodeId) {
        let Ok(board) = outcome.machine().ports().frame_buffers.binary_search(&node) else { return };
        let message = outcome.machine().ring().timing().occupancy(MAX_MESSAGE_WORDS);
        let arrivals = outcome.observation().arrivals.iter().filter(|arrival| arrival.board == board);
        let slices = arrivals.map(|arrival| Slice {
            name: format!("COPY region {}", arrival.target.region.0),
            begin: arrival.begins_at(message),
            end: arrival.last_part_at,
            picture: Some(arrival.target.picture),
            flow: None,
        });
        self.track(group, "COPY", Events::Slices(apart(slices.collect())));
        let video = outcome.machine().video();
        let swaps = outcome.observation().swaps.iter().filter(|swap| swap.board == board);
        let swaps = swaps.map(|swap| (video.retrace(swap.field), "swap".to_owned()));
        self.track(group, "swaps", Events::Instants(swaps.collect()));
    }

    fn ring(&mut self, traffic: Option<&Traffic>) {
        let Some(traffic) = traffic else { return };
        let group = self.group("ring".to_owned());
        let values = traffic.busy_channels.iter().map(|(time, busy)| (*time, i64::from(*busy)));
        self.track(group, "busy channels", Events::Counter(values.collect()));
    }

    fn video(&mut self, outcome: &Outcome) {
        let (video, fields) = (outcome.machine().video(), outcome.fields());
        let group = self.group("video".to_owned());
        let retraces = (0..=fields).map(|field| (video.retrace(field), format!("retrace {field}")));
        self.track(group, "retraces", Events::Instants(retraces.collect()));
        let slices = (0..fields).map(|field| {
            let begin = video.retrace(field);
            let shown = shown(outcome.pictures(), begin);
            let name = shown.map_or_else(|| format!("field {field}"), |p| format!("field {field}: picture {p}"));
            Slice { name, begin, end: video.retrace(field + 1), picture: shown, flow: None }
        });
        self.track(group, "displayed", Events::Slices(slices.collect()));
    }
}

impl Track {
    fn is_empty(&self) -> bool {
        match &self.events {
            Events::Slices(slices) => slices.is_empty(),
            Events::Instants(instants) => instants.is_empty(),
            Events::Counter(values) => values.is_empty(),
        }
    }
}

/// The picture that is shown in the field that begins at a retrace.
fn shown(pictures: &[PictureTimes], retrace: Time) -> Option<u64> {
    let after = pictures.partition_point(|times| times.shown_at <= retrace);
    after.checked_sub(1).map(|last| pictures[last].picture)
}

fn boards(outcome: &Outcome) -> Vec<(NodeId, String)> {
    let ports = outcome.machine().ports();
    let numbered = |nodes: &[NodeId], name: &str| -> Vec<(NodeId, String)> {
        nodes.iter().enumerate().map(|(i, node)| (*node, format!("{name} {i}"))).collect()
    };
    let mut all = vec![(ports.host, "host".to_owned())];
    all.extend(numbered(&ports.gps, "GP"));
    all.extend(numbered(&ports.renderers, "renderer"));
    let sides = if ports.frame_buffers.len() == 1 { ["", ""] } else { ["left ", "right "] };
    all.extend(ports.frame_buffers.iter().zip(sides).map(|(node, side)| (*node, format!("{side}frame buffer"))));
    all
}

pub(super) const fn stage_name(stage: Stage) -> &'static str {
    match stage {
        Stage::Sample => "SAMPLE",
        Stage::Send => "SEND",
        Stage::Edit => "EDIT",
        Stage::Transform => "TRANSFORM",
        Stage::Render => "RENDER",
        Stage::Copy => "COPY",
        Stage::Swap => "SWAP",
    }
}

fn stage_slice((stage, picture, eye): (Stage, u64, Option<Eye>), begin: Time, end: Time) -> Slice {
    let eye = match eye {
        Some(Eye::Left) => " left",
        Some(Eye::Right) => " right",
        None => "",
    };
    let name = format!("{} {picture}{eye}", stage_name(stage));
    Slice { name, begin, end, picture: Some(picture), flow: None }
}

fn message_slice(transfer: &Transfer, name: String) -> Slice {
    Slice { name, begin: transfer.begin, end: transfer.end, picture: None, flow: None }
}

/// In order of time, each from the end of the one before at the earliest.
fn apart(mut slices: Vec<Slice>) -> Vec<Slice> {
    slices.sort_by_key(|slice| (slice.end, slice.begin));
    let mut free_at = Time::ZERO;
    for slice in &mut slices {
        slice.begin = slice.begin.max(free_at).min(slice.end);
        free_at = slice.end;
    }
    slices
}
