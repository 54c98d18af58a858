//! Conversion of primitives to fragments: preparation of triangles, the reference model and the fast rasterizer. Both
//! rasterizers draw the same voxels.

mod assemble;
mod cluster;
mod connected;
mod fast;
mod lanes;
mod oracle;
mod setup;
mod supersampled;

pub use cluster::Bin;
pub use fast::HostRenderer;
pub use oracle::ReferenceRenderer;
pub use supersampled::Supersampled;

use crate::command::CommandBuffer;
use crate::image::SliceImage;
use crate::view::SliceView;
use serde::{Deserialize, Serialize};

/// Rule for the pixels of a slice that a primitive covers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Coverage {
    /// A primitive covers the pixels whose centres lie inside the primitive.
    #[default]
    Sampled,
    /// The pixels of `Sampled`, plus a line of adjacent pixels along the curve in which the primitive intersects the
    /// plane of the slice. **Beyond the SpatialGL paper**, which calls for this coverage but states that GPUs do not
    /// offer it.
    Connected,
}

impl Coverage {
    pub const ALL: [(&'static str, Self); 2] = [("sampled", Self::Sampled), ("connected", Self::Connected)];
}

pxpl5_sim::parameters::named!(Coverage, "coverage rule", Coverage::ALL);

/// Counts of the work for one slice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SliceStats {
    /// Number of primitives drawn, in all passes.
    pub draws: u64,
    /// Number of fragments that reach the fragment program.
    pub generated: u64,
    /// Number of fragments that lie in the slice's volume.
    pub accepted: u64,
    /// Number of pixels added to close gaps in the intersections of surfaces with the slice. Added pixels are beyond
    /// the SpatialGL paper.
    pub added: u64,
}

/// The part of the recorded draw calls that one slice draws: the primitives of the slice's bin, in the order of
/// drawing.
#[derive(Clone, Copy, Debug)]
pub struct SliceWork<'a> {
    pub commands: &'a CommandBuffer,
    pub bin: &'a Bin,
    pub coverage: Coverage,
}

/// A renderer of slices, which draws into an image that [`SliceImage::clear`] has cleared.
pub trait SliceRenderer: Send + Sync {
    fn render(&self, work: SliceWork<'_>, view: &SliceView, image: &mut SliceImage) -> SliceStats;

    /// Returns the number of samples per pixel. Each sample counts as a fragment.
    fn samples(&self) -> u32 {
        1
    }
}
