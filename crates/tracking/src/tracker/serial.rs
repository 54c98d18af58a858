use serde::{Deserialize, Serialize};

use crate::config::{self as table, Tables};
use crate::time::PS_PER_S;

/// The serial cable from tracker to host, which carries one record at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SerialLine {
    /// Length of one receiver's record, 1 to 1000 bytes.
    pub record_bytes: u32,
    /// Rate of the cable, 300 to 1,000,000 bits per second.
    pub baud: u32,
    /// Bits on the cable for each byte, including start and stop bits, 1 to 100.
    #[serde(default = "default_byte_bits")]
    pub byte_bits: u32,
}

fn default_byte_bits() -> u32 {
    table::HostPort::PAPERS.byte_bits as u32
}

impl SerialLine {
    /// Returns the serial cable of the Fastrak. A record of 47 bytes at 115,200 baud takes 4.08 ms.
    pub fn fastrak() -> Self {
        Self::fastrak_by(&Tables::PAPERS)
    }

    /// Returns the serial cable of the Fastrak with the numbers of `tables`.
    pub fn fastrak_by(tables: &Tables) -> Self {
        Self {
            record_bytes: tables.fastrak.record as u32,
            baud: tables.fastrak.baud as u32,
            byte_bits: tables.host.byte_bits as u32,
        }
    }

    /// Returns the time that `records` records take on the cable, ps: bytes x bits per byte / baud.
    pub fn transfer_ps(&self, records: u32) -> u64 {
        let bits = u128::from(self.record_bytes) * u128::from(self.byte_bits) * u128::from(records);
        let ps = bits.saturating_mul(u128::from(PS_PER_S)) / u128::from(self.baud.max(1));
        u64::try_from(ps).unwrap_or(u64::MAX)
    }
}

/// The method by which the host's Unix kernel reads the serial port.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum SerialRead {
    /// The unpatched Unix kernel polls the port periodically, and the seed determines the phase. A record waits for at
    /// most one period. All waiting times are equally probable over all seeds.
    Polled {
        /// Time between two polls, ps, above 0.
        period_ps: u64,
    },
    /// The patched Unix kernel handles an interrupt for each character. A record arrives without waiting.
    InterruptPerCharacter,
}

impl SerialRead {
    /// Returns the method of the unpatched Unix kernel, which polls the serial port every 30 ms (TR94).
    pub fn unix() -> Self {
        Self::unix_by(&Tables::PAPERS)
    }

    /// Returns the method of the unpatched Unix kernel, with the polling interval `host.poll` of `tables`.
    pub fn unix_by(tables: &Tables) -> Self {
        Self::Polled { period_ps: table::ms_to_ps(tables.host.poll) }
    }

    /// Returns the instant (ps) at which the Unix kernel reads a record whose last character arrives at `t_ps`.
    /// `phase_ps` is the instant of the first poll.
    pub fn seen_ps(&self, t_ps: u64, phase_ps: u64) -> u64 {
        match *self {
            Self::InterruptPerCharacter => t_ps,
            Self::Polled { .. } if t_ps <= phase_ps => phase_ps,
            Self::Polled { period_ps } => {
                let period_ps = period_ps.max(1);
                phase_ps.saturating_add((t_ps - phase_ps).div_ceil(period_ps).saturating_mul(period_ps))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::PS_PER_MS;

    #[test]
    fn a_fastrak_record_takes_4_ms_at_115200_and_49_ms_at_9600_baud() {
        let fast = SerialLine::fastrak();
        assert_eq!((fast.transfer_ps(1) + PS_PER_MS / 2) / PS_PER_MS, 4);
        let slow = SerialLine { baud: 9600, ..fast };
        assert_eq!((slow.transfer_ps(1) + PS_PER_MS / 2) / PS_PER_MS, 49);
    }

    #[test]
    fn a_record_complete_at_a_poll_is_read_at_this_poll_and_a_later_record_waits_for_the_next_poll() {
        let line = SerialRead::unix();
        let poll_ps = 5 + 30 * PS_PER_MS;
        assert_eq!(line.seen_ps(poll_ps, 5), poll_ps);
        assert_eq!(line.seen_ps(poll_ps + 1, 5), poll_ps + 30 * PS_PER_MS);
        assert_eq!(line.seen_ps(0, 5), 5);
    }

    #[test]
    fn serial_lines_with_extreme_settings_cause_no_panic() {
        assert!(SerialLine { record_bytes: u32::MAX, baud: 0, byte_bits: u32::MAX }.transfer_ps(u32::MAX) > 0);
        assert_eq!(SerialRead::Polled { period_ps: 0 }.seen_ps(9, 5), 9);
        assert_eq!(SerialRead::Polled { period_ps: u64::MAX }.seen_ps(9, 5), u64::MAX);
    }

    #[test]
    fn a_patched_kernel_adds_no_delay_to_a_received_character() {
        assert_eq!(SerialRead::InterruptPerCharacter.seen_ps(123, 5), 123);
    }
}
