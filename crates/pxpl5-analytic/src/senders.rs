//! TRANSFORM and RENDER of Slats on any number of graphics processors (GPs). Messages are processed in the order in
//! which the ring grants them channels.
//!
//! ```text
//!   clumps of GP 0 --chain--+
//!   clumps of GP 1 --chain--+--> heads --grant: port, channel to a FIFO--> FIFO of a renderer --> its array
//!   ...                     |
//! ```
//!
//! A single GP is limited by its own processor time, so computing an average clump suffices ([`super::clumps`]).
//! Several GPs are limited by shared resources. A renderer's port accepts one message at a time. A message that waits
//! for room in a full FIFO occupies its channel. All renderers share
//! [`fifo_channels`](pxpl5_ring::RingTiming::fifo_channels) channels.
//!
//! The order of grants determines which renderers work at the same time, so the model processes all messages in this
//! order. The model follows the timing rules of ring, FIFO and firmware, but shares no code with the simulator.

use super::copies::MAX_RENDERERS;
use super::model::{PerTriangle, REGIONS, SlatsModel};
use super::renderer::{Array, Cost, Times, later};
use pphigs::{Picture, RegionBinning, Shading, Share, TransformWork};
use pxpl5_geometry::Viewport;
use pxpl5_gp::Work;
use pxpl5_renderer::Layout;
use pxpl5_run::{Experiment, ExperimentError, SceneViews, ViewSource, display_list};
use pxpl5_sim::Time;
use pxpl5_wire::{FieldParity, MAX_MESSAGE_WORDS, RegionId, ViewNumber};
use slats::CLUMP;
use std::collections::VecDeque;
use std::sync::Arc;

/// A group of up to [`CLUMP`] primitives that a graphics processor (GP) sends together.
#[derive(Clone, Debug, PartialEq)]
struct Clump {
    /// Time of TRANSFORM for both eyes, in nanoseconds.
    transform_ns: f64,
    bins: [[f64; 2]; REGIONS],
}

/// The clumps of every graphics processor (GP), and the length of the message with the view for the other GPs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Clumps {
    of_gps: Vec<Vec<Clump>>,
    view_words: f64,
}

/// Number of words of a message with the view of two eyes: a number of two words, two counts, and three matrices for
/// each eye.
const VIEW_WORDS: f64 = 4.0 + 2.0 * 3.0 * 16.0;

impl Clumps {
    /// Creates clumps of equal triangles that are distributed evenly over the GPs and the regions.
    pub(super) fn uniform(model: &SlatsModel, triangles: f64, each: PerTriangle) -> Self {
        let all = triangles.round() as usize;
        // Distribute the triangles evenly over the GPs.
        let of_gp = |gp: usize| {
            let share = (all + model.gps - 1 - gp) / model.gps;
            let clumps = share.div_ceil(CLUMP).max(1);
            let clump = |n: usize| {
                let size = (share - n * CLUMP).min(CLUMP) as f64;
                // The first clump includes the begin of the pass.
                let begin_ns = if n == 0 { model.begin_ns } else { 0.0 };
                let bins = [[size * each.entries / 10.0, 0.0]; REGIONS];
                Clump { transform_ns: begin_ns + model.clump_ns(size, each), bins }
            };
            (0..clumps).map(clump).collect()
        };
        Self { of_gps: (0..model.gps).map(of_gp).collect(), view_words: VIEW_WORDS }
    }

    /// Creates the clumps of an experiment's scene in its first view.
    ///
    /// # Errors
    ///
    /// Returns [`ExperimentError::Scene`] if the scene has no primitives.
    ///
    /// # Panics
    ///
    /// Never panics, because an experiment has a valid head-mounted display.
    pub(super) fn of_scene(
        model: &SlatsModel,
        experiment: &Experiment,
        binning: RegionBinning,
    ) -> Result<Self, ExperimentError> {
        // Transform the scene for the first view.
        let list = Arc::new(display_list(experiment.scene())?);
        let views = SceneViews::new(experiment.scene(), experiment.seed, experiment.hmd, 2);
        let view = views.newest(ViewNumber::FIRST, Time(0));
        let viewport = Viewport::field(FieldParity::Even);
        let picture = Picture { viewport, shading: Shading::Gouraud, binning, layout: Layout::slats(), pixels: false };
        let of_gp = |gp: usize| {
            let share = Share::new(Arc::clone(&list), gp, model.gps);
            let mut clumps: Vec<Share> = share.clumps(CLUMP).collect();
            // A GP without primitives still begins its pass.
            if clumps.is_empty() {
                clumps.push(share);
            }
            let clump = |(n, share): (usize, &Share)| {
                let passes = [0, 1].map(|eye| share.transform(&view, eye, picture));
                let work = TransformWork { passes: &passes, context: 0, begins: n == 0 };
                // The order is: the columns of the upper half for one eye, then for the other eye, then the same for
                // the lower half.
                let bins = std::array::from_fn(|region| {
                    let (kind, column) = (region / COLUMNS, region % COLUMNS);
                    let counts = passes[kind % 2].counts(RegionId((kind / 2 * COLUMNS + column) as u16));
                    [f64::from(counts.triangles), f64::from(counts.spheres)]
                });
                Clump { transform_ns: work.by_table(&model.gp).as_ms() * 1e6, bins }
            };
            clumps.iter().enumerate().map(clump).collect()
        };
        Ok(Self { of_gps: (0..model.gps).map(of_gp).collect(), view_words: view.to_words().len() as f64 })
    }
}

