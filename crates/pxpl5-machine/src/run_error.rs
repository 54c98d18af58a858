//! Why a machine cannot go on.

use pxpl5_gp::Fault;
use pxpl5_sim::{Blocked, Time};
use thiserror::Error;

/// Why a run ended early.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RunError {
    /// A program stopped: something did not fit, or a message made no sense.
    #[error("{board} stopped at {time}: {fault}")]
    Fault {
        /// The board's name.
        board: String,
        /// When it stopped.
        time: Time,
        /// What it could not do.
        fault: Fault,
    },
    /// Nothing can happen any more but ticks of the displays.
    #[error("nothing can happen any more at {time}:{}", waits(blocked))]
    Deadlock {
        /// When that was noticed.
        time: Time,
        /// Who waits for what.
        blocked: Vec<Blocked>,
    },
    /// The ring could not carry a message.
    #[error("ring, at {time}: {reason}")]
    Ring {
        /// When it was asked to.
        time: Time,
        /// What is wrong with the message.
        reason: String,
    },
}

impl RunError {
    /// When the run ended.
    #[must_use]
    pub const fn time(&self) -> Time {
        match self {
            Self::Fault { time, .. } | Self::Deadlock { time, .. } | Self::Ring { time, .. } => *time,
        }
    }
}

fn waits(blocked: &[Blocked]) -> String {
    blocked.iter().map(|b| format!(" {} waits for {};", b.board, b.waits_for)).collect()
}
