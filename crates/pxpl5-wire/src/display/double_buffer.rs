//! A double buffer of whole regions, for displays that swap buffers at the start of a period.

use crate::{Body, MAX_MESSAGE_WORDS, RegionId, RegionPixels, Word, read_swap_request};
use image::{Rgb, RgbImage};
use pxpl5_sim::Time;
use std::collections::BTreeMap;

#[derive(Clone, Debug)]
struct PartialRegion {
    pixels: RegionPixels,
    /// Left, top, width and height of the region on the surface, in pixels.
    rectangle: [u32; 4],
    /// Bit set of the messages that have arrived. Bit `n` stands for message `n` of the region.
    arrived: u32,
    first_part_at: Time,
}

impl PartialRegion {
    const fn is_complete(&self) -> bool {
        self.arrived.count_ones() == self.pixels.parts
    }
}

type Regions = BTreeMap<RegionId, PartialRegion>;

/// Two buffers for one surface.
///
/// One of the buffers is shown.
///
/// **Not modelled:** pixels that arrive in the shown buffer during the scan. A display with such pixels must keep the
/// arrival times of all messages, like the NTSC frame buffer.
#[derive(Clone, Debug)]
pub struct DoubleBuffer {
    width: u32,
    height: u32,
    buffers: [Regions; 2],
    shown: u8,
    /// Contents of the buffer that was shown until the last tick of the display's clock.
    scanned: Regions,
    /// Arrival time of the last swap request, and the number of the requested buffer.
    requested: Option<(Time, u8)>,
    faults: u64,
    first_fault: Option<String>,
}

/// The effect of an arriving message on a [`DoubleBuffer`].
#[derive(Clone, Debug)]
pub enum BufferReceipt {
    /// The message completed its region. The time is the arrival of the region's first message.
    Region(RegionPixels, Time),
    /// The message was a swap request, or a message of a region that is still incomplete.
    Part,
    /// The buffer cannot use the message. [`DoubleBuffer::faults`] counts such messages.
    Fault,
}

impl DoubleBuffer {
    /// Makes two empty buffers for a surface of `width` x `height` pixels. Buffer 0 is shown.
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

    /// Handles a message that arrives at time `now`.
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

    /// Returns the number of messages that the buffer could not use, and the reason for the first of these messages.
    pub fn faults(&self) -> (u64, Option<&str>) {
        (self.faults, self.first_fault.as_deref())
    }

