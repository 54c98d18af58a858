use pxpl5_geometry::Viewport;
use pxpl5_geometry::kernel::{Kernel, KernelSurface, Schedule};
use pxpl5_renderer::Layout;

/// Method of shading: where and when colours are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shading {
    /// The graphics processor computes colours at the corners, and the renderers interpolate the colours.
    Gouraud,
    /// Colours are computed once, before the run, and the renderers interpolate these colours. Spheres have no corners,
    /// and are lit as with [`Shading::Gouraud`].
    Precomputed,
    /// The renderers compute the colour of each pixel, after all primitives are drawn.
    Phong,
}

/// Choice of the regions that receive a primitive's commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RegionBinning {
    /// The regions that the primitive touches, found by its edges.
    Touched,
    /// The regions under the bounding box of the primitive. No i860 code exists for this choice.
    Boxes,
    /// All regions (Slats prototype, TR94). An invisible triangle takes as much time as a visible triangle.
    ///
    /// Spheres go only to the regions that they touch. Elsewhere, a sphere's quadratic expression would exceed the
    /// renderers' 48 bits. The prototype had no spheres.
    All,
}

impl RegionBinning {
    /// All choices with their names in experiment files.
    pub const ALL: [(&str, Self); 3] = [("all", Self::All), ("touched", Self::Touched), ("boxes", Self::Boxes)];
}

pxpl5_sim::parameters::named!(RegionBinning, "choice of regions", RegionBinning::ALL);

/// Settings for the drawing of a view.
#[derive(Clone, Copy, Debug)]
pub struct Picture {
    /// The lines of the video frame that the picture has (all, even or odd), and the picture's division into regions.
    pub viewport: Viewport,
    pub shading: Shading,
    pub binning: RegionBinning,
    pub layout: Layout,
    /// True if the run can compute pixels, so that the words of commands are needed.
    pub pixels: bool,
}

impl Picture {
    /// Returns the kernel for the picture's triangles, or `None` if the picture has no kernel. The time of TRANSFORM
    /// then comes from the timing table.
    pub(crate) fn kernel(&self, schedule: Schedule) -> Option<Kernel> {
        let surface = match self.shading {
            Shading::Gouraud => KernelSurface::Gouraud,
            Shading::Precomputed => KernelSurface::Precomputed,
            Shading::Phong => KernelSurface::Phong,
        };
        let is_binned = match self.binning {
            RegionBinning::Touched => true,
            RegionBinning::All => false,
            RegionBinning::Boxes => return None,
        };
        Kernel::for_picture(schedule, surface, &self.viewport, is_binned)
    }
}
