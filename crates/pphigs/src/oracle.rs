//! Ideal renderer: it computes the correct picture directly. Every picture of the simulated machine can be compared
//! with it.
//!
//! ```text
//!   DisplayList, FrameView --place_all--> Transform --gouraud, phong, sphere--> expressions of one primitive
//!                                                                                  |  at each pixel of its box
//!                            IdealPicture <-- nearest depth wins, ties are kept <--+
//! ```
//!
//! The renderer takes the primitives in the order of the display list. It computes the expressions of each primitive
//! like the graphics processors do ([`pxpl5_geometry`]), and evaluates them at every pixel. Numbers have the widths of
//! a renderer board: edges modulo 2^32, depth in the bits of the layout, colour in 8 bits per component. No ring, bin,
//! pixel memory or time is involved. The code shares only the formats of commands with the pixel arrays of
//! `pxpl5-renderer`, which documents these formats.
//!
//! The machine's colour is not determined where two primitives have exactly the same depth. The primitive whose
//! commands arrive first is visible, which depends on the number of processors. An [`IdealPicture`] lists these pixels
//! and all colours that they can have ([`IdealPicture::ties`]). Any other difference is an error of the machine.
//!
//! **Not modelled:** the display's light; pictures drawn for more than one time; interlace. A field is exactly every
//! second line of its frame, so a frame can be compared with two fields.

mod picture;
mod raster;
mod shade;
mod sphere;
mod widths;

pub use picture::{DEPTH_FARTHEST, IdealPicture, Tie};
pub use raster::{ideal_picture, ideal_picture_of};
