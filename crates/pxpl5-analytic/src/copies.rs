//! Copies of regions to the frame buffers. A frame-buffer port receives one region at a time, in order of arrival.

use super::renderer::{Array, Times, later};

/// Computes an array with one value for each machine. The compiler turns the loop into vector instructions.
macro_rules! lanes {
    ($i:ident => $lane:expr) => {{
        let mut all = [Default::default(); N];
        for $i in 0..N {
            all[$i] = $lane;
        }
        all
    }};
}

/// Largest number of renderers in the model. With 20 regions per field, more than 20 renderers are not faster.
pub(super) const MAX_RENDERERS: usize = 20;

/// The copies of a renderer, with two bits for each copy: [`Queue::ONE`] is always set, and `Queue::RIGHT` is set for
/// the right frame buffer. The first copy is in the lowest bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Queue(u64);

impl Queue {
    const BITS: u32 = 2;
    const ONE: u64 = 1;
    const RIGHT: u64 = 2;

    pub(super) const fn len(self) -> u32 {
        (u64::BITS - self.0.leading_zeros()).div_ceil(Self::BITS)
    }

    pub(super) const fn push(&mut self, to_right: bool) {
        let board = if to_right { Self::RIGHT } else { 0 };
        self.0 |= (Self::ONE | board) << (Self::BITS * self.len());
    }

    /// Returns the same copies in an order that alternates between the left and the right frame buffer.
    ///
    /// If `begins_right` is true, the new order begins with a copy to the right frame buffer, if any exists. Otherwise
    /// the new order begins with the same copy as the old order.
    pub(super) fn alternated(self, begins_right: bool) -> Self {
        let copies = (0..self.len()).map(|n| self.0 >> (Self::BITS * n) & Self::RIGHT != 0);
        let mut left = [0; 2];
        // Count the copies of each side.
        copies.for_each(|to_right| left[usize::from(to_right)] += 1);
        let mut next = if begins_right { left[1] > 0 } else { self.0 & Self::RIGHT != 0 };
        let mut all = Self::default();
        // Alternate, and skip a side without remaining copies.
        while left != [0; 2] {
            if left[usize::from(next)] > 0 {
                left[usize::from(next)] -= 1;
                all.push(next);
            }
            next = !next;
        }
        all
    }
}

/// Begin and end of the copies of regions to the frame buffers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CopyTimes {
    /// Time of the first word of the first copy.
    pub begin_ns: f64,
    /// Time of the last word of the last copy.
    pub end_ns: f64,
}

/// The ports of the two frame buffers, for several machines: when the ports become free, and the times of the copies.
struct Ports<const N: usize> {
    free: [Times<N>; 2],
    begins: Times<N>,
    ends: Times<N>,
}

/// Copies the regions of all renderers to the frame buffers. Each copy takes `region` nanoseconds.
///
/// The renderer that is free first copies first, and for equal times the renderer with the lower index. While this
/// order is equal on all machines, the machines are computed together. `free` has the times at which the two ports are
/// free, before these copies and then after them.
#[inline(always)]
pub(super) fn make<const N: usize>(
    arrays: &mut [Array<N>],
    queues: &[Queue; MAX_RENDERERS],
    region: Times<N>,
    free: &mut [Times<N>; 2],
) -> [CopyTimes; N] {
    let mut left = *queues;
    let mut ports = Ports::new(*free);
    // While all configurations agree on the first renderer, copy for all lanes at once.
    while let Some(first) = first_of_all(arrays, &left) {
        let to_right = left[first].0 & Queue::RIGHT != 0;
        left[first].0 >>= Queue::BITS;
        arrays[first].free = ports.copy(arrays[first].free, to_right, region);
    }
    // Then copy for each lane in its own order.
    ports.copy_apart(arrays, &left, region);
    *free = ports.free;
    std::array::from_fn(|i| CopyTimes { begin_ns: ports.begins.0[i], end_ns: ports.ends.0[i] })
}

