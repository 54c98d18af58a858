use serde::{Deserialize, Serialize};

/// Counts of primitives, and of all cases in which a primitive was dropped, cut or limited.
///
/// All counts start at zero. Callers can add the counts of several graphics processors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SetupStats {
    /// Number of triangles in the input, visible or not.
    pub triangles: u64,
    /// Number of triangles on the screen. Clipping can turn an input triangle into several screen triangles or into
    /// none.
    pub screen_triangles: u64,
    /// Number of triangles, or pieces of clipped triangles, dropped because a clip coordinate is NaN, infinite or
    /// beyond [`crate::MAX_CLIP`], or because w is nearly 0.
    pub not_finite: u64,
    /// Number of triangles dropped because all corners are beyond the same side of the visible volume.
    pub outside: u64,
    /// Number of triangles cut by the near plane, the far plane or the guard band.
    pub clipped: u64,
    /// Number of screen triangles dropped as back faces (only with [`crate::Culling::Back`]).
    pub back_facing: u64,
    /// Number of screen triangles dropped because their area is zero after rounding to subpixels.
    pub degenerate: u64,
    /// Number of screen triangles dropped because they are off the screen or lie between pixel centres.
    pub untouched: u64,
    /// Number of planes of depth, colour or normal that were too steep for the format and were made constant.
    pub flattened_planes: u64,
    /// Number of spheres in the input, visible or not.
    pub spheres: u64,
    /// Number of spheres that are drawn.
    pub screen_spheres: u64,
    /// Number of spheres dropped because the near plane cuts the sphere or the eye is inside the sphere.
    pub spheres_across_near: u64,
    /// Number of spheres dropped because the far plane cuts the sphere.
    pub spheres_across_far: u64,
    /// Number of spheres dropped because they are behind the eye, beyond the far plane or off the screen.
    pub spheres_outside: u64,
    /// Number of spheres dropped because a number is NaN, infinite or too large, or the radius is negative.
    pub spheres_not_finite: u64,
    /// Number of spheres dropped because the projection is neither perspective nor parallel along -Z.
    pub spheres_unprojectable: u64,
}

impl SetupStats {
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
