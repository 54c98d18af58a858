//! Code of the graphics processor for triangles between two views. The code records the corners of triangles in both
//! views, and makes commands for any view between the two views.
//!
//! The sources are kernels/ends.s, blend.s and between.s.

use super::Kernel;

/// Number of words of a triangle's record for two views.
///
/// The record holds four words, then the corners in the first view and in the second view. The four words are a flag,
/// the least y, the greatest y, and a free word. The flag is set if both views have the triangle on the screen.
pub const ENDS_WORDS: usize = 28;

/// Number of words that a triangle's record has for each view.
pub const ENDS_VIEW_WORDS: usize = 12;

impl Kernel {
    /// Returns the source that makes commands of triangles [between two views](Self::ends_source). The commands are for
    /// a strip of screen lines.
    ///
    /// At every optimization level, the code is like the compiled kernel. The code stores the bounding box of each
    /// command. Execution begins at the label `start`, and kernels/between.s lists the registers.
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

    /// Returns the source with two functions. The function at the label `keepends` records triangles in two views. The
    /// function at the label `blend` interpolates between the matrices of the views.
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
