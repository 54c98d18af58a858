//! Collection of consecutive instructions into a run (a sequence of instructions). Each tile of 32 x 16 pixels executes
//! the whole run before the next tile begins.

use super::BitSerial;
use super::delivery::{Delivery, ExpressionEffect};
use super::runs::{BitOrigin, ConstantBits, EXPRESSIONS, InstructionRun, RunStep, RunTiles};
use crate::array::Executed;
use crate::controller::LocalExpression;
use crate::isa::timing::SET_UP_CLOCKS;
use crate::isa::{ArrayInstruction, Expression, LINEAR_BITS, opcode};
use pxpl5_wire::Word;

impl BitSerial {
    /// Executes the run (sequence of instructions) that begins at word `position`. Returns the length of the run in
    /// words, or 0 if no run begins at this word.
    pub(super) fn execute_run(&mut self, words: &[Word], position: usize, executed: &mut Executed) -> usize {
        let mut run = std::mem::take(&mut self.run);
        run.clear();
        while self.extend(&mut run, words, position) {}
        if !run.steps.is_empty() {
            self.vectors.run(RunTiles { run: &run, tiles: &mut self.tiles });
        }
        executed.instructions += run.steps.len() as u32;
        executed.clocks +=
            run.steps.iter().map(|step| u64::from(SET_UP_CLOCKS) + step.delivery.taken.end as u64).sum::<u64>();
        let used = run.words;
        self.run = run;
        used
    }

    /// Adds the instruction at word `position` to the run (a sequence of instructions) and returns true. Returns false
    /// if the instruction is illegal, or if an instruction of this kind cannot belong to a run.
    fn extend(&mut self, run: &mut InstructionRun, words: &[Word], position: usize) -> bool {
        let position = position + run.words;
        let Some(head) = words.get(position) else { return false };
        if !matches!((head >> 24) as u8, opcode::LINEAR..opcode::QUADRATIC | opcode::LOAD_CONSTANT) {
            return false;
        }
        let Ok((instruction, used)) = self.controller.fetch(words, position) else { return false };
        let Some(step) = self.step_of(run, &instruction) else { return false };
        run.steps.push(step);
        run.words += used;
        true
    }

    fn step_of(&mut self, run: &mut InstructionRun, instruction: &ArrayInstruction) -> Option<RunStep> {
        match *instruction {
            ArrayInstruction::Evaluate { expression, usage } => {
                let delivery = self.delivery(&usage, LINEAR_BITS).ok()?;
                // A repeated expression reuses the last expression of the run, if the run has an expression.
                if expression != Expression::LinearAgain || run.expressions.is_empty() {
                    if run.expressions.len() == EXPRESSIONS {
                        return None;
                    }
                    let LocalExpression::Linear(local) = self.controller.latch(&expression) else { return None };
                    run.expressions.push(local);
                }
                Some(RunStep { input: BitOrigin::Expression(run.expressions.len() - 1), delivery })
            }
            ArrayInstruction::LoadConstant { destination, value } => {
                let field = self.controller.bits(destination).ok()?;
                let delivery =
                    Delivery { taken: 0..field.width, effect: ExpressionEffect::Load { first: field.first } };
                Some(RunStep { input: BitOrigin::Constant(ConstantBits { value, signed: field.signed }), delivery })
            }
            _ => None,
        }
    }
}
