//! The interface to the memory and the devices outside the processor.

use std::fmt;

/// An access to an address without memory and without a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no memory and no device answers")]
pub struct Unmapped;

/// The memory and devices that the processor can access, by physical byte addresses. Data are little-endian.
///
/// Alignment is checked before, so an address is always a multiple of the access size. A 16-byte access arrives as two
/// of 8 bytes.
pub trait Bus {
    /// Reads `size` bytes (1, 2, 4 or 8) at `address`. The result is zero-extended.
    ///
    /// # Errors
    /// Returns [`Unmapped`] if no memory or device answers. The processor then takes a data or instruction access trap.
    fn read(&mut self, address: u32, size: u32) -> Result<u64, Unmapped>;

    /// Writes the low `size` bytes (1, 2, 4 or 8) of `value` at `address`.
    ///
    /// # Errors
    /// Returns [`Unmapped`] if no memory or device answers. The processor then takes a data access trap.
    fn write(&mut self, address: u32, size: u32, value: u64) -> Result<(), Unmapped>;

    /// Returns true if the caches may contain the data at `address`. The processor reads this bit from its pin KEN#.
    /// The result must be false for addresses of devices.
    fn is_cacheable(&self, _address: u32) -> bool {
        true
    }
}

/// Memory for a range of addresses, which can be the bus of a processor.
#[derive(Clone, PartialEq, Eq)]
pub struct Ram {
    base: u32,
    bytes: Vec<u8>,
}

impl Ram {
    /// Makes a memory of `len` zero bytes that begins at address `base`.
    pub fn new(base: u32, len: usize) -> Ram {
        Ram { base, bytes: vec![0; len] }
    }

    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Copies `bytes` to memory at `address`.
    ///
    /// # Errors
    /// Returns [`Unmapped`] if the bytes do not fit. In this case, nothing is written.
    pub fn load(&mut self, address: u32, bytes: &[u8]) -> Result<(), Unmapped> {
        let at = self.offset(address, bytes.len())?;
        self.bytes[at..at + bytes.len()].copy_from_slice(bytes);
        Ok(())
    }

    /// Copies 32-bit words to memory at `address`.
    ///
    /// # Errors
    /// Returns [`Unmapped`] if the words do not fit. In this case, nothing is written.
    pub fn load_words(&mut self, address: u32, words: &[u32]) -> Result<(), Unmapped> {
        let at = self.offset(address, size_of_val(words))?;
        for (place, word) in self.bytes[at..].as_chunks_mut::<4>().0.iter_mut().zip(words) {
            *place = word.to_le_bytes();
        }
        Ok(())
    }

    /// Reads `count` 32-bit words from `address`.
    ///
    /// # Errors
    /// Returns [`Unmapped`] if a word lies outside the memory.
    pub fn words(&self, address: u32, count: usize) -> Result<Vec<u32>, Unmapped> {
        let at = self.offset(address, count.saturating_mul(4))?;
        let words = self.bytes[at..at + count * 4].chunks_exact(4);
        Ok(words.map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
    }

    fn offset(&self, address: u32, len: usize) -> Result<usize, Unmapped> {
        // Refuse ranges that begin below the memory or end after it.
        let at = address.wrapping_sub(self.base) as usize;
        let end = at.checked_add(len).ok_or(Unmapped)?;
        if address < self.base || end > self.bytes.len() { Err(Unmapped) } else { Ok(at) }
    }
}

impl fmt::Debug for Ram {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Ram {{ base: {:#010x}, len: {:#x} }}", self.base, self.bytes.len())
    }
}

impl Bus for Ram {
    #[inline]
    fn read(&mut self, address: u32, size: u32) -> Result<u64, Unmapped> {
        let at = address.wrapping_sub(self.base) as usize;
        let bytes = self.bytes.get(at..).ok_or(Unmapped)?;
        let value = match size {
            1 => bytes.first().map(|b| u64::from(*b)),
            2 => bytes.first_chunk().map(|b| u64::from(u16::from_le_bytes(*b))),
            4 => bytes.first_chunk().map(|b| u64::from(u32::from_le_bytes(*b))),
            _ => bytes.first_chunk().map(|b| u64::from_le_bytes(*b)),
        };
        value.ok_or(Unmapped)
    }

    #[inline]
    fn write(&mut self, address: u32, size: u32, value: u64) -> Result<(), Unmapped> {
        let at = address.wrapping_sub(self.base) as usize;
        let place = self.bytes.get_mut(at..).and_then(|b| b.get_mut(..size as usize)).ok_or(Unmapped)?;
        match size {
            4 => place.copy_from_slice(&(value as u32).to_le_bytes()),
            8 => place.copy_from_slice(&value.to_le_bytes()),
            2 => place.copy_from_slice(&(value as u16).to_le_bytes()),
            _ => place[0] = value as u8,
        }
        Ok(())
    }
}
