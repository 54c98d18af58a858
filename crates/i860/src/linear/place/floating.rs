//! Choice of the floating-point half of a pair: an operation, or a push that drains a pipe.

use super::{DOUBLE_STAGES, Place, Placer, STAGES};
use crate::linear::machine::Unit;

impl Placer<'_> {
    pub(super) fn floating_half(&mut self) -> String {
        let best = self.candidates(true).into_iter().next();
        let drain = self.most_urgent_drain();
        match (best, drain) {
            (Some(n), Some((height, unit))) if height > self.heights[n] + self.settings.eagerness => self.drain(unit),
            (Some(n), _) => self.issue_floating(n),
            (None, Some((_, unit))) => self.drain(unit),
            (None, None) => "fnop".to_owned(),
        }
    }

    /// Returns the unit (adder or multiplier) whose pipe contains the most urgent value, and the urgency of this value
    /// in clocks. Returns `None` if no pipe with values can be pushed.
    fn most_urgent_drain(&self) -> Option<(u32, Unit)> {
        let double = self.multiplies_double;
        let stages = if double { DOUBLE_STAGES } else { STAGES };
        // Compare both pipes. A pipe without values is not drained.
        let adder = (self.urgency(&self.adder), Unit::Adder, self.can_push(&self.adder, STAGES, None));
        let free = self.multiplier_free <= self.now;
        let multiplier = (
            self.urgency(&self.multiplier),
            Unit::Multiplier { double },
            free && self.can_push(&self.multiplier, stages, None),
        );
        [adder, multiplier]
            .into_iter()
            .filter(|(_, _, possible)| *possible)
            .filter_map(|(height, unit, _)| Some((height?, unit)))
            .max_by_key(|(height, _)| *height)
    }

    /// Returns the urgency of a pipe in clocks: the longest path from one of its values to the end of the linear
    /// stretch.
    fn urgency(&self, pipe: &[Option<usize>]) -> Option<u32> {
        pipe.iter().flatten().map(|n| self.heights[*n].saturating_sub(self.operations[*n].name.latency)).max()
    }

    fn drain(&mut self, unit: Unit) -> String {
        let (mnemonic, dest) = match unit {
            Unit::Adder => {
                let dest = self.push_adder(None);
                (self.with_multiplier("pfadd.ss"), dest)
            }
            _ => {
                let double = self.multiplies_double;
                let dest = self.push_multiplier(None, double, None);
                (self.with_adder(if double { "pfmul.dd" } else { "pfmul.ss" }), dest)
            }
        };
        format!("{mnemonic} f0, f0, {dest}")
    }

    fn issue_floating(&mut self, n: usize) -> String {
        let operation = &self.operations[n];
        let mnemonic = operation.name.mnemonic;
        // Row 9 would delay the latest result as first source. Multiplication is commutative, so the sources can be
        // swapped.
        let swapped =
            matches!(operation.name.unit, Unit::Multiplier { .. }) && self.is_last_result(&operation.sources[0]);
        let mut texts: Vec<String> = operation.sources.iter().map(|source| self.floating_text(source)).collect();
        if swapped {
            texts.swap(0, 1);
        }
        let (mnemonic, dest) = match operation.name.unit {
            Unit::Adder => {
                let dest = self.push_adder(Some(n));
                (self.with_multiplier(mnemonic), dest)
            }
            Unit::Multiplier { double } => {
                let first = self.first_source_register(n);
                let dest = self.push_multiplier(Some(n), double, first);
                (self.with_adder(mnemonic), dest)
            }
            unit => {
                let dest = self.place(n, self.now + 2);
                self.last_result = None;
                if unit == Unit::Seed {
                    self.after_seed = STAGES;
                }
                (mnemonic, dest)
            }
        };
        self.finish_issue(n);
        format!("{mnemonic} {}, {dest}", texts.join(", "))
    }

    /// Turns a single-precision addition into a dual operation, which also pushes the multiplier's pipe. Returns
    /// `mnemonic` unchanged for all other operations, and if the push would move no value or lose a result.
    fn with_multiplier(&mut self, mnemonic: &'static str) -> &'static str {
        let dual = match mnemonic {
            "pfadd.ss" => "ra1p2.ss",
            "pfsub.ss" => "ra1s2.ss",
            _ => return mnemonic,
        };
        // The push must move values and must not lose a result.
        let waits = self.multiplier.iter().any(Option::is_some) && self.multiplier[0].is_none();
        if self.multiplies_double || !waits || self.multiplier_free > self.now {
            return mnemonic;
        }
        self.multiplier.rotate_left(1);
        dual
    }

    /// Turns a multiplication into a dual operation, which also pushes the adder's pipe. Returns `mnemonic` unchanged
    /// for all other operations, and if the push would move no value or lose a result.
    fn with_adder(&mut self, mnemonic: &'static str) -> &'static str {
        let dual = match mnemonic {
            "pfmul.ss" => "mm12mpm.ss",
            "pfmul.sd" => "mm12mpm.sd",
            "pfmul.dd" => "mm12mpm.dd",
            _ => return mnemonic,
        };
        // The multiplier's pipe still holds values that a reciprocal approximation has destroyed.
        if self.after_seed > 0 {
            self.after_seed -= 1;
            return mnemonic;
        }
        if self.adder[0].is_some() || self.adder.iter().all(Option::is_none) {
            return mnemonic;
        }
        self.adder.rotate_left(1);
        dual
    }

    fn push_adder(&mut self, n: Option<usize>) -> String {
        let leaving = self.adder.remove(0);
        self.adder.push(n);
        self.leave(leaving, None)
    }

    /// Pushes an operation into the multiplier's pipe. A double-precision operation skips the first of the three
    /// stages.
    fn push_multiplier(&mut self, n: Option<usize>, double: bool, first_source: Option<u8>) -> String {
        let at = if double { STAGES - DOUBLE_STAGES } else { 0 };
        self.multiplies_double = double;
        // The oldest value leaves the pipe, and the new value enters at the end.
        let leaving = self.multiplier.remove(at);
        self.multiplier.push(n);
        if double {
            self.multiplier_free = self.now + 2;
        }
        self.leave(leaving, first_source)
    }

    /// Moves a value from a pipe to registers other than `but`. Returns the text of the destination register.
    fn leave(&mut self, value: Option<usize>, but: Option<u8>) -> String {
        self.last_result = None;
        let Some(value) = value else { return "f0".to_owned() };
        let count = self.width(value).registers();
        let Some(register) = self.floats.find(count, self.now, but) else { return "f0".to_owned() };
        self.floats.take(register, count);
        self.places[value] = Place::Ready { at: self.now + 1, register };
        self.last_result = Some((register, count));
        self.last_result_at = self.now;
        format!("f{register}")
    }
}
