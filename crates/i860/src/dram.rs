//! The external bus, and the page-mode memory on this bus. At a request, the model computes the arrival times of all
//! data, without an event for each transfer.

use crate::timing::{ChipSizes, DramTiming};

const BUS_BYTES: u64 = ChipSizes::PAPERS.bus_bytes;
const BUS_DEPTH: usize = ChipSizes::PAPERS.bus_depth as usize;

/// The clocks at which the 8-byte transfers of a request arrive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Transfer {
    /// Clock at which the first 8 bytes arrive. These bytes contain the requested data.
    pub(crate) first: u64,
    pub(crate) last: u64,
    step: u64,
}

impl Transfer {
    /// Returns the clock at which transfer `number` arrives. Transfer 0 contains the requested data.
    pub(crate) fn arrival(&self, number: u32) -> u64 {
        self.first + u64::from(number) * self.step
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Dram {
    timing: DramTiming,
    /// First clock at which a read of the open DRAM row can start. Data of the previous read can still be on the bus at
    /// this clock.
    free: u64,
    /// Clock at which the data transfers of all requests end. A write, or a request to another DRAM row, cannot start
    /// earlier.
    data_end: u64,
    open_page: u64,
    next_refresh: u64,
    next_dma: u64,
    /// End of each of the latest requests, in clocks, the oldest request first.
    outstanding: [u64; BUS_DEPTH],
    pub(crate) transfers: u64,
    pub(crate) page_misses: u64,
}

const CLOSED: u64 = u64::MAX;

impl Dram {
    pub(crate) fn new(timing: DramTiming) -> Dram {
        Dram {
            timing,
            free: 0,
            data_end: 0,
            open_page: CLOSED,
            next_refresh: timing.refresh_interval,
            next_dma: timing.dma_interval,
            outstanding: [0; BUS_DEPTH],
            transfers: 0,
            page_misses: 0,
        }
    }

    /// Returns the first clock at which the address pipe of the bus has room for a request.
    pub(crate) fn accepts_at(&self) -> u64 {
        self.outstanding[0]
    }

    pub(crate) fn idle_at(&self) -> u64 {
        self.data_end.max(self.free)
    }

    /// Adds the times of a DRAM refresh and of a transfer by another bus master, if they are due at clock `now` or
    /// earlier. Of several that are due, only the latest takes time (assumed).
    fn steal(&mut self, now: u64) {
        let t = self.timing;
        for (interval, clocks, due) in [
            (t.refresh_interval, t.refresh_clocks, &mut self.next_refresh),
            (t.dma_interval, t.dma_clocks, &mut self.next_dma),
        ] {
            if interval == 0 || clocks == 0 || *due > now {
                continue;
            }
            // If several interruptions were due since the last request, only the latest interruption takes time
            // (assumed).
            let missed = (now - *due) / interval;
            let latest = *due + missed * interval;
            self.free = self.free.max(latest) + clocks;
            *due = latest + interval;
            self.open_page = CLOSED;
        }
    }

    /// Opens the DRAM row that contains `address`. Returns true if this row was already open.
    fn open(&mut self, address: u32) -> bool {
        let page = u64::from(address) / self.timing.page_bytes.max(BUS_BYTES);
        let hit = page == self.open_page;
        self.open_page = page;
        self.transfers += 1;
        self.page_misses += u64::from(!hit);
        hit
    }

    fn finish(&mut self, transfer: Transfer) -> Transfer {
        self.data_end = self.data_end.max(transfer.last);
        self.outstanding.rotate_left(1);
        self.outstanding[BUS_DEPTH - 1] = self.data_end;
        transfer
    }

    /// Reads `beats` transfers of 8 bytes. The requested 8 bytes arrive first.
    ///
    /// Requests to the open DRAM row overlap: the first data of a request follow [`DramTiming::next`] clocks after the
    /// last data of the previous request. A row is closed only after the transfer of its last data.
    pub(crate) fn read(&mut self, now: u64, address: u32, beats: u32) -> Transfer {
        self.steal(now);
        let hit = self.open(address);
        let start = now.max(if hit { self.free } else { self.free.max(self.data_end) });
        let t = self.timing;
        let first = start + if hit { t.first_hit } else { t.first_miss };
        let last = first + u64::from(beats - 1) * t.next;
        // The opening of a row also delays later requests.
        let opening = if hit { 0 } else { t.first_miss.saturating_sub(t.first_hit) };
        self.free = start + opening + u64::from(beats) * t.next;
        self.finish(Transfer { first, last, step: t.next })
    }

    /// Writes `beats` transfers of 8 bytes to one DRAM row. The write begins after the transfers of all reads.
    pub(crate) fn write(&mut self, now: u64, address: u32, beats: u32) -> Transfer {
        self.steal(now);
        let hit = self.open(address);
        let start = self.free.max(self.data_end).max(now);
        let t = self.timing;
        let first = start + if hit { t.write_hit } else { t.write_miss };
        let last = first + u64::from(beats - 1) * t.write_hit;
        self.free = last;
        self.finish(Transfer { first, last, step: t.write_hit })
    }
}

#[cfg(test)]
mod tests {
    use super::Dram;
    use crate::timing::DramTiming;

    fn quiet() -> DramTiming {
        DramTiming { refresh_interval: 0, ..DramTiming::PAPERS }
    }

    #[test]
    fn a_line_fill_is_one_first_access_and_three_page_mode_accesses() {
        let t = quiet();
        let mut dram = Dram::new(t);
        let opening = dram.read(0, 0, 4);
        assert_eq!((opening.first, opening.last), (t.first_miss, t.first_miss + 3 * t.next));
        let open = dram.read(1000, 32, 4);
        assert_eq!(open.last - 1000, t.first_hit + 3 * t.next);
    }

    #[test]
    fn overlapped_reads_of_the_open_row_arrive_in_sequence() {
        let t = quiet();
        let mut dram = Dram::new(t);
        let first = dram.read(0, 0, 1);
        let second = dram.read(1, 8, 1);
        assert_eq!(second.first - first.last, t.next);
    }

    #[test]
    fn a_write_begins_after_the_data_of_the_previous_read() {
        let t = quiet();
        let mut dram = Dram::new(t);
        let line = dram.read(0, 0, 4);
        assert_eq!(dram.write(1, 32, 1).last - line.last, t.write_hit);
    }

    #[test]
    fn another_row_is_opened_after_the_data_of_the_previous_read() {
        let t = quiet();
        let mut dram = Dram::new(t);
        let line = dram.read(0, 0, 4);
        assert_eq!(dram.read(1, t.page_bytes as u32, 1).first - line.last, t.first_miss);
    }

    #[test]
    fn changing_the_row_costs_opening_it_again() {
        let t = quiet();
        let mut dram = Dram::new(t);
        dram.read(0, 0, 1);
        assert_eq!(dram.read(1000, t.page_bytes as u32, 1).first - 1000, t.first_miss);
        assert_eq!(dram.page_misses, 2);
    }

    #[test]
    fn a_refresh_delays_a_request_only_if_it_is_due() {
        let t = DramTiming { refresh_interval: 100, refresh_clocks: 7, ..DramTiming::PAPERS };
        let mut due = Dram::new(t);
        assert_eq!(due.read(100, 0, 1).first, 100 + 7 + t.first_miss);
        let mut early = Dram::new(t);
        assert_eq!(early.read(99, 0, 1).first, 99 + t.first_miss);
    }

    #[test]
    fn the_address_pipe_holds_three_requests() {
        let mut dram = Dram::new(quiet());
        let oldest = dram.read(0, 0, 1);
        dram.read(0, 8, 1);
        dram.read(0, 16, 1);
        assert_eq!(dram.accepts_at(), oldest.last);
    }
}
