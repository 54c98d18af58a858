//! A test bench that runs the programs of a single board.

use crate::board::{GpBoard, GpEvent, GpOutput};
use pxpl5_sim::{Phase, TestBench, Time};
use pxpl5_wire::Message;

/// A board together with its event queue ([`TestBench`]). The test supplies the messages and acceptances that other
/// boards would send.
#[derive(Debug)]
pub struct BoardBench {
    pub board: GpBoard,
    bench: TestBench<GpEvent, GpOutput>,
    accepted: usize,
}

impl BoardBench {
    /// Makes a test bench, in which the programs of `board` start at time zero.
    pub fn new(board: GpBoard) -> Self {
        let mut bench = TestBench::new();
        bench.feed(Time::ZERO, Phase::Work, GpEvent::Poll);
        Self { board, bench, accepted: 0 }
    }

    /// Schedules an event for the board at time `at`. The board handles the event before its programs continue.
    pub fn feed(&mut self, at: Time, event: GpEvent) {
        self.bench.feed(at, Phase::Arrive, event);
    }

    /// Schedules, at time `at`, the acceptance of all messages of the board that were not accepted before.
    pub fn accept_all(&mut self, at: Time) {
        while let Some((_, GpOutput::Send { ticket, .. })) = self.bench.outputs.get(self.accepted) {
            let accepted = GpEvent::Accepted(*ticket);
            self.bench.feed(at, Phase::Arrive, accepted);
            self.accepted += 1;
        }
    }

    /// Handles all events up to and including time `until`.
    pub fn run_until(&mut self, until: Time) {
        self.bench.run_until(until, |event, context| self.board.handle(event, context));
    }

    /// Iterates over the messages of the board and the times at which they left the board, in the order of sending.
    pub fn sent(&self) -> impl Iterator<Item = (Time, &Message)> {
        self.bench.outputs.iter().map(|(time, GpOutput::Send { message, .. })| (*time, message))
    }
}
