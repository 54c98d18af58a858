//! Straight-line code without registers or order, placed for dual-instruction mode.
//!
//! A stretch between `.linear` and `.endlinear` of an assembler source says what is computed: each line makes a value out of
//! others, by the name of an operation without its pipe. [`schedule`] replaces the stretch by pairs of a floating-point and a
//! core instruction: it chooses the order, fills and drains the pipes of adder and multiplier, and gives values their registers. What is
//! computed stays what is written, operation by operation, so that results do not depend on the order.
//!
//! ```text
//!         .linear                       or with numbers: window, eagerness, reserve, slope, shake
//!         for i 0 1 2                   repeated with $i replaced, until endfor
//! a$i   = fld.d 16*$i(r16)              a pair: its halves are a0.0 and a0.1 as singles
//! d$i   = sub.ss a$i.0, a$i.1
//! s$i   = mul.sd d$i, d$i               single sources, double result
//!         fst.d s$i, 16*$i(r18)
//!         endfor
//!         .endlinear
//! ```
//!
//! # Operations
//!
//! | lines | unit |
//! |---|---|
//! | `add` `sub` `.ss .sd .dd`, `mov` `.sd .ds` | adder, pipelined |
//! | `mul` `.ss .sd .dd` | multiplier, pipelined |
//! | `rcp` `.ss .dd` | seed of a reciprocal; the multiplier's pipe is drained before it |
//! | `isub.ss` `iadd.ss` `zmin.dd` | graphics unit (fisub, fiadd, fzchkl) |
//! | `fld.l .d .q`, `ld.l`, `fst.l .d`, `st.l`, `ixfr` | core |
//! | `adds subs and andnot or xor shl shr shra orh` | core; the first source may be a constant |
//! | `prefetch` | core: a load that is not waited for; nothing else goes to memory while it is under way |
//!
//! Values are named once. `r0` to `r31` and `f0` are registers that the stretch does not change; [`schedule`] is told by `.pool`
//! lines of the source which integer registers it may use: `.pool r4 r5 r6`. Loads and stores are independent of each other unless
//! a store is marked, `@mark st.l ..`, and a load says `!mark` at its end. A stretch begins and ends in dual-instruction mode.
//!
//! # Method
//!
//! List scheduling, clock by clock: of the operations that could issue, the one with the longest way to the end, out of a
//! *window* of lines from the first one that has not issued. That one may take the last registers; the others leave a *reserve*,
//! and more the farther ahead they are (*slope*, for each 64 lines), so that no schedule runs into a corner. A pipe is pushed by a
//! drain when there is nothing else to do, or when what waits in it is more urgent by the *eagerness*. An operation that
//! can be a dual operation pushes the other pipe on its way, where that loses nothing. The rules of issue are those of the freeze
//! table, so that code in the caches runs without freezes. A *shake* other than 0 changes priorities a little: schedules of
//! the same text differ by some per cent, and who wants the shortest tries many.

mod machine;
mod parse;
mod place;
mod settings;

use std::cell::RefCell;
use std::fmt::Write as _;

/// What is wrong with a linear stretch.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {reason}")]
pub struct LinearError {
    /// Line of the source, from 1.
    pub line: usize,
    /// What was expected, and what was found.
    pub reason: String,
}

/// What a stretch needs of the two halves of pairs, and how long its schedule is, in clocks without freezes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slots {
    /// Floating-point operations, those of the multiplier with double sources twice: it takes one every second clock.
    pub floating: usize,
    /// Core operations. No schedule is shorter than the greater of both.
    pub core: usize,
    /// Pairs of the schedule.
    pub pairs: usize,
}

/// The slots of each linear stretch of a source, in order.
///
/// # Errors
/// As [`schedule`].
pub fn slots(source: &str) -> Result<Vec<Slots>, LinearError> {
    let mut found = Vec::new();
    stretches(
        source,
        |operations, pairs| {
            let floating = operations.iter().filter(|operation| operation.name.unit.is_floating());
            let doubles = floating
                .clone()
                .filter(|operation| operation.name.unit == machine::Unit::Multiplier { double: true })
                .count();
            let floating = floating.count();
            found.push(Slots { floating: floating + doubles, core: operations.len() - floating, pairs: pairs.len() });
        },
        |_| {},
    )?;
    Ok(found)
}

/// Replaces all linear stretches of a source by pairs; the rest stays as it is.
///
/// # Errors
/// [`LinearError`] for the first line that is not understood, or a stretch whose values do not fit the registers.
pub fn schedule(source: &str) -> Result<String, LinearError> {
    let out = RefCell::new(String::with_capacity(source.len()));
    stretches(
        source,
        |_, pairs| {
            for (floating, core) in pairs {
                let _ = writeln!(out.borrow_mut(), "        d.{floating}\n            {core}");
            }
        },
        |text| {
            let _ = writeln!(out.borrow_mut(), "{text}");
        },
    )?;
    Ok(out.into_inner())
}

/// Hands the operations of each stretch with their pairs to `linear`, and every other line to `other`, in order.
fn stretches(
    source: &str,
    mut linear: impl FnMut(&[parse::Operation], &[(String, String)]),
    mut other: impl FnMut(&str),
) -> Result<(), LinearError> {
    let mut pool = Vec::new();
    let mut lines = source.lines().enumerate().map(|(n, text)| (n + 1, text));
    while let Some((line, text)) = lines.next() {
        let words: Vec<&str> = text.split_whitespace().collect();
        match words.as_slice() {
            [".pool", registers @ ..] => pool = parse::pool(line, registers)?,
            [".linear", parameters @ ..] => {
                let settings = parse::settings(line, parameters)?;
                let block: Vec<(usize, &str)> = lines.by_ref().take_while(|(_, t)| t.trim() != ".endlinear").collect();
                let operations = parse::operations(&block)?;
                let pairs =
                    place::pairs_of(&operations, &pool, settings).map_err(|reason| LinearError { line, reason })?;
                linear(&operations, &pairs);
            }
            _ => other(text),
        }
    }
    Ok(())
}
