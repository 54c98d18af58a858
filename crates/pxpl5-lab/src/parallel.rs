//! Independent runs on all of the host's threads, with results in the order of the inputs.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Applies `run` to every item.
///
/// # Panics
///
/// When `run` does.
pub(crate) fn map<I: Sync, O: Send>(items: &[I], run: impl Fn(&I) -> O + Sync) -> Vec<O> {
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(items.len().max(1));
    let mut all: Vec<(usize, O)> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(|| work(&next, items, &run))).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("a run panicked")).collect()
    });
    all.sort_by_key(|(index, _)| *index);
    all.into_iter().map(|(_, output)| output).collect()
}

/// What one thread does: it takes items until there are no more.
fn work<I, O>(next: &AtomicUsize, items: &[I], run: impl Fn(&I) -> O) -> Vec<(usize, O)> {
    let mut done = Vec::new();
    while let Some((index, item)) = take(next, items) {
        done.push((index, run(item)));
    }
    done
}

fn take<'a, I>(next: &AtomicUsize, items: &'a [I]) -> Option<(usize, &'a I)> {
    let index = next.fetch_add(1, Ordering::Relaxed);
    items.get(index).map(|item| (index, item))
}

#[cfg(test)]
mod tests {
    #[test]
    fn results_keep_the_order_of_their_inputs() {
        let inputs: Vec<u64> = (0..1_000).collect();
        assert_eq!(super::map(&inputs, |n| n * n), inputs.iter().map(|n| n * n).collect::<Vec<_>>());
        assert!(super::map(&[0u8; 0], |n| *n).is_empty());
    }
}
