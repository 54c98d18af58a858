//! Settings that are choices with names: clips, projections and renderers.

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
    /// All six clips with their names, in the order of the SpatialGL paper.
    pub const ALL: [(&'static str, Self); 6] = [
        ("prism", Self::Prism),
        ("user-planes", Self::UserPlanes),
        ("exact", Self::Exact),
        ("tapered", Self::Tapered),
        ("parallel", Self::Parallel),
        ("hyperbolic", Self::Hyperbolic),
    ];
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
    /// All three projections with their names, in the order in which a comparison lists them.
    pub const ALL: [(&'static str, Self); 3] =
        [("orthographic", Self::Orthographic), ("perspective", Self::Perspective), ("jittered", Self::Jittered)];
}

/// The hardware that draws the slices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RendererKind {
    /// The CPU of this computer, in place of the SpatialGL paper's GPU.
    Host,
    /// The emulated renderers of Pixel-Planes 5, which are beyond the SpatialGL paper.
    PixelPlanes,
}

impl RendererKind {
    /// Both renderers with their names.
    pub const ALL: [(&'static str, Self); 2] = [("host", Self::Host), ("pixel-planes", Self::PixelPlanes)];
}

pxpl5_sim::parameters::named!(ClipKind, "clip", ClipKind::ALL);
pxpl5_sim::parameters::named!(ProjectionKind, "projection", ProjectionKind::ALL);
pxpl5_sim::parameters::named!(RendererKind, "renderer", RendererKind::ALL);

/// Returns the name of a choice. The name is empty if the choice has none.
pub(crate) fn name_of<T: PartialEq>(choice: T, all: &[(&'static str, T)]) -> &'static str {
    all.iter().find(|(_, other)| *other == choice).map_or("", |(name, _)| name)
}
