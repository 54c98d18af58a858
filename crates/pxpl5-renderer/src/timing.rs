//! All numbers of the renderer board: times, rates and sizes.
//!
//! The table contains an execution time in clocks for each command. By default, this time equals the sum of the clocks
//! of the instructions in the command's program, in the layout of Rendering Control ([`CommandKind::clocks`]). A test
//! checks this equality. The times are nevertheless separate numbers of the table, so that experiments can change them.

use crate::command::CommandKind;
use pxpl5_sim::{Clock, Cycles, Span};

pxpl5_sim::parameters::parameter_table! {
    /// Times and sizes of a renderer board.
    pub struct RendererTiming {
        /// Clock rate of the controller and the array.
        clock_hz: 40_000_000, "Hz", Published, 40000000..=40000000 in 1_000..=MAX, "F89";
        /// Execution time of a triangle with interpolated colour, in each region to which it is sent.
        triangle_clocks: 258, "clocks", Derived, 250..=300 in 0..=MAX, "its program; no paper prints a rate for interpolated colours";
        /// Execution time of a triangle with interpolated normals, in each region to which it is sent.
        phong_triangle_clocks: 292, "clocks", Derived, 250..=300 in 0..=MAX, "its program; the design rate of 150,000 Phong triangles/s (F89) is 267 clocks, and a count of bits gives 262 to 292";
        /// Execution time of a sphere with interpolated colour. In the layout of Slats, the program of the command
        /// takes 748 clocks.
        sphere_clocks: 810, "clocks", Derived, 318..=810 in 0..=MAX, "its program, with an exact root; a paraboloid takes 318";
        /// Execution time of a sphere with interpolated normals, in each region to which it is sent.
        phong_sphere_clocks: 504, "clocks", Derived, 268..=504 in 0..=MAX, "its program, with an exact root; a paraboloid takes 268";
        /// Execution time of the command that selects a context (part of pixel memory for one region) and the region's
        /// position on the screen.
        select_clocks: 6, "clocks", Derived, 1..=64 in 0..=MAX, "its program: one instruction";
        /// Execution time of the command that stores the background colour and the farthest depth in all pixels.
        clear_clocks: 62, "clocks", Derived, 16..=256 in 0..=MAX, "its program: one clock for each bit of colour and depth, and the fetches";
        /// Execution time of the command that shades a region after its last primitive.
        shade_clocks: 3_790, "clocks", Derived, 3_790..=8_000 in 0..=MAX, "its program with one light takes 95 us";
        /// Time to move one 32-bit block of all pixels to or from the backing store.
        backing_block_clocks: 2_040, "clocks", Assumed, 1024..=4096 in 0..=MAX, "51 us, about 64 chips x 4 bits a clock";
        /// Size of the backing store of each pixel, in bits.
        backing_bits: 4_096, "bits", Published, 4_096..=4_096 in 0..=MAX, "F89: video memory beside each pixel's 208 bits";
        /// Number of bits of each pixel's backing store that a finished region occupies until the region is copied.
        kept_bits: 32, "bits", Derived, 32..=256 in 1..=MAX, "24 bits of colour, moved in blocks of 32 bits (F89); 256 if all 208 bits of a pixel were kept";
        /// Capacity of the input FIFO in words.
        fifo_words: 1_024, "words", Assumed, 256..=2048 in 128..=1_048_576, "no source gives the value. FIFO chips of 9 bits that were sold from 1988 to 1990 had 256, 512, 1,024 or 2,048 words (recollected), and a port of 32 bits needs four of them. 1,024 words is the smallest chip that takes a whole message of maximum size, which TR94 recommends to senders; a smaller FIFO would hold the message's channel until the array has worked through the rest. docs/interpretations.md has the other sizes";
    }
}

impl RendererTiming {
    /// Returns the time to move one 32-bit block of all pixels to or from the backing store.
    pub fn backing_block(&self) -> Span {
        Clock::from_hz(self.clock_hz).map_or(Span::ZERO, |clock| clock.span(Cycles(self.backing_block_clocks)))
    }

    /// Returns the number of finished regions for which the backing store has room: 128 with the default values.
    pub const fn backing_regions(&self) -> u64 {
        match self.backing_bits.checked_div(self.kept_bits) {
            Some(regions) => regions,
            None => 0,
        }
    }

    /// Returns the execution time of one command. Returns `None` for the copy of a region, because the duration of a
    /// copy depends on the frame buffer.
    pub fn span(&self, kind: CommandKind) -> Option<Span> {
        let clocks = match kind {
            CommandKind::SelectRegion => self.select_clocks,
            CommandKind::Clear => self.clear_clocks,
            CommandKind::Triangle => self.triangle_clocks,
            CommandKind::PhongTriangle => self.phong_triangle_clocks,
            CommandKind::Sphere => self.sphere_clocks,
            CommandKind::PhongSphere => self.phong_sphere_clocks,
            CommandKind::Shade => self.shade_clocks,
            // The transfer of the block continues in parallel with the array.
            CommandKind::StoreBacking | CommandKind::LoadBacking => self.select_clocks,
            CommandKind::WaitBacking => self.backing_block_clocks,
            CommandKind::CopyRegion => return None,
        };
        Clock::from_hz(self.clock_hz).map(|clock| clock.span(Cycles(clocks)))
    }
}
