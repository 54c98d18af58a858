//! Two buffers of whole regions: what a display needs that swaps at its ticks.

use image::{Rgb, RgbImage};
use pxpl5_sim::Time;
use pxpl5_wire::{Body, RegionId, RegionPixels, Word, read_swap_request};
use std::collections::BTreeMap;

/// A region as far as its messages have arrived.
#[derive(Clone, Debug)]
struct Arriving {
    pixels: RegionPixels,
    arrived: u32,
    first_part_at: Time,
}

type Regions = BTreeMap<RegionId, Arriving>;

/// Two buffers for one surface, of which one is shown.
///
/// **Not modelled:** pixels that arrive while they are lit; whoever needs them keeps the times of all messages, as the
/// NTSC frame buffer does.
#[derive(Clone, Debug, Default)]
pub struct DoubleBuffer {
    buffers: [Regions; 2],
    shown: u8,
    /// What was shown before the last tick.
    scanned: Regions,
    /// The last request, and when it arrived.
    requested: Option<(Time, u8)>,
}

/// What a message was to a [`DoubleBuffer`].
#[derive(Clone, Debug)]
pub enum BufferReceipt {
    /// The last message of a region, the first of which arrived at this time.
    Region(RegionPixels, Time),
    /// Another message of a region, or a request to swap.
    Part,
    /// Nothing that it can use.
    Fault,
}

impl DoubleBuffer {
    /// Takes a message that arrives at `now`.
    pub fn receive(&mut self, body: Body, now: Time) -> BufferReceipt {
        match body {
            Body::Pixels(pixels) => self.receive_pixels(pixels, now),
            Body::Words(words) => self.receive_request(&words, now),
            Body::Commands(_) => BufferReceipt::Fault,
        }
    }

    fn receive_pixels(&mut self, pixels: RegionPixels, now: Time) -> BufferReceipt {
        let Some(buffer) = self.buffers.get_mut(usize::from(pixels.target.buffer)) else { return BufferReceipt::Fault };
        let fresh = Arriving { pixels, arrived: 0, first_part_at: now };
        let region = buffer.entry(fresh.pixels.target.region).or_insert_with(|| fresh.clone());
        if region.pixels.target != fresh.pixels.target || region.arrived == region.pixels.parts {
            *region = fresh;
        }
        region.arrived += 1;
        if region.arrived < region.pixels.parts {
            return BufferReceipt::Part;
        }
        BufferReceipt::Region(region.pixels.clone(), region.first_part_at)
    }

    fn receive_request(&mut self, words: &[Word], now: Time) -> BufferReceipt {
        let asked_for = read_swap_request(words).filter(|buffer| usize::from(*buffer) < self.buffers.len());
        let Some(buffer) = asked_for else { return BufferReceipt::Fault };
        self.requested = Some((now, buffer));
        BufferReceipt::Part
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
    pub fn picture(&self, width: u32, height: u32) -> RgbImage {
        picture_of(&self.buffers[usize::from(self.shown)], width, height)
    }

    /// What was shown until the last tick, in the same way.
    #[must_use]
    pub fn scanned_picture(&self, width: u32, height: u32) -> RgbImage {
        picture_of(&self.scanned, width, height)
    }
}

fn picture_of(regions: &Regions, width: u32, height: u32) -> RgbImage {
    let mut picture = RgbImage::new(width, height);
    for (id, region) in regions {
        let [left, top, region_width, _] = region.pixels.target.grid.rectangle(*id);
        for (i, word) in (0..).zip(region.pixels.image.pixels().iter()) {
            let [_, red, green, blue] = word.to_be_bytes();
            if let Some(pixel) = picture.get_pixel_mut_checked(left + i % region_width, top + i / region_width) {
                *pixel = Rgb([red, green, blue]);
            }
        }
    }
    picture
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_wire::swap_request;

    #[test]
    fn a_request_takes_effect_at_a_tick_after_it_and_not_at_its_own_instant() {
        let mut buffers = DoubleBuffer::default();
        buffers.receive(Body::Words(swap_request(1)), Time(100));
        assert_eq!(buffers.swap(Time(100)), None);
        assert_eq!(buffers.swap(Time(101)), Some(1));
        assert_eq!(buffers.swap(Time(102)), None, "once");
    }

    #[test]
    fn a_third_buffer_is_a_fault() {
        let mut buffers = DoubleBuffer::default();
        assert!(matches!(buffers.receive(Body::Words(swap_request(2)), Time(1)), BufferReceipt::Fault));
    }
}
