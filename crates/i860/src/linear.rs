//! A scheduler that converts straight-line code to instruction pairs for dual-instruction mode.
//!
//! A *linear stretch* is the part of an assembler source between `.linear` and `.endlinear`. Each of its lines computes
//! a value from other values, and names the operation but not the pipe that executes it. [`schedule`] replaces the
//! stretch by pairs of a floating-point and a core instruction: it chooses the order, fills and drains the pipes of
//! adder and multiplier, and assigns registers. Operations and operands stay as written, so results do not depend on
//! the order.
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
//! | `rcp` `.ss .dd` | first approximation of a reciprocal; the multiplier's pipe is drained first |
//! | `isub.ss` `iadd.ss` `zmin.dd` | graphics unit (fisub, fiadd, fzchkl) |
//! | `fld.l .d .q`, `ld.l`, `fst.l .d`, `st.l`, `ixfr` | core |
//! | `adds subs and andnot or xor shl shr shra orh` | core; the first source may be a constant |
//! | `prefetch` | core: a load whose data is not used; no other memory access is placed until the load ends |
//!
//! Each value has one name. `r0` to `r31` and `f0` are registers that the stretch does not change, and a `.pool` line
//! lists the integer registers that [`schedule`] can use: `.pool r4 r5 r6`. Loads and stores can be placed in any
//! order. If a load must wait for a store, the store has a label, `@label st.l ..`, and the load has `!label` at its
//! end. A stretch begins and ends in dual-instruction mode.
//!
//! The base register of a store has a meaning by convention:
//!
//! | base register | memory | effect on the schedule |
//! |---|---|---|
//! | `r18` | output, such as command words, which the data cache does not hold | the store uses the bus for 3 clocks; at most two of these stores wait for the bus, and no prefetch is placed while one of them uses the bus |
//! | any other | memory that the data cache holds | none of these limits |
//!
//! This affects only the order of the pairs. Code that breaks the convention computes the same results, but can have
//! freezes.
//!
//! # Method
//!
//! This is list scheduling, clock by clock. Each clock looks at a *window* of lines that begins with the first unissued
//! one. Of the operations in it that can be issued, the one with the longest path to the end of the stretch is taken.
//!
//! Only the first line may use the last free registers. Later ones must leave a *reserve*, which increases by *slope*
//! registers for each 64 lines of distance. With it, no schedule runs out of registers.
//!
//! An operation without operands pushes a pipe (a *drain*) if nothing can be issued. It also does so if a value in the
//! pipe has a longer path than the best operation, by more than the *eagerness*. An operation that can be a dual
//! operation also pushes the other pipe, if no result is lost.
//!
//! The rules of the freeze table are respected, so scheduled code runs without freezes if all accesses except the
//! stores with the base `r18` hit the caches. If *shake* is not 0, priorities change at random by small amounts, and
//! the length of the schedule by some per cent. A search can try many values and keep the shortest schedule.

mod machine;
mod parse;
mod place;
mod settings;

use crate::AssemblyError;
use crate::assembler::select;
use std::cell::RefCell;
use std::fmt::Write as _;

/// Number of operations in a linear stretch, and number of pairs in its schedule. Without freezes, each pair takes one
/// clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slots {
    /// Number of floating-point operations. A multiplication of doubles counts twice, because the multiplier accepts
    /// one such multiplication every second clock.
    pub floating: usize,
    /// Number of core operations. A schedule needs at least as many pairs as the greater of `floating` and `core`.
    pub core: usize,
    pub pairs: usize,
}

/// Returns the number of operations in each linear stretch (from `.linear` to `.endlinear`) of an assembly text, in the
/// order of the text.
///
/// # Errors
/// Returns the errors of [`schedule`].
pub fn slots(source: &str) -> Result<Vec<Slots>, AssemblyError> {
    let mut found = Vec::new();
    stretches(
        source,
        |operations, pairs| {
            // A multiplication of doubles takes two slots.
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

/// Replaces every linear stretch (from `.linear` to `.endlinear`) of an assembly text by instruction pairs. Lines that
/// a condition (`.if`) excludes become empty. All other lines stay unchanged.
///
/// # Errors
/// Returns an [`AssemblyError`] for the first line with an error, or for a stretch whose values need too many
/// registers.
pub fn schedule(source: &str) -> Result<String, AssemblyError> {
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

/// Reads an assembly text from top to bottom. Calls `linear` with the operations and the schedule of each linear
/// stretch, and `other` with each line outside a stretch.
fn stretches(
    source: &str,
    mut linear: impl FnMut(&[parse::Operation], &[(String, String)]),
    mut other: impl FnMut(&str),
) -> Result<(), AssemblyError> {
    let source = select(source).map_err(|(line, reason)| AssemblyError::in_line(line, reason))?;
    let mut pool = Vec::new();
    let mut lines = source.lines().enumerate().map(|(n, text)| (n + 1, text));
    while let Some((line, text)) = lines.next() {
        let words: Vec<&str> = text.split_whitespace().collect();
        match words.as_slice() {
            // A pool applies to all following stretches.
            [".pool", registers @ ..] => pool = parse::pool(line, registers)?,
            [".linear", parameters @ ..] => {
                let settings = parse::settings(line, parameters)?;
                // A stretch extends to the end directive.
                let block: Vec<(usize, &str)> = lines.by_ref().take_while(|(_, t)| t.trim() != ".endlinear").collect();
                let operations = parse::operations(&block)?;
                let pairs = place::pairs_of(&operations, &pool, settings)
                    .map_err(|reason| AssemblyError::in_line(line, reason))?;
                linear(&operations, &pairs);
            }
            _ => other(text),
        }
    }
    Ok(())
}
