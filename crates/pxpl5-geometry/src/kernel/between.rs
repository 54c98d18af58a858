//! Code of the graphics processor for triangles whose corners are interpolated between two views. The code records the
//! corners of triangles in both views, and makes commands for any view between the two views.
//!
//! The sources are kernels/ends.s and kernels/compiled.s.

use super::{COMPILED, Kernel, KernelList, PARAMETERS, PICTURE, SCALAR, Schedule, choices};

/// Number of words of the record that describes one triangle in two views.
///
/// The record holds four words, then the corners in the first view and in the second view. The four words are a flag,
/// the least y, the greatest y, and a free word. The flag is set if both views have the triangle on the screen.
pub const ENDS_WORDS: usize = 28;

/// Number of words that the record of a triangle has for each of the two views.
pub const ENDS_VIEW_WORDS: usize = 12;

impl Kernel {
    /// Returns the source of code that interpolates triangles [between two views](Self::ends_source) and makes their
    /// commands. One call makes the commands for a range of screen lines.
    ///
    /// All optimization levels use this code, which has the style of the compiled kernel. The code stores the bounding
    /// box of each command. Execution begins at the label `start`; kernels/compiled.s lists the registers.
    #[must_use]
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

    /// Returns the source with two functions. The function at the label `keepends` records the corners of triangles in
    /// two views. The function at the label `blend` interpolates between the matrices of these views.
    #[must_use]
    pub fn ends_source() -> String {
        // The records have corners only, so their surface does not matter.
        let choices = choices(&[("PHONG", false)]);
        [&choices, PARAMETERS, SCALAR, include_str!("../../kernels/ends.s")].join("\n")
    }
}
