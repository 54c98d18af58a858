//! The greatest size that reaches a goal, found by trying.

use serde::Serialize;
use std::collections::BTreeMap;

/// What was found, and how sure it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Limit {
    /// Most triangles for which the goal was reached; 0 if it was not reached with one.
    pub triangles: u32,
    /// Fewest triangles above them that were tried and missed it; `None` if all that were tried reached it.
    pub first_miss: Option<u32>,
    /// Whether no smaller size that was tried missed it.
    pub monotone: bool,
    /// Sizes that were simulated.
    pub tried: usize,
}

/// Sizes tried above the answer of the bisection: those of two clumps, but no more than half of the answer.
const LOOK_AHEAD: u32 = 60;

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

    /// The answer, where the greatest size that reached the goal is known.
    fn limit(&self, triangles: u32) -> Limit {
        let missed = self.answers.iter().find(|(size, reached)| **size > triangles && !**reached);
        Limit {
            triangles,
            first_miss: missed.map(|(size, _)| *size),
            monotone: self.answers.iter().all(|(size, reached)| *size > triangles || *reached),
            tried: self.answers.len(),
        }
    }
}

/// The largest size up to `ceiling` at which `reached` holds, as far as bisection and a look ahead can tell.
///
/// # Errors
///
/// The first error of `reached`.
pub fn most<E>(ceiling: u32, reached: impl FnMut(u32) -> Result<bool, E>) -> Result<Limit, E> {
    let mut tried = Tried { answers: BTreeMap::new(), reached };
    let mut low = 0;
    let mut high = 1;
    while high < ceiling && tried.ask(high)? {
        low = high;
        high = (high * 2).min(ceiling);
    }
    loop {
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            *if tried.ask(middle)? { &mut low } else { &mut high } = middle;
        }
        let Some(better) = further(&mut tried, low, ceiling)? else { return Ok(tried.limit(low)) };
        low = better;
        high = better + 1;
    }
}

/// A size not far above the answer of a bisection that reaches the goal all the same.
fn further<E, F: FnMut(u32) -> Result<bool, E>>(
    tried: &mut Tried<F>,
    low: u32,
    ceiling: u32,
) -> Result<Option<u32>, E> {
    let farthest = (low + 1 + LOOK_AHEAD.min(low / 2)).min(ceiling);
    let step = (low / 400).max(1) as usize;
    for size in (low + 1..=farthest).rev().step_by(step) {
        if tried.ask(size)? {
            return Ok(Some(size));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    const CEILING: u32 = 1_000_000;

    fn of(ceiling: u32, reached: impl Fn(u32) -> bool) -> Limit {
        most(ceiling, |size| Ok::<_, Infallible>(reached(size))).expect("infallible")
    }

    #[test]
    fn a_monotone_limit_is_found_exactly() {
        for limit in [0, 1, 2, 63, 110, 4_096] {
            let found = of(CEILING, |size| size <= limit);
            assert_eq!((found.triangles, found.first_miss, found.monotone), (limit, Some(limit + 1), true));
        }
    }

    #[test]
    fn a_gap_below_the_limit_is_looked_across() {
        // 121 to 123 miss because of an almost empty clump, 124 to 150 do not.
        let found = of(CEILING, |size| size <= 120 || (124..=150).contains(&size));
        assert_eq!((found.triangles, found.first_miss), (150, Some(151)));
    }

    #[test]
    fn a_goal_that_is_always_reached_ends_at_the_ceiling() {
        let found = of(1_000, |_| true);
        assert_eq!((found.triangles, found.first_miss), (1_000, None));
    }
}
