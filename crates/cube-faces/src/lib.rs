//! The six faces of the cube around an eye, drawn exactly and in no simulated time: an ideal source for address recalculation.
//!
//! ```text
//!  triangles --> [ seen from the eye, axes of a face ] --> [ three edges, 1/w: planes over the face ] --> rows of texels --> FaceSet
//!    eye ------------^                  six times                                                          nearest wins
//! ```
//!
//! # Behaviour
//!
//! - [`CubeView::draw`] draws triangles as an eye at a place sees them, into faces that may hold other triangles already: of two
//!   on a texel the nearer one stays, the first on ties. No orientation: the faces lie on the world's axes.
//! - A texel takes what its middle meets, in the guard as well: a face is drawn with a tangent of texels / inner texels.
//! - Triangles are not clipped. Edges and 1/w are linear over a face, whatever lies behind the eye: a corner there is no case of
//!   its own. Nearer than near and farther than far nothing is drawn.
//! - Depth is z/w along the axis of the face, 24 bits rounded down, the same near and far for all faces and memories, so that
//!   memories can be compared.
//! - A middle on an edge that two triangles share belongs to exactly one of them: both compute the edge from the same two corners,
//!   to the same number with opposite signs. Where corners are the same in every bit, there are no cracks.
//! - Colours are those of the corners, interpolated in the plane of the triangle.
//!
//! Everything is computed in double precision with additions, products, quotients and roundings: all hosts agree in every bit.
//!
//! # Not here
//!
//! Light and materials: corners come shaded. Spheres. What is due, and when: `priority-rendering`.

mod depth;
mod edges;
mod rows;
mod view;

pub use depth::{DepthError, DepthRange};
pub use view::{Corner, CubeView, Drawing};
