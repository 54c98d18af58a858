//! Frame-buffer ports: one region at a time, in order of arrival.

use super::renderer::Times;

/// Renderers that are looked at one by one; more than there are field regions never hold one.
pub(super) const MOST_RENDERERS: usize = 20;

/// Copies that a renderer has to make, by frame buffer, the first one in the lowest two bits: [`Queue::ONE`], and which of the two boards.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Queue(u64);

impl Queue {
    const BITS: u32 = 2;
    const ONE: u64 = 1;
    const RIGHT: u64 = 2;

    pub(super) const fn len(self) -> u32 {
        (u64::BITS - self.0.leading_zeros()).div_ceil(Self::BITS)
    }

    /// Adds a copy behind the others.
    pub(super) const fn push(&mut self, to_right: bool) {
        let board = if to_right { Self::RIGHT } else { 0 };
        self.0 |= (Self::ONE | board) << (Self::BITS * self.len());
    }

    /// The last one first.
    pub(super) fn reversed(self) -> Self {
        let copies = (0..self.len()).rev().map(|n| self.0 >> (Self::BITS * n) & Self::RIGHT != 0);
        copies.fold(Self::default(), |mut all, to_right| {
            all.push(to_right);
            all
        })
    }
}

/// First word and last word of all copies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CopyTimes {
    /// First word of the first one.
    pub begin_ns: f64,
    /// Last word of the last one.
    pub end_ns: f64,
}

/// The copies of renderers on some machines at once, which have the same ones to make.
#[derive(Clone, Copy, Debug)]
pub(super) struct Copies<const N: usize> {
    /// When each renderer is ready for its next copy, or free for good.
    pub(super) ready: [Times<N>; MOST_RENDERERS],
}

impl<const N: usize> Copies<N> {
    /// Makes all copies of so many renderers, each of `region` nanoseconds: the renderer that is ready first goes first, of several the
    /// one with the lowest number.
    #[inline(always)]
    pub(super) fn make(
        &mut self,
        queues: &[Queue; MOST_RENDERERS],
        renderers: usize,
        region: Times<N>,
    ) -> [CopyTimes; N] {
        let never = f64::INFINITY;
        let mut left = [[0_u64; N]; MOST_RENDERERS];
        // When each renderer could begin: never where nothing is left to do.
        let mut next = self.ready;
        for r in 0..renderers {
            left[r] = [queues[r].0; N];
            if queues[r].0 == 0 {
                next[r] = Times::all(never);
            }
        }
        let mut ports = [[f64::MIN; N]; 2];
        let (mut begins, mut ends) = (Times::<N>::all(never), Times::<N>::all(f64::MIN));
        for _ in 0..queues[..renderers].iter().map(|queue| queue.len()).sum::<u32>() {
            let (mut first, mut chosen, mut copy) = ([never; N], [0; N], [0; N]);
            for r in 0..renderers {
                let sooner = where_less(next[r].0, first);
                first = select_times(sooner, next[r].0, first);
                chosen = select(sooner, [r as u64; N], chosen);
                copy = select(sooner, left[r], copy);
            }
            let to_right = where_set(copy, Queue::RIGHT);
            let port = select_times(to_right, ports[1], ports[0]);
            let begin = Times(port).later(Times(first));
            let end = begin + region;
            ports = [select_times(to_right, ports[0], end.0), select_times(to_right, end.0, ports[1])];
            // A later copy may begin sooner, on the other port.
            begins = begins.sooner(begin);
            ends = ends.later(end);
            for r in 0..renderers {
                let is_chosen = where_equal(chosen, [r as u64; N]);
                let rest = shifted(left[r], Queue::BITS);
                let then = select_times(where_equal(rest, [0; N]), [never; N], end.0);
                left[r] = select(is_chosen, rest, left[r]);
                next[r].0 = select_times(is_chosen, then, next[r].0);
                self.ready[r].0 = select_times(is_chosen, end.0, self.ready[r].0);
            }
        }
        let mut all = [CopyTimes { begin_ns: never, end_ns: never }; N];
        for (i, times) in all.iter_mut().enumerate() {
            *times = CopyTimes { begin_ns: begins.0[i], end_ns: ends.0[i] };
        }
        all
    }
}

/// All bits of a lane where something holds of it.
type Mask<const N: usize> = [u64; N];

/// A loop over the lanes that compilers turn into one operation on all of them.
macro_rules! lanes {
    ($i:ident => $lane:expr) => {{
        let mut all = [Default::default(); N];
        for $i in 0..N {
            all[$i] = $lane;
        }
        all
    }};
}

#[inline(always)]
fn where_less<const N: usize>(a: [f64; N], b: [f64; N]) -> Mask<N> {
    lanes!(i => u64::from(a[i] < b[i]).wrapping_neg())
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

    fn times(order: [&[bool]; 5], region_ns: f64) -> CopyTimes {
        let mut queues = [Queue::default(); MOST_RENDERERS];
        for (queue, boards) in queues.iter_mut().zip(order) {
            boards.iter().for_each(|right| queue.push(*right));
        }
        let mut copies = Copies { ready: [Times::all(0.0); MOST_RENDERERS] };
        let [times] = copies.make(&queues, 5, Times::all(region_ns));
        times
    }

    #[test]
    fn twenty_regions_over_two_ports_take_eleven_region_times() {
        let times = times([&[false, true, false, true]; 5], 780.0);
        assert_eq!(times.end_ns - times.begin_ns, 11.0 * 780.0);
    }

    #[test]
    fn ten_regions_take_five_when_both_ports_start_at_once() {
        let [left, right]: [&[bool]; 2] = [&[false, true], &[true, false]];
        assert_eq!(times([left, right, left, right, left], 780.0).end_ns, 5.0 * 780.0);
    }

    #[test]
    fn a_queue_has_its_copies_in_order_and_turned_round() {
        let mut queue = Queue::default();
        [true, false, false].map(|right| queue.push(right));
        assert_eq!((queue, queue.len()), (Queue(0b01_01_11), 3));
        assert_eq!(queue.reversed(), Queue(0b11_01_01));
    }
}
