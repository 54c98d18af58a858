//! Execution of loads and stores.

use crate::bus::Bus;
use crate::cpu::Cpu;
use crate::decoded::Decoded;
use crate::instruction::{Flags, Instruction, Op};
use crate::state::PipeStage;
use crate::trap::TrapCause;

impl Cpu {
    #[inline]
    fn effective_address(&self, i: &Instruction) -> u32 {
        let offset = if i.has(Flags::IMMEDIATE) { i.imm as u32 } else { self.state.r(i.src1) };
        offset.wrapping_add(self.state.r(i.src2))
    }

    #[inline]
    fn aligned(address: u32, size: u32) -> Result<(), TrapCause> {
        if address & (size - 1) == 0 { Ok(()) } else { Err(TrapCause::Unaligned { address, size }) }
    }

    #[inline]
    fn increment(&mut self, i: &Instruction, address: u32) {
        if i.has(Flags::AUTOINCREMENT) {
            self.state.set_r(i.src2, address);
        }
    }

    #[inline]
    fn read<B: Bus>(&self, bus: &mut B, address: u32, size: u32) -> Result<u64, TrapCause> {
        bus.read(address, size).map_err(|_| TrapCause::DataAccess { address })
    }

    #[inline]
    fn write<B: Bus>(&mut self, bus: &mut B, address: u32, size: u32, value: u64) -> Result<(), TrapCause> {
        bus.write(address, size, value).map_err(|_| TrapCause::DataAccess { address })?;
        self.code_changed |= self.code.words.may_hold(address, size);
        Ok(())
    }

    #[inline]
    pub(crate) fn load_integer<B: Bus>(&mut self, d: &Decoded, bus: &mut B) -> Result<(), TrapCause> {
        let i = &d.instruction;
        let address = self.effective_address(i);
        let (size, shift) = match i.op {
            Op::LdB => (1, 24),
            Op::LdS => (2, 16),
            _ => (4, 0),
        };
        Self::aligned(address, size)?;
        let raw = self.read(bus, address, size)? as u32;
        self.state.set_r(i.dest, ((raw << shift) as i32 >> shift) as u32);
        self.accesses.push(address);
        Ok(())
    }

    #[inline]
    pub(crate) fn store_integer<B: Bus>(&mut self, d: &Decoded, bus: &mut B) -> Result<(), TrapCause> {
        let i = &d.instruction;
        let address = (i.imm as u32).wrapping_add(self.state.r(i.src2));
        let size = match i.op {
            Op::StB => 1,
            Op::StS => 2,
            _ => 4,
        };
        Self::aligned(address, size)?;
        self.write(bus, address, size, u64::from(self.state.r(i.src1)))?;
        self.accesses.push(address);
        Ok(())
    }

    #[inline]
    pub(crate) fn load_floating<B: Bus>(&mut self, d: &Decoded, bus: &mut B) -> Result<(), TrapCause> {
        let i = &d.instruction;
        let address = self.effective_address(i);
        let size = u32::from(i.size);
        Self::aligned(address, size)?;
        match size {
            4 => {
                let low = self.read(bus, address, 4)?;
                self.state.set_f32(i.dest, low as u32);
            }
            8 => {
                let pair = self.read(bus, address, 8)?;
                self.state.set_f64(i.dest, pair);
            }
            _ => self.load_quad(i.dest & 28, address, bus)?,
        }
        self.increment(i, address);
        self.accesses.push(address);
        Ok(())
    }

    fn load_quad<B: Bus>(&mut self, dest: u8, address: u32, bus: &mut B) -> Result<(), TrapCause> {
        let low = self.read(bus, address, 8)?;
        let high = self.read(bus, address + 8, 8)?;
        self.state.set_f64(dest, low);
        self.state.set_f64(dest + 2, high);
        Ok(())
    }

    #[inline]
    pub(crate) fn store_floating<B: Bus>(&mut self, d: &Decoded, bus: &mut B) -> Result<(), TrapCause> {
        let i = &d.instruction;
        let address = self.effective_address(i);
        let size = u32::from(i.size);
        Self::aligned(address, size)?;
        match size {
            4 => self.write(bus, address, 4, u64::from(self.state.f32_bits(i.dest)))?,
            8 => self.write(bus, address, 8, self.state.f64_bits(i.dest))?,
            _ => {
                let quad = i.dest & 28;
                self.write(bus, address, 8, self.state.f64_bits(quad))?;
                self.write(bus, address + 8, 8, self.state.f64_bits(quad + 2))?;
            }
        }
        self.increment(i, address);
        self.accesses.push(address);
        Ok(())
    }

    pub(crate) fn load_pipelined<B: Bus>(&mut self, d: &Decoded, bus: &mut B) -> Result<(), TrapCause> {
        let i = &d.instruction;
        let address = self.effective_address(i);
        let size = u32::from(i.size);
        Self::aligned(address, size)?;
        let bits = self.read(bus, address, size)?;
        let [first, second, leaving] = self.state.load;
        self.state.set_f(i.dest, leaving);
        self.state.load = [PipeStage { bits, double: size == 8 }, first, second];
        self.increment(i, address);
        self.accesses.push(address);
        Ok(())
    }

    /// Writes the pixels whose PM bit is set, bit 0 at the lowest address, and shifts PM by the pixels passed.
    pub(crate) fn store_pixels<B: Bus>(&mut self, d: &Decoded, bus: &mut B) -> Result<(), TrapCause> {
        let i = &d.instruction;
        let address = self.effective_address(i);
        Self::aligned(address, 8)?;
        self.read(bus, address, 8)?;
        let size = 1 << self.state.pixel_size();
        let pixels = 8 / size;
        let mask = self.state.pixel_mask();
        let value = self.state.f64_bits(i.dest);
        for n in (0..pixels).filter(|n| mask >> n & 1 != 0) {
            self.write(bus, address + n * size, size, value >> (8 * n * size))?;
        }
        self.state.set_pixel_mask(mask >> pixels);
        self.increment(i, address);
        self.accesses.push(address);
        Ok(())
    }

    pub(crate) fn flush_line(&mut self, i: &Instruction) {
        let address = self.effective_address(i);
        self.increment(i, address);
        self.accesses.push(address);
    }
}
