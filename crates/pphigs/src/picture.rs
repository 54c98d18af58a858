//! Parameters of drawing a view, such as its shading and binning modes.

use pxpl5_geometry::Viewport;
use pxpl5_geometry::kernel::{Kernel, KernelSurface, Schedule};
use pxpl5_renderer::Layout;

/// Shading mode: the processor that computes colours, and the points at which it computes them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shading {
    /// The graphics processor computes colours at the corners, and the renderers interpolate the colours.
    Gouraud,
    /// Lighting is computed once for the vertices, before the run. The renderers interpolate the resulting colours.
    /// Spheres have no corners, so they are lit as with [`Shading::Gouraud`].
    Precomputed,
    /// The renderers compute the colour of each pixel once, at the end of the frame.
    Phong,
}

/// Binning mode: the regions that receive a primitive's commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RegionBinning {
    /// The regions that the primitive touches.
    Touched,
    /// All regions (Slats prototype, TR94). An invisible triangle takes as much time as a visible triangle, but draws
    /// nothing.
    ///
    /// Spheres go only to the touched regions. Elsewhere, the values of a sphere's quadratic expression would exceed
    /// the renderers' 48 bits. The prototype had no spheres.
    All,
}

impl RegionBinning {
    /// Both binning modes with their names in experiment files.
    pub const ALL: [(&str, Self); 2] = [("all", Self::All), ("touched", Self::Touched)];
}

pxpl5_sim::parameters::named!(RegionBinning, "choice of regions", RegionBinning::ALL);

/// Parameters of drawing a view.
#[derive(Clone, Copy, Debug)]
pub struct Picture {
    /// Lines of the frame that the picture contains, and their division into regions.
    pub viewport: Viewport,
    /// Shading mode: colours computed at corners or at pixels.
    pub shading: Shading,
    /// Binning mode: regions that receive a primitive's commands.
    pub binning: RegionBinning,
    /// Layout of pixel memory, for which the commands are encoded.
    pub layout: Layout,
    /// True if the run can compute pixels. Pixels require the words of commands.
    pub pixels: bool,
}

impl Picture {
    /// Returns the kernel for the picture's triangles. Returns `None` if TRANSFORM has no i860 code for this kind of
    /// picture. The time of TRANSFORM then comes from the timing table.
    pub(crate) fn kernel(&self, schedule: Schedule) -> Option<Kernel> {
        let surface = match self.shading {
            Shading::Gouraud => KernelSurface::Gouraud,
            Shading::Precomputed => KernelSurface::Precomputed,
            Shading::Phong => KernelSurface::Phong,
        };
        Kernel::for_picture(schedule, surface, &self.viewport, self.binning == RegionBinning::Touched)
    }
}
