//! Two buffers of whole regions: what a display needs that swaps at its ticks.

use image::{Rgb, RgbImage};
use pxpl5_sim::Time;
use pxpl5_wire::{Body, MAX_MESSAGE_WORDS, RegionId, RegionPixels, Word, read_swap_request};
use std::collections::BTreeMap;

/// A region as far as its messages have arrived.
#[derive(Clone, Debug)]
struct Arriving {
    pixels: RegionPixels,
    /// Left, top, width and height on the surface.
    rectangle: [u32; 4],
    /// One bit a message.
    arrived: u32,
    first_part_at: Time,
}

impl Arriving {
    const fn is_complete(&self) -> bool {
        self.arrived.count_ones() == self.pixels.parts
    }
}

type Regions = BTreeMap<RegionId, Arriving>;

/// Two buffers for one surface, of which one is shown.
///
/// **Not modelled:** pixels that arrive while they are lit; whoever needs them keeps the times of all messages, as the
/// NTSC frame buffer does.
#[derive(Clone, Debug)]
pub struct DoubleBuffer {
    width: u32,
    height: u32,
    buffers: [Regions; 2],
    shown: u8,
    /// What was shown before the last tick.
    scanned: Regions,
    /// The last request, and when it arrived.
    requested: Option<(Time, u8)>,
    faults: u64,
    first_fault: Option<String>,
}

/// What a message was to a [`DoubleBuffer`].
#[derive(Clone, Debug)]
pub enum BufferReceipt {
    /// The last message of a region, the first of which arrived at this time.
    Region(RegionPixels, Time),
    /// Another message of a region, or a request to swap.
    Part,
    /// Nothing that it can use: see [`DoubleBuffer::faults`].
    Fault,
}

impl DoubleBuffer {
    /// Two empty buffers for a surface of so many pixels, of which the first is shown.
    #[must_use]
    pub const fn new(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            buffers: [Regions::new(), Regions::new()],
            shown: 0,
            scanned: Regions::new(),
            requested: None,
            faults: 0,
            first_fault: None,
        }
    }

    /// Takes a message that arrives at `now`.
    pub fn receive(&mut self, body: Body, now: Time) -> BufferReceipt {
        let receipt = match body {
            Body::Pixels(pixels) => self.receive_pixels(pixels, now),
            Body::Words(words) => self.receive_request(&words, now),
            Body::Commands(_) => Err("commands for a renderer".to_owned()),
        };
        receipt.unwrap_or_else(|reason| {
            self.faults += 1;
            self.first_fault.get_or_insert(reason);
            BufferReceipt::Fault
        })
    }

    /// Messages that it could not use, and what was wrong with the first.
    #[must_use]
    pub fn faults(&self) -> (u64, Option<&str>) {
        (self.faults, self.first_fault.as_deref())
    }

    fn receive_pixels(&mut self, pixels: RegionPixels, now: Time) -> Result<BufferReceipt, String> {
        let RegionPixels { target, part, parts, .. } = pixels;
        let place = target.grid.rectangle_within(target.region, self.width, self.height);
        let outside = || {
            let (region, grid) = (target.region.0, target.grid);
            format!("region {region} of {grid:?} does not lie in {} x {} or exceeds 128 x 128", self.width, self.height)
        };
        let rectangle = place.ok_or_else(outside)?;
        let expected = (rectangle[2] * rectangle[3]).div_ceil(MAX_MESSAGE_WORDS);
        if parts != expected || part >= parts {
            return Err(format!("expected one of {expected} messages of a region, found message {part} of {parts}"));
        }
        let buffer = self.buffers.get_mut(usize::from(target.buffer)).ok_or_else(|| no_such_buffer(target.buffer))?;
        let fresh = Arriving { pixels, rectangle, arrived: 0, first_part_at: now };
        let region = buffer.entry(target.region).or_insert_with(|| fresh.clone());
        if region.pixels.target != target || region.is_complete() {
            *region = fresh;
        }
        if region.arrived & 1 << part != 0 {
            return Err(format!("message {part} of region {} has arrived already", target.region.0));
        }
        region.arrived |= 1 << part;
        if region.is_complete() {
            return Ok(BufferReceipt::Region(region.pixels.clone(), region.first_part_at));
        }
        Ok(BufferReceipt::Part)
    }

    fn receive_request(&mut self, words: &[Word], now: Time) -> Result<BufferReceipt, String> {
        let buffer = read_swap_request(words).ok_or("words that are no request to swap")?;
        if usize::from(buffer) >= self.buffers.len() {
            return Err(no_such_buffer(buffer));
        }
        self.requested = Some((now, buffer));
        Ok(BufferReceipt::Part)
    }

    /// At a tick: shows the buffer that was asked for before (not at) this instant, if one was; which.
    pub fn swap(&mut self, now: Time) -> Option<u8> {
        self.scanned.clone_from(&self.buffers[usize::from(self.shown)]);
        let (_, buffer) = self.requested.take_if(|(asked_at, _)| *asked_at < now)?;
        self.shown = buffer;
        Some(buffer)
    }

    /// The buffer that is shown, with every region of which a message has arrived; black elsewhere.
    #[must_use]
    pub fn picture(&self) -> RgbImage {
        self.picture_of(&self.buffers[usize::from(self.shown)])
    }

    /// What was shown until the last tick, in the same way.
    #[must_use]
    pub fn scanned_picture(&self) -> RgbImage {
        self.picture_of(&self.scanned)
    }

    fn picture_of(&self, regions: &Regions) -> RgbImage {
        let mut picture = RgbImage::new(self.width, self.height);
        for region in regions.values() {
            let [left, top, width, height] = region.rectangle;
            let words = region.pixels.image.pixels();
            for (i, word) in (0..width * height).zip(words.iter()) {
                let [_, red, green, blue] = word.to_be_bytes();
                picture.put_pixel(left + i % width, top + i / width, Rgb([red, green, blue]));
            }
        }
        picture
    }
}

fn no_such_buffer(found: u8) -> String {
    format!("expected buffer 0 or 1, found {found}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_wire::swap_request;

    #[test]
    fn a_request_takes_effect_at_a_tick_after_it_and_not_at_its_own_instant() {
        let mut buffers = DoubleBuffer::new(640, 480);
        buffers.receive(Body::Words(swap_request(1)), Time(100));
        assert_eq!(buffers.swap(Time(100)), None);
        assert_eq!(buffers.swap(Time(101)), Some(1));
        assert_eq!(buffers.swap(Time(102)), None, "once");
    }

    #[test]
    fn a_third_buffer_is_a_fault() {
        let mut buffers = DoubleBuffer::new(640, 480);
        let receipt = buffers.receive(Body::Words(swap_request(2)), Time(1));
        assert!(matches!(receipt, BufferReceipt::Fault));
        assert_eq!(buffers.faults(), (1, Some("expected buffer 0 or 1, found 2")));
    }
}