/// Returns the times of the copies of the top regions, if renderers with few bottom regions may ask for them before other
/// renderers have asked for all of theirs. The ports serve both in order of arrival.
///
/// `queues` are the copies of the bottom and of the top regions. `ready` is the time at which a renderer asks for its
/// first top region if it has copied its bottom regions at `ends`. A copy command follows the previous one after `order_ns`,
/// and a copy takes `region_ns`.
pub(super) fn overtaking(
    count: usize,
    [order_ns, region_ns]: [f64; 2],
    [bottom, top]: [[Queue; MAX_RENDERERS]; 2],
    ready: [f64; MAX_RENDERERS],
    ends: [f64; MAX_RENDERERS],
) -> CopyTimes {
    // Copies that a renderer has left of one half, the time at which it asks for the next one, and true for the top half.
    let of_renderer = |r: usize| match bottom[r].0 {
        0 => (top[r], ready[r], true),
        _ => (bottom[r], (r + 1) as f64 * order_ns, false),
    };
    let mut renderers: Vec<(Queue, f64, bool)> = (0..count).map(of_renderer).collect();
    let mut free = [f64::MIN; 2];
    let mut times = CopyTimes { begin_ns: f64::INFINITY, end_ns: f64::MIN };
    loop {
        let asking = renderers.iter().enumerate().filter(|(_, (left, ..))| left.0 != 0).map(|(r, (_, at, _))| (*at, r));
        let first = asking.reduce(|first, other| if other.0 < first.0 { other } else { first });
        let Some((at, r)) = first else { return times };
        let (left, next, is_top) = &mut renderers[r];
        let port = &mut free[usize::from(left.0 & Queue::RIGHT != 0)];
        let begin = later(*port, at);
        *port = begin + region_ns;
        if *is_top {
            times = CopyTimes { begin_ns: times.begin_ns.min(begin), end_ns: later(times.end_ns, *port) };
        }
        left.0 >>= Queue::BITS;
        *next = *port;
        if left.0 == 0 && !*is_top {
            (*left, *next, *is_top) = (top[r], ready[r] + later(0.0, *port - ends[r]), true);
        }
    }
}

/// Returns the index of the renderer that makes the next copy on all machines. Returns `None` if this renderer differs
/// between machines, or if all copies are done.
#[inline(always)]
fn first_of_all<const N: usize>(arrays: &[Array<N>], left: &[Queue; MAX_RENDERERS]) -> Option<usize> {
    let waiting = || (0..arrays.len()).filter(|r| left[*r].0 != 0);
    let there = |r: usize| arrays[r].free.0[0];
    // Candidate: the first renderer of configuration 0.
    let first = waiting().reduce(|first, r| if there(r) < there(first) { r } else { first })?;
    if N == 1 {
        return Some(first);
    }
    let own = arrays[first].free.0;
    // Check that no other renderer precedes the candidate in any configuration.
    let mut not_first = [0; N];
    for r in waiting() {
        let other = arrays[r].free.0;
        let before = if r < first { where_no_more(other, own) } else { where_less(other, own) };
        not_first = lanes!(i => not_first[i] | before[i]);
    }
    (not_first == [0; N]).then_some(first)
}

impl<const N: usize> Ports<N> {
    const fn new(free: [Times<N>; 2]) -> Self {
        Self { free, begins: Times::all(f64::INFINITY), ends: Times::all(f64::MIN) }
    }

    /// Copies a region from the time `ready` on, or later when the port becomes free. Returns the end of the copy.
    #[inline(always)]
    fn copy(&mut self, ready: Times<N>, to_right: bool, region: Times<N>) -> Times<N> {
        let begin = self.free[usize::from(to_right)].later(ready);
        let end = begin + region;
        self.free[usize::from(to_right)] = end;
        self.note(begin, end);
        end
    }

    /// Extends the recorded begin and end of all copies by one more copy.
    #[inline(always)]
    fn note(&mut self, begin: Times<N>, end: Times<N>) {
        self.begins = self.begins.sooner(begin);
        self.ends = self.ends.later(end);
    }

