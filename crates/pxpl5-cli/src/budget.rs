//! Limits on the memory and time of a command. A run is refused before it starts if its estimate exceeds a limit. A run
//! is stopped early if its first fields show that the whole run would exceed a limit.

use crate::error::CliError;
use crate::numbers::{count_of, whole};
use clap::Args;
use pxpl5::Study;
use pxpl5::lab::estimate::{Estimate, RunWork};
use std::cell::OnceCell;
use std::time::Instant;

/// Limits on the memory and time of a command.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct BudgetArgs {
    /// Refuse a command that would take more memory than this, in MB of 10^6 bytes.
    #[arg(long, value_name = "MB", default_value_t = MAX_MEGABYTES, value_parser = whole::<u64>(1, 1_000_000_000))]
    max_memory: u64,
    /// Refuse a command that would take longer than this, in seconds.
    #[arg(long, value_name = "S", default_value_t = MAX_SECONDS, value_parser = whole::<u64>(1, 1_000_000_000))]
    max_seconds: u64,
}

/// The limits of commands without options for memory and time.
impl Default for BudgetArgs {
    fn default() -> Self {
        Self { max_memory: MAX_MEGABYTES, max_seconds: MAX_SECONDS }
    }
}

/// Limit in MB. Assumed: the memory of a workstation.
const MAX_MEGABYTES: u64 = 16_000;
/// Limit in seconds. Assumed: one day.
const MAX_SECONDS: u64 = 86_400;

/// Numbers of simulated fields after which the cost of a run is compared with the limits. After 32 fields, each report
/// of progress compares the cost.
pub(crate) const EARLY_CHECK_FIELDS: [u64; 6] = [1, 2, 4, 8, 16, 32];

/// Seconds that a run must have taken before its total time is extrapolated. The first seconds are not typical, because
/// pipelines fill and caches are cold.
const MIN_EXTRAPOLATED_SECONDS: f64 = 0.5;

const MIN_EXTRAPOLATED_BYTES: f64 = 50e6;

#[derive(Clone, Debug)]
pub(crate) struct CostMonitor {
    budget: BudgetArgs,
    fields: u64,
    begun: Instant,
    bytes_before: Option<f64>,
    /// Number of simulated fields at the first check, and the time and memory until then. Later checks subtract these
    /// values and extrapolate only the rest. Before the first field, the time can include a dry run or the tuning of a
    /// predictor, which happen only once.
    first: OnceCell<(u64, Taken)>,
}

impl BudgetArgs {
    /// Returns a budget with a limit on the memory in MB and on the time in seconds. `None` means no limit.
    pub(crate) fn of(max_memory: Option<u64>, max_seconds: Option<u64>) -> Self {
        Self { max_memory: max_memory.unwrap_or(u64::MAX), max_seconds: max_seconds.unwrap_or(u64::MAX) }
    }

    /// Returns an error if the estimated memory or time of a run exceeds the budget. The error contains the estimate
    /// and advice to reduce the work.
    pub(crate) fn admit(&self, work: &RunWork) -> Result<(), CliError> {
        self.admit_estimate(work.estimate(), "simulate fewer fields")
    }

    /// Returns an error if a study would exceed the budget. `advice` is a text about ways to reduce the work.
    pub(crate) fn admit_study(&self, study: &impl Study, advice: &str) -> Result<(), CliError> {
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        self.admit_estimate(study.estimate(threads), advice)
    }

    pub(crate) fn admit_estimate(&self, estimate: Estimate, advice: &str) -> Result<(), CliError> {
        let Estimate { bytes, seconds } = estimate;
        match self.excess(bytes / 1e6, seconds, advice) {
            Some(reason) => Err(CliError::failure(format!(
                "{reason}; this is an estimate before the start, and nothing was written"
            ))),
            None => Ok(()),
        }
    }

    pub(crate) fn monitor(self, fields: u64) -> CostMonitor {
        CostMonitor {
            budget: self,
            fields,
            begun: Instant::now(),
            bytes_before: resident_bytes(),
            first: OnceCell::new(),
        }
    }
}

impl CostMonitor {
    /// Returns an error if the whole run would exceed the budget. The cost of the run is extrapolated from the first
    /// `done` fields. `planned` is the memory in bytes that the output will take after the run, for these fields.
    pub(crate) fn check(&self, done: u64, planned: f64) -> Result<(), String> {
        // The cost until the first check is a constant; the cost since then is extrapolated over the rest of the
        // fields.
        let taken = self.taken(planned);
        let (first, before) = *self.first.get_or_init(|| (done, taken));
        let part = (done.min(self.fields) - first.min(done)) as f64 / self.fields as f64;
        match self.budget.refusal(before, taken.since(before), part) {
            Some(reason) => {
                Err(format!("after {done} of {} {reason}; nothing was written", count_of(self.fields, "field")))
            }
            None => Ok(()),
        }
    }

