//! Tests the reason for the limit of six of the eight channels for messages to FIFOs. The test searches all states of
//! small machines, in any order of events.
//!
//! The invariant: messages to full FIFOs hold at most `fifo_channels` < `channels` channels. At least one channel is
//! therefore free, or carries a message to an elastic receiver. Such a message always ends. A board that must send
//! before it accepts more words can therefore send. Then its FIFO drains, and every message ends. With `fifo_channels`
//! = `channels` the first step fails. Full FIFOs hold all channels, and the messages that their boards must send first
//! wait for a channel.
//!
//! The search has no time: it tries every possible next event, in every order. Its result therefore holds for all times
//! and rules of arbitration. The search model shares no code with the ring.

use std::collections::HashSet;

/// A machine whose processors send to renderers. The renderers send each command's pixels to one frame buffer.
#[derive(Clone, Copy, Debug)]
struct Machine {
    channels: usize,
    fifo_channels: usize,
    /// Number of channels on which one board can send at the same time.
    source_channels: usize,
    processors: usize,
    renderers: usize,
    /// Number of messages from each processor to each renderer.
    messages: u8,
    /// Number of messages that fit into a renderer's FIFO.
    fifo: u8,
}

/// The positions of all messages, without time.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct State {
    /// Numbers of unsent messages, by processor and renderer. A processor can send its messages in any order.
    unsent: Vec<Vec<u8>>,
    /// Messages on channels to renderers: processor and renderer of each message.
    to_fifos: Vec<(usize, usize)>,
    /// Renderer whose message is on a channel to the frame buffer. The frame buffer takes one message at a time.
    to_frame_buffer: Option<usize>,
    /// Number of commands in each FIFO.
    held: Vec<u8>,
    /// True for each renderer with a message to send. Such a renderer takes no command from its FIFO before the message
    /// has ended.
    must_send: Vec<bool>,
}

impl Machine {
    fn start(&self) -> State {
        State {
            unsent: vec![vec![self.messages; self.renderers]; self.processors],
            to_fifos: Vec::new(),
            to_frame_buffer: None,
            held: vec![0; self.renderers],
            must_send: vec![false; self.renderers],
        }
    }

    fn has_free_channel(&self, state: &State) -> bool {
        state.to_fifos.len() + usize::from(state.to_frame_buffer.is_some()) < self.channels
    }

    fn next(&self, state: &State) -> Vec<State> {
        let mut all = self.grants(state);
        // A message ends if its receiver has room.
        for (flight, &(_, renderer)) in state.to_fifos.iter().enumerate() {
            if state.held[renderer] < self.fifo {
                let mut next = state.clone();
                next.to_fifos.remove(flight);
                next.held[renderer] += 1;
                all.push(next);
            }
        }
        // A message to an elastic receiver always ends. Then its renderer can continue.
        if let Some(renderer) = state.to_frame_buffer {
            let mut next = state.clone();
            next.to_frame_buffer = None;
            next.must_send[renderer] = false;
            all.push(next);
        }
        // A renderer takes a command, and must send pixels before the next one.
        for renderer in (0..self.renderers).filter(|&r| state.held[r] > 0 && !state.must_send[r]) {
            let mut next = state.clone();
            next.held[renderer] -= 1;
            next.must_send[renderer] = true;
            all.push(next);
        }
        all
    }

    /// Returns the states that can follow by one grant of a channel.
    fn grants(&self, state: &State) -> Vec<State> {
        let mut all = Vec::new();
        if !self.has_free_channel(state) {
            return all;
        }
        for processor in 0..self.processors {
            let sends = state.to_fifos.iter().filter(|(source, _)| *source == processor).count();
            for renderer in (0..self.renderers).filter(|&r| state.unsent[processor][r] > 0) {
                let is_taken = state.to_fifos.iter().any(|(_, destination)| *destination == renderer);
                if is_taken || sends == self.source_channels || state.to_fifos.len() == self.fifo_channels {
                    continue;
                }
                let mut next = state.clone();
                next.unsent[processor][renderer] -= 1;
                next.to_fifos.push((processor, renderer));
                next.to_fifos.sort_unstable();
                all.push(next);
            }
        }
        for renderer in (0..self.renderers).filter(|&r| state.must_send[r] && state.to_frame_buffer.is_none()) {
            let mut next = state.clone();
            next.to_frame_buffer = Some(renderer);
            all.push(next);
        }
        all
    }

    /// Returns true if all messages were sent and all commands drawn.
    fn is_done(&self, state: &State) -> bool {
        *state == State { unsent: vec![vec![0; self.renderers]; self.processors], ..self.start() }
    }

    /// Returns the number of reachable states, and the reachable deadlocks.
    fn search(&self) -> (usize, Vec<State>) {
        let mut states = HashSet::from([self.start()]);
        let mut open = vec![self.start()];
        let mut stuck = Vec::new();
        while let Some(state) = open.pop() {
            let next = self.next(&state);
            if next.is_empty() && !self.is_done(&state) {
                stuck.push(state.clone());
            }
            assert!(state.to_fifos.len() <= self.fifo_channels, "the invariant's first half");
            open.extend(next.into_iter().filter(|next| states.insert(next.clone())));
        }
        (states.len(), stuck)
    }
}

/// Returns all machines of up to three channels, three renderers and two processors whose search stays small.
fn machines() -> impl Iterator<Item = Machine> {
    let boards = [(1, 1), (1, 2), (1, 3), (2, 1), (2, 2)];
    let channels = (1..=3).flat_map(|channels| (1..=channels).map(move |fifo| (channels, fifo)));
    let shapes = channels.flat_map(|shape| (1..=3).map(move |source| (shape, source)));
    shapes.flat_map(move |((channels, fifo_channels), source_channels)| {
        boards.map(|(processors, renderers)| Machine {
            channels,
            fifo_channels,
            source_channels,
            processors,
            renderers,
            // One message on the channel, one in the FIFO, and one whose pixels wait. With fewer messages, one of these
            // places would stay empty.
            messages: if processors == 1 { 3 } else { 2 },
            fifo: 1,
        })
    })
}

#[test]
fn if_fifos_leave_one_channel_free_no_order_of_events_causes_a_deadlock() {
    let mut states = 0;
    let mut searched = 0;
    for machine in machines().filter(|machine| machine.fifo_channels < machine.channels) {
        let (reached, stuck) = machine.search();
        assert!(stuck.is_empty(), "{machine:?}: {:?}", stuck[0]);
        states += reached;
        searched += 1;
    }
    assert!(searched > 20 && states > 10_000, "{searched} machines, {states} states");
}

/// Without the limit, a machine can deadlock if full FIFOs can hold all channels. For this, the machine needs at least
/// as many renderers as channels, and enough senders.
#[test]
fn if_fifos_can_hold_every_channel_a_machine_with_enough_renderers_and_senders_can_deadlock() {
    for machine in machines().filter(|machine| machine.fifo_channels == machine.channels) {
        let (_, stuck) = machine.search();
        let can_fill = machine.channels.min(machine.processors * machine.source_channels);
        let holds_all = machine.renderers >= machine.channels && can_fill == machine.channels;
        assert_eq!(!stuck.is_empty(), holds_all, "{machine:?}: {:?}", stuck.first());
        for state in stuck {
            assert_eq!(state.to_fifos.len(), machine.channels, "{machine:?}: {state:?}");
        }
    }
}
