//! Decoded programs with their memoized clocks, shared by processors with the same configuration.

use crate::assembler::Program;
use crate::code::Code;
use crate::memo::Numbers;
use std::fmt;
use std::sync::Arc;

/// A shared store of decoded programs with their memoized clocks, for processors with the same freeze rules.
///
/// Several processors can use one store in turn, because decoded code and clocks do not depend on the processor. If one
/// processor has decoded a program and counted its clocks, other processors reuse the decoded code and the clocks
/// ([`Cpu::open`](crate::Cpu::open), [`Cpu::close`](crate::Cpu::close)).
#[derive(Default)]
pub struct DecodedPrograms {
    pub(crate) numbers: Box<Numbers>,
    /// Programs with their decoded code. The code is `None` while a processor uses it.
    codes: Vec<(Arc<Program>, Option<Code>)>,
    /// Highest number that a state of an instruction cache has had, in any processor that has used the store.
    pub(crate) cache_states: u64,
}

impl fmt::Debug for DecodedPrograms {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Shelf").field("programs", &self.codes.len()).finish_non_exhaustive()
    }
}

impl DecodedPrograms {
    /// Makes a store without programs.
    #[must_use]
    pub fn new() -> DecodedPrograms {
        DecodedPrograms::default()
    }

    fn place(&mut self, program: &Arc<Program>) -> &mut Option<Code> {
        // Programs are compared by address, because all processors share one copy of a program.
        let known = self.codes.iter().position(|(known, _)| Arc::ptr_eq(known, program));
        let at = known.unwrap_or_else(|| {
            self.codes.push((Arc::clone(program), None));
            self.codes.len() - 1
        });
        &mut self.codes[at].1
    }

    /// Takes the decoded code of a program out of the store. If the store has no code of this program, returns a
    /// [`Code`] without decoded blocks.
    pub(crate) fn take(&mut self, program: &Arc<Program>) -> Code {
        self.place(program).take().unwrap_or_else(|| Code::of(program))
    }

    pub(crate) fn put(&mut self, program: &Arc<Program>, code: Code) {
        *self.place(program) = Some(code);
    }
}
