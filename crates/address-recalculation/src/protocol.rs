//! The messages that a display memory accepts besides pixels.
//!
//! ```text
//! BEGIN    buffer  bit i: region i will arrive   makes all regions of the buffer empty
//! SWAP     buffer                                shows the buffer when all its regions have arrived (swap_request)
//! TOGETHER buffer  bit k: memory k               as SWAP, but together with all these memories or not at all
//! MATRIX   nine words, row by row                an orientation, in single precision
//! ```

use crate::face::{CubeFace, Vector};
use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::{REGION_SIZE, RegionGrid, RegionId, Word, read_swap_request};
use std::sync::Arc;

const BEGIN: Word = 0x0041_5042;

const TOGETHER: Word = 0x0041_5054;

const MATRIX: Word = 0x0041_504D;

/// Returns the division of six faces into regions of 128 x 128 texels. The faces lie one below the other, in the order
/// of their indices.
pub const fn region_grid(face_texels: u32) -> RegionGrid {
    let height = face_texels * CubeFace::ALL.len() as u32;
    RegionGrid { width: face_texels, height, region_width: REGION_SIZE, region_height: REGION_SIZE }
}

/// Returns the index of the region at a column and row of regions on a face. Returns `None` outside the face.
pub const fn face_region(face_texels: u32, face: CubeFace, column: u32, row: u32) -> Option<RegionId> {
    let across = face_texels / REGION_SIZE;
    if column >= across || row >= across {
        return None;
    }
    Some(RegionId(((face as u32 * across + row) * across + column) as u16))
}

/// Returns the message that begins an update of a buffer. `regions` are the regions that will arrive. All other regions
/// will be empty.
pub fn begin_update(face_texels: u32, buffer: u8, regions: &[RegionId]) -> Arc<[Word]> {
    let count = region_grid(face_texels).regions();
    let mut words = vec![0; 2 + count.div_ceil(Word::BITS) as usize];
    words[0] = BEGIN;
    words[1] = buffer.into();
    for region in regions.iter().map(|region| u32::from(region.0)).filter(|region| *region < count) {
        words[2 + (region / Word::BITS) as usize] |= 1 << (region % Word::BITS);
    }
    words.into()
}

/// Returns the message that requests to show a buffer together with buffers of other memories. All memories of the bit
/// mask `memories` swap at the first retrace at which all are ready.
///
/// Bit k of `memories` stands for memory k.
pub fn swap_together(buffer: u8, memories: u8) -> Arc<[Word]> {
    [TOGETHER, buffer.into(), memories.into()].into()
}

/// Returns the message that sets the orientation. `rows` is the matrix from head axes to world axes.
pub fn orientation_message(rows: [Vector; 3]) -> Arc<[Word]> {
    let components = rows.into_iter().flatten().map(|component| (component as f32).to_bits());
    [MATRIX].into_iter().chain(components).collect()
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum ArpMessage {
    Begin {
        buffer: u8,
        regions: Vec<u16>,
    },
    /// Requests to show a buffer at the same retrace as buffers of other memories. Bit k of `together` stands for
    /// memory k. If `together` is 0, the memory swaps alone.
    Swap {
        buffer: u8,
        together: u8,
    },
    /// Sets an orientation that is not yet checked.
    Matrix([Vector; 3]),
}

/// Decodes a message for faces of `face_texels` texels.
///
/// # Errors
///
/// [`SettingError`] describes the expected and the found content.
pub(crate) fn read(words: &[Word], face_texels: u32) -> Result<ArpMessage, SettingError> {
    // Swap requests have the same words for all displays.
    if let Some(buffer) = read_swap_request(words) {
        return Ok(ArpMessage::Swap { buffer: checked_buffer(buffer.into())?, together: 0 });
    }
    match words {
        [BEGIN, buffer, map @ ..] => {
            let buffer = checked_buffer(*buffer)?;
            Ok(ArpMessage::Begin { buffer, regions: announced(map, region_grid(face_texels).regions())? })
        }
        [TOGETHER, buffer, memories] => {
            let together = u8::try_from(*memories).map_err(|_| wrong("a set of 8 memories", memories))?;
            Ok(ArpMessage::Swap { buffer: checked_buffer(*buffer)?, together })
        }
        [MATRIX, components @ ..] => {
            let components: [Word; 9] = components.try_into().map_err(|_| wrong("9 components", &components.len()))?;
            // The components are single-precision numbers, row by row.
            let row = |first: usize| [0, 1, 2].map(|i| f64::from(f32::from_bits(components[first + i])));
            Ok(ArpMessage::Matrix([row(0), row(3), row(6)]))
        }
        _ => Err(wrong("BEGIN, SWAP, TOGETHER or MATRIX", &format!("{:#x?}", words.first()))),
    }
}

fn wrong(expected: &str, found: &dyn std::fmt::Display) -> SettingError {
    SettingError::value("message", expected, found)
}

fn checked_buffer(buffer: Word) -> Result<u8, SettingError> {
    u8::try_from(buffer).ok().filter(|buffer| *buffer < 2).ok_or_else(|| wrong("buffer 0 or 1", &buffer))
}

/// Returns the regions of a map, which must have exactly one bit for each region.
fn announced(map: &[Word], count: u32) -> Result<Vec<u16>, SettingError> {
    if map.len() != count.div_ceil(Word::BITS) as usize {
        return Err(wrong(&format!("a map of {count} regions"), &format!("{} words", map.len())));
    }
    // Bits are numbered from the lowest bit of the first word.
    let bits = (0..map.len() as u32 * Word::BITS)
        .filter(|bit| map[(bit / Word::BITS) as usize] >> (bit % Word::BITS) & 1 == 1);
    let regions: Vec<u16> = bits.map(|bit| bit as u16).collect();
    match regions.last() {
        Some(last) if u32::from(*last) >= count => {
            Err(wrong(&format!("a map of {count} regions"), &format!("region {last}")))
        }
        _ => Ok(regions),
    }
}
