//! Code for triangles between two views: where they are in both, and their commands in between (kernels/ends.s, blend.s, between.s).

use super::Kernel;

/// Words of the record of a triangle between two views: whether it has a place on the screen in both, the least and the greatest y, free;
/// its corners in the first view, then in the second.
pub const ENDS_WORDS: usize = 28;

/// Words of it for the corners in one view.
pub const ENDS_VIEW_WORDS: usize = 12;

impl Kernel {
    /// As the compiled kernel, for triangles [between two views](Self::ends_source): their commands for a strip of lines, which are
    /// kept with their boxes. The schedule does not matter. Its entry is the label `start`, its registers stand in kernels/between.s.
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

    /// The source of what finds where triangles are in two views, and of what interpolates their matrices: the labels `keepends` and `blend`.
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
