//! Address recalculation pipeline: a display that decides at scan-out which texel around the head a pixel is.
//!
//! ```text
//!                     latched orientation
//!                              |
//!  beam -> [ lens table ] -> [ 3 x 3 ] -> [ face ] -> [ divide x 2 ] -> [ address ] --+--> memory 0 --+
//!                                                                                     +--> memory 1 --+--> [ nearest ]
//!  ring --map, regions with depth, swap request--> port k of memory k                 +--> ...      --+        |
//!  host --nine words--> [ orientation register ]                                      +--> background --> [ interpolate ] -> light
//! ```
//!
//! The renderer draws all that surrounds the eye onto six faces of a cube. When a pixel is wanted, its viewing vector is turned by
//! the newest orientation and made into an address in the faces: a turn of the head needs no rendering.
//!
//! # Behaviour, in the order of the signal
//!
//! 1. **Table.** For each pixel a unit vector in signed words, through the [`Lens`]: flat, radial, equidistant, or from a
//!    reader. A lens that folds the picture over itself is refused.
//! 2. **Latch.** [`OrientationLatch`] takes matrices by the host's own port
//!    ([`AddressRecalculationPipeline::load_orientation`]) or over the ring ([`orientation_message`]); what is no rotation is
//!    refused and counted, and the last good one stays. It is read all stages before the first visible pixel of a field or line,
//!    or before each pixel ([`Latch`]).
//! 3. **Turn.** Nine products and six sums, kept in full.
//! 4. **Face.** The longest component, on ties x before y before z ([`CubeFace`]).
//! 5. **Divide.** (1 + u) / 2 and (1 + v) / 2, a bit a stage, rounded down, all ones for 1.
//! 6. **Address.** Quotient times face, half of the quotient's last bit added, is the place between four texels: the upper bits are
//!    the texel, the next ones the fractions, rounded. The four lie in four banks, so that one access reads them all. Without guard
//!    texels one beyond an edge is its neighbour's, and the one beyond a corner the mean of the other three ([`Footprint`]).
//! 7. **Compose.** Of each texel the nearest of all memories, the lowest memory on ties; what is farthest is empty and shows the
//!    background memory, or the background colour ([`Composition`]).
//! 8. **Interpolate.** Weights are products of the two fractions; halves are rounded up.
//!
//! # Updates
//!
//! A memory's update begins with a map of the regions that come ([`begin_update`]); the six faces lie one under the other in the
//! grid of [`region_grid`]. A region comes in 32 messages, its 16,384 colours before its 16,384 depths of 24 bits; with 16 + 16
//! bits in 16 messages, depth in the upper half of a word. The [`PixelSource`](pxpl5_wire::PixelSource) of a region gives all
//! these words. A request to swap takes effect at the first retrace after it that finds all of them there, so nothing half-drawn is
//! ever shown; retraces that an update misses are counted, and how late it was ([`MemoryStats`]). Memories that exchanged objects
//! swap together or not at all ([`swap_together`]).
//!
//! Nothing is looked up before somebody looks; then only those regions are computed that the field's pixels read.
//!
//! # Timing
//!
//! All numbers stand in [`ArpTiming`] and [`ScanTiming`]; [`Scan`] gives the exact instants.
//!
//! | instant | time |
//! |---|---|
//! | a pixel lights | as in the NTSC frame buffer |
//! | its texels are read | 2 + ceil(log2 n) stages before, n memories |
//! | its orientation is latched | 8 + 16 + ceil(log2 n) stages before it, its line's or its field's first pixel: 650 ns for n = 4 |
//!
//! # Two of everything
//!
//! [`literal`] is the definition: registers of every stage, clock by clock, partial products, restoring dividers, banks. [`Lookup`]
//! takes 64 pixels at a time in doubles, which are exact for these words, and gives the same bits; tests/equal.rs holds them
//! together.
//!
//! # Not modelled
//!
//! Electronics below stages; colours of the lens; a pixel period that four reads of every memory do not fit in (bank conflicts
//! are counted); blanking so short that the first texels of a field are read before its retrace.
//!
//! # Sources
//!
//! RP93 = Regan and Pose, VRAIS 93; RP94 = the same, SIGGRAPH 94; RPM = the same, *Display Memory Access Issues*; CPR05 = Chow,
//! Pose and Regan, ACSC 2005. Word lengths, stages, face sizes and lenses are not printed and assumed here.

mod address;
mod batch;
mod composition;
mod config;
mod display;
mod error;
mod face;
mod field;
mod lens;
pub mod literal;
mod lookup;
mod memory;
mod orientation;
mod protocol;
mod scan;
mod texel;
mod timing;

pub use address::{AddressUnit, Footprint};
pub use composition::{Composition, CompositionOrder};
pub use config::ArpConfig;
pub use display::AddressRecalculationPipeline;
pub use error::ArpError;
pub use face::{CubeFace, FaceGeometry, TexelAddress, Vector};
pub use lens::{Lens, LensTable, Picture};
pub use lookup::{LookStats, Lookup};
pub use memory::{DisplayMemory, MemoryStats};
pub use orientation::{MatrixWords, Orientation, OrientationLatch};
pub use protocol::{begin_update, face_region, orientation_message, region_grid, swap_together};
pub use scan::{Latch, Scan};
pub use texel::{DEPTH_FARTHEST, FaceSet, TexelFormat};
pub use timing::{ArpTiming, ScanTiming};
