//! Pictures: what is made of a view.

use pxpl5_geometry::Viewport;
use pxpl5_geometry::kernel::{Kernel, KernelSurface, Schedule};
use pxpl5_renderer::Layout;

/// Where colours are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shading {
    /// At the corners, by the GP; interpolated by the renderers.
    Gouraud,
    /// Before the run: the display list's colours are taken as they are and interpolated by the renderers. Spheres, which have no corners,
    /// are lit as under [`Shading::Gouraud`].
    Precomputed,
    /// At the pixels, by the renderers, once at the end of the frame.
    Phong,
}

/// Which regions a primitive's commands are sent to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RegionBinning {
    /// Those that it touches.
    Touched,
    /// All; a triangle that is not seen costs as much as any other, and draws nothing (Slats prototype, TR94). Spheres,
    /// which the prototype did not have, go to the regions that they touch: elsewhere a quadratic leaves its 48 bits.
    All,
}

/// What to make of a view.
#[derive(Clone, Copy, Debug)]
pub struct Picture {
    /// Lines of the frame that it holds, and how it is cut into regions.
    pub viewport: Viewport,
    /// Whether colours are computed at corners or at pixels.
    pub shading: Shading,
    /// Which regions get a primitive's commands.
    pub binning: RegionBinning,
    /// Division of pixel memory that the commands are encoded for.
    pub layout: Layout,
    /// Whether somebody may want the command words.
    pub pixels: bool,
}

impl Picture {
    /// The kernel of its triangles; `None` where there is no i860 code for its TRANSFORM, which takes the time of the table then.
    pub(crate) fn kernel(&self, schedule: Schedule) -> Option<Kernel> {
        let surface = match self.shading {
            Shading::Gouraud => KernelSurface::Gouraud,
            Shading::Precomputed => KernelSurface::Precomputed,
            Shading::Phong => KernelSurface::Phong,
        };
        Kernel::for_picture(schedule, surface, &self.viewport, self.binning == RegionBinning::Touched)
    }
}
