//! Operands of instructions: references to bit fields of pixel memory.

/// A bit field of pixel memory, as encoded in an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Operand {
    /// Address of the least significant bit. It is an absolute address, or counts from the first bit of the selected
    /// context (the part of pixel memory that holds one region).
    pub address: u8,
    /// Width in bits, 1 to 64.
    pub width: u8,
    /// True if the address counts from the first bit of the selected context (the part of pixel memory that holds one
    /// region).
    pub relative: bool,
    /// True if the bit field holds a two's complement number, which is then sign-extended.
    pub signed: bool,
}

const SIGNED: u32 = 1 << 15;
const RELATIVE: u32 = 1 << 14;

impl Operand {
    /// Returns an unsigned bit field whose address counts from the first bit of the selected context (the part of pixel
    /// memory that holds one region).
    pub const fn context(address: u8, width: u8) -> Self {
        Self { address, width, relative: true, signed: false }
    }

    /// Returns an unsigned bit field of pixel memory at an absolute address, 0 to 207.
    pub const fn absolute(address: u8, width: u8) -> Self {
        Self { address, width, relative: false, signed: false }
    }

    /// Returns this bit field, interpreted as a two's complement number.
    #[must_use]
    pub const fn signed(self) -> Self {
        Self { signed: true, ..self }
    }

    /// Returns the `width` bits of this bit field from its bit `low` on. The result is signed if this bit field is
    /// signed.
    #[must_use]
    pub const fn part(self, low: u8, width: u8) -> Self {
        Self { address: self.address + low, width, ..self }
    }

    pub const fn to_bits(self) -> u32 {
        let flags = (self.signed as u32) << 15 | (self.relative as u32) << 14;
        flags | ((self.width as u32 - 1) & 63) << 8 | self.address as u32
    }

    pub const fn from_bits(bits: u32) -> Self {
        Self {
            address: bits as u8,
            width: (bits >> 8 & 63) as u8 + 1,
            relative: bits & RELATIVE != 0,
            signed: bits & SIGNED != 0,
        }
    }
}
