//! TRANSFORM and RENDER of Slats on one GP: clumps on their way to the renderers, on some machines at once.

use super::model::{MOST_CHANNELS, PerTriangle, REGIONS, SlatsModel};
use super::renderer::{Array, Commands, Costs, Fifos, Times};
use slats::CLUMP;

/// All clumps; returns when the last one was accepted, and when the processor had handed it over.
#[inline(always)]
pub(super) fn render<const N: usize>(
    models: &[SlatsModel; N],
    arrays: &mut [Array<N>],
    triangles: f64,
    each: PerTriangle,
) -> [Times<N>; 2] {
    let clumps = (triangles / CLUMP as f64).ceil().max(1.0) as usize;
    let size = |clump: usize| (triangles - (clump * CLUMP) as f64).min(CLUMP as f64);
    let sending = Sending::of(models);
    let message = Times::each(|i| models[i].message_ns);
    let mut clump = Clump::first(models, &sending, size(0), each);
    // Once a field the host's next view comes, which the processor receives while it transforms.
    let mut chain = Chain::begin(Times::each(|i| models[i].begin_ns + models[i].message_ns));
    for n in 0..clumps {
        // All between the first and the last are alike.
        if n == 1 || n > 1 && size(n) != size(n - 1) {
            clump = clump.next(models, &sending, size(n), each);
        }
        // The one clump buffer is written again when all renderers have begun with what was in it.
        let transformed = chain.cpu.later(chain.draining) + clump.transform;
        chain.cpu = transformed.later(chain.accepted) + message;
        chain.send(arrays, &sending, &clump);
        clump.behind_last = clump.behind_itself;
    }
    [chain.accepted, chain.cpu]
}

/// What messages cost that does not depend on what they hold.
struct Sending<const N: usize> {
    source_channels: usize,
    overhead: Times<N>,
    hop: Times<N>,
    fifos: Fifos<N>,
    clear: Costs<N>,
    select: Costs<N>,
    command: Costs<N>,
}

impl<const N: usize> Sending<N> {
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

    /// The message of a clump that goes to a region.
    #[inline(always)]
    fn commands(&self, head: Costs<N>, triangles: f64, each: PerTriangle) -> Commands<N> {
        Commands::new(&self.fifos, &head, triangles * each.entries / 10.0, &self.command)
    }
}

/// A clump: select, and clear in the first messages of a field, then its triangles.
struct Clump<const N: usize> {
    transform: Times<N>,
    message: Commands<N>,
    /// [Room](Commands::room_behind) of a message behind the clump before and behind others of this one.
    behind_last: Times<N>,
    behind_itself: Times<N>,
}

impl<const N: usize> Clump<N> {
    /// The first one of a field.
    #[inline(always)]
    fn first(models: &[SlatsModel; N], sending: &Sending<N>, triangles: f64, each: PerTriangle) -> Self {
        let message = sending.commands(sending.select + sending.clear, triangles, each);
        let transform = Times::each(|i| models[i].clump_ns(triangles, each));
        let behind_itself = message.room_behind(&message);
        Self { transform, message, behind_last: Times::all(f64::NEG_INFINITY), behind_itself }
    }

    /// A later one, behind this one.
    #[inline(always)]
    fn next(&self, models: &[SlatsModel; N], sending: &Sending<N>, triangles: f64, each: PerTriangle) -> Self {
        let message = sending.commands(sending.select, triangles, each);
        let transform = Times::each(|i| models[i].clump_ns(triangles, each));
        let behind_last = message.room_behind(&self.message);
        Self { transform, message, behind_last, behind_itself: message.room_behind(&message) }
    }
}

/// Clumps on their way.
struct Chain<const N: usize> {
    /// When the processor is done with what it did last.
    cpu: Times<N>,
    /// When the last message of the last clump was accepted.
    accepted: Times<N>,
    /// When every renderer had accepted its first message of that clump.
    draining: Times<N>,
}

impl<const N: usize> Chain<N> {
    const fn begin(cpu: Times<N>) -> Self {
        Self { cpu, accepted: Times::all(0.0), draining: Times::all(0.0) }
    }

    /// The messages of one clump, as many at a time as a port drives channels.
    #[inline(always)]
    fn send(&mut self, arrays: &mut [Array<N>], sending: &Sending<N>, clump: &Clump<N>) {
        let mut channels = Channels::new(sending.source_channels);
        let mut granted = self.cpu;
        let mut accepted = self.cpu;
        let mut behind = clump.behind_last;
        // A round is a region of every renderer.
        for round in (0..REGIONS).step_by(arrays.len()) {
            for (renderer, array) in arrays.iter_mut().enumerate().take(REGIONS - round) {
                let latency = sending.hop * Times::all((renderer + 1) as f64);
                granted = granted.later(array.released).later(channels.soonest);
                let first = array.take(granted + sending.overhead + latency, &clump.message, behind);
                array.released = first - latency;
                channels.give_back(array.released);
                accepted = accepted.later(first);
            }
            if round == 0 {
                self.draining = accepted;
            }
            behind = clump.behind_itself;
        }
        self.accepted = accepted;
    }
}

/// When the channels of a port are free: the soonest one, which is taken next, and as many others as there are, in their order.
struct Channels<const N: usize> {
    soonest: Times<N>,
    others: [Times<N>; MOST_CHANNELS - 1],
    number: usize,
}

impl<const N: usize> Channels<N> {
    const fn new(number: usize) -> Self {
        let free = Times::all(f64::MIN);
        Self { soonest: free, others: [free; MOST_CHANNELS - 1], number: number - 1 }
    }

    /// Gives the channel back that was taken: it goes before all that are free later.
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