/// Number of regions in a row of one eye's picture.
const COLUMNS: usize = REGIONS / 4;

/// Sends all clumps (groups of primitives) to the renderers, and updates the state of the renderers in `arrays`.
///
/// Returns two times: when the renderers had accepted all clumps, and when the first GP had received the reports of all
/// other GPs.
pub(super) fn render(model: &SlatsModel, arrays: &mut [Array<1>], clumps: &Clumps) -> [f64; 2] {
    let mut ring = Ring::new(model, arrays);
    let mut senders = ring.begin(clumps);
    // Grant messages in the order of the ring's arbiter.
    while let Some(place) = ring.first_head(&senders) {
        ring.grant(&mut senders[place]);
    }
    // Report the final state of the renderers.
    for (array, renderer) in arrays.iter_mut().zip(&ring.renderers) {
        array.free = Times::all(renderer.free_ns);
        array.released = Times::all(renderer.released_ns);
    }
    let accepted_ns = senders.iter().fold(0.0, |last, sender| later(last, sender.accepted_ns));
    [accepted_ns, ring.all_done_ns(&senders)]
}

/// The words of a command that has left a renderer's FIFO. Their departure makes room for the words that follow one
/// FIFO depth later.
#[derive(Clone, Copy, Debug)]
struct Departure {
    first_word: f64,
    words: f64,
    at_ns: f64,
}

#[derive(Clone, Debug, Default)]
struct Renderer {
    free_ns: f64,
    released_ns: f64,
    words_in: f64,
    departures: VecDeque<Departure>,
}

impl Renderer {
    /// Receives a command whose words arrive without gaps from `from_ns` on. Returns the time at which the last word
    /// has entered the FIFO.
    ///
    /// A full FIFO accepts a word when the word has left that entered one FIFO depth earlier in the sequence of words.
    /// The words of a command leave when the command starts. A command starts when all its words have arrived and the
    /// previous command has ended.
    fn take(&mut self, from_ns: f64, command: Cost, depth_words: f64, word_ns: f64) -> f64 {
        let first = self.words_in;
        let last = first + command.words - 1.0;
        let mut complete = from_ns + command.words * word_ns;
        // A word that leaves the FIFO makes room for the word that is one FIFO depth later.
        while let Some(room) = self.departures.front() {
            let made_room_for = room.first_word + depth_words;
            if made_room_for > last {
                break;
            }
            complete = later(complete, room.at_ns + word_ns * (last - later(made_room_for, first) + 1.0));
            if made_room_for + room.words > last + 1.0 {
                break;
            }
            self.departures.pop_front();
        }
        let start = later(complete, self.free_ns);
        self.free_ns = start + command.ns;
        self.words_in += command.words;
        self.departures.push_back(Departure { first_word: first, words: command.words, at_ns: start });
        complete
    }
}

/// A message to a renderer. Each entry of `runs` is a kind of command: the cost of one command, and their number.
#[derive(Clone, Copy, Debug)]
struct Message {
    region: usize,
    runs: [(Cost, f64); 4],
}

#[derive(Debug)]
struct Sender<'a> {
    gp: usize,
    clumps: &'a [Clump],
    begun: usize,
    /// Messages of the current clump that still wait for a channel of the ring.
    messages: VecDeque<Message>,
    /// Instant, in nanoseconds, at which the next message began to wait for a channel.
    since_ns: f64,
    channels_ns: Vec<f64>,
    cpu_ns: f64,
    /// Time at which the renderers had accepted all messages of the current clump.
    accepted_ns: f64,
    /// Time at which every renderer had accepted its first message of the current clump.
    draining_ns: f64,
    served: [bool; MAX_RENDERERS],
}

impl<'a> Sender<'a> {
    fn idle(gp: usize, clumps: &'a [Clump], model: &SlatsModel) -> Self {
        Self {
            gp,
            clumps,
            begun: 0,
            messages: VecDeque::new(),
            since_ns: 0.0,
            channels_ns: vec![f64::MIN; model.source_channels],
            cpu_ns: 0.0,
            accepted_ns: 0.0,
            draining_ns: 0.0,
            served: [false; MAX_RENDERERS],
        }
    }

