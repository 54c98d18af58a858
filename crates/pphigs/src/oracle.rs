//! Ideal renderer, which computes the correct picture directly.
//!
//! Every picture of the simulated machine can be compared with the correct picture.
//!
//! ```text
//!   DisplayList, FrameView --place_all--> Transform --gouraud, phong, sphere--> expressions of one primitive
//!                                                                                  |  at each pixel of its box
//!                            IdealPicture <-- nearest depth wins, ties are kept <--+
//! ```
//!
//! The renderer takes the primitives in the order of the display list. For each primitive, the renderer computes the
//! same expressions as the graphics processors ([`pxpl5_geometry`]), and evaluates the expressions at every pixel.
//! Numbers have the widths of a renderer board: edges modulo 2^32, depth in the bits of the layout, colour in 8 bits
//! per component. The renderer uses no ring, bin, pixel memory or time. This code and the pixel arrays of
//! `pxpl5-renderer` share only the formats of commands, which `pxpl5-renderer` documents.
//!
//! If two primitives have exactly the same depth at a pixel, the pixel can have either colour. On the machine, the
//! primitive whose commands arrive first is visible. The order of arrival depends on the number of processors. An
//! [`IdealPicture`] lists these pixels and all colours that they can have ([`IdealPicture::ties`]). Any other
//! difference is an error of the machine.
//!
//! **Not modelled:** the display's light, pictures drawn for more than one time, and interlace. A field consists of
//! every second line of its frame, so a frame can be compared with two fields.

mod picture;
mod raster;
mod shade;
mod sphere;
mod widths;

pub use picture::{DEPTH_FARTHEST, IdealPicture, Tie};
pub use raster::{ideal_picture, ideal_picture_of};