    /// Copies the remaining regions, in an order that may differ between machines.
    #[inline(always)]
    fn copy_apart(&mut self, arrays: &mut [Array<N>], queues: &[Queue; MAX_RENDERERS], region: Times<N>) {
        let never = [f64::INFINITY; N];
        let mut left = queues.map(|queue| [queue.0; N]);
        // Earliest start of each renderer's next copy, infinite if it has none.
        let mut next = [never; MAX_RENDERERS];
        let waiting = arrays.iter().zip(&mut next).zip(queues).filter(|(_, queue)| queue.0 != 0);
        waiting.for_each(|((array, next), _)| *next = array.free.0);
        for _ in 0..queues.iter().map(|queue| queue.len()).sum::<u32>() {
            // Choose the first renderer of each configuration.
            let (mut first, mut chosen, mut copy) = (never, [0; N], [0; N]);
            for r in 0..arrays.len() {
                let sooner = where_less(next[r], first);
                first = select_times(sooner, next[r], first);
                chosen = select(sooner, [r as u64; N], chosen);
                copy = select(sooner, left[r], copy);
            }
            // Make its copy, and update only its lanes.
            let end = self.copy_where(Times(first), where_set(copy, Queue::RIGHT), region);
            for r in 0..arrays.len() {
                let is_chosen = where_equal(chosen, [r as u64; N]);
                let rest = shifted(left[r], Queue::BITS);
                let then = select_times(where_equal(rest, [0; N]), never, end.0);
                left[r] = select(is_chosen, rest, left[r]);
                next[r] = select_times(is_chosen, then, next[r]);
                arrays[r].free.0 = select_times(is_chosen, end.0, arrays[r].free.0);
            }
        }
    }

    /// Copies one region on each machine, to the right frame buffer if `to_right` is set, otherwise to the left frame
    /// buffer. Returns the end times.
    #[inline(always)]
    fn copy_where(&mut self, ready: Times<N>, to_right: Mask<N>, region: Times<N>) -> Times<N> {
        let [left, right] = self.free;
        let begin = Times(select_times(to_right, right.0, left.0)).later(ready);
        let end = begin + region;
        self.free = [select_times(to_right, left.0, end.0), select_times(to_right, end.0, right.0)].map(Times);
        self.note(begin, end);
        end
    }
}

/// A condition for each machine: all bits are set if the condition is true, and no bit otherwise.
type Mask<const N: usize> = [u64; N];

#[inline(always)]
fn where_less<const N: usize>(a: [f64; N], b: [f64; N]) -> Mask<N> {
    lanes!(i => u64::from(a[i] < b[i]).wrapping_neg())
}

#[inline(always)]
fn where_no_more<const N: usize>(a: [f64; N], b: [f64; N]) -> Mask<N> {
    lanes!(i => u64::from(a[i] <= b[i]).wrapping_neg())
}

#[inline(always)]
fn where_equal<const N: usize>(a: [u64; N], b: [u64; N]) -> Mask<N> {
    lanes!(i => u64::from(a[i] == b[i]).wrapping_neg())
}

#[inline(always)]
fn where_set<const N: usize>(a: [u64; N], bit: u64) -> Mask<N> {
    lanes!(i => u64::from(a[i] & bit != 0).wrapping_neg())
}

#[inline(always)]
fn shifted<const N: usize>(a: [u64; N], bits: u32) -> [u64; N] {
    lanes!(i => a[i] >> bits)
}

#[inline(always)]
fn select<const N: usize>(mask: Mask<N>, yes: [u64; N], no: [u64; N]) -> [u64; N] {
    lanes!(i => mask[i] & yes[i] | !mask[i] & no[i])
}

#[inline(always)]
fn select_times<const N: usize>(mask: Mask<N>, yes: [f64; N], no: [f64; N]) -> [f64; N] {
    lanes!(i => f64::from_bits(mask[i] & yes[i].to_bits() | !mask[i] & no[i].to_bits()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests copies of 100 ns and commands 10 ns apart. Renderer 0 copies its top region from 5 ns on, before renderer 1
    /// asks at 20 ns. Both want the left port, so the three bottom regions of renderer 1 go from 105 to 405 ns, 85 ns
    /// later than alone. Renderer 1 therefore asks for its top region at 485 instead of 400 ns.
    #[test]
    fn a_top_region_that_overtakes_delays_bottom_regions_and_the_top_region_after_them() {
        let queue = |copies: &[bool]| {
            let mut queue = Queue::default();
            copies.iter().for_each(|to_right| queue.push(*to_right));
            queue
        };
        let [mut bottom, mut top] = [[Queue::default(); MAX_RENDERERS]; 2];
        bottom[1] = queue(&[false; 3]);
        (top[0], top[1]) = (queue(&[false]), queue(&[true]));
        let [mut ready, mut ends] = [[0.0; MAX_RENDERERS]; 2];
        (ready[0], ready[1], ends[1]) = (5.0, 400.0, 320.0);
        let found = overtaking(2, [10.0, 100.0], [bottom, top], ready, ends);
        assert_eq!(found, CopyTimes { begin_ns: 5.0, end_ns: 585.0 });
    }
}
