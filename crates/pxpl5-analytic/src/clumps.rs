//! TRANSFORM and RENDER of Slats on one graphics processor. Each formula is computed for several machines together.

use super::model::{MAX_CHANNELS, PerTriangle, REGIONS, SlatsModel};
use super::renderer::{Array, Commands, Costs, Fifos, Times};
use slats::CLUMP;

/// Computes the times of TRANSFORM and RENDER of a field, which is divided into clumps (groups) of triangles.
///
/// Returns two times of the last clump: when the renderers had accepted its messages, and when the graphics processor
/// had started to send them.
#[inline(always)]
pub(super) fn render<const N: usize>(
    models: &[SlatsModel; N],
    arrays: &mut [Array<N>],
    triangles: f64,
    each: PerTriangle,
) -> [Times<N>; 2] {
    let clumps = (triangles / CLUMP as f64).ceil().max(1.0) as usize;
    let size = |clump: usize| (triangles - (clump * CLUMP) as f64).min(CLUMP as f64);
    let sending = MessageCosts::of(models);
    let message = Times::each(|i| models[i].message_ns);
    let mut clump = Clump::first(models, &sending, size(0), each);
    // The processor receives the host's next view once per field, during TRANSFORM.
    let mut chain = Chain::begin(Times::each(|i| models[i].begin_ns + models[i].message_ns));
    for n in 0..clumps {
        // All clumps between the first and the last are equal.
        if n == 1 || n > 1 && size(n) != size(n - 1) {
            clump = clump.next(models, &sending, size(n), each);
        }
        // The single clump buffer can be reused after all renderers have started to receive its content.
        let transformed = chain.cpu.later(chain.draining) + clump.transform;
        chain.cpu = transformed.later(chain.accepted) + message;
        chain.send(arrays, &sending, &clump);
        clump.behind_last = clump.behind_itself;
    }
    [chain.accepted, chain.cpu]
}

/// Costs of messages that do not depend on the number of triangles.
struct MessageCosts<const N: usize> {
    source_channels: usize,
    overhead: Times<N>,
    hop: Times<N>,
    fifos: Fifos<N>,
    clear: Costs<N>,
    select: Costs<N>,
    command: Costs<N>,
}

impl<const N: usize> MessageCosts<N> {
    #[inline(always)]
    fn of(models: &[SlatsModel; N]) -> Self {
        Self {
            source_channels: models[0].source_channels,
            overhead: Times::each(|i| models[i].overhead_ns),
            hop: Times::each(|i| models[i].hop_ns),
            fifos: Fifos {
                depth_words: Times::each(|i| models[i].fifo_words),
                word_ns: Times::each(|i| models[i].word_ns),
            },
            clear: Costs::each(|i| models[i].clear),
            select: Costs::each(|i| models[i].select),
            command: Costs::each(|i| models[i].command),
        }
    }

    #[inline(always)]
    fn commands(&self, head: Costs<N>, triangles: f64, each: PerTriangle) -> Commands<N> {
        Commands::new(&self.fifos, &head, triangles * each.entries / 10.0, &self.command)
    }
}

/// A clump (group of triangles), and the message with its triangles for one region.
///
/// The message selects the region and draws the triangles. In the first clump of a field, the message also clears the
/// region.
struct Clump<const N: usize> {
    transform: Times<N>,
    message: Commands<N>,
    /// Time until a renderer's FIFO has [room](Commands::room_behind) for a message of this clump, if the last message
    /// belongs to the previous clump.
    behind_last: Times<N>,
    /// Time until a renderer's FIFO has room for a message of this clump, if the last message also belongs to this
    /// clump.
    behind_itself: Times<N>,
}

impl<const N: usize> Clump<N> {
    #[inline(always)]
    fn first(models: &[SlatsModel; N], sending: &MessageCosts<N>, triangles: f64, each: PerTriangle) -> Self {
        let message = sending.commands(sending.select + sending.clear, triangles, each);
        let transform = Times::each(|i| models[i].clump_ns(triangles, each));
        let behind_itself = message.room_behind(&message);
        Self { transform, message, behind_last: Times::all(f64::NEG_INFINITY), behind_itself }
    }

    #[inline(always)]
    fn next(&self, models: &[SlatsModel; N], sending: &MessageCosts<N>, triangles: f64, each: PerTriangle) -> Self {
        let message = sending.commands(sending.select, triangles, each);
        let transform = Times::each(|i| models[i].clump_ns(triangles, each));
        let behind_last = message.room_behind(&self.message);
        Self { transform, message, behind_last, behind_itself: message.room_behind(&message) }
    }
}

struct Chain<const N: usize> {
    /// Time at which the graphics processor has finished its latest work.
    cpu: Times<N>,
    /// Time at which the renderers had accepted all messages of the latest clump.
    accepted: Times<N>,
    /// Time at which every renderer had accepted its first message of the latest clump.
    draining: Times<N>,
}

impl<const N: usize> Chain<N> {
    const fn begin(cpu: Times<N>) -> Self {
        Self { cpu, accepted: Times::all(0.0), draining: Times::all(0.0) }
    }

    /// Sends the messages of one clump. Several channels carry messages at the same time.
    #[inline(always)]
    fn send(&mut self, arrays: &mut [Array<N>], sending: &MessageCosts<N>, clump: &Clump<N>) {
        let mut channels = Channels::new(sending.source_channels);
        let mut granted = self.cpu;
        let mut accepted = self.cpu;
        let mut behind = clump.behind_last;
        // In each round, every renderer receives one region.
        for round in (0..REGIONS).step_by(arrays.len()) {
            for (renderer, array) in arrays.iter_mut().enumerate().take(REGIONS - round) {
                let latency = sending.hop * Times::all((renderer + 1) as f64);
                // A message is granted when the renderer's port and a channel are free.
                granted = granted.later(array.released).later(channels.soonest);
                let first = array.take(granted + sending.overhead + latency, &clump.message, behind);
                array.released = first - latency;
                channels.give_back(array.released);
                accepted = accepted.later(first);
            }
            // After the first round, every renderer has accepted one message.
            if round == 0 {
                self.draining = accepted;
            }
            behind = clump.behind_itself;
        }
        self.accepted = accepted;
    }
}

/// Times at which the ring channels of a port become free, in ascending order.
struct Channels<const N: usize> {
    soonest: Times<N>,
    others: [Times<N>; MAX_CHANNELS - 1],
    number: usize,
}

impl<const N: usize> Channels<N> {
    const fn new(number: usize) -> Self {
        let free = Times::all(f64::MIN);
        Self { soonest: free, others: [free; MAX_CHANNELS - 1], number: number - 1 }
    }

    /// Marks the channel that becomes free first as busy until `free`. Then sorts the channels by the time at which
    /// they become free.
    #[inline(always)]
    fn give_back(&mut self, free: Times<N>) {
        let mut here = free;
        let mut before = &mut self.soonest;
        for other in self.others.iter_mut().take(self.number) {
            *before = other.sooner(here);
            here = other.later(here);
            before = other;
        }
        *before = here;
    }
}
