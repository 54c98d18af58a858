//! Renders the six faces of the cube around an eye in no simulated time: an ideal source for address recalculation.
//!
//! ```text
//!  triangles --> [ seen from the eye, axes of a face ] --> [ three edges, 1/w: planes over the face ] --> rows of texels --> FaceSet
//!    eye ------------^                  six times                                                          nearest wins
//! ```
//!
//! # Behaviour
//!
//! - [`CubeView::draw`] draws triangles as seen from an eye position. The faces may already contain other triangles.
//!   The nearest triangle of a texel wins, and the first one wins a tie. The faces are parallel to the world's axes,
//!   independent of orientation.
//! - A texel shows the triangle at its middle. This holds for guard texels as well: the half angle of a face has the
//!   tangent texels / inner texels.
//! - Triangles are not clipped. Edges and 1/w are linear functions over a face, even for corners behind the eye. Parts
//!   nearer than the near plane or beyond the far plane are not drawn.
//! - Depth is z/w along the axis of the face, 24 bits, rounded down. All faces and memories have the same near and far
//!   plane, so their depths can be compared.
//! - If two triangles share an edge, each texel middle on this edge belongs to exactly one of them. Both triangles
//!   compute the edge from the same two corners, with opposite signs. Bit-identical corners therefore leave no cracks.
//! - Colours are those of the corners, interpolated in the plane of the triangle.
//!
//! All computations are additions, products, quotients and roundings in double precision, so results are bit-identical
//! on all hosts.
//!
//! # Not here
//!
//! - Lighting and materials. Corners have shaded colours.
//! - Spheres.
//! - The decision when a face is drawn (see `priority-rendering`).

mod depth;
mod edges;
mod rows;
mod view;

pub use depth::{DepthError, DepthRange};
pub use view::{Corner, CubeView, Drawing};
