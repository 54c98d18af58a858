//! Code of the graphics processor for triangles whose corners are interpolated between two views. The code records the
//! corners in both views, and makes commands for any view between them.
//!
//! The sources are kernels/ends.s and kernels/compiled.s.

use super::{COMPILED, Kernel, KernelList, PARAMETERS, PICTURE, SCALAR, Schedule, choices};

/// Number of words that record one triangle in two views.
///
/// The words are: a flag, the least y, the greatest y, a free word, and the corners in both views. The flag is set if
/// both views have the triangle on the screen.
pub const ENDS_WORDS: usize = 28;

/// Number of words for the corners of a recorded triangle in one view.
pub const ENDS_VIEW_WORDS: usize = 12;

impl Kernel {
    /// Returns the source of code that interpolates [recorded triangles](Self::ends_source) and makes their commands,
    /// for a range of screen lines.
    ///
    /// The code has the style of the compiled kernel, and stores the bounding box of each command. Execution begins at
    /// the label `start`. kernels/compiled.s lists the registers.
    pub fn between_source(&self) -> String {
        let own = Self {
            schedule: Schedule::Compiled,
            list: KernelList::Triangles,
            binned: false,
            keeps_boxes: true,
            both_eyes: false,
            ..*self
        };
        let common = [&own.choices(true), PARAMETERS, include_str!("../../kernels/list.s"), PICTURE];
        [&common, COMPILED.as_slice()].concat().join("\n")
    }

    /// Returns the source of two functions: `keepends` records the corners of triangles in two views, and `blend`
    /// interpolates between the matrices of these views.
    pub fn ends_source() -> String {
        // The records have corners only, so their surface does not matter.
        let choices = choices(&[("PHONG", false)]);
        [&choices, PARAMETERS, SCALAR, include_str!("../../kernels/ends.s")].join("\n")
    }
}
