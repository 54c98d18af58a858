//! Measures several workloads in turns.

use cpu_time::ProcessTime;
use std::error::Error;

pub(crate) type Fallible<T> = Result<T, Box<dyn Error>>;

/// A workload with a name. Its function performs the work once and returns the number of processed elements. For work
/// in another process, the function returns the CPU time of an element in seconds instead.
pub(crate) struct Way<'a> {
    pub(crate) name: String,
    pub(crate) run: Box<dyn FnMut() -> Fallible<f64> + 'a>,
    is_elsewhere: bool,
}

impl<'a> Way<'a> {
    pub(crate) fn new(name: impl Into<String>, run: impl FnMut() -> Fallible<f64> + 'a) -> Self {
        Self { name: name.into(), run: Box::new(run), is_elsewhere: false }
    }

    pub(crate) fn elsewhere(name: impl Into<String>, run: impl FnMut() -> Fallible<f64> + 'a) -> Self {
        Self { is_elsewhere: true, ..Self::new(name, run) }
    }
}

/// CPU times of an element in seconds, in rising order.
#[derive(Clone, Debug)]
pub(crate) struct Measured {
    pub(crate) seconds: Vec<f64>,
}

impl Measured {
    pub(crate) fn best(&self) -> f64 {
        self.seconds.first().copied().unwrap_or(f64::NAN)
    }

    /// Returns the relative difference between the median and the best time.
    pub(crate) fn spread(&self) -> f64 {
        self.seconds.get(self.seconds.len() / 2).map_or(f64::NAN, |median| median / self.best() - 1.0)
    }
}

/// Runs all workloads in turns for `rounds` rounds, after a first round that does not count.
pub(crate) fn in_turns(rounds: usize, mut ways: Vec<Way<'_>>) -> Fallible<Vec<Measured>> {
    let mut all = vec![Measured { seconds: Vec::new() }; ways.len()];
    for round in 0..=rounds {
        for (way, measured) in ways.iter_mut().zip(&mut all) {
            let begin = ProcessTime::try_now()?;
            let done = (way.run)().map_err(|error| format!("{}: {error}", way.name))?;
            let seconds = if way.is_elsewhere { done } else { begin.try_elapsed()?.as_secs_f64() / done };
            if round > 0 {
                measured.seconds.push(seconds);
            }
        }
    }
    all.iter_mut().for_each(|measured| measured.seconds.sort_by(f64::total_cmp));
    Ok(all)
}
