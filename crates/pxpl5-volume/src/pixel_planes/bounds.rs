//! Volumes per second as a function of the numbers of renderers and graphics processors. Each part of the machine gives
//! an upper bound of this rate.

use super::renderer::RendererWork;
use super::traffic::SliceTraffic;
use pxpl5_gp::GpTiming;
use pxpl5_renderer::RendererTiming;
use pxpl5_renderer::isa::timing::CLOCK_HZ;
use pxpl5_ring::RingTiming;
use pxpl5_wire::MAX_MESSAGE_WORDS;
use serde::Serialize;
use spatialgl::{Tiling, VolumeFrame};

/// The time that each part of the machine needs for a volume if the part never waits, in milliseconds.
///
/// ```text
/// renderers   (clocks of clears, triangles and halftones + copies x backing block) / 40 MHz / renderers
/// ring in     (command words + overhead of messages) t_word / channels that may end at renderers
/// ring out    (words of occupied tiles + overhead of one message each) t_word / channels
/// port        (the same words) t_word: the display takes one message after the other
/// processors  (slice triangles t_triangle + commands t_bin_entry) / processors
/// ```
///
/// A triangle of a slice takes a processor as long as a triangle of a frame. It is assumed that the six coefficients of
/// the clip function (a hyperbola) take as long as the coefficients of the depth.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct SliceBounds {
    /// Work of the renderers for the volume.
    pub work: RendererWork,
    /// Number of tiles sent.
    pub tiles: u64,
    /// Number of ring words of a tile.
    pub tile_words: u64,
    /// Number of regions with at least one tile to send. Each such region is first copied to the backing store, and its
    /// renderer waits for this copy.
    pub copies: u64,
}

/// The time that each part of a machine with certain numbers of boards needs for a volume. Each of these times is a
/// lower bound of the time for the volume.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BoundRow {
    /// Number of renderers among which the slices are divided.
    pub renderers: u64,
    /// Number of graphics processors among which the triangles are divided.
    pub processors: u64,
    /// Times in milliseconds: renderers, ring (both directions), the display's port, processors.
    pub ms: [f64; 4],
    /// Volumes per second if only the slowest part limits this rate.
    pub volumes_hz: f64,
    /// Name of the slowest part: `renderers`, `ring`, `port` or `processors`. If several parts are equally slow, the
    /// first of these parts is named.
    pub limited_by: &'static str,
}

impl SliceBounds {
    /// Computes the counts of a volume that the renderers have drawn. A tile that is occupied in one slice is sent for
    /// every slice of its batch. `traffic` is `None` if the tiles cannot be sent, and then no region is copied.
    pub fn of(work: RendererWork, frame: &VolumeFrame, tiling: Tiling, traffic: Option<&SliceTraffic>) -> Self {
        let tile_words = tiling.grid(frame.planes.size()).words(0);
        let packed = frame.stats.pixels_packed / 8 / tile_words.max(1);
        let tiles = traffic.map_or(packed, SliceTraffic::tiles);
        Self { work, tiles, tile_words, copies: traffic.map_or(0, SliceTraffic::copies) }
    }

    /// Returns the time that each part of a machine needs for a volume. The machine has these numbers of renderers and
    /// graphics processors, each 1 or more.
    pub fn with(&self, renderers: u64, processors: u64) -> BoundRow {
        let clocks = self.work.clocks + self.copies * RendererTiming::PAPERS.backing_block_clocks;
        let renderer_ms = clocks as f64 / CLOCK_HZ as f64 * 1e3 / renderers.max(1) as f64;
        let gp = GpTiming::PAPERS;
        let gp_ns = self.work.triangles * gp.triangle_ns + self.work.commands * gp.bin_entry_ns;
        let gp_ms = gp_ns as f64 / 1e6 / processors.max(1) as f64;
        let ms = [renderer_ms, self.ring_ms(), self.port_ms(), gp_ms];
        let names = ["renderers", "ring", "port", "processors"];
        let slowest = (1..ms.len()).fold(0, |slowest, part| if ms[part] > ms[slowest] { part } else { slowest });
        BoundRow { renderers, processors, ms, volumes_hz: 1e3 / ms[slowest], limited_by: names[slowest] }
    }

    /// Returns the time that the ring needs for a volume, in milliseconds. Commands and tiles share the ring's
    /// channels. Transfers to all renderers together can occupy at most six channels.
    fn ring_ms(&self) -> f64 {
        let ring = RingTiming::PAPERS;
        let messages = self.work.command_words.div_ceil(u64::from(MAX_MESSAGE_WORDS)).max(self.work.regions);
        let words_in = self.work.command_words + messages * ring.overhead_words;
        let alone = milliseconds(words_in) / ring.fifo_channels as f64;
        let together = milliseconds(words_in + self.words_out()) / ring.channels as f64;
        alone.max(together)
    }

    /// Returns the time that the display's port needs for a volume, in milliseconds. The port receives one message at a
    /// time.
    fn port_ms(&self) -> f64 {
        milliseconds(self.words_out())
    }

    /// Returns the number of ring words of all occupied tiles, including the overhead of each message.
    fn words_out(&self) -> u64 {
        self.tiles * (self.tile_words + RingTiming::PAPERS.overhead_words)
    }
}

fn milliseconds(words: u64) -> f64 {
    (words * RingTiming::PAPERS.word_ns) as f64 / 1e6
}
