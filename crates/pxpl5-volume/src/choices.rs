//! Choices by name: clips, projections, tie rules, bins, coverage.

use spatialgl::{BinTolerance, Binning, Combine, Coverage, Rotation, Strobes, TieRule};

/// Which of the six clips; its offset or bias is a number of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClipKind {
    /// Near and far plane alone.
    Prism,
    /// Two clip planes for each of two passes.
    UserPlanes,
    /// Two planes in the fragment program.
    Exact,
    /// Planes that leave room at the axis, in two passes.
    Tapered,
    /// Both planes moved outwards.
    Parallel,
    /// A bias added to the product of both planes.
    Hyperbolic,
}

impl ClipKind {
    /// All six in the order of the paper.
    pub const ALL: [Self; 6] =
        [Self::Prism, Self::UserPlanes, Self::Exact, Self::Tapered, Self::Parallel, Self::Hyperbolic];
}

/// Which of the three projections.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProjectionKind {
    /// Along the normal of the slice.
    Orthographic,
    /// From one eye for all slices.
    Perspective,
    /// From an eye and with a shear drawn for each slice.
    Jittered,
}

impl ProjectionKind {
    /// All three in the order in which they are compared.
    pub const ALL: [Self; 3] = [Self::Orthographic, Self::Perspective, Self::Jittered];
}

/// Who draws the slices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RendererKind {
    /// This computer, as the paper's GPU would.
    Host,
    /// The renderers of Pixel-Planes 5, which is beyond the paper.
    PixelPlanes,
}

/// Something that has names in options, files and reports.
pub(crate) trait Named: Copy + PartialEq + 'static {
    /// Names and what they stand for.
    const NAMES: &'static [(&'static str, Self)];

    fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, choice)| *choice == self).map_or("", |(name, _)| name)
    }

    fn named(text: &str) -> Result<Self, String> {
        let found = Self::NAMES.iter().find(|(name, _)| *name == text).map(|(_, choice)| *choice);
        found.ok_or_else(|| {
            let names: Vec<&str> = Self::NAMES.iter().map(|(name, _)| *name).collect();
            names.join(", ")
        })
    }
}

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

impl Named for ProjectionKind {
    const NAMES: &'static [(&'static str, Self)] =
        &[("orthographic", Self::Orthographic), ("perspective", Self::Perspective), ("jittered", Self::Jittered)];
}

impl Named for RendererKind {
    const NAMES: &'static [(&'static str, Self)] = &[("host", Self::Host), ("pixel-planes", Self::PixelPlanes)];
}

impl Named for TieRule {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("half-open", Self::HalfOpen),
        ("product-positive", Self::ProductPositive),
        ("same-sign", Self::SameSign),
        ("closed", Self::Closed),
    ];
}

impl Named for Binning {
    const NAMES: &'static [(&'static str, Self)] =
        &[("off", Self::Off), ("two-planes", Self::TwoPlanes), ("all-planes", Self::AllPlanes)];
}

impl Named for BinTolerance {
    const NAMES: &'static [(&'static str, Self)] = &[("clip", Self::OfTheClip), ("codes", Self::Codes)];
}

impl Named for Coverage {
    const NAMES: &'static [(&'static str, Self)] = &[("sampled", Self::Sampled), ("connected", Self::Connected)];
}

impl Named for Strobes {
    const NAMES: &'static [(&'static str, Self)] = &[("each", Self::Each), ("mirror", Self::Mirror)];
}

impl Named for Combine {
    const NAMES: &'static [(&'static str, Self)] = &[("last", Self::Last), ("max", Self::Max), ("add", Self::Add)];
}

impl Named for Rotation {
    const NAMES: &'static [(&'static str, Self)] = &[("x-to-z", Self::XToZ), ("z-to-x", Self::ZToX)];
}

impl Named for bool {
    const NAMES: &'static [(&'static str, Self)] = &[("true", true), ("false", false)];
}
