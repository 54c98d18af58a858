//! Code for triangles between two views: it records their corners in both views and makes commands for views in
//! between.
//!
//! The sources are kernels/ends.s, blend.s and between.s.

use super::Kernel;

/// Number of words of the record of a triangle in two views.
///
/// The record holds: a flag that the triangle is on the screen in both views, least and greatest y, a free word, and
/// the corners in the first and second view.
pub const ENDS_WORDS: usize = 28;

/// Number of words of the record for the corners in one view.
pub const ENDS_VIEW_WORDS: usize = 12;

impl Kernel {
    /// Returns the source that makes commands for triangles [between two views](Self::ends_source), for a strip of
    /// lines.
    ///
    /// The code is like the compiled kernel for every schedule, and keeps each command with its box. Its entry is the
    /// label `start`; kernels/between.s lists its registers.
    #[must_use]
    pub fn between_source(&self) -> String {
        let record = include_str!("../../kernels/ends_record.s");
        let list = include_str!("../../kernels/list_triangles.s");
        let common = [include_str!("../../kernels/parameters.s"), list, self.picture.source(), self.cull(), record];
        let one = include_str!("../../kernels/compiled_one.s");
        let corner = include_str!("../../kernels/compiled_corner.s");
        let triangle = self.compiled([one, include_str!("../../kernels/between.s"), corner]);
        [common.as_slice(), &triangle, &[include_str!("../../kernels/box_kept.s")]].concat().join("\n")
    }

    /// Returns the source that records triangles in two views (label `keepends`) and interpolates the views' matrices
    /// (label `blend`).
    #[must_use]
    pub fn ends_source() -> String {
        [
            include_str!("../../kernels/parameters.s"),
            include_str!("../../kernels/setup_scalar.s"),
            include_str!("../../kernels/ends_record.s"),
            include_str!("../../kernels/ends.s"),
            include_str!("../../kernels/blend.s"),
        ]
        .join("\n")
    }
}
