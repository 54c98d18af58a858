//! Conditions for the command `run until` of the debugger.

use super::words::{board, number};
use pxpl5::{Board, PictureNumber, Stepper};
use std::cmp::Ordering::{self, Equal, Greater, Less};

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Condition {
    /// A surface or a display memory has swapped its buffers since the last stop of the run.
    Swap,
    /// A region has arrived at a display since the last stop of the run.
    Region,
    /// A board has begun a stage of this picture.
    Picture(PictureNumber),
    /// The number of words in a renderer's input FIFO satisfies a comparison. The first value is the index of the
    /// renderer.
    Fifo(usize, Comparison),
    /// The number of messages in the inbox of the host or a graphics processor satisfies a comparison.
    Inbox(Board, Comparison),
    Channels(Comparison),
    /// A program on a board waits for an event whose name starts with this text.
    Waits(Board, String),
}

/// A comparison with a bound, which holds if the order of a value and the bound is one of `orders`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Comparison {
    orders: &'static [Ordering],
    bound: u64,
}

/// Numbers of swaps and of arrived regions at the last stop of the run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Before {
    swaps: usize,
    arrivals: usize,
    marks: usize,
}

impl Before {
    pub(super) fn of(stepper: &Stepper) -> Self {
        let observation = stepper.record().observation();
        let [swaps, arrivals, marks] = [observation.swaps.len(), observation.arrivals.len(), observation.marks.len()];
        Self { swaps, arrivals, marks }
    }
}

impl Condition {
    /// Parses a condition from words. An error states the expected syntax and the text found.
    pub(super) fn parse(words: &[&str]) -> Result<Self, String> {
        // The first word selects the kind of condition.
        match words {
            ["swap"] => Ok(Self::Swap),
            ["region"] => Ok(Self::Region),
            ["picture", picture] => number("picture", picture).map(|picture| Self::Picture(PictureNumber(picture))),
            ["fifo", renderer, rest @ ..] => {
                Ok(Self::Fifo(number("renderer", renderer)? as usize, Comparison::parse(rest)?))
            }
            ["channels", rest @ ..] => Comparison::parse(rest).map(Self::Channels),
            ["inbox", rest @ ..] => {
                let (board, rest) = board(rest)?;
                Ok(Self::Inbox(board, Comparison::parse(rest)?))
            }
            ["waits", rest @ ..] => match board(rest)? {
                (board, ["for", what @ ..]) if !what.is_empty() => Ok(Self::Waits(board, what.join(" "))),
                (_, rest) => Err(format!("waits: expected BOARD for WORDS, found `{}`", rest.join(" "))),
            },
            words => Err(format!(
                "expected swap, region, picture N, fifo R >= N, inbox BOARD >= N, channels >= N or waits BOARD for WORDS, found `{}`",
                words.join(" ")
            )),
        }
    }

    pub(super) fn check(&self, stepper: &Stepper) -> Result<(), String> {
        let renderers = stepper.record().renderers().len();
        // Only conditions with a board can be wrong for a machine.
        match self {
            Self::Fifo(renderer, _) if *renderer >= renderers => {
                Err(format!("renderer: expected 0 to {}, found {renderer}", renderers - 1))
            }
            Self::Inbox(board, _) | Self::Waits(board, _) if stepper.processor(*board).is_none() => {
                Err(format!("expected the host or a graphics processor of this machine, found {board}"))
            }
            _ => Ok(()),
        }
    }

    /// Returns true if the condition is satisfied now. `before` was recorded at the last stop of the run.
    pub(super) fn holds(&self, stepper: &Stepper, before: Before) -> bool {
        let observation = stepper.record().observation();
        // Swaps and arrivals count from the instant when the run was resumed.
        match self {
            Self::Swap => observation.swaps.len() > before.swaps,
            Self::Region => observation.arrivals.len() > before.arrivals,
            Self::Picture(picture) => {
                // Earlier events of this run were checked already. All marks of an event have its time.
                let new = observation.marks.iter().skip(before.marks).rev();
                let newest = new.clone().next().map(|mark| mark.time);
                new.take_while(|mark| Some(mark.time) == newest).any(|mark| mark.picture == *picture)
            }
            Self::Fifo(renderer, comparison) => {
                let words = stepper.renderer(*renderer).and_then(|snapshot| snapshot.fifo_words);
                words.is_some_and(|words| comparison.holds(u64::from(words)))
            }
            Self::Inbox(board, comparison) => {
                stepper.processor(*board).is_some_and(|snapshot| comparison.holds(snapshot.inbox.len() as u64))
            }
            Self::Channels(comparison) => comparison.holds(stepper.channels().len() as u64),
            Self::Waits(board, what) => stepper.processor(*board).is_some_and(|snapshot| {
                snapshot.programs.iter().any(|program| program.waits_for.starts_with(what.as_str()))
            }),
        }
    }
}

impl Comparison {
    fn parse(words: &[&str]) -> Result<Self, String> {
        let refused = || format!("expected <, <=, =, >= or > and a number, found `{}`", words.join(" "));
        let [relation, bound] = words else { return Err(refused()) };
        let orders: &[Ordering] = match *relation {
            "<" => &[Less],
            "<=" => &[Less, Equal],
            "=" | "==" => &[Equal],
            ">=" => &[Equal, Greater],
            ">" => &[Greater],
            _ => return Err(refused()),
        };
        Ok(Self { orders, bound: number("bound", bound)? })
    }

    fn holds(self, value: u64) -> bool {
        self.orders.contains(&value.cmp(&self.bound))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comparisons_are_exact_at_their_bounds() {
        for (relation, holds) in [
            ("<", [true, false, false]),
            ("<=", [true, true, false]),
            ("=", [false, true, false]),
            (">=", [false, true, true]),
            (">", [false, false, true]),
        ] {
            let comparison = Comparison::parse(&[relation, "5"]).expect("known");
            assert_eq!([4, 5, 6].map(|value| comparison.holds(value)), holds, "{relation}");
        }
    }

    #[test]
    fn an_invalid_condition_is_refused() {
        for wrong in
            ["", "fifo", "fifo 0", "fifo 0 ~ 3", "channels >= x", "waits gp 1", "waits gp 1 for", "inbox 3 > 1"]
        {
            let words: Vec<&str> = wrong.split_whitespace().collect();
            assert!(Condition::parse(&words).is_err(), "{wrong}");
        }
    }
}
