//! Instruction scheduler: combines floating-point and core operations into pairs, one pair per clock.

mod floating;

use super::machine::{Unit, Width};
use super::parse::{Operation, Source};
use super::settings::Settings;

/// Number of stages of the adder's pipe, and of the multiplier's pipe for single-precision sources.
const STAGES: usize = 3;
/// Number of stages of the multiplier's pipe for double-precision sources.
const DOUBLE_STAGES: usize = 2;
/// Number of clocks after a prefetch in which the scheduler places no memory access, because a cache-line fill takes
/// this time.
const PREFETCH: u32 = 18;
/// Base register of stores that the scheduler expects to miss the data cache. By convention, a kernel writes its output,
/// the command words, with this base.
const OUTPUT_BASE: &str = "r18";
/// Greatest number of stores with the base [`OUTPUT_BASE`] that can wait for the bus.
const STORES: u32 = 2;
/// Number of clocks for which a store with the base [`OUTPUT_BASE`] uses the bus.
const STORE: u32 = 3;
/// The scheduler fails with an error if it issues no operation for this number of successive clocks.
const PATIENCE: u32 = 80;

/// The pairs of a schedule: the texts of the floating-point half and of the core half.
pub(super) type Pairs = Vec<(String, String)>;

/// Chooses the clock and the registers of every operation.
///
/// # Errors
/// Returns a message if the registers cannot hold all values.
pub(super) fn pairs_of(operations: &[Operation], pool: &[u8], settings: Settings) -> Result<Pairs, String> {
    Placer::new(operations, pool, settings).run()
}

/// Location of a value: not computed yet, in a pipe, in registers, or no longer needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Nowhere,
    InPipe,
    /// The value is in one or more registers, from number `register` on. Operations can read the value from clock `at`
    /// on.
    Ready {
        at: u32,
        register: u8,
    },
    Gone,
}

/// One register file. For each register, the first clock at which the register can be written, or `None` while it holds
/// a value.
#[derive(Clone, Debug)]
struct File {
    free_from: Vec<Option<u32>>,
    usable: Vec<bool>,
}

impl File {
    fn new(usable: impl Fn(usize) -> bool) -> File {
        File { free_from: vec![Some(0); 32], usable: (0..32).map(usable).collect() }
    }

    fn is_free(&self, n: usize, now: u32) -> bool {
        self.usable[n] && self.free_from[n].is_some_and(|from| from <= now)
    }

    fn free(&self, now: u32) -> usize {
        (0..32).filter(|n| self.is_free(*n, now)).count()
    }

    /// Finds `count` consecutive free registers, without register `but`, and returns the number of the first. For one
    /// or two registers, the function prefers a gap beside used registers.
    fn find(&self, count: usize, now: u32, but: Option<u8>) -> Option<u8> {
        // The first register of a value is a multiple of its number of registers.
        let fits = |first: &usize| (*first..first + count).all(|n| self.is_free(n, now) && Some(n as u8) != but);
        let mut starts = (0..32).step_by(count).filter(fits);
        let start = match count {
            1 => {
                let all: Vec<usize> = starts.collect();
                // Prefer a register whose neighbour is in use, so that whole pairs stay free.
                let lonely = all.iter().copied().find(|n| !self.is_free(n ^ 1, now));
                lonely.or_else(|| all.first().copied())
            }
            2 => {
                let all: Vec<usize> = starts.collect();
                let lonely = all.iter().copied().find(|n| (n & !3..(n & !3) + 4).any(|m| !self.is_free(m, now)));
                lonely.or_else(|| all.first().copied())
            }
            _ => starts.next(),
        };
        start.map(|n| n as u8)
    }

    fn take(&mut self, first: u8, count: usize) {
        (usize::from(first)..usize::from(first) + count).for_each(|n| self.free_from[n] = None);
    }

    fn give_back(&mut self, first: u8, count: usize, from: u32) {
        (usize::from(first)..usize::from(first) + count).for_each(|n| self.free_from[n] = Some(from));
    }
}

struct Placer<'a> {
    operations: &'a [Operation],
    settings: Settings,
    heights: Vec<u32>,
    uses_left: Vec<usize>,
    places: Vec<Place>,
    /// Clock at which each operation was issued. `None` before its issue.
    issued: Vec<Option<u32>>,
    now: u32,
    first: usize,
    /// Number of following multiplications that must not become dual operations. A reciprocal approximation (`frcp`,
    /// `frsqr`) has destroyed the values in the multiplier's pipe, so a dual operation would read a wrong product.
    after_seed: usize,
    /// Values in the adder's pipe, the oldest first. `None` is a result that no operation reads.
    adder: Vec<Option<usize>>,
    multiplier: Vec<Option<usize>>,
    multiplies_double: bool,
    multiplier_free: u32,
    /// First register and number of registers of the floating-point result of the previous clock. Row 9 of the freeze
    /// table delays a multiplication whose first source is this result.
    last_result: Option<(u8, usize)>,
    last_result_at: u32,
    last_store: Option<u32>,
    bus_free: u32,
    memory_free: u32,
    floats: File,
    integers: File,
}

