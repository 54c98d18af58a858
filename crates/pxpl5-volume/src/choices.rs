//! Settings that are choices with names: clips, projections, rules for points on a boundary, bins, coverage.

use spatialgl::{BinTolerance, Binning, Combine, Coverage, Rotation, Strobes, TieRule};

/// One of the six methods of clipping the scene to a slice. Its offset or bias is a separate number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClipKind {
    /// Clip by the near plane and the far plane alone.
    Prism,
    /// Clip by two user clip planes in each of two drawing passes.
    UserPlanes,
    /// The fragment program clips by the two boundary planes of the slice. The result is exactly the volume of the
    /// slice.
    Exact,
    /// Clip by two planes whose distance grows with the radius. The distance is a fixed number of pixels at the axis,
    /// and the exact thickness of the slice at the rim. Each side of the axis has its own drawing pass.
    Tapered,
    /// Clip by the two boundary planes of the slice, which are moved outwards.
    Parallel,
    /// Clip by the sign of a sum: the product of a point's distances from the two boundary planes of the slice, plus a
    /// bias.
    Hyperbolic,
}

impl ClipKind {
    /// All six clips, in the order of the SpatialGL paper.
    pub const ALL: [Self; 6] =
        [Self::Prism, Self::UserPlanes, Self::Exact, Self::Tapered, Self::Parallel, Self::Hyperbolic];
}

/// A projection of points near a slice onto the slice's image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProjectionKind {
    /// Projection along the normal of the slice.
    Orthographic,
    /// Projection from one eye for all slices.
    Perspective,
    /// Projection with a random eye position and a random shear, chosen anew for each slice.
    Jittered,
}

impl ProjectionKind {
    /// All three projections, in the order in which a comparison lists them.
    pub const ALL: [Self; 3] = [Self::Orthographic, Self::Perspective, Self::Jittered];
}

/// The hardware that draws the slices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RendererKind {
    /// The CPU of this computer, in place of the SpatialGL paper's GPU.
    Host,
    /// The emulated renderers of Pixel-Planes 5, which are beyond the SpatialGL paper.
    PixelPlanes,
}

pub(crate) trait Named: Copy + PartialEq + 'static {
    const NAMES: &'static [(&'static str, Self)];

    fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, choice)| *choice == self).map_or("", |(name, _)| name)
    }
}

pxpl5_sim::parameters::named!(ClipKind, "clip", ClipKind::NAMES.iter().copied());

impl Named for ClipKind {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("prism", Self::Prism),
        ("user-planes", Self::UserPlanes),
        ("exact", Self::Exact),
        ("tapered", Self::Tapered),
        ("parallel", Self::Parallel),
        ("hyperbolic", Self::Hyperbolic),
    ];
}

pxpl5_sim::parameters::named!(ProjectionKind, "projection", ProjectionKind::NAMES.iter().copied());

impl Named for ProjectionKind {
    const NAMES: &'static [(&'static str, Self)] =
        &[("orthographic", Self::Orthographic), ("perspective", Self::Perspective), ("jittered", Self::Jittered)];
}

pxpl5_sim::parameters::named!(RendererKind, "renderer", RendererKind::NAMES.iter().copied());

impl Named for RendererKind {
    const NAMES: &'static [(&'static str, Self)] = &[("host", Self::Host), ("pixel-planes", Self::PixelPlanes)];
}

impl Named for TieRule {
    const NAMES: &'static [(&'static str, Self)] = &Self::ALL;
}

impl Named for Binning {
    const NAMES: &'static [(&'static str, Self)] = &Self::ALL;
}

impl Named for BinTolerance {
    const NAMES: &'static [(&'static str, Self)] = &Self::ALL;
}

impl Named for Coverage {
    const NAMES: &'static [(&'static str, Self)] = &Self::ALL;
}

impl Named for Strobes {
    const NAMES: &'static [(&'static str, Self)] = &Self::ALL;
}

impl Named for Combine {
    const NAMES: &'static [(&'static str, Self)] = &Self::ALL;
}

impl Named for Rotation {
    const NAMES: &'static [(&'static str, Self)] = &Self::ALL;
}

impl Named for bool {
    const NAMES: &'static [(&'static str, Self)] = &[("true", true), ("false", false)];
}
