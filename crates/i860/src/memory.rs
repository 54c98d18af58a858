//! Execution of loads and stores.

use crate::action::CoreAction;
use crate::bus::Bus;
use crate::cpu::{Cpu, Flow};
use crate::instruction::{Flags, Instruction};
use crate::state::PipeStage;
use crate::trap::TrapCause;

impl Cpu {
    #[inline(always)]
    fn effective_address(&self, a: &CoreAction, size: u32) -> Result<u32, TrapCause> {
        let address = a.immediate.wrapping_add(self.state.r(a.first)).wrapping_add(self.state.r(a.second));
        if address & (size - 1) == 0 { Ok(address) } else { Err(TrapCause::Unaligned { address, size }) }
    }

    /// Records the address of a load or store for the clock. With auto-increment, also writes the address to the base
    /// register.
    #[inline(always)]
    fn accessed(&mut self, a: &CoreAction, address: u32, stores: bool) {
        self.state.set_r(a.increments, address);
        self.accesses.push(address);
        if self.accesses.all_held {
            self.accesses.all_held = self.time.data.access(address, stores);
        }
    }

    #[inline(always)]
    fn read<B: Bus>(&self, bus: &mut B, address: u32, size: u32) -> Result<u64, TrapCause> {
        bus.read(address, size).map_err(|_| TrapCause::DataAccess { address })
    }

    #[inline(always)]
    fn write<B: Bus>(&mut self, bus: &mut B, address: u32, size: u32, value: u64) -> Result<(), TrapCause> {
        bus.write(address, size, value).map_err(|_| TrapCause::DataAccess { address })?;
        self.code_changed |= self.code.words.note_store(address, size);
        Ok(())
    }

    /// Returns [`Flow::NextOfChangedCode`] if the latest store has changed decoded code, otherwise [`Flow::Next`].
    #[inline(always)]
    fn after_store(&self) -> Flow {
        if self.code_changed { Flow::NextOfChangedCode } else { Flow::Next }
    }

    #[inline(always)]
    pub(crate) fn load_integer<const SIZE: u32, B: Bus>(
        &mut self,
        a: &CoreAction,
        bus: &mut B,
    ) -> Result<Flow, TrapCause> {
        let address = self.effective_address(a, SIZE)?;
        // Bytes and shorts are sign-extended.
        let value = match SIZE {
            4 => self.read(bus, address, 4)? as u32,
            2 => self.read(bus, address, 2)? as i16 as u32,
            _ => self.read(bus, address, 1)? as i8 as u32,
        };
        self.state.set_r(a.dest, value);
        self.accessed(a, address, false);
        Ok(Flow::Next)
    }

    #[inline(always)]
    pub(crate) fn store_integer<const SIZE: u32, B: Bus>(
        &mut self,
        a: &CoreAction,
        bus: &mut B,
    ) -> Result<Flow, TrapCause> {
        let address = self.effective_address(a, SIZE)?;
        let value = u64::from(self.state.r(a.dest));
        self.write(bus, address, SIZE, value)?;
        self.accessed(a, address, true);
        Ok(self.after_store())
    }

    #[inline(always)]
    pub(crate) fn load_floating<const SIZE: u32, B: Bus>(
        &mut self,
        a: &CoreAction,
        bus: &mut B,
    ) -> Result<Flow, TrapCause> {
        let address = self.effective_address(a, SIZE)?;
        match SIZE {
            4 => {
                let low = self.read(bus, address, 4)?;
                self.state.set_f32(a.dest, low as u32);
            }
            8 => {
                let pair = self.read(bus, address, 8)?;
                self.state.set_f64(a.dest, pair);
            }
            // The four registers of a quad begin at a multiple of four.
            _ => self.load_quad(a.dest & 28, address, bus)?,
        }
        self.accessed(a, address, false);
        Ok(Flow::Next)
    }

    #[inline(always)]
    fn load_quad<B: Bus>(&mut self, dest: u8, address: u32, bus: &mut B) -> Result<(), TrapCause> {
        let low = self.read(bus, address, 8)?;
        let high = self.read(bus, address + 8, 8)?;
        self.state.set_f64(dest, low);
        self.state.set_f64(dest + 2, high);
        Ok(())
    }

    #[inline(always)]
    pub(crate) fn store_floating<const SIZE: u32, B: Bus>(
        &mut self,
        a: &CoreAction,
        bus: &mut B,
    ) -> Result<Flow, TrapCause> {
        let address = self.effective_address(a, SIZE)?;
        match SIZE {
            4 => self.write(bus, address, 4, u64::from(self.state.f32_bits(a.dest)))?,
            8 => self.write(bus, address, 8, self.state.f64_bits(a.dest))?,
            _ => {
                let quad = a.dest & 28;
                self.write(bus, address, 8, self.state.f64_bits(quad))?;
                self.write(bus, address + 8, 8, self.state.f64_bits(quad + 2))?;
            }
        }
        self.accessed(a, address, true);
        Ok(self.after_store())
    }

    pub(crate) fn load_pipelined<const SIZE: u32, B: Bus>(
        &mut self,
        a: &CoreAction,
        bus: &mut B,
    ) -> Result<Flow, TrapCause> {
        let address = self.effective_address(a, SIZE)?;
        let bits = self.read(bus, address, SIZE)?;
        // The destination receives the data of the oldest load, and the new data enter the pipe.
        let [first, second, leaving] = self.state.load;
        self.state.set_f(a.dest, leaving);
        self.state.load = [PipeStage { bits, double: SIZE == 8 }, first, second];
        // A pipelined load bypasses the cache, so it never counts as a hit.
        self.accesses.all_held = false;
        self.accessed(a, address, false);
        Ok(Flow::Next)
    }

    /// Executes `pst`: stores the pixels whose bits in psr.PM are set. Bit 0 belongs to the pixel at the lowest
    /// address. Then shifts PM right by the number of pixels.
    pub(crate) fn store_pixels<B: Bus>(&mut self, a: &CoreAction, bus: &mut B) -> Result<Flow, TrapCause> {
        let address = self.effective_address(a, 8)?;
        // If the address is not mapped, trap before the first write of a pixel.
        self.read(bus, address, 8)?;
        let size = 1 << self.state.pixel_size();
        let pixels = 8 / size;
        let mask = self.state.pixel_mask();
        let value = self.state.f64_bits(a.dest);
        // Each pixel whose mask bit is set needs one write.
        for n in (0..pixels).filter(|n| mask >> n & 1 != 0) {
            self.write(bus, address + n * size, size, value >> (8 * n * size))?;
        }
        self.state.set_pixel_mask(mask >> pixels);
        self.accessed(a, address, true);
        Ok(self.after_store())
    }

    /// Executes `flush`. The address can be unaligned, and memory at the address is not necessary.
    pub(crate) fn flush_line(&mut self, i: &Instruction) {
        let offset = if i.has(Flags::IMMEDIATE) { i.imm as u32 } else { self.state.r(i.src1) };
        let address = offset.wrapping_add(self.state.r(i.src2));
        if i.has(Flags::AUTOINCREMENT) {
            self.state.set_r(i.src2, address);
        }
        self.accesses.all_held = false;
        self.accesses.push(address);
    }
}
