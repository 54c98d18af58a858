//! Ideal renderer: computes the correct picture directly, as a reference for every picture of the machine.
//!
//! ```text
//!   DisplayList, FrameView --place_all--> Transform --gouraud, phong, sphere--> expressions of one primitive
//!                                                                                  |  at each pixel of its box
//!                            IdealPicture <-- nearest depth wins, ties are kept <--+
//! ```
//!
//! The renderer takes the primitives in the order of the display list. It sets each up like the graphics processors do
//! ([`pxpl5_geometry`]), and evaluates its expressions at every pixel. The widths are those of a renderer board: edges
//! modulo 2^32, depth in the bits of the layout, colour in 8 bits per component. No ring, bin, pixel memory or time is
//! involved. The code shares nothing with the pixel arrays of `pxpl5-renderer`, except for the formats of commands,
//! which are documented there.
//!
//! One thing stays open on the machine: the winner of two primitives with exactly the same depth. It is the one whose
//! commands arrive first, which depends on the number of processors. An [`IdealPicture`] knows these pixels and all
//! colours that they may have ([`IdealPicture::ties`]). Any other difference is an error of the machine.
//!
//! **Not modelled:** light and pictures of more than one moment; interlace (a field is exactly every second line of its
//! frame, so a frame can be compared with two fields).

mod picture;
mod raster;
mod shade;
mod sphere;
mod widths;

pub use picture::{DEPTH_FARTHEST, IdealPicture, Tie};
pub use raster::{ideal_picture, ideal_picture_of};
