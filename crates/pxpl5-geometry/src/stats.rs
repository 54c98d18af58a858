//! Counters of the set-up.

use serde::{Deserialize, Serialize};

/// Counts of primitives, and of everything that the set-up dropped, cut or limited.
///
/// All counts start at zero. Callers add the counts of several graphics processors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SetupStats {
    /// Triangles passed to the set-up, visible or not.
    pub triangles: u64,
    /// Screen triangles produced. Clipping can give several or none per triangle.
    pub screen_triangles: u64,
    /// Triangles or pieces dropped because a clip coordinate is NaN, infinite or beyond [`crate::MAX_CLIP`], or w is
    /// nearly 0.
    pub not_finite: u64,
    /// Triangles dropped because all vertices are beyond one side of the view.
    pub outside: u64,
    /// Triangles cut by the near plane, the far plane or the guard band.
    pub clipped: u64,
    /// Screen triangles dropped as back faces (only with [`crate::Culling::Back`]).
    pub back_facing: u64,
    /// Screen triangles dropped because their area is zero after snapping.
    pub degenerate: u64,
    /// Screen triangles dropped because they touch no region: off the screen, or between pixel centres.
    pub untouched: u64,
    /// Planes of depth, colour or normal that were steeper than [`crate::MAX_SLOPE`] and became flat.
    pub flattened_planes: u64,
    /// Spheres passed to the set-up, visible or not.
    pub spheres: u64,
    /// Spheres produced, which are on the screen.
    pub screen_spheres: u64,
    /// Spheres dropped because the near plane cuts them or the eye is inside.
    pub spheres_across_near: u64,
    /// Spheres dropped because the far plane cuts them.
    pub spheres_across_far: u64,
    /// Spheres dropped because they are behind the eye, beyond the far plane or off the screen.
    pub spheres_outside: u64,
    /// Spheres dropped because a number is NaN, infinite or huge, or the radius is negative.
    pub spheres_not_finite: u64,
    /// Spheres dropped because the projection is neither perspective nor parallel along -Z.
    pub spheres_unprojectable: u64,
}

impl SetupStats {
    /// Adds the counts of `other` to this one.
    pub fn add(&mut self, other: &Self) {
        self.triangles += other.triangles;
        self.screen_triangles += other.screen_triangles;
        self.not_finite += other.not_finite;
        self.outside += other.outside;
        self.clipped += other.clipped;
        self.back_facing += other.back_facing;
        self.degenerate += other.degenerate;
        self.untouched += other.untouched;
        self.flattened_planes += other.flattened_planes;
        self.spheres += other.spheres;
        self.screen_spheres += other.screen_spheres;
        self.spheres_across_near += other.spheres_across_near;
        self.spheres_across_far += other.spheres_across_far;
        self.spheres_outside += other.spheres_outside;
        self.spheres_not_finite += other.spheres_not_finite;
        self.spheres_unprojectable += other.spheres_unprojectable;
    }
}
