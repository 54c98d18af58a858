//! Pictures: parameters of drawing a view.

use pxpl5_geometry::Viewport;
use pxpl5_geometry::kernel::{Kernel, KernelSurface, Schedule};
use pxpl5_renderer::Layout;

/// Shading mode: where and when colours are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shading {
    /// The GP computes colours at the corners; the renderers interpolate them.
    Gouraud,
    /// The colours of the display list were lit before the run; the renderers interpolate them. Spheres have no
    /// corners, so they are lit as under [`Shading::Gouraud`].
    Precomputed,
    /// The renderers compute colours at the pixels, once at the end of the frame.
    Phong,
}

/// Binning mode: the regions that receive a primitive's commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RegionBinning {
    /// The regions that the primitive touches.
    Touched,
    /// All regions (Slats prototype, TR94). An invisible triangle costs as much as any other, but draws nothing.
    ///
    /// Spheres, which the prototype did not have, go to the touched regions only. In other regions a quadratic would
    /// exceed 48 bits.
    All,
}

/// Parameters of drawing a view.
#[derive(Clone, Copy, Debug)]
pub struct Picture {
    /// Lines of the frame that the picture contains, and its division into regions.
    pub viewport: Viewport,
    /// Shading mode: colours computed at corners or at pixels.
    pub shading: Shading,
    /// Binning mode: regions that receive a primitive's commands.
    pub binning: RegionBinning,
    /// Layout of pixel memory for which commands are encoded.
    pub layout: Layout,
    /// True if command words may be needed to compute pixels.
    pub pixels: bool,
}

impl Picture {
    /// Returns the kernel for the picture's triangles. Returns `None` if TRANSFORM has no i860 code for it and takes
    /// the table's time.
    pub(crate) fn kernel(&self, schedule: Schedule) -> Option<Kernel> {
        let surface = match self.shading {
            Shading::Gouraud => KernelSurface::Gouraud,
            Shading::Precomputed => KernelSurface::Precomputed,
            Shading::Phong => KernelSurface::Phong,
        };
        Kernel::for_picture(schedule, surface, &self.viewport, self.binning == RegionBinning::Touched)
    }
}
