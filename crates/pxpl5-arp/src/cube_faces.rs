//! Renderer of the six faces of a cube around the eye. The renderer takes no simulated time, and serves as an ideal
//! source of pictures for address recalculation.
//!
//! ```text
//!  triangles --> [ seen from the eye, axes of a face ] --> [ three edges, 1/w: planes over the face ] --> rows of texels --> FaceSet
//!    eye ------------^                  six times                                                          nearest wins
//! ```
//!
//! # Behaviour
//!
//! - [`CubeView::draw`] draws triangles as seen from an eye position. The faces may already contain other triangles.
//!   Each texel shows the nearest triangle. If two triangles are equally near, the first triangle is visible. The faces
//!   are parallel to the world's axes, whatever the orientation of the head.
//! - A texel shows the triangle at the texel's middle. A face is drawn with more than 90 degrees if it has guard texels
//!   (a margin around the inner texels). The tangent of its half angle is the number of all texels along an edge,
//!   divided by the number of inner texels.
//! - Triangles are not clipped. Let w be the distance along the axis of the face. Edges and 1/w are linear functions
//!   over a face, even for corners behind the eye. Parts of a triangle before the near plane or beyond the far plane
//!   are not drawn.
//! - The depth has 24 bits and is a linear function of 1/w, rounded down. All faces and memories have the same near and
//!   far plane, so their depths can be compared.
//! - If two triangles share an edge, each texel middle on this edge belongs to exactly one of the triangles. Both
//!   triangles compute the edge from the same two corners, with opposite signs. Bit-identical corners therefore leave
//!   no cracks.
//! - Colours are interpolated between the corners in the plane of the triangle.
//!
//! All computations are additions, products, quotients and roundings in double precision, so results are bit-identical
//! on all hosts.
//!
//! # Not here
//!
//! - Lighting and materials. The corners of triangles already have shaded colours.
//! - Spheres.
//! - The decision when a face is drawn (see module `address_recalculation::priority`).

mod depth;
mod edges;
mod rows;
mod view;

pub use depth::DepthRange;
pub use view::{Corner, CubeView, DrawCounts};
