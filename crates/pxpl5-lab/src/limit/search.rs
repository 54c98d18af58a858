//! Search for the smallest number of triangles that misses a goal, by simulating scenes of several sizes.

use serde::Serialize;
use std::collections::BTreeMap;

/// Result of a search for the largest number of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Limit {
    /// Largest number of triangles below the first miss. All smaller tried sizes reached the goal. 0 if one triangle
    /// already misses the goal.
    pub triangles: u32,
    /// Smallest tried number of triangles that missed the goal. `None` if all tried sizes reached the goal.
    pub first_miss: Option<u32>,
    /// Largest tried number of triangles above the first miss that nevertheless reached the goal, if any.
    pub island: Option<u32>,
    /// Smallest number of triangles from which on all sizes up to `triangles` were tried. Only some smaller sizes were
    /// tried.
    pub unbroken_from: u32,
    /// Number of simulated scene sizes.
    pub tried: usize,
}

impl Limit {
    /// Returns true if a number of triangles missed the goal. Also returns true if the search ended below
    /// [`CEILING`](super::CEILING) at the last triangle of a model. Otherwise the pipeline has no limit.
    pub const fn has_limit(&self) -> bool {
        self.first_miss.is_some() || self.triangles < super::CEILING
    }
}

/// Hints about the limit, which reduce the number of simulations but do not change their results.
#[derive(Clone, Debug, Default)]
pub struct Hints {
    /// Number of triangles near the limit. Without this hint, the search starts with one triangle.
    pub near: Option<u32>,
    /// Numbers of triangles that may miss the goal although larger numbers of triangles reach the goal. The search
    /// therefore tries these numbers.
    pub doubtful: Vec<u32>,
}

/// Maximum number of consecutive sizes that are tried below the result: 60 sizes, or two clumps of 30 triangles. About
/// as many sizes are tried above the result, because some may reach the goal.
const LOOK: u32 = 60;

/// Maximum sum of the triangles of all consecutive scenes below the result. The simulation time grows with the size of
/// the scene. The limit therefore allows fewer scenes if the scenes are large.
const TRIANGLES_IN_A_ROW: u32 = 60_000;

/// Minimum number of consecutive scene sizes below the result.
const MIN_IN_A_ROW: u32 = 4;

/// The tried scene sizes. The boolean is true if the size reached the goal.
struct Tried<F> {
    answers: BTreeMap<u32, bool>,
    reached: F,
}

impl<F> Tried<F> {
    fn ask<E>(&mut self, size: u32) -> Result<bool, E>
    where
        F: FnMut(u32) -> Result<bool, E>,
    {
        if let Some(known) = self.answers.get(&size) {
            return Ok(*known);
        }
        let answer = (self.reached)(size)?;
        self.answers.insert(size, answer);
        Ok(answer)
    }

    fn first_miss(&self) -> Option<u32> {
        self.answers.iter().find(|(_, reached)| !**reached).map(|(size, _)| *size)
    }

    /// Returns the largest tried number of triangles below `size`, or 0 if there is none.
    fn before(&self, size: u32) -> u32 {
        self.answers.range(..size).next_back().map_or(0, |(size, _)| *size)
    }

    /// Tries numbers of triangles around `near` in steps that double, until one number has reached the goal and another
    /// number has missed.
    fn bracket<E>(&mut self, near: u32, ceiling: u32) -> Result<(), E>
    where
        F: FnMut(u32) -> Result<bool, E>,
    {
        let mut size = near.clamp(1, ceiling);
        // The first step is proportional to the size.
        let mut step = (size / 64).max(1);
        let up = self.ask(size)?;
        while if up { size < ceiling } else { size > 1 } {
            size = if up { size.saturating_add(step).min(ceiling) } else { size.saturating_sub(step).max(1) };
            step = step.saturating_mul(2);
            if self.ask(size)? != up {
                return Ok(());
            }
        }
        Ok(())
    }

    /// Bisects the gap below the first miss, until the number directly before the first miss was tried.
    fn bisect<E>(&mut self) -> Result<(), E>
    where
        F: FnMut(u32) -> Result<bool, E>,
    {
        while let Some(miss) = self.first_miss() {
            let low = self.before(miss);
            if miss - low <= 1 {
                return Ok(());
            }
            self.ask(low + (miss - low) / 2)?;
        }
        Ok(())
    }

