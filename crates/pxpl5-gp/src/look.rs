//! What somebody who looks at a graphics processor while it works sees.

use crate::cpu::Priority;
use crate::firmware::Shared;
use crate::memory::Account;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{NodeId, PeriodNumber};

/// What a board does at an instant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GpLook {
    /// Its programs, that of interrupts first.
    pub programs: Vec<ProgramLook>,
    /// Messages that have arrived and that no program has taken, in order.
    pub inbox: Vec<WaitingMail>,
    /// Receivers of the chain that the DMA sends which have not accepted their message, in the order of the chain.
    pub unaccepted: Vec<NodeId>,
    /// Messages of each chain that waits behind it.
    pub chains: Vec<usize>,
    /// Bytes of memory in use by each account.
    pub memory: Vec<(Account, u64)>,
    /// CPU time spent up to the last event of the board.
    pub busy: Span,
    /// The period of the first display that its last retrace began.
    pub period: PeriodNumber,
}

/// What a program does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProgramLook {
    /// Which program.
    pub priority: Priority,
    /// What it waits for, in words; empty before it has run for the first time.
    pub waits_for: &'static str,
    /// How much of its work is left; `None` where it does no work. That of the foreground stands still while that of interrupts goes on.
    pub work_left: Option<Span>,
}

/// A message in the inbox.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WaitingMail {
    /// When its last word had arrived.
    pub arrived: Time,
    /// The port of the sender.
    pub source: NodeId,
}

impl GpLook {
    pub(crate) fn of(shared: &Shared, programs: impl Iterator<Item = Priority>, now: Time) -> Self {
        let program = |priority| ProgramLook {
            priority,
            waits_for: shared.waits[priority as usize].what,
            work_left: shared.cpu.left(priority, now).filter(|left| *left > Span::ZERO),
        };
        let mut unaccepted = shared.in_flight.clone();
        unaccepted.sort_unstable_by_key(|flight| flight.0);
        Self {
            programs: programs.map(program).collect(),
            inbox: shared.inbox.iter().map(|mail| WaitingMail { arrived: mail.arrived, source: mail.source }).collect(),
            unaccepted: unaccepted.into_iter().map(|flight| flight.1).collect(),
            chains: shared.batches.iter().map(|batch| batch.links.len()).collect(),
            memory: Account::ALL.map(|account| (account, shared.memory.used_by(account))).into(),
            busy: shared.cpu.busy(),
            period: shared.field,
        }
    }
}
