//! A board alone, for tests of programs.

use crate::board::{GpBoard, GpEvent, GpOutput};
use pxpl5_sim::{Phase, TestBench, Time};
use pxpl5_wire::Message;

/// A board on a bench of its own, as [`TestBench`] is for any device: whoever holds it says what other boards would have said.
#[derive(Debug)]
pub struct BoardBench {
    /// The board with its programs.
    pub board: GpBoard,
    bench: TestBench<GpEvent, GpOutput>,
    accepted: usize,
}

impl BoardBench {
    /// The board is switched on at time zero.
    #[must_use]
    pub fn new(board: GpBoard) -> Self {
        let mut bench = TestBench::new();
        bench.feed(Time::ZERO, Phase::Work, GpEvent::Poll);
        Self { board, bench, accepted: 0 }
    }

    /// Something arrives at the board at an instant.
    pub fn feed(&mut self, at: Time, event: GpEvent) {
        self.bench.feed(at, Phase::Arrive, event);
    }

    /// Receivers accept, at an instant, all messages that the board has sent and of which they had not said so.
    pub fn accept_all(&mut self, at: Time) {
        while let Some((_, GpOutput::Send { ticket, .. })) = self.bench.outputs.get(self.accepted) {
            let accepted = GpEvent::Accepted(*ticket);
            self.bench.feed(at, Phase::Arrive, accepted);
            self.accepted += 1;
        }
    }

    /// Goes on up to and including an instant.
    pub fn run_until(&mut self, until: Time) {
        self.bench.run_until(until, |event, context| self.board.handle(event, context));
    }

    /// What it has sent and when, in order.
    pub fn sent(&self) -> impl Iterator<Item = (Time, &Message)> {
        self.bench.outputs.iter().map(|(time, GpOutput::Send { message, .. })| (*time, message))
    }
}
