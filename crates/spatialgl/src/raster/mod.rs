//! From primitives to fragments: set-up, the literal rasteriser and the fast one, which agree in every voxel.

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
pub use oracle::OracleRenderer;
pub use supersampled::Supersampled;

use crate::command::CommandBuffer;
use crate::image::SliceImage;
use crate::view::SliceView;
use serde::{Deserialize, Serialize};

/// What of a primitive is drawn on a slice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Coverage {
    /// The samples at pixel centres that it covers.
    #[default]
    Sampled,
    /// Those, and a line of touching pixels along its intersection with the slice. **Beyond the paper**, which wants this
    /// and finds that GPUs refuse it.
    Connected,
}

/// What was drawn on one slice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SliceStats {
    /// Primitives issued, in all passes.
    pub draws: u64,
    /// Fragments that reach the fragment program.
    pub generated: u64,
    /// Fragments that lie in the slice's volume.
    pub accepted: u64,
    /// Pixels added to make intersections connected; beyond the paper.
    pub added: u64,
}

/// One slice's share of a recording: the primitives of its bin, in their order.
#[derive(Clone, Copy, Debug)]
pub struct SliceWork<'a> {
    /// The recording whose primitives are drawn.
    pub commands: &'a CommandBuffer,
    /// The primitives to draw.
    pub bin: &'a Bin,
    /// What of them is drawn.
    pub coverage: Coverage,
}

/// Whoever draws slices. The image is as [`SliceImage::clear`] left it.
pub trait SliceRenderer: Send + Sync {
    /// Draws one slice in all its passes.
    fn render(&self, work: SliceWork<'_>, view: &SliceView, image: &mut SliceImage) -> SliceStats;

    /// How many samples it takes of each pixel, all of which are counted as fragments.
    fn samples(&self) -> u32 {
        1
    }
}