    fn taken(&self, planned: f64) -> Taken {
        let bytes = resident_bytes().zip(self.bytes_before).map_or(0.0, |(now, before)| (now - before).max(0.0));
        Taken { seconds: self.begun.elapsed().as_secs_f64(), bytes: bytes + planned }
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Taken {
    seconds: f64,
    bytes: f64,
}

impl Taken {
    fn since(self, before: Self) -> Self {
        Self { seconds: self.seconds - before.seconds, bytes: (self.bytes - before.bytes).max(0.0) }
    }
}

impl BudgetArgs {
    /// Returns the reason to stop a run, if any. `before` is the cost up to the first check of the budget. This cost is
    /// not extrapolated. `taken` is the cost since this check. In this time, the fraction `part` (0 to 1) of all fields
    /// was simulated.
    fn refusal(&self, before: Taken, taken: Taken, part: f64) -> Option<String> {
        // The costs of short and small runs are too inaccurate to extrapolate.
        let megabytes = if taken.bytes > MIN_EXTRAPOLATED_BYTES { taken.bytes / part / 1e6 } else { 0.0 };
        let seconds = if taken.seconds > MIN_EXTRAPOLATED_SECONDS { taken.seconds / part } else { 0.0 };
        self.excess(before.bytes / 1e6 + megabytes, before.seconds + seconds, "simulate fewer fields")
    }

    fn excess(&self, megabytes: f64, seconds: f64, advice: &str) -> Option<String> {
        let most = self.max_memory;
        if megabytes > most as f64 {
            return Some(format!(
                "the run is expected to take {megabytes:.0} MB, more than {most}: {advice}, or allow it with --max-memory"
            ));
        }
        let most = self.max_seconds;
        (seconds > most as f64).then(|| {
            format!(
                "the run is expected to take {seconds:.0} s, more than {most}: {advice}, or allow it with --max-seconds"
            )
        })
    }
}

/// Returns the resident memory of this process in bytes, or `None` if the operating system does not report it.
fn resident_bytes() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kilobytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const BUDGET: BudgetArgs = BudgetArgs { max_memory: 1_000, max_seconds: 100 };

    #[test]
    fn a_run_that_would_take_too_long_is_refused_with_its_estimate() {
        let refusal = |seconds: f64, bytes: f64| BUDGET.refusal(Taken::default(), Taken { seconds, bytes }, 0.1);
        assert_eq!((refusal(10.0, 100e6), refusal(0.4, 49e6)), (None, None));
        assert!(refusal(10.1, 0.0).is_some_and(|reason| reason.contains("take 101 s, more than 100")));
        assert!(refusal(0.0, 101e6).is_some_and(|reason| reason.contains("take 1010 MB, more than 1000")));
    }

    #[test]
    fn a_run_is_not_refused_because_of_a_measurement_that_is_too_short() {
        let refusal = |seconds: f64, bytes: f64| BUDGET.refusal(Taken::default(), Taken { seconds, bytes }, 1e-6);
        assert_eq!(refusal(0.4, 49e6), None);
        assert!(refusal(0.6, 0.0).is_some());
    }

    #[test]
    fn the_time_before_a_run_counts_once_and_not_for_each_field() {
        let refusal = |before: f64, seconds: f64| {
            BUDGET.refusal(Taken { seconds: before, bytes: 0.0 }, Taken { seconds, bytes: 0.0 }, 0.1)
        };
        assert_eq!(refusal(90.0, 1.0), None, "100 s in all");
        assert!(refusal(91.0, 1.0).is_some_and(|reason| reason.contains("take 101 s, more than 100")));
        assert!(refusal(101.0, 0.0).is_some(), "too much already");
        let monitor = BUDGET.monitor(1_000_000);
        std::thread::sleep(std::time::Duration::from_secs_f64(1.5 * MIN_EXTRAPOLATED_SECONDS));
        assert_eq!(monitor.check(1, 0.0), Ok(()), "what the first field needed took no 750,000 s");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_memory_of_this_process_can_be_measured() {
        let before = resident_bytes().expect("Linux tells");
        // `black_box` keeps the optimizer from removing the allocation, which no code reads.
        let held = std::hint::black_box(vec![1u8; 64 << 20]);
        let after = resident_bytes().expect("Linux tells");
        assert!(after - before > 32e6, "{before} to {after}, {}", held.len());
    }
}
