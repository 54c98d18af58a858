//! Execution of branches and trap instructions, and dispatch of core instructions.

use crate::action::{Core, CoreAction};
use crate::block::Unit;
use crate::bus::Bus;
use crate::cpu::Cpu;
use crate::flow::Flow;
use crate::instruction::{Flags, Instruction, Op};
use crate::state::{Mode, epsr, psr};
use crate::trap::TrapCause;

#[inline]
fn immediate(taken: bool, target: u32) -> Flow {
    if taken { Flow::Jump(target) } else { Flow::Next }
}

#[inline]
fn delayed(taken: bool, target: u32) -> Flow {
    if taken { Flow::Delayed(target) } else { Flow::Skip }
}

/// Returns the address of the instruction after the delay slot of a branch. The slot is a pair if the code after the
/// branch is in dual-instruction mode.
fn after_slot_address(unit: &Unit) -> u32 {
    unit.core_pc().wrapping_add(if unit.after.is_dual() { 12 } else { 8 })
}

impl Cpu {
    #[inline(always)]
    pub(crate) fn core<'a, B: Bus>(&mut self, a: &CoreAction, unit: impl Fn() -> &'a Unit, bus: &mut B) -> Flow {
        // Integer operations return directly, because they cannot trap.
        let done = match a.does {
            Core::Nothing => return Flow::Next,
            Core::Integer => {
                self.integer(a);
                return Flow::Next;
            }
            Core::LoadByte => self.load_integer::<1, B>(a, bus),
            Core::LoadShort => self.load_integer::<2, B>(a, bus),
            Core::LoadLong => self.load_integer::<4, B>(a, bus),
            Core::StoreByte => self.store_integer::<1, B>(a, bus),
            Core::StoreShort => self.store_integer::<2, B>(a, bus),
            Core::StoreLong => self.store_integer::<4, B>(a, bus),
            Core::LoadSingle => self.load_floating::<4, B>(a, bus),
            Core::LoadDouble => self.load_floating::<8, B>(a, bus),
            Core::LoadQuad => self.load_floating::<16, B>(a, bus),
            Core::StoreSingle => self.store_floating::<4, B>(a, bus),
            Core::StoreDouble => self.store_floating::<8, B>(a, bus),
            Core::StoreQuad => self.store_floating::<16, B>(a, bus),
            Core::PipelinedLoadSingle => self.load_pipelined::<4, B>(a, bus),
            Core::PipelinedLoadDouble => self.load_pipelined::<8, B>(a, bus),
            Core::StorePixels => self.store_pixels(a, bus),
            Core::System => self.system(unit()),
            Core::Branch => return self.branch(unit()),
        };
        self.flow(done)
    }

    #[inline(never)]
    fn system(&mut self, unit: &Unit) -> Result<Flow, TrapCause> {
        let i = &unit.core().instruction;
        match i.op {
            Op::LdC => self.state.set_r(i.dest, self.read_control(i.src2)),
            Op::StC => self.write_control(i.src2, self.state.r(i.src1)),
            Op::Ixfr => self.state.set_f32(i.dest, self.state.r(i.src1)),
            Op::Flush => self.flush_line(i),
            Op::Trap => return Err(TrapCause::Instruction),
            Op::Intovr if self.state.epsr & epsr::OF != 0 => return Err(TrapCause::Overflow),
            Op::Calli => return Ok(self.call_indirect(i, unit)),
            Op::Lock => self.set_lock(true),
            Op::Unlock => self.set_lock(false),
            _ => {}
        }
        Ok(Flow::Next)
    }

    fn call_indirect(&mut self, i: &Instruction, unit: &Unit) -> Flow {
        let target = self.state.r(i.src1);
        // r1 can also be the target register, so the target was read before this write.
        self.state.set_r(1, after_slot_address(unit));
        Flow::Delayed(target & !3)
    }

    #[inline]
    fn branch(&mut self, unit: &Unit) -> Flow {
        let i = &unit.core().instruction;
        // Offsets count words from the instruction after the branch.
        let target = unit.core_pc().wrapping_add(4).wrapping_add((i.imm as u32) << 2);
        let condition = self.state.psr & psr::CC != 0;
        match i.op {
            Op::Br => Flow::Delayed(target),
            Op::Call => {
                self.state.set_r(1, after_slot_address(unit));
                Flow::Delayed(target)
            }
            Op::Bri => self.branch_indirect(i),
            Op::Bc => immediate(condition, target),
            Op::Bnc => immediate(!condition, target),
            Op::BcT => delayed(condition, target),
            Op::BncT => delayed(!condition, target),
            Op::Bla => self.branch_on_loop(i, target),
            _ => self.compare_and_branch(i, target),
        }
    }

    fn compare_and_branch(&self, i: &Instruction, target: u32) -> Flow {
        let first = if i.has(Flags::IMMEDIATE) { u32::from(i.src1) } else { self.state.r(i.src1) };
        let equal = first == self.state.r(i.src2);
        immediate(equal == (i.op == Op::Bte), target)
    }

    /// Executes `bla`, which adds two registers. It branches if the loop condition code LCC was set before. Then LCC is
    /// set if the sum is not negative.
    fn branch_on_loop(&mut self, i: &Instruction, target: u32) -> Flow {
        let a = self.state.r(i.src1);
        let b = self.state.r(i.src2);
        let taken = self.state.psr & psr::LCC != 0;
        let sum = i64::from(a as i32) + i64::from(b as i32);
        self.state.set_psr_bit(psr::LCC, sum >= 0);
        self.state.set_r(i.src2, a.wrapping_add(b));
        if taken { Flow::Delayed(target) } else { Flow::Next }
    }

    /// Executes `bri`, an indirect branch. If a trap bit is set, `bri` returns from the trap: it restores user mode
    /// (U), interrupt mode (IM) and the pairing mode.
    fn branch_indirect(&mut self, i: &Instruction) -> Flow {
        let target = self.state.r(i.src1);
        if self.state.psr & psr::TRAPS != 0 {
            self.return_from_trap();
        }
        Flow::Delayed(target & !3)
    }

    fn return_from_trap(&mut self) {
        let old = self.state.psr;
        self.state.psr = old & !(psr::TRAPS | psr::DIM | psr::DS);
        // Restore the user and interrupt bits from before the trap.
        self.state.set_psr_bit(psr::U, old & psr::PU != 0);
        self.state.set_psr_bit(psr::IM, old & psr::PIM != 0);
        // The old pairing mode is restored after the delay slot.
        self.mode_after_slot = Some(match (old & psr::DIM != 0, old & psr::DS != 0) {
            (true, true) => Mode::DualOnce,
            (true, false) => Mode::Dual,
            (false, true) => Mode::Entering,
            (false, false) => Mode::Single,
        });
    }
}