    fn receive_pixels(&mut self, pixels: RegionPixels, now: Time) -> Result<BufferReceipt, String> {
        let RegionPixels { target, part, parts, .. } = pixels;
        // The region must lie on the surface and have the right number of messages.
        let place = target.grid.rectangle_within(target.region, self.width, self.height);
        let outside = || {
            let (region, grid) = (target.region.0, target.grid);
            format!("region {region} of {grid:?} does not lie in {} x {} or exceeds 128 x 128", self.width, self.height)
        };
        let rectangle = place.ok_or_else(outside)?;
        // The number of messages follows from the size of the region.
        let expected = (rectangle[2] * rectangle[3]).div_ceil(MAX_MESSAGE_WORDS);
        if parts != expected || part >= parts {
            return Err(format!("expected one of {expected} messages of a region, found message {part} of {parts}"));
        }
        let buffer = self.buffers.get_mut(usize::from(target.buffer)).ok_or_else(|| no_such_buffer(target.buffer))?;
        // The first message of a new copy replaces the earlier copy of the region.
        let fresh = PartialRegion { pixels, rectangle, arrived: 0, first_part_at: now };
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

    /// Shows the buffer that was requested last, and returns the number of this buffer. Returns `None` without a
    /// request. A request that arrives exactly at `now`, the time of the tick, has its effect at the next tick.
    pub fn swap(&mut self, now: Time) -> Option<u8> {
        // Keep the old picture, which was visible until this tick.
        self.scanned.clone_from(&self.buffers[usize::from(self.shown)]);
        let (_, buffer) = self.requested.take_if(|(asked_at, _)| *asked_at < now)?;
        self.shown = buffer;
        Some(buffer)
    }

    /// Returns the picture in the shown buffer. Incomplete regions are included. The picture is black where no region
    /// has arrived.
    pub fn picture(&self) -> RgbImage {
        self.picture_of(&self.buffers[usize::from(self.shown)])
    }

    /// Returns the picture that was shown until the last tick of the display's clock. The picture is black where no
    /// region has arrived.
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
    use crate::{CopyTarget, Lines, NodeId, PictureNumber, RegionGrid, swap_request};
    use std::sync::Arc;

    #[test]
    fn a_request_takes_effect_only_at_a_later_tick() {
        let mut buffers = DoubleBuffer::new(640, 480);
        buffers.receive(Body::Words(swap_request(1)), Time(100));
        assert_eq!(buffers.swap(Time(100)), None);
        assert_eq!(buffers.swap(Time(101)), Some(1));
        assert_eq!(buffers.swap(Time(102)), None, "once");
    }

    #[test]
    fn a_swap_request_for_a_third_buffer_is_a_fault() {
        let mut buffers = DoubleBuffer::new(640, 480);
        let receipt = buffers.receive(Body::Words(swap_request(2)), Time(1));
        assert!(matches!(receipt, BufferReceipt::Fault));
        assert_eq!(buffers.faults(), (1, Some("expected buffer 0 or 1, found 2")));
    }

    #[derive(Debug)]
    struct Plain(Word);

    impl crate::PixelSource for Plain {
        fn pixels(&self) -> Arc<[Word]> {
            vec![self.0; 64 * 32].into()
        }
    }

    /// Returns one of the two messages with the pixels of a region of 64 x 32 pixels.
    fn part(region: u16, part: u32, picture: u64, colour: Word) -> RegionPixels {
        let grid = RegionGrid { width: 100, height: 60, region_width: 64, region_height: 32 };
        let target = CopyTarget {
            frame_buffer: NodeId(1),
            buffer: 0,
            lines: Lines::Frame,
            grid,
            region: RegionId(region),
            picture: PictureNumber(picture),
        };
        RegionPixels { target, image: Arc::new(Plain(colour)), part, parts: 2 }
    }

    fn receive(buffers: &mut DoubleBuffer, pixels: RegionPixels, now: u64) -> BufferReceipt {
        buffers.receive(Body::Pixels(pixels), Time(now))
    }

    #[test]
    fn a_region_is_complete_with_its_last_message_and_replaced_by_a_newer_one() {
        let mut buffers = DoubleBuffer::new(100, 60);
        for (picture, colour) in [(1, 0x0010_2030), (2, 0x0040_5060)] {
            assert!(matches!(receive(&mut buffers, part(0, 1, picture, colour), 10 * picture), BufferReceipt::Part));
            let whole = receive(&mut buffers, part(0, 0, picture, colour), 10 * picture + 5);
            let BufferReceipt::Region(pixels, first) = whole else { panic!("{whole:?}") };
            assert_eq!((pixels.target.picture, first), (PictureNumber(picture), Time(10 * picture)));
            let [_, red, green, blue] = colour.to_be_bytes();
            let seen =
                RgbImage::from_fn(100, 60, |x, y| Rgb(if x < 64 && y < 32 { [red, green, blue] } else { [0; 3] }));
            assert_eq!(buffers.picture(), seen);
        }
        assert_eq!(buffers.scanned_picture(), RgbImage::new(100, 60), "no tick has been");
        buffers.swap(Time(99));
        assert_eq!(buffers.scanned_picture(), buffers.picture());
    }

    #[test]
    fn an_incomplete_region_is_replaced_by_the_next_picture() {
        let mut buffers = DoubleBuffer::new(100, 60);
        receive(&mut buffers, part(0, 0, 1, 1), 1);
        receive(&mut buffers, part(0, 0, 2, 2), 2);
        let whole = receive(&mut buffers, part(0, 1, 2, 2), 3);
        assert!(matches!(whole, BufferReceipt::Region(_, Time(2))), "{whole:?}");
    }

    #[test]
    fn messages_that_fit_no_region_are_faults() {
        let mut buffers = DoubleBuffer::new(100, 60);
        receive(&mut buffers, part(0, 0, 1, 1), 1);
        let wrong = [
            // Invalid messages: a repeated message, a wrong number of messages, and a message, a buffer and a region
            // that do not exist.
            part(0, 0, 1, 1),
            RegionPixels { parts: 3, ..part(0, 1, 1, 1) },
            part(0, 2, 1, 1),
            RegionPixels { target: CopyTarget { buffer: 2, ..part(0, 1, 1, 1).target }, ..part(0, 1, 1, 1) },
            part(4, 0, 1, 1),
        ];
        for (count, pixels) in (1..).zip(wrong) {
            assert!(matches!(receive(&mut buffers, pixels, 2), BufferReceipt::Fault));
            assert_eq!(buffers.faults(), (count, Some("message 0 of region 0 has arrived already")));
        }
    }
}
