//! Drawing of slices by the renderers of Pixel-Planes 5, an addition **beyond the SpatialGL paper**. The function that
//! clips a triangle to a slice is a quadratic on the triangle's plane, and its zeros form a hyperbola. The multiplier
//! trees of the renderers can evaluate quadratics at all pixels.
//!
//! ```text
//!  corners of a slice --snap to 1/16 px--> SliceTriangle (38 words, 238 clocks) --ring--> 36 regions of 128 x 128 pixels
//!                                                                                            |
//!  bounds of renderers, ring, processors <--counted clocks and words---------------- colours of each region
//! ```
//!
//! The emulated pixel arrays draw the slices, and their instructions determine the clocks. Two methods compute the
//! number of volumes per second. [`SliceBounds`] has the time that each part of the machine needs if the part never
//! waits. [`simulate()`] sends the messages of the volume through the ring and the boards, event by event, and is never
//! faster than the bounds.

mod bounds;
mod command;
mod halftone;
mod renderer;
mod simulation;
mod traffic;

pub use bounds::{BoundRow, SliceBounds};
pub use command::{CLIP_FRACTION_BITS, SliceCorner, SliceTriangle};
pub use halftone::{halftone_clocks, halftone_program, halftone_words, lit_field, threshold_field};
pub use renderer::{ArrayKind, PixelPlanesRenderer, RendererWork, SliceLoad, supported};
pub use simulation::{SimulatedRow, simulate};
pub use traffic::SliceTraffic;
