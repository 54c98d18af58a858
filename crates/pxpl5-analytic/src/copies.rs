//! Frame-buffer ports: one region at a time, in order of arrival.

use super::renderer::{later, sooner};

/// Copies that a renderer has to make, by frame buffer, and when it can begin.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Queue {
    pub(super) boards: [u8; 4],
    pub(super) len: usize,
    pub(super) done: usize,
    pub(super) ready_ns: f64,
}

impl Queue {
    pub(super) fn push(&mut self, board: u8) {
        self.boards[self.len] = board;
        self.len += 1;
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

/// Makes all copies; afterwards `ready_ns` of each queue says when its renderer is free.
pub(super) fn copy_all(queues: &mut [Queue], region_ns: f64) -> CopyTimes {
    let mut ports = [f64::MIN; 2];
    let mut times = CopyTimes { begin_ns: f64::INFINITY, end_ns: f64::MIN };
    while let Some(next) = first_ready(queues) {
        let queue = &mut queues[next];
        let port = &mut ports[usize::from(queue.boards[queue.done])];
        let begin = later(*port, queue.ready_ns);
        *port = begin + region_ns;
        queue.ready_ns = *port;
        queue.done += 1;
        // A later copy may begin sooner, on the other port.
        times.begin_ns = sooner(times.begin_ns, begin);
        times.end_ns = later(times.end_ns, *port);
    }
    times
}

fn first_ready(queues: &[Queue]) -> Option<usize> {
    let mut first = (None, f64::INFINITY);
    for (i, queue) in queues.iter().enumerate() {
        if queue.done < queue.len && queue.ready_ns < first.1 {
            first = (Some(i), queue.ready_ns);
        }
    }
    first.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn queues(order: [[u8; 4]; 5], len: usize) -> Vec<Queue> {
        order.iter().map(|boards| Queue { boards: *boards, len, done: 0, ready_ns: 0.0 }).collect()
    }

    #[test]
    fn twenty_regions_over_two_ports_take_eleven_region_times() {
        let times = copy_all(&mut queues([[0, 1, 0, 1]; 5], 4), 780.0);
        assert_eq!(times.end_ns - times.begin_ns, 11.0 * 780.0);
    }

    #[test]
    fn ten_regions_take_five_when_both_ports_start_at_once() {
        let order = [[0, 1, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0]];
        assert_eq!(copy_all(&mut queues(order, 2), 780.0).end_ns, 5.0 * 780.0);
    }
}
