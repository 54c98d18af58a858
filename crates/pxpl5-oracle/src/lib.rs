//! What should be on the screen: an ideal renderer of one process, against which every picture of the machine can be held.
//!
//! ```text
//!   DisplayList, FrameView --place_all--> Transform --gouraud, phong, sphere--> expressions of one primitive
//!                                                                                  |  at each pixel of its box
//!                            IdealPicture <-- nearest depth wins, ties are kept <--+
//! ```
//!
//! It takes the primitives one after the other in the order of the display list, sets each up as graphics processors do
//! ([`pxpl5_geometry`]), and evaluates its expressions at every pixel by itself, in the widths that a renderer has: edges
//! modulo 2^32, depth in the bits that the layout keeps, colour in 8 bits a component. There is no ring, no bin, no
//! pixel memory and no time, and nothing is shared with the pixel arrays of `pxpl5-renderer` but the formats of commands
//! that are written down there, which both follow.
//!
//! What remains open on the machine is which of two primitives wins that have the same depth to the last bit: the one
//! whose commands come first, which depends on the number of processors. An [`IdealPicture`] knows these pixels and
//! all colours that they may have ([`IdealPicture::ties`]); any other difference is an error of the machine.
//!
//! **Not modelled:** light and pictures of more than one moment; interlace (a field is every second line of its frame, to the
//! bit, so a frame can be held against two fields).

mod picture;
mod raster;
mod shade;
mod sphere;
mod widths;

pub use picture::{DEPTH_FARTHEST, IdealPicture, Tie};
pub use raster::{ideal_picture, ideal_picture_of};
