//! What processors that are built alike know of programs: decoded code, and the clocks of its runs.

use crate::assembler::Program;
use crate::code::Code;
use crate::memo::Numbers;
use std::fmt;
use std::sync::Arc;

/// Decoded programs with the clocks that their runs took, for processors with the same rules of freezing.
///
/// Neither depends on which processor has executed them, so several can take turns: what one has decoded and counted, the others
/// need not ([`Cpu::open`](crate::Cpu::open), [`Cpu::close`](crate::Cpu::close)).
#[derive(Default)]
pub struct Shelf {
    pub(crate) numbers: Box<Numbers>,
    /// Nothing decoded while a processor has it.
    codes: Vec<(Arc<Program>, Option<Code>)>,
    /// Number of the latest state of an instruction cache.
    pub(crate) cache_states: u64,
}

impl fmt::Debug for Shelf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Shelf").field("programs", &self.codes.len()).finish_non_exhaustive()
    }
}

impl Shelf {
    /// One without programs.
    #[must_use]
    pub fn new() -> Shelf {
        Shelf::default()
    }

    fn place(&mut self, program: &Arc<Program>) -> &mut Option<Code> {
        let known = self.codes.iter().position(|(known, _)| Arc::ptr_eq(known, program));
        let at = known.unwrap_or_else(|| {
            self.codes.push((Arc::clone(program), None));
            self.codes.len() - 1
        });
        &mut self.codes[at].1
    }

    /// Takes out what is known of a program.
    pub(crate) fn take(&mut self, program: &Arc<Program>) -> Code {
        self.place(program).take().unwrap_or_else(|| Code::of(program))
    }

    /// Puts it back.
    pub(crate) fn put(&mut self, program: &Arc<Program>, code: Code) {
        *self.place(program) = Some(code);
    }
}
