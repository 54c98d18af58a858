//! Decoded programs with their memoized clocks, shared by processors with the same configuration.

use crate::assembler::Program;
use crate::code::Code;
use crate::memo::Numbers;
use std::fmt;
use std::sync::Arc;

/// A shared store of decoded programs and their memoized clocks, for processors with the same freeze rules.
///
/// Several processors can use it in turn, because decoded code and clocks do not depend on the processor. Each reuses
/// the work of an earlier one ([`Cpu::open`](crate::Cpu::open), [`Cpu::close`](crate::Cpu::close)).
#[derive(Default)]
pub struct DecodedPrograms {
    pub(crate) numbers: Box<Numbers>,
    /// Programs with their decoded code. The code is `None` while a processor uses it.
    codes: Vec<(Arc<Program>, Option<Code>)>,
    /// Highest number that a state of an instruction cache has had so far, over all processors that have used this
    /// store of decoded programs.
    pub(crate) cache_states: u64,
}

impl fmt::Debug for DecodedPrograms {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DecodedPrograms").field("programs", &self.codes.len()).finish_non_exhaustive()
    }
}

impl DecodedPrograms {
    pub fn new() -> DecodedPrograms {
        DecodedPrograms::default()
    }

    fn place(&mut self, program: &Arc<Program>) -> &mut Option<Code> {
        // Compare programs by their addresses in the simulator, because all processors share one copy of a program.
        let position = self.codes.iter().position(|(code, _)| Arc::ptr_eq(code, program));
        let at = position.unwrap_or_else(|| {
            self.codes.push((Arc::clone(program), None));
            self.codes.len() - 1
        });
        &mut self.codes[at].1
    }

    /// Takes the decoded code of a program out of the store. Returns an empty [`Code`] if the store does not contain
    /// the program.
    pub(crate) fn take(&mut self, program: &Arc<Program>) -> Code {
        self.place(program).take().unwrap_or_else(|| Code::of(program))
    }

    pub(crate) fn put(&mut self, program: &Arc<Program>, code: Code) {
        *self.place(program) = Some(code);
    }
}
