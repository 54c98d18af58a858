//! The time of TRANSFORM according to the timing table.

use crate::list::{DisplayList, PrimitiveCounts};
use crate::view::DisplayStructure;
use pxpl5_gp::GpTiming;
use pxpl5_sim::Span;

/// The work of TRANSFORM as counts. The timing table has a time for each unit of a count.
///
/// The simulation uses whole counts (`u64`). A closed form can use mean counts (`f64`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TransformCost<N = u64> {
    /// Number of passes over a display list, at [`GpTiming::pass_ns`] each.
    pub passes: N,
    /// Number of structures, counted for each eye, at [`GpTiming::structure_ns`] each.
    pub structures: N,
    /// Number of structures with spheres, at an extra [`GpTiming::sphere_view_ns`] each.
    pub sphere_views: N,
    /// Number of transformed triangles, visible or not, at [`GpTiming::triangle_ns`] each.
    pub triangles: N,
    /// Number of transformed spheres, visible or not, at [`GpTiming::sphere_ns`] each.
    pub spheres: N,
    /// Number of triangles that the clipper cuts, at an extra [`GpTiming::guard_ns`] each.
    pub clipped: N,
    /// Number of bin entries, one for each region that a primitive touches, at [`GpTiming::bin_entry_ns`] each.
    pub entries: N,
}

impl TransformCost {
    const NOTHING: Self =
        Self { passes: 0, structures: 0, sphere_views: 0, triangles: 0, spheres: 0, clipped: 0, entries: 0 };

    /// Start of a pass over a display list, without its structures.
    pub const PASS: Self = Self { passes: 1, ..Self::NOTHING };

    /// Returns the work for primitives, without the start of the pass and without bin entries.
    pub const fn primitives(counts: PrimitiveCounts) -> Self {
        Self { triangles: counts.triangles as u64, spheres: counts.spheres as u64, ..Self::NOTHING }
    }

    /// Returns the work before the first primitive of a pass over `structures`, for one eye.
    pub fn beginning<'a>(structures: impl IntoIterator<Item = &'a DisplayStructure>) -> Self {
        structures.into_iter().fold(Self::PASS, |cost, structure| Self {
            structures: cost.structures + 1,
            sphere_views: cost.sphere_views + u64::from(!structure.spheres.is_empty()),
            ..cost
        })
    }

    /// Returns the work of a whole pass over a display list for one eye, without bin entries. `counts` are the numbers
    /// of primitives of the graphics processor.
    pub fn pass_over(list: &DisplayList, counts: PrimitiveCounts) -> Self {
        let begin = Self::beginning(&list.structures);
        Self { triangles: counts.triangles.into(), spheres: counts.spheres.into(), ..begin }
    }

    /// Returns the processor time of this work, in nanoseconds.
    pub const fn ns(self, timing: &GpTiming) -> u64 {
        timing.pass_ns * self.passes
            + timing.structure_ns * self.structures
            + timing.sphere_view_ns * self.sphere_views
            + timing.triangle_ns * self.triangles
            + timing.sphere_ns * self.spheres
            + timing.guard_ns * self.clipped
            + timing.bin_entry_ns * self.entries
    }

    pub const fn span(self, timing: &GpTiming) -> Span {
        Span::from_ns(self.ns(timing))
    }
}

impl TransformCost<f64> {
    /// Returns the mean processor time of TRANSFORM, in nanoseconds, for mean counts.
    pub fn ns(self, timing: &GpTiming) -> f64 {
        let structures =
            timing.structure_ns as f64 * self.structures + timing.sphere_view_ns as f64 * self.sphere_views;
        let begin = timing.pass_ns as f64 * self.passes + structures;
        let primitives = timing.triangle_ns as f64 * self.triangles + timing.sphere_ns as f64 * self.spheres;
        let primitives = begin + primitives + timing.guard_ns as f64 * self.clipped;
        primitives + timing.bin_entry_ns as f64 * self.entries
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::ModelFrame;
    use pxpl5_geometry::Culling;

    const TIMING: GpTiming = GpTiming {
        pass_ns: 5_000,
        structure_ns: 900,
        sphere_view_ns: 30,
        triangle_ns: 300,
        sphere_ns: 70,
        guard_ns: 40,
        bin_entry_ns: 2,
        ..GpTiming::PAPERS
    };

    fn list() -> DisplayList {
        let structure =
            |spheres| DisplayStructure { triangles: 0..0, spheres, frame: ModelFrame::World, culling: Culling::None };
        DisplayList { structures: vec![structure(0..0), structure(0..4), structure(4..4)], ..DisplayList::default() }
    }

    #[test]
    fn the_time_of_a_transform_is_the_sum_for_pass_structures_primitives_and_bin_entries() {
        let counts = PrimitiveCounts { triangles: 11, spheres: 13 };
        let cost = TransformCost { clipped: 4, entries: 9, ..TransformCost::pass_over(&list(), counts) };
        let begin = 5_000 + 3 * 900 + 30;
        assert_eq!(cost.span(&TIMING), Span::from_ns(begin + 11 * 300 + 13 * 70 + 4 * 40 + 9 * 2));
        assert_eq!(TransformCost::PASS.ns(&TIMING), 5_000);
        assert_eq!(TransformCost::primitives(counts).ns(&TIMING), 11 * 300 + 13 * 70);
    }

    #[test]
    fn mean_counts_that_are_whole_numbers_take_the_time_of_the_counts() {
        let means = TransformCost {
            passes: 1.0,
            structures: 3.0,
            sphere_views: 1.0,
            triangles: 11.0,
            spheres: 13.0,
            clipped: 4.0,
            entries: 9.0,
        };
        assert_eq!(means.ns(&TIMING), 12_118.0);
    }

    /// Tests that structures add no time to a pass under the published timing table. The published time of a pass
    /// includes them.
    #[test]
    fn in_the_published_table_structures_are_part_of_the_pass() {
        let pass = TransformCost::pass_over(&list(), PrimitiveCounts::default());
        assert_eq!(pass.ns(&GpTiming::PAPERS), GpTiming::PAPERS.pass_ns);
    }
}
