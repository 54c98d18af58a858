//! Parallel execution of independent runs on all threads of this computer. Results have the order of the inputs. A run
//! may start further parallel runs.

use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};

/// Applies `run` to every item on all cores of this computer, and returns the results in the order of the items. `run`
/// may itself start parallel work.
///
/// ```
/// assert_eq!(pxpl5_lab::in_parallel(&[1, 2, 3], |n| n * n), [1, 4, 9]);
/// ```
///
/// # Panics
///
/// Panics when `run` panics.
pub fn map<I: Sync, O: Send>(items: &[I], run: impl Fn(&I) -> O + Sync) -> Vec<O> {
    items.par_iter().with_max_len(1).map(&run).collect()
}

/// Applies `run` to every item on all cores like [`map`], and starts the items in their order. Calls `finished` for each
/// item, in the order of the items, as soon as the item and all earlier items have a result.
pub(crate) fn map_in_order<I: Sync, O: Send>(
    items: &[I],
    run: impl Fn(&I) -> O + Sync,
    finished: impl FnMut(&I, &O) + Send,
) -> Vec<O> {
    let results: Vec<Option<O>> = items.iter().map(|_| None).collect();
    let state = Mutex::new((results, 0, finished));
    items.iter().enumerate().par_bridge().for_each(|(place, item)| {
        let result = run(item);
        let (results, n_reported, finished) = &mut *state.lock().unwrap_or_else(PoisonError::into_inner);
        results[place] = Some(result);
        while let Some(Some(result)) = results.get(*n_reported) {
            finished(&items[*n_reported], result);
            *n_reported += 1;
        }
    });
    let (results, ..) = state.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.into_iter().flatten().collect()
}

/// Executes two closures, in parallel if a thread is free, and returns both results.
pub(crate) fn both<A: Send, B: Send>(one: impl FnOnce() -> A + Send, other: impl FnOnce() -> B + Send) -> (A, B) {
    rayon::join(one, other)
}

#[cfg(test)]
mod tests {
    use super::{both, map, map_in_order};

    #[test]
    fn results_keep_the_order_of_their_inputs() {
        let inputs: Vec<u64> = (0..1_000).collect();
        assert_eq!(map(&inputs, |n| n * n), inputs.iter().map(|n| n * n).collect::<Vec<_>>());
        assert!(map(&[0u8; 0], |n| *n).is_empty());
    }

    #[test]
    fn results_are_reported_in_the_order_of_their_inputs() {
        let inputs: Vec<u64> = (0..100).collect();
        let mut reported = Vec::new();
        // The first items take longest, so that most items finish before an earlier item.
        let run = |n: &u64| {
            std::thread::sleep(std::time::Duration::from_micros(1_000 - 10 * n));
            n * n
        };
        let results = map_in_order(&inputs, run, |n, square| reported.push((*n, *square)));
        assert_eq!(results, inputs.iter().map(|n| n * n).collect::<Vec<_>>());
        assert_eq!(reported, inputs.iter().map(|n| (*n, n * n)).collect::<Vec<_>>());
    }

    #[test]
    fn nested_parallel_runs_finish_and_keep_their_order() {
        let tens: Vec<u64> = (0..40).collect();
        let of_tens = |ten: &u64| map(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 9], |one| 10 * ten + one);
        let (all, last) = both(|| map(&tens, of_tens), || of_tens(&40));
        assert_eq!(all.concat().into_iter().chain(last).collect::<Vec<_>>(), (0..410).collect::<Vec<_>>());
    }
}