    /// Tries the numbers of triangles in `sizes` until a number misses the goal. Returns true if a number missed.
    fn finds_a_miss<E>(&mut self, sizes: impl IntoIterator<Item = u32>) -> Result<bool, E>
    where
        F: FnMut(u32) -> Result<bool, E>,
    {
        for size in sizes {
            if !self.ask(size)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Finds a number of triangles that misses the goal, then bisects again as long as a smaller number misses.
    fn find_limit<E>(&mut self, ceiling: u32, hints: &Hints) -> Result<(), E>
    where
        F: FnMut(u32) -> Result<bool, E>,
    {
        if ceiling == 0 {
            return Ok(());
        }
        self.bracket(hints.near.unwrap_or(1), ceiling)?;
        loop {
            self.bisect()?;
            let limit = self.limit(ceiling).triangles;
            if !self.finds_a_miss(below(limit, &hints.doubtful))? {
                return Ok(());
            }
        }
    }

    fn limit(&self, ceiling: u32) -> Limit {
        let first_miss = self.first_miss();
        let triangles = first_miss.map_or(ceiling, |miss| miss - 1);
        let island = self.answers.iter().rev().find(|(size, reached)| **reached && **size > triangles);
        // Go to smaller sizes as long as every size was tried.
        let mut unbroken_from = triangles;
        while unbroken_from > 1 && self.answers.contains_key(&(unbroken_from - 1)) {
            unbroken_from -= 1;
        }
        Limit { triangles, first_miss, island: island.map(|(size, _)| *size), unbroken_from, tried: self.answers.len() }
    }
}

/// Searches for the first miss: the smallest number of triangles up to `ceiling` for which `reached` returns false.
///
/// Sizes above the first miss may reach the goal, because a nearly empty clump (group of triangles) costs as many
/// messages as a full clump. The search tries only some sizes, but guarantees three facts:
///
/// - The reported first miss was tried and missed the goal.
/// - All sizes from [`Limit::unbroken_from`] to the size before the first miss were tried and reached the goal.
/// - No smaller size that was tried missed the goal.
///
/// Below [`Limit::unbroken_from`], the search tries the sizes of the hints and five sizes at growing distances. A miss
/// at any size between them is not found.
///
/// Without `looks_above`, no size above the first miss is tried. These sizes never change the limit and are about half of
/// all tried sizes.
///
/// # Errors
///
/// Returns the first error of `reached`.
pub fn most<E>(
    ceiling: u32,
    hints: &Hints,
    looks_above: bool,
    reached: impl FnMut(u32) -> Result<bool, E>,
) -> Result<Limit, E> {
    let mut tried = Tried { answers: BTreeMap::new(), reached };
    tried.find_limit(ceiling, hints)?;
    // Islands (sizes above the first miss that reach the goal) do not change the limit, but the result reports them.
    let limit = tried.limit(ceiling).triangles;
    for size in above(limit, ceiling).filter(|_| looks_above) {
        tried.ask(size)?;
    }
    Ok(tried.limit(ceiling))
}

/// Returns the limit found by bisection alone, as a hint for a search at another level of detail.
pub fn about<E>(ceiling: u32, reached: impl FnMut(u32) -> Result<bool, E>) -> Result<u32, E> {
    let mut tried = Tried { answers: BTreeMap::new(), reached };
    tried.bracket(1, ceiling)?;
    tried.bisect()?;
    Ok(tried.limit(ceiling).triangles)
}

/// Returns the numbers of triangles to try below `limit`. These are consecutive numbers directly below `limit`, the
/// numbers in `doubtful`, which may miss the goal, and five numbers at doubling distances.
fn below(limit: u32, doubtful: &[u32]) -> impl Iterator<Item = u32> {
    let in_a_row = in_a_row(limit);
    // Try all sizes directly below the limit, from the largest to the smallest.
    let near = (limit.saturating_sub(in_a_row)..limit).rev();
    let far = (1..=5).rev().map(move |halvings| limit - (limit >> halvings));
    near.chain(doubtful.iter().copied().filter(move |size| *size < limit)).chain(far).filter(|size| *size > 0)
}

/// Returns the number of consecutive sizes to try below `limit`. About as many sizes are tried above `limit`.
fn in_a_row(limit: u32) -> u32 {
    (TRIANGLES_IN_A_ROW / limit.max(1)).clamp(MIN_IN_A_ROW, LOOK)
}

/// Returns the numbers of triangles to try above the first miss, from the largest down. The numbers are evenly spaced
/// and at most 61 above `limit`. About as many numbers are tried as directly below `limit`.
fn above(limit: u32, ceiling: u32) -> impl Iterator<Item = u32> {
    let farthest = limit.saturating_add(1 + LOOK.min(limit / 2)).min(ceiling);
    let step = (farthest.saturating_sub(limit) / in_a_row(limit)).max(1) as usize;
    (limit + 2..=farthest).rev().step_by(step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::convert::Infallible;

    const CEILING: u32 = 1_000_000;

    fn of(ceiling: u32, reached: impl Fn(u32) -> bool) -> Limit {
        with(ceiling, &Hints::default(), reached)
    }

    fn with(ceiling: u32, hints: &Hints, reached: impl Fn(u32) -> bool) -> Limit {
        most(ceiling, hints, true, |size| Ok::<_, Infallible>(reached(size))).expect("infallible")
    }

    #[test]
    fn the_search_finds_a_limit_without_islands_exactly() {
        for limit in [0, 1, 2, 63, 110, 4_096, 900_000] {
            let found = of(CEILING, |size| size <= limit);
            assert_eq!((found.triangles, found.first_miss, found.island), (limit, Some(limit + 1), None));
        }
    }

    #[test]
    fn a_search_returns_the_largest_size_below_the_misses_and_not_an_island_above() {
        // The sizes 796 to 806 miss the goal because of an almost empty clump. The size 807 reaches the goal.
        for near in [None, Some(700), Some(807), Some(900)] {
            let hints = Hints { near, ..Hints::default() };
            let found = with(CEILING, &hints, |size| size <= 795 || size == 807);
            assert_eq!((found.triangles, found.first_miss, found.island), (795, Some(796), Some(807)), "{near:?}");
            assert_eq!(found.unbroken_from, 795 - LOOK);
        }
        assert_eq!(of(CEILING, |size| size <= 120 || (124..=150).contains(&size)).triangles, 120);
    }

    #[test]
    fn a_single_missed_size_is_found_if_a_hint_names_it_as_doubtful() {
        let reached = |size: u32| size <= 800 && size != 421;
        assert_eq!(of(CEILING, reached).triangles, 800);
        let hints = Hints { near: Some(800), doubtful: vec![421] };
        let found = with(CEILING, &hints, reached);
        assert_eq!((found.triangles, found.island), (420, Some(800)));
    }

    #[test]
    fn a_goal_that_is_always_reached_ends_at_the_ceiling() {
        let found = of(1_000, |_| true);
        assert_eq!((found.triangles, found.first_miss), (1_000, None));
        assert_eq!(of(0, |_| true).triangles, 0);
    }

    proptest! {
        /// Tests that a search with any hints finds the limit, if all sizes up to the limit reach the goal and no
        /// larger size does.
        #[test]
        fn hints_change_only_the_number_of_trials(
            limit in 0u32..5_000,
            near in 1u32..6_000,
            doubtful in proptest::collection::vec(1u32..6_000, 0..5),
        ) {
            let reached = |size: u32| size <= limit;
            let found = with(CEILING, &Hints { near: Some(near), doubtful }, reached);
            prop_assert_eq!((found.triangles, found.first_miss), (limit, Some(limit + 1)));
        }

        /// Tests that the fast search finds the same largest size as the full search, for any hints and any missed
        /// sizes.
        #[test]
        fn islands_and_wrong_hints_do_not_change_the_largest_size(
            misses in proptest::collection::btree_set(1u32..400, 0..20),
            ceiling in 0u32..400,
            near in proptest::option::of(1u32..1_000),
            doubtful in proptest::collection::vec(1u32..600, 0..5),
        ) {
            let hints = Hints { near, doubtful };
            let reached = |size: u32| Ok::<_, Infallible>(!misses.contains(&size));
            let whole = most(ceiling, &hints, true, reached).expect("infallible");
            prop_assert_eq!(most(ceiling, &hints, false, reached).map(|limit| limit.triangles), Ok(whole.triangles));
        }

        #[test]
        fn all_sizes_of_the_unbroken_row_reach_the_goal(misses in proptest::collection::btree_set(1u32..400, 1..20)) {
            let found = of(400, |size| !misses.contains(&size));
            prop_assert!((found.unbroken_from..=found.triangles).all(|size| !misses.contains(&size)));
            match found.first_miss {
                Some(first) => prop_assert!(misses.contains(&first) && first == found.triangles + 1),
                None => prop_assert_eq!(found.triangles, 400),
            }
            let long = found.triangles.min(LOOK);
            prop_assert!(found.triangles - found.unbroken_from + 1 >= long);
        }
    }
}
