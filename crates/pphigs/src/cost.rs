//! The time of a TRANSFORM by the table of graphics-processor code, derived in this one place.

use crate::counts::PrimitiveCounts;
use pxpl5_gp::GpTiming;
use pxpl5_sim::Span;

/// What a TRANSFORM does, counted; each takes the time that the table gives for it.
///
/// Counts of a machine are whole (`u64`); an analytic model may have means (`f64`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TransformCost<N = u64> {
    /// Passes over a display list that begin, at [`GpTiming::pass_ns`] each.
    pub passes: N,
    /// Triangles transformed, seen or not, at [`GpTiming::triangle_ns`] each.
    pub triangles: N,
    /// Spheres transformed, seen or not, at [`GpTiming::sphere_ns`] each.
    pub spheres: N,
    /// Triangles that the clipper cuts, at [`GpTiming::guard_ns`] each besides.
    pub clipped: N,
    /// Entries made in bins, one for each region that gets a primitive's commands, at [`GpTiming::bin_entry_ns`] each.
    pub entries: N,
}

impl TransformCost {
    /// The beginning of a pass over a display list, before its first primitive.
    pub const PASS: Self = Self { passes: 1, triangles: 0, spheres: 0, clipped: 0, entries: 0 };

    /// Primitives transformed, without the beginning of their pass and without entries in bins.
    #[must_use]
    pub const fn primitives(counts: PrimitiveCounts) -> Self {
        Self { triangles: counts.triangles as u64, spheres: counts.spheres as u64, passes: 0, ..Self::PASS }
    }

    /// A whole pass over so many primitives, without entries in bins.
    #[must_use]
    pub const fn pass_over(counts: PrimitiveCounts) -> Self {
        Self { passes: 1, ..Self::primitives(counts) }
    }

    /// The processor's time in nanoseconds.
    #[must_use]
    pub const fn ns(self, timing: &GpTiming) -> u64 {
        timing.pass_ns * self.passes
            + timing.triangle_ns * self.triangles
            + timing.sphere_ns * self.spheres
            + timing.guard_ns * self.clipped
            + timing.bin_entry_ns * self.entries
    }

    /// The processor's time, as the simulation spends it.
    #[must_use]
    pub const fn span(self, timing: &GpTiming) -> Span {
        Span::from_ns(self.ns(timing))
    }
}

impl TransformCost<f64> {
    /// The processor's mean time in nanoseconds; primitives are added before the beginning of the pass is, then entries.
    #[must_use]
    pub fn ns(self, timing: &GpTiming) -> f64 {
        let primitives = timing.triangle_ns as f64 * self.triangles + timing.sphere_ns as f64 * self.spheres;
        let primitives = timing.pass_ns as f64 * self.passes + primitives + timing.guard_ns as f64 * self.clipped;
        primitives + timing.bin_entry_ns as f64 * self.entries
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMING: GpTiming =
        GpTiming { pass_ns: 5_000, triangle_ns: 300, sphere_ns: 70, guard_ns: 40, bin_entry_ns: 2, ..GpTiming::PAPERS };

    #[test]
    fn a_transform_takes_the_time_of_its_pass_its_primitives_and_its_entries() {
        let cost = TransformCost {
            clipped: 4,
            entries: 9,
            ..TransformCost::pass_over(PrimitiveCounts { triangles: 11, spheres: 13 })
        };
        assert_eq!(cost.span(&TIMING), Span::from_ns(5_000 + 11 * 300 + 13 * 70 + 4 * 40 + 9 * 2));
        assert_eq!(TransformCost::PASS.ns(&TIMING), 5_000);
    }

    #[test]
    fn whole_means_take_the_time_of_counts() {
        let means = TransformCost { passes: 1.0, triangles: 11.0, spheres: 13.0, clipped: 4.0, entries: 9.0 };
        assert_eq!(means.ns(&TIMING), 9_388.0);
    }
}