    fn is_done(&self) -> bool {
        self.messages.is_empty()
    }
}

struct Ring<'a> {
    model: &'a SlatsModel,
    renderers: Vec<Renderer>,
    channels_ns: Vec<f64>,
    clears: bool,
}

impl<'a> Ring<'a> {
    fn new(model: &'a SlatsModel, arrays: &[Array<1>]) -> Self {
        let renderer = |array: &Array<1>| Renderer { free_ns: array.free.0[0], ..Renderer::default() };
        Self {
            model,
            renderers: arrays.iter().map(renderer).collect(),
            channels_ns: vec![f64::MIN; model.fifo_channels],
            clears: model.gps == 1,
        }
    }

    /// Returns the senders, each with the messages of its first clump.
    ///
    /// A single GP clears the regions with its first clump. With several GPs, the first GP sends separate messages that
    /// clear all regions, and then sends the view to the other GPs.
    fn begin<'c>(&mut self, clumps: &'c Clumps) -> Vec<Sender<'c>> {
        let model = self.model;
        let mut begin_ns = vec![0.0; model.gps];
        // The first GP receives the host's next view during TRANSFORM.
        begin_ns[0] = model.message_ns;
        let mut accepted_ns = 0.0;
        // With several GPs, the first GP clears all regions and then sends the view.
        if !self.clears {
            accepted_ns = self.clear_all();
            let words_ns = model.overhead_ns + (clumps.view_words + 3.0) * model.word_ns;
            for (gp, begin) in begin_ns.iter_mut().enumerate().skip(1) {
                // A port sends on `source_channels` channels at a time.
                let round = (gp - 1) / model.source_channels + 1;
                let arrives = later(accepted_ns, 2.0 * model.message_ns) + round as f64 * words_ns;
                *begin = arrives + gp as f64 * model.hop_ns + model.message_ns;
            }
            // The first GP continues after the software cost of both chains, and sends when both have been accepted.
            accepted_ns = begin_ns[1..].iter().fold(accepted_ns, |last, begin| later(last, begin - model.message_ns));
            begin_ns[0] += model.transform_begins_ns();
        }
        let sender = |(gp, clumps): (usize, &'c Vec<Clump>)| {
            let sender = Sender { cpu_ns: begin_ns[gp], ..Sender::idle(gp, clumps, model) };
            let mut sender = Sender { accepted_ns: if gp == 0 { accepted_ns } else { 0.0 }, ..sender };
            self.next_clump(&mut sender);
            sender
        };
        clumps.of_gps.iter().enumerate().map(sender).collect()
    }

    fn clear_all(&mut self) -> f64 {
        // A clump without primitives produces only the messages that clear.
        let nothing = Clump { transform_ns: 0.0, bins: [[0.0; 2]; REGIONS] };
        let mut sender = Sender::idle(0, std::slice::from_ref(&nothing), self.model);
        self.clears = true;
        self.next_clump(&mut sender);
        while !sender.is_done() {
            self.grant(&mut sender);
        }
        self.clears = false;
        sender.accepted_ns
    }

    /// Transforms clumps until a clump has messages to send, or until no clump is left.
    fn next_clump(&self, sender: &mut Sender<'_>) {
        while let Some(clump) = sender.clumps.get(sender.begun) {
            // The single clump buffer can be reused after all renderers have started to receive its content.
            let transformed = later(sender.cpu_ns, sender.draining_ns) + clump.transform_ns;
            sender.cpu_ns = later(transformed, sender.accepted_ns);
            sender.begun += 1;
            sender.messages = self.messages_of(clump, self.clears && sender.begun == 1);
            if !sender.is_done() {
                sender.cpu_ns += self.model.message_ns;
                sender.since_ns = sender.cpu_ns;
                sender.draining_ns = 0.0;
                sender.served = [false; MAX_RENDERERS];
                return;
            }
        }
    }

    /// Returns the messages of a clump, with as many primitives in each message as fit. If `clears` is true, the first
    /// message to a region also clears the region.
    fn messages_of(&self, clump: &Clump, clears: bool) -> VecDeque<Message> {
        let SlatsModel { select, clear, command, sphere, .. } = *self.model;
        let mut messages = VecDeque::new();
        for (region, bin) in clump.bins.iter().enumerate() {
            let mut left = *bin;
            let mut clearing = if clears { 1.0 } else { 0.0 };
            while clearing > 0.0 || left != [0.0; 2] {
                // Fill the message with triangles, then with spheres.
                let mut room = f64::from(MAX_MESSAGE_WORDS) - select.words - clearing * clear.words;
                let held = [(command, 0), (sphere, 1)].map(|(command, kind)| {
                    let count = left[kind].min((room / command.words).floor());
                    left[kind] -= count;
                    room -= count * command.words;
                    count
                });
                let runs = [(select, 1.0), (clear, clearing), (command, held[0]), (sphere, held[1])];
                messages.push_back(Message { region, runs });
                clearing = 0.0;
            }
        }
        messages
    }

    /// Returns the time at which a sender's next message can get channels, and the time since which the message waits.
    fn head(&self, sender: &Sender<'_>) -> (f64, f64) {
        let region = sender.messages.front().map_or(0, |message| message.region);
        let port = &self.renderers[region % self.renderers.len()];
        let since = later(sender.since_ns, soonest(&sender.channels_ns).1);
        (later(later(since, port.released_ns), soonest(&self.channels_ns).1), since)
    }

    /// Returns the index of the sender whose message gets the next channels of the ring.
    ///
    /// If several messages can get channels at the same time, the message that has waited longest comes first. For
    /// equal waits, the sender with the lowest index comes first.
    fn first_head(&self, senders: &[Sender<'_>]) -> Option<usize> {
        let waiting = senders.iter().enumerate().filter(|(_, sender)| !sender.is_done());
        let heads = waiting.map(|(place, sender)| (self.head(sender), place));
        heads.reduce(|first, head| if head.0 < first.0 { head } else { first }).map(|(_, place)| place)
    }

    /// Sends a sender's next message. The message occupies the renderer's port and ring channels until its last word is
    /// in the FIFO.
    fn grant(&mut self, sender: &mut Sender<'_>) {
        let model = self.model;
        let (granted, _) = self.head(sender);
        let Some(message) = sender.messages.pop_front() else { return };
        let number = message.region % self.renderers.len();
        let latency = model.hop_ns * (model.gps - sender.gp + number) as f64;
        let accepted = self.take(&message, number, granted + model.overhead_ns + latency);
        // Port and channels are free when the last word has entered the FIFO.
        let released = accepted - latency;
        self.renderers[number].released_ns = released;
        for channels in [&mut sender.channels_ns, &mut self.channels_ns] {
            let (place, _) = soonest(channels);
            channels[place] = released;
        }
        sender.accepted_ns = later(sender.accepted_ns, accepted);
        // The clump buffer is free when every renderer has accepted its first message.
        if !std::mem::replace(&mut sender.served[number], true) {
            sender.draining_ns = later(sender.draining_ns, accepted);
        }
        sender.since_ns = granted;
        if sender.is_done() {
            self.next_clump(sender);
        }
    }

    /// Receives a message whose first word arrives at `from_ns`. Returns the time at which the last word has entered
    /// the FIFO.
    fn take(&mut self, message: &Message, number: usize, from_ns: f64) -> f64 {
        let (depth, word) = (self.model.fifo_words, self.model.word_ns);
        let renderer = &mut self.renderers[number];
        let mut entered = from_ns;
        for (command, count) in message.runs {
            let mut left = count;
            while left > 0.0 {
                // Mean counts need not be integers.
                let part = left.min(1.0);
                let some = Cost { words: command.words * part, ns: command.ns * part };
                entered = renderer.take(entered, some, depth, word);
                left -= part;
            }
        }
        entered
    }

    /// Returns the time at which the first GP has received the reports of all other GPs that their clumps were
    /// accepted. Each report takes processor time of the first GP.
    fn all_done_ns(&self, senders: &[Sender<'_>]) -> f64 {
        let model = self.model;
        let (Some(first), others) = (senders.first(), senders.get(1..).unwrap_or_default()) else { return 0.0 };
        let message_ns = model.overhead_ns + 3.0 * model.word_ns;
        let ports = 1 + model.gps + self.renderers.len() + FRAME_BUFFERS;
        // Each GP reports after its last message was accepted.
        let arrival = |sender: &Sender<'_>| {
            let sent = later(sender.cpu_ns + model.message_ns, sender.accepted_ns);
            sent + message_ns + model.hop_ns * (ports - sender.gp) as f64
        };
        let mut arrivals: Vec<f64> = others.iter().map(arrival).collect();
        arrivals.sort_by(f64::total_cmp);
        // The first GP handles the reports one by one.
        let handled_ns = arrivals.into_iter().fold(0.0, |done, arrival| later(done, arrival) + model.message_ns);
        later(first.cpu_ns, handled_ns)
    }
}

const FRAME_BUFFERS: usize = 2;

fn soonest(times: &[f64]) -> (usize, f64) {
    let all = times.iter().copied().enumerate();
    all.reduce(|first, time| if time.1 < first.1 { time } else { first }).unwrap_or((0, f64::MIN))
}
