//! Slices drawn by the renderers of Pixel-Planes 5, which is **beyond the paper**: the hyperbola on a triangle's plane is a quadratic,
//! and the renderers' trees evaluate quadratics.
//!
//! ```text
//!  corners of a slice --snap to 1/16 px--> SliceTriangle (38 words, 238 clocks) --ring--> 36 regions of 128 x 128 pixels
//!                                                                                            |
//!  bounds of renderers, ring, processors <--counted clocks and words---------------- colours of each region
//! ```
//!
//! What is drawn is drawn by the emulated pixel arrays, and its clocks are those of the instructions. Volumes a second are
//! **bounds** of each part by itself: no event of the ring or of a processor is simulated here.

mod bounds;
mod command;
mod renderer;

pub use bounds::{BoundRow, SliceBounds};
pub use command::{CLIP_FRACTION_BITS, SliceCorner, SliceTriangle};
pub use renderer::{ArrayKind, PixelPlanesRenderer, RendererWork, supported};
