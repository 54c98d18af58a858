//! Snapshots of a graphics processor board (copies of its state), for display in user interfaces.

use crate::cpu::Priority;
use crate::firmware::Shared;
use crate::memory::Account;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{NodeId, PeriodNumber};

/// A snapshot of a graphics processor board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GpSnapshot {
    /// Snapshots of the programs, the interrupt program first.
    pub programs: Vec<ProgramSnapshot>,
    /// Messages that no program has received yet, in order of arrival.
    pub inbox: Vec<WaitingMessageInfo>,
    /// Receivers of those messages of the current chain that were not accepted yet, in the order of the chain. The DMA
    /// sends the messages of a chain together.
    pub unaccepted: Vec<NodeId>,
    /// Number of messages in each chain that waits for the DMA, in the order of sending.
    pub chains: Vec<usize>,
    /// Bytes of memory in use for each purpose.
    pub memory: Vec<(Account, u64)>,
    /// CPU time of the board from the start of the simulation to the last event.
    pub busy: Span,
    /// Number of the current period of the first display (a field on an NTSC display).
    pub period: PeriodNumber,
}

/// A snapshot of one program of a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProgramSnapshot {
    pub priority: Priority,
    /// Name of the condition for which the program waits. Empty before the program runs for the first time.
    pub waits_for: &'static str,
    /// Remaining CPU time of the program's work. It stays constant in the foreground program while the interrupt
    /// program works.
    pub work_left: Option<Span>,
}

/// A message that waits in the inbox of a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WaitingMessageInfo {
    /// Arrival time of the last word of the message.
    pub arrived: Time,
    pub source: NodeId,
}

impl GpSnapshot {
    pub(crate) fn of(shared: &Shared, programs: impl Iterator<Item = Priority>, now: Time) -> Self {
        let program = |priority| ProgramSnapshot {
            priority,
            waits_for: shared.waits[priority as usize].what,
            work_left: shared.cpu.left(priority, now).filter(|left| *left > Span::ZERO),
        };
        // Receivers accept messages in any order, so sort the messages in the order of the chain.
        let mut unaccepted = shared.in_flight.clone();
        unaccepted.sort_unstable_by_key(|flight| flight.0);
        Self {
            programs: programs.map(program).collect(),
            inbox: shared
                .inbox
                .iter()
                .map(|mail| WaitingMessageInfo { arrived: mail.arrived, source: mail.source })
                .collect(),
            unaccepted: unaccepted.into_iter().map(|flight| flight.1).collect(),
            chains: shared.batches.iter().map(|batch| batch.links.len()).collect(),
            memory: Account::ALL.map(|account| (account, shared.memory.used_by(account))).into(),
            busy: shared.cpu.busy(),
            period: shared.field,
        }
    }
}