impl<'a> Placer<'a> {
    fn new(operations: &'a [Operation], pool: &[u8], settings: Settings) -> Placer<'a> {
        let mut uses_left = vec![0; operations.len()];
        // Count the reads of each value. The registers of a value are free after the last read.
        operations.iter().flat_map(Operation::reads).for_each(|n| uses_left[n] += 1);
        Placer {
            operations,
            settings,
            heights: heights(operations, settings.shake),
            uses_left,
            places: vec![Place::Nowhere; operations.len()],
            issued: vec![None; operations.len()],
            now: 0,
            first: 0,
            after_seed: 0,
            adder: vec![None; STAGES],
            multiplier: vec![None; STAGES],
            multiplies_double: false,
            multiplier_free: 0,
            last_result: None,
            last_result_at: 0,
            last_store: None,
            bus_free: 0,
            memory_free: 0,
            floats: File::new(|n| n >= 2),
            integers: File::new(|n| pool.contains(&(n as u8))),
        }
    }

    fn run(mut self) -> Result<Pairs, String> {
        let mut pairs = Vec::new();
        let mut progress = 0;
        // Each turn places one pair and advances the clock by one.
        while self.first < self.operations.len() || self.is_something_in_pipes() {
            let before = self.issued.iter().flatten().count();
            let floating = self.floating_half();
            let core = self.core_half();
            if self.issued.iter().flatten().count() > before {
                progress = self.now;
            }
            if self.now > progress + PATIENCE {
                let line = self.operations[self.first.min(self.operations.len() - 1)].name.mnemonic;
                return Err(format!("the values do not fit the registers (operation {}, {line})", self.first));
            }
            pairs.push((floating, core));
            self.now += 1;
            self.skip_issued();
        }
        Ok(pairs)
    }

    fn is_something_in_pipes(&self) -> bool {
        self.adder.iter().chain(&self.multiplier).any(Option::is_some)
    }

    fn skip_issued(&mut self) {
        while self.first < self.operations.len() && self.issued[self.first].is_some() {
            self.first += 1;
        }
    }

    // ---- choice of the next operation

    fn candidates(&self, floating: bool) -> Vec<usize> {
        // Only operations in the window can be issued, the most urgent operation first.
        let window = self.first..self.operations.len().min(self.first + self.settings.window);
        let mut all: Vec<usize> = window
            .filter(|n| self.issued[*n].is_none() && self.operations[*n].name.unit.is_floating() == floating)
            .filter(|n| self.can_issue(*n, *n == self.first))
            .collect();
        all.sort_by_key(|n| (std::cmp::Reverse(self.heights[*n]), *n));
        all
    }

    fn can_issue(&self, n: usize, is_oldest: bool) -> bool {
        let operation = &self.operations[n];
        // A load that must wait for a store is placed at least two clocks after the store.
        let awaited = operation.after.iter().all(|store| self.issued[*store].is_some_and(|at| at + 2 <= self.now));
        awaited
            && operation.reads().all(|value| self.is_ready(value))
            && self.unit_accepts(n)
            && self.has_room(n, is_oldest)
    }

    fn is_ready(&self, value: usize) -> bool {
        matches!(self.places[value], Place::Ready { at, .. } if at <= self.now)
    }

    fn unit_accepts(&self, n: usize) -> bool {
        let operation = &self.operations[n];
        // A load directly after a store would freeze (row 17).
        let follows_store = self.last_store.is_some_and(|at| at + 1 == self.now);
        match operation.name.unit {
            Unit::Adder => self.can_push(&self.adder, STAGES, None),
            Unit::Multiplier { double } => self.multiplier_accepts(n, double),
            Unit::Seed => self.multiplier.iter().all(Option::is_none),
            Unit::Graphics | Unit::Integer => true,
            Unit::Load => self.memory_free <= self.now && !follows_store,
            Unit::Prefetch => self.memory_free <= self.now && !follows_store && self.bus_free <= self.now,
            Unit::Store => {
                let room = !stores_output(operation) || self.bus_free < self.now + STORES * STORE;
                self.memory_free <= self.now && room
            }
        }
    }

    fn multiplier_accepts(&self, n: usize, double: bool) -> bool {
        let mixes = double != self.multiplies_double && self.multiplier.iter().any(Option::is_some);
        self.multiplier_free <= self.now && !mixes && {
            let first = self.first_source_register(n);
            let stages = if double { DOUBLE_STAGES } else { STAGES };
            self.can_push(&self.multiplier, stages, first) && !self.waits_for_first_source(n)
        }
    }

    /// Returns true if the registers have room for a push into the pipe. The push can move a value out of the pipe,
    /// which then needs one free register or a free pair of registers. The register `but` does not count as free.
    fn can_push(&self, pipe: &[Option<usize>], stages: usize, but: Option<u8>) -> bool {
        match pipe[STAGES - stages] {
            Some(value) => self.floats.find(self.width(value).registers(), self.now, but).is_some(),
            None => true,
        }
    }

    fn width(&self, value: usize) -> Width {
        self.operations[value].name.result.unwrap_or(Width::Integer)
    }

    /// Returns true if both sources of a multiplication are the result of the previous operation. Row 9 of the freeze
    /// table would then delay the multiplication. If only one source is this result, the scheduler instead swaps the
    /// operands.
    fn waits_for_first_source(&self, n: usize) -> bool {
        let sources = &self.operations[n].sources;
        self.is_last_result(&sources[0]) && self.is_last_result(&sources[1])
    }

    fn is_last_result(&self, source: &Source) -> bool {
        let Some((first, count)) = self.last_result else { return false };
        let fresh = self.last_result_at + 1 == self.now;
        fresh && self.register(source).is_some_and(|r| (first..first + count as u8).contains(&r))
    }

    fn register(&self, source: &Source) -> Option<u8> {
        let Source::Value(value, part) = source else { return None };
        match self.places[*value] {
            Place::Ready { register, .. } => Some(register + part.unwrap_or(0)),
            _ => None,
        }
    }

    /// Returns the number of the register that a multiplication will read as its first source.
    fn first_source_register(&self, n: usize) -> Option<u8> {
        let sources = &self.operations[n].sources;
        self.register(&sources[usize::from(self.is_last_result(&sources[0]))])
    }

    /// Returns true if enough registers are free for the result of operation `n` and for the values in the pipes. Only
    /// the first unissued operation (`is_oldest`) can use the last free registers.
    fn has_room(&self, n: usize, is_oldest: bool) -> bool {
        let Some(width) = self.operations[n].name.result else { return true };
        let count = width.registers();
        if width == Width::Integer {
            let spare = self.spare(n);
            return self.operations[n].register.is_some()
                || self.is_last_integer_use(n)
                || self.integers.free(self.now) > spare;
        }
        let piped = matches!(self.operations[n].name.unit, Unit::Adder | Unit::Multiplier { .. });
        // Values in the pipes will also need registers.
        let coming: usize =
            self.adder.iter().chain(&self.multiplier).flatten().map(|value| self.width(*value).registers()).sum();
        let free = self.floats.free(self.now);
        let fits = piped || self.floats.find(count, self.now, None).is_some();
        let spare = self.spare(n);
        fits && (free >= coming + count + spare || piped && is_oldest)
    }

    /// Returns the number of registers that operation `n` must leave free for earlier lines of the source.
    fn spare(&self, n: usize) -> usize {
        let behind = n - self.first;
        if behind == 0 { 0 } else { self.settings.reserve + behind * self.settings.slope / 64 }
    }

    fn core_half(&mut self) -> String {
        // The candidates are sorted by urgency. Without a candidate, the core half is empty.
        let Some(n) = self.candidates(false).into_iter().next() else { return "nop".to_owned() };
        let operation = &self.operations[n];
        let mnemonic = operation.name.mnemonic;
        let mut texts: Vec<String> = operation.sources.iter().map(|source| self.core_text(source)).collect();
        if let Some((offset, base)) = &operation.address {
            texts.push(format!("{offset}({})", self.core_text(base)));
        }
        self.note_memory(n);
        // Release the sources before the result gets a register, so that the result can reuse a register of a source.
        if operation.name.unit == Unit::Integer {
            self.release_integers(n);
        }
        let dest = operation.name.result.is_some().then(|| self.place(n, self.now + operation.name.latency));
        // A prefetch is a load whose result is not used.
        let dest = if operation.name.unit == Unit::Prefetch { Some("r0".to_owned()) } else { dest };
        self.finish_issue(n);
        texts.extend(dest);
        format!("{mnemonic} {}", texts.join(", "))
    }

    /// Returns true if an integer operation is the last reader of one of its source values.
    fn is_last_integer_use(&self, n: usize) -> bool {
        let mut read = self.operations[n].reads();
        self.operations[n].name.unit == Unit::Integer
            && read.any(|value| self.width(value) == Width::Integer && self.uses_left[value] == 1)
    }

    /// Frees the integer registers that operation `n` is the last to read, so that its result can overwrite them.
    fn release_integers(&mut self, n: usize) {
        let read: Vec<usize> = self.operations[n].reads().collect();
        for value in read {
            let is_last = self.uses_left[value] == self.operations[n].reads().filter(|v| *v == value).count();
            if let (Place::Ready { register, .. }, Width::Integer, true) =
                (self.places[value], self.width(value), is_last)
            {
                self.integers.give_back(register, 1, self.now);
                self.places[value] = Place::Gone;
            }
        }
    }

    fn floating_text(&self, source: &Source) -> String {
        match source {
            Source::Text(text) => text.clone(),
            value => format!("f{}", self.register(value).unwrap_or(0)),
        }
    }

    fn core_text(&self, source: &Source) -> String {
        let Source::Value(value, _) = source else { return self.floating_text(source) };
        let file = if self.width(*value) == Width::Integer { 'r' } else { 'f' };
        format!("{file}{}", self.register(source).unwrap_or(0))
    }

    fn note_memory(&mut self, n: usize) {
        let operation = &self.operations[n];
        match operation.name.unit {
            Unit::Store => {
                self.last_store = Some(self.now);
                if stores_output(operation) {
                    self.bus_free = self.bus_free.max(self.now) + STORE;
                }
            }
            Unit::Prefetch => self.memory_free = self.now + PREFETCH,
            _ => {}
        }
    }

    /// Assigns registers to the result of operation `n`. Returns the text of the destination register.
    fn place(&mut self, n: usize, at: u32) -> String {
        let width = self.width(n);
        let (file, letter) = match width {
            Width::Integer => (&mut self.integers, 'r'),
            _ => (&mut self.floats, 'f'),
        };
        if let Some(register) = self.operations[n].register {
            return format!("r{register}");
        }
        let register = file.find(width.registers(), self.now, None).unwrap_or(0);
        file.take(register, width.registers());
        self.places[n] = Place::Ready { at, register };
        format!("{letter}{register}")
    }

    /// Records the issue of an operation, and frees the registers that no later operation reads. They are free from the
    /// next clock on, or one clock later after a store (row 24 of the freeze table).
    fn finish_issue(&mut self, n: usize) {
        self.issued[n] = Some(self.now);
        if matches!(self.operations[n].name.unit, Unit::Adder | Unit::Multiplier { .. }) {
            self.places[n] = Place::InPipe;
        }
        // A stored register is free one clock later (row 24).
        let stores = self.operations[n].name.unit == Unit::Store;
        let from = self.now + if stores { 2 } else { 1 };
        let read: Vec<usize> = self.operations[n].reads().collect();
        for value in read {
            self.uses_left[value] -= 1;
            if self.uses_left[value] == 0 {
                self.release(value, from);
            }
        }
    }

    fn release(&mut self, value: usize, from: u32) {
        let width = self.width(value);
        if let Place::Ready { register, .. } = self.places[value] {
            let file = if width == Width::Integer { &mut self.integers } else { &mut self.floats };
            file.give_back(register, width.registers(), from);
        }
        self.places[value] = Place::Gone;
    }
}

fn stores_output(operation: &Operation) -> bool {
    matches!(&operation.address, Some((_, Source::Text(base))) if base == OUTPUT_BASE)
}

/// Returns the longest path from each operation to the end of the linear stretch, in clocks. If `shake` is not 0, the
/// function adds pseudo-random noise, which changes the schedule.
fn heights(operations: &[Operation], shake: u32) -> Vec<u32> {
    let mut heights = vec![0; operations.len()];
    let mut state = u64::from(shake);
    for n in (0..operations.len()).rev() {
        // The noise comes from a fixed generator, so that schedules are reproducible.
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let noise = if shake == 0 { 0 } else { (state >> 40) as u32 % (6 << (shake % 4)) };
        heights[n] += operations[n].name.latency + noise;
        let height = heights[n];
        // Sources are at least as urgent as the operations that read them.
        for before in operations[n].reads().chain(operations[n].after.iter().copied()) {
            heights[before] = heights[before].max(height);
        }
    }
    heights
}
