//! The least size that misses a goal, found by trying.

use serde::Serialize;
use std::collections::BTreeMap;

/// The answer of a search, and what is known of the sizes around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Limit {
    /// One less than the first miss: no tried size up to this one missed the goal. 0 if it was missed with one triangle.
    pub triangles: u32,
    /// The least size that was tried and missed the goal; `None` if all that were tried reached it.
    pub first_miss: Option<u32>,
    /// The greatest size above the first miss that was tried and reaches the goal all the same.
    pub island: Option<u32>,
    /// All sizes from here to `triangles` were tried. Below this size only some were.
    pub unbroken_from: u32,
    /// Sizes that were simulated.
    pub tried: usize,
}

/// What another model says of the sizes, which saves trials and changes no answer of a size.
#[derive(Clone, Debug, Default)]
pub struct Hints {
    /// A size that is near the limit; without it the search begins with one triangle.
    pub near: Option<u32>,
    /// Sizes that miss, or nearly so, though greater ones may not: they are tried too.
    pub doubtful: Vec<u32>,
}

/// Sizes below the answer that are all tried, and distance above it up to which islands are looked for: those of two clumps.
const LOOK: u32 = 60;

/// Triangles of all sizes together that are tried in a row on either side of the answer: fewer sizes where each takes longer.
const TRIANGLES_IN_A_ROW: u32 = 60_000;

/// The least number of sizes that are tried in a row.
const LEAST_IN_A_ROW: u32 = 4;

/// Sizes that were asked for, and what came of each.
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

    /// The least size that missed.
    fn first_miss(&self) -> Option<u32> {
        self.answers.iter().find(|(_, reached)| !**reached).map(|(size, _)| *size)
    }

    /// The greatest size below another one that was tried; 0 if there is none.
    fn before(&self, size: u32) -> u32 {
        self.answers.range(..size).next_back().map_or(0, |(size, _)| *size)
    }

    /// Tries sizes around a first one, in steps that double, until one reaches the goal and one misses it.
    fn bracket<E>(&mut self, near: u32, ceiling: u32) -> Result<(), E>
    where
        F: FnMut(u32) -> Result<bool, E>,
    {
        let mut size = near.clamp(1, ceiling);
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

    /// Halves the gap below the first miss until the size before it was tried too.
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

    /// Tries sizes until one misses; returns true if one did.
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

    fn limit(&self, ceiling: u32) -> Limit {
        let first_miss = self.first_miss();
        let triangles = first_miss.map_or(ceiling, |miss| miss - 1);
        let island = self.answers.iter().rev().find(|(size, reached)| **reached && **size > triangles);
        let mut unbroken_from = triangles;
        while unbroken_from > 1 && self.answers.contains_key(&(unbroken_from - 1)) {
            unbroken_from -= 1;
        }
        Limit { triangles, first_miss, island: island.map(|(size, _)| *size), unbroken_from, tried: self.answers.len() }
    }
}

/// The least size that misses, up to `ceiling`, as far as trials can tell.
///
/// A goal need not be missed by all sizes above the first that misses: a clump that is nearly empty costs as many messages as a full one.
/// Guaranteed is that the first miss misses, that the size before it and [`Limit::unbroken_from`] to there reach the goal, and that no
/// tried size below missed it. Below that the sizes of the hints are tried, and five at growing distance; a miss that lies between
/// them is not found.
///
/// # Errors
///
/// The first error of `reached`.
pub fn most<E>(ceiling: u32, hints: &Hints, reached: impl FnMut(u32) -> Result<bool, E>) -> Result<Limit, E> {
    let mut tried = Tried { answers: BTreeMap::new(), reached };
    if ceiling == 0 {
        return Ok(tried.limit(0));
    }
    tried.bracket(hints.near.unwrap_or(1), ceiling)?;
    loop {
        tried.bisect()?;
        let limit = tried.limit(ceiling).triangles;
        if !tried.finds_a_miss(below(limit, &hints.doubtful))? {
            break;
        }
    }
    let limit = tried.limit(ceiling).triangles;
    for size in above(limit, ceiling) {
        tried.ask(size)?;
    }
    Ok(tried.limit(ceiling))
}

/// The answer of another model's search, as a hint: no size besides those of the bisection is tried.
///
/// # Errors
///
/// The first error of `reached`.
pub fn about<E>(ceiling: u32, reached: impl FnMut(u32) -> Result<bool, E>) -> Result<u32, E> {
    let mut tried = Tried { answers: BTreeMap::new(), reached };
    tried.bracket(1, ceiling)?;
    tried.bisect()?;
    Ok(tried.limit(ceiling).triangles)
}

/// Sizes that are tried below an answer: all nearest ones, doubtful ones, and some at distances that double.
fn below(limit: u32, doubtful: &[u32]) -> impl Iterator<Item = u32> {
    let in_a_row = in_a_row(limit);
    let near = (limit.saturating_sub(in_a_row)..limit).rev();
    let far = (1..=5).rev().map(move |halvings| limit - (limit >> halvings));
    near.chain(doubtful.iter().copied().filter(move |size| *size < limit)).chain(far).filter(|size| *size > 0)
}

/// How many sizes on either side of an answer are tried.
fn in_a_row(limit: u32) -> u32 {
    (TRIANGLES_IN_A_ROW / limit.max(1)).clamp(LEAST_IN_A_ROW, LOOK)
}

/// Sizes that are tried above the first miss, as many as below the answer.
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
        most(ceiling, hints, |size| Ok::<_, Infallible>(reached(size))).expect("infallible")
    }

    #[test]
    fn a_monotone_limit_is_found_exactly() {
        for limit in [0, 1, 2, 63, 110, 4_096, 900_000] {
            let found = of(CEILING, |size| size <= limit);
            assert_eq!((found.triangles, found.first_miss, found.island), (limit, Some(limit + 1), None));
        }
    }

    #[test]
    fn the_answer_lies_below_an_island() {
        // 796 to 806 miss because of an almost empty clump, 807 does not.
        for near in [None, Some(700), Some(807), Some(900)] {
            let hints = Hints { near, ..Hints::default() };
            let found = with(CEILING, &hints, |size| size <= 795 || size == 807);
            assert_eq!((found.triangles, found.first_miss, found.island), (795, Some(796), Some(807)), "{near:?}");
            assert_eq!(found.unbroken_from, 795 - LOOK);
        }
        assert_eq!(of(CEILING, |size| size <= 120 || (124..=150).contains(&size)).triangles, 120);
    }

    #[test]
    fn a_gap_far_below_is_found_where_another_model_doubts_it() {
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
        /// Wherever a search begins, it ends at the same size, if sizes below the answer do not miss.
        #[test]
        fn hints_change_the_number_of_trials_alone(
            limit in 0u32..5_000,
            near in 1u32..6_000,
            doubtful in proptest::collection::vec(1u32..6_000, 0..5),
        ) {
            let reached = |size: u32| size <= limit;
            let found = with(CEILING, &Hints { near: Some(near), doubtful }, reached);
            prop_assert_eq!((found.triangles, found.first_miss), (limit, Some(limit + 1)));
        }

        /// What is said of the sizes in a row is so.
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
