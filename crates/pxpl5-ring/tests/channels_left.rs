//! Why messages to FIFOs take six of eight channels at most: all states of small machines, whatever order things happen in.
//!
//! The invariant: messages to full FIFOs hold at most `fifo_channels` < `channels` channels. So there is always a channel that is
//! free, or that carries a message to an elastic receiver, which ends by itself. Hence a board that must send before it takes more
//! can send; hence its FIFO drains; hence every message ends. With `fifo_channels` = `channels` the first step fails: full FIFOs hold
//! all channels, and what their boards must send first waits for one.
//!
//! The search below knows no time: whatever can happen next does, in every order, so it holds for all times and rules of arbitration.
//! Its model shares no code with the ring.

use std::collections::HashSet;

/// A machine: processors that send to renderers, which send each command's pixels to one frame buffer.
#[derive(Clone, Copy, Debug)]
struct Machine {
    channels: usize,
    fifo_channels: usize,
    /// Channels that one board sends on at a time.
    source_channels: usize,
    processors: usize,
    renderers: usize,
    /// Messages that each processor sends to each renderer.
    messages: u8,
    /// Messages that fit into a renderer's FIFO.
    fifo: u8,
}

/// What stands where, without any time.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct State {
    /// Of each processor: messages to each renderer that it has not begun to send. It may send them in any order.
    unsent: Vec<Vec<u8>>,
    /// Messages on channels: from a processor to a renderer.
    to_fifos: Vec<(usize, usize)>,
    /// Messages on channels to the frame buffer, by renderer; it takes one at a time.
    to_frame_buffer: Option<usize>,
    /// Commands in each FIFO.
    held: Vec<u8>,
    /// Renderers that have a message to send, and take nothing out of their FIFO before it is on its way and has ended.
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

    /// Every state that can be next.
    fn next(&self, state: &State) -> Vec<State> {
        let mut all = self.grants(state);
        // A message whose receiver has room ends.
        for (flight, &(_, renderer)) in state.to_fifos.iter().enumerate() {
            if state.held[renderer] < self.fifo {
                let mut next = state.clone();
                next.to_fifos.remove(flight);
                next.held[renderer] += 1;
                all.push(next);
            }
        }
        // What is elastic ends by itself; its renderer may go on.
        if let Some(renderer) = state.to_frame_buffer {
            let mut next = state.clone();
            next.to_frame_buffer = None;
            next.must_send[renderer] = false;
            all.push(next);
        }
        // A renderer takes a command, and has pixels to send before the next.
        for renderer in (0..self.renderers).filter(|&r| state.held[r] > 0 && !state.must_send[r]) {
            let mut next = state.clone();
            next.held[renderer] -= 1;
            next.must_send[renderer] = true;
            all.push(next);
        }
        all
    }

    /// States after a channel was granted to somebody.
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

    /// Whether everything was sent and drawn.
    fn is_done(&self, state: &State) -> bool {
        *state == State { unsent: vec![vec![0; self.renderers]; self.processors], ..self.start() }
    }

    /// All states that can be reached, and those of them in which nothing can happen any more although work is left.
    fn search(&self) -> (usize, Vec<State>) {
        let mut known = HashSet::from([self.start()]);
        let mut open = vec![self.start()];
        let mut stuck = Vec::new();
        while let Some(state) = open.pop() {
            let next = self.next(&state);
            if next.is_empty() && !self.is_done(&state) {
                stuck.push(state.clone());
            }
            assert!(state.to_fifos.len() <= self.fifo_channels, "the invariant's first half");
            open.extend(next.into_iter().filter(|next| known.insert(next.clone())));
        }
        (known.len(), stuck)
    }
}

/// All shapes of up to three channels and renderers, and up to two processors where that is few enough to be searched.
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
            // One message on the channel, one in the FIFO, one whose pixels wait: less would fill nothing.
            messages: if processors == 1 { 3 } else { 2 },
            fifo: 1,
        })
    })
}

#[test]
fn while_fifos_leave_a_channel_no_order_of_events_ends_in_a_deadlock() {
    let mut states = 0;
    let mut searched = 0;
    for machine in machines().filter(|machine| machine.fifo_channels < machine.channels) {
        let (known, stuck) = machine.search();
        assert!(stuck.is_empty(), "{machine:?}: {:?}", stuck[0]);
        states += known;
        searched += 1;
    }
    println!("{searched} machines, {states} states");
    assert!(searched > 20 && states > 10_000, "{searched} machines, {states} states");
}

/// Without the limit a machine is stuck as soon as full FIFOs can hold all channels: as many renderers as channels, and enough boards
/// that send to them.
#[test]
fn without_a_channel_left_full_fifos_hold_all_of_them() {
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
