//! Address recalculation pipeline: a display that finds the texel of each pixel at scan-out, in six faces around the
//! head.
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
//! The renderer draws the surroundings of the eye onto six faces of a cube. For each pixel, the display rotates the
//! viewing vector by the newest orientation and finds its address in the faces. This is why a rotation of the head
//! needs no rendering.
//!
//! # Stages, in the order of the signal
//!
//! 1. **Table.** Each pixel has a viewing vector of length 1, in signed words, which includes the effect of the
//!    [`Lens`]: flat, radial, equidistant, or from a file. A lens that shows two pixels in the same direction is
//!    refused.
//! 2. **Latch.** The orientation register ([`OrientationLatch`]) accepts matrices from the host's own port
//!    ([`AddressRecalculationPipeline::load_orientation`]) or over the ring ([`orientation_message`]). One that is not
//!    a rotation is refused and counted, and the previous matrix stays valid. The display reads (latches) the matrix
//!    once per field, per line or per pixel ([`Latch`]). It does so before the first pixel of the field or line,
//!    earlier by the duration of all stages.
//! 3. **Rotate.** Nine products and six sums rotate the vector. The results keep all bits.
//! 4. **Face.** The longest component selects the face. Among equally long components, x precedes y, and y precedes z
//!    ([`CubeFace`]).
//! 5. **Divide.** Dividers compute (1 + u) / 2 and (1 + v) / 2, one bit per stage. Results are rounded down, and 1
//!    becomes all ones.
//! 6. **Address.** The position is the quotient, plus half of its last bit, times the size of the face. Its upper bits
//!    select the texel, and the next bits, rounded, are the fractions. The four texels around it lie in four banks, so
//!    one access reads them all. Without guard texels, a texel beyond an edge belongs to the neighbouring face, and one
//!    beyond a corner is the mean of the other three ([`Footprint`]).
//! 7. **Compose.** For each texel, the memory with the nearest depth is selected, and among equal depths the one with
//!    the lowest index. A texel with the farthest depth is empty. If all are empty, the background memory or colour is
//!    visible ([`Composition`]).
//! 8. **Interpolate.** The weights are products of the two fractions. Halves are rounded up.
//!
//! # Updates
//!
//! An update begins with a map of the regions that will arrive ([`begin_update`]). The six faces lie one below the
//! other in the grid of [`region_grid`]. A region arrives in 32 messages: first its 16,384 colours, then its 16,384
//! depths of 24 bits. With 16 bits of colour and of depth it takes 16 messages, with the depth in the upper half of
//! each word. Its [`PixelSource`](pxpl5_wire::PixelSource) supplies all these words.
//!
//! A request to swap takes effect at the first later retrace at which all regions have arrived, so an incomplete update
//! is never visible. [`MemoryStats`] counts the retraces that it missed, and the delay until it is shown. Memories that
//! have exchanged objects swap together or not at all ([`swap_together`]).
//!
//! Pixels are computed only when a picture is read, and only for the regions that the field's pixels use.
//!
//! # Timing
//!
//! All numbers are in [`ArpTiming`] and [`ScanTiming`]. [`FaceScan`] computes the exact instants.
//!
//! | instant | time |
//! |---|---|
//! | a pixel is displayed | as in the NTSC frame buffer |
//! | its texels are read | 2 + ceil(log2 n) stages before its display, for n memories |
//! | its orientation is read (latched) | 8 + 16 + ceil(log2 n) stages before the display of the pixel, or of the first pixel of its line or field: 650 ns for n = 4 |
//!
//! # Reference model and fast model
//!
//! [`mod@reference`] simulates, clock by clock, the registers of every stage, partial products, restoring dividers and
//! banks. [`Lookup`] is fast: it processes 64 pixels at a time in doubles, which are exact for these word lengths.
//! tests/equal.rs checks that both give identical bits.
//!
//! # Not modelled
//!
//! - Electronics below the level of stages, and colour errors of the lens.
//! - Pixel periods too short for four reads of every memory. Bank conflicts are counted but cost no time.
//! - Blanking so short that the first texels of a field are read before its retrace.
//!
//! # Sources
//!
//! RP93 = Regan and Pose, VRAIS 93. RP94 = Regan and Pose, SIGGRAPH 94. RPM = Regan and Pose, *Display Memory Access
//! Issues*. CPR05 = Chow, Pose and Regan, ACSC 2005. Word lengths, stages, face sizes and lenses are not printed and
//! are assumed here.

mod address;
mod batch;
mod composition;
mod config;
mod display;
mod face;
mod field;
mod lens;
mod lookup;
mod memory;
mod orientation;
pub mod priority;
mod protocol;
pub mod reference;
mod scan;
mod texel;
mod timing;

pub use address::{AddressUnit, Footprint};
pub use composition::{Composition, CompositionOrder};
pub use config::ArpConfig;
pub use display::AddressRecalculationPipeline;
pub use face::{CubeFace, FaceGeometry, TexelAddress, Vector};
pub use lens::{Lens, LensPicture, LensTable};
pub use lookup::{Lookup, LookupStats};
pub use memory::{DisplayMemory, MemoryStats};
pub use orientation::{MatrixWords, Orientation, OrientationLatch};
pub use protocol::{begin_update, face_region, orientation_message, region_grid, swap_together};
pub use scan::{FaceScan, Latch};
pub use texel::{DEPTH_FARTHEST, FaceSet, TexelFormat};
pub use timing::{ArpTiming, ScanTiming};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
