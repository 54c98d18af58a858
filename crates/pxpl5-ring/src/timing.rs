//! All timing parameters of the ring.

use pxpl5_sim::Span;
use pxpl5_wire::NodeId;

pxpl5_sim::parameters::parameter_table! {
    /// Times, sizes and channel counts of the ring.
    pub struct RingTiming {
        /// Time in which a channel moves one word.
        word_ns: 50, "ns", Published, 50..=50 in 1..=1_000_000, "TR94, F89: 20 Mwords/s per channel";
        /// Overhead of each message, as a number of word times.
        overhead_words: 16, "words", Derived, 16..=16 in 0..=1_000_000, "(780 us a region of TR94 - 15,360 words x 50 ns) / 15 messages = 0.8 us";
        /// Latency from one board to the next board on the ring.
        hop_ns: 50, "ns", Assumed, 0..=200 in 0..=1_000_000, "one word time: every board latches a word once";
        /// Time from an event inside a board to its signal at the ring port, for graphics processors, renderers and the
        /// host.
        signal_ns: 25, "ns", Derived, 25..=25 in 1..=1_000_000, "one clock of the boards' 40 MHz (F89)";
        /// Number of channels of the ring. Each channel carries one message at a time.
        channels: 8, "channels", Published, 8..=8 in 1..=64, "TR94";
        /// Greatest number of channels on which one board can send at the same time, to different receivers.
        source_channels: 2, "channels", Assumed, 1..=2 in 1..=64, "no source gives the value. At most 2, because the memory bus of a GP moves 64 bits every second clock of 40 MHz. These 160 MB/s are two channels of 80 MB/s. At least 1, because the processor also needs the bus. Other boards send at most a copy and its acknowledgement at the same time";
        /// Greatest number of channels that all messages to receivers with a FIFO can use together. The other channels
        /// are left to receivers that never stall.
        fifo_channels: 6, "channels", Assumed, 5..=7 in 1..=64, "the machine ran with 20 renderers. If full FIFOs could block all 8 channels, the pixels of the renderers would wait forever. 6 leaves one channel for each of two frame buffers";
    }
}

impl RingTiming {
    /// Returns the time from an event inside a board to its signal at the ring port.
    pub const fn signal(&self) -> Span {
        Span::from_ns(self.signal_ns)
    }

    /// Returns the time in which a channel moves one word.
    pub const fn word(&self) -> Span {
        Span::from_ns(self.word_ns)
    }

    /// Returns the time for which a message of `words` words occupies its channel and ports, without stalls.
    pub const fn occupancy(&self, words: u32) -> Span {
        Span::from_ns((self.overhead_words + words as u64) * self.word_ns)
    }

    /// Returns the latency from one port to another on a ring of `n_nodes` ports. A message from a port to itself
    /// travels once around the ring.
    pub fn latency(&self, source: NodeId, destination: NodeId, n_nodes: u16) -> Span {
        let from = u64::from(source.0);
        let to = u64::from(destination.0);
        let hops = if to > from { to - from } else { to + u64::from(n_nodes) - from };
        Span::from_ns(hops * self.hop_ns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_sim::parameters::{ParameterTable, Value};

    #[test]
    fn fifteen_messages_of_maximum_size_occupy_the_published_780_us() {
        let message = RingTiming::PAPERS.occupancy(pxpl5_wire::MAX_MESSAGE_WORDS);
        assert_eq!(message * 15, Span::from_us(780));
    }

    fn latency_in_a_ring_of_ten(source: u16, destination: u16) -> Span {
        RingTiming::PAPERS.latency(NodeId(source), NodeId(destination), 10)
    }

    #[test]
    fn latency_counts_hops_in_the_direction_of_travel() {
        assert_eq!(latency_in_a_ring_of_ten(2, 5), Span::from_ns(150));
        assert_eq!(latency_in_a_ring_of_ten(5, 2), Span::from_ns(350));
        assert_eq!(latency_in_a_ring_of_ten(3, 3), Span::from_ns(500));
    }

    #[test]
    fn a_ring_without_channels_or_with_words_of_zero_time_is_refused() {
        for (name, value) in
            [("channels", 0), ("channels", 65), ("word_ns", 0), ("hop_ns", u64::MAX), ("overhead_words", u64::MAX)]
        {
            let mut timing = RingTiming::PAPERS;
            timing.set(name, Value::Whole(value)).expect("known");
            let error = timing.check().expect_err(name);
            assert!(error.to_string().contains(name), "{error}");
        }
    }
}
