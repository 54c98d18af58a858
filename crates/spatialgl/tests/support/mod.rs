//! The triangles of the hard cases, and functions that draw them.

use glam::{DMat4, DVec3};
use spatialgl::*;

pub(crate) type Triangle = [[f64; 3]; 3];

pub(crate) const T1: Triangle = [[-200.3, -150.2, 40.1], [200.4, -150.2, 40.1], [0.6, 200.7, 40.1]];
pub(crate) const T2: Triangle = [[50.3, -100.2, 0.0], [300.7, -100.2, 0.0], [50.3, 150.6, 0.0]];
pub(crate) const T3: Triangle = [[-200.3, 10.2, -100.4], [250.6, 10.2, -150.3], [30.7, 10.2, 260.9]];
pub(crate) const T4: Triangle = [[-100.3, -80.2, -30.6], [120.4, -60.7, 40.3], [10.9, 90.1, 20.2]];
pub(crate) const T5: Triangle = [[3.3, -50.2, 2.1], [9.7, -50.2, -4.4], [5.1, 60.6, 6.3]];
pub(crate) const T8: Triangle = [[0.1, -20.0, 5.0], [0.3, -20.0, 6.0], [0.2, 20.0, 5.5]];

/// The eye and shear of the numbered case 9.
pub(crate) const ASIDE: Projection =
    Projection::Perspective { eye: [100.0, -150.0], distance: 1536.0, shear: [0.05, 0.1] };

/// A flat screen without hidden surfaces, whose pixels have one bit for each colour.
pub(crate) struct Screen(Size, [SliceView; 1]);

impl Screen {
    pub(crate) fn new(size: Size) -> Self {
        let [width, height] = size.map(f64::from);
        // Depth 0 is at z = 4, and depth 1 at z = -4.
        let scale = DMat4::from_scale(DVec3::new(2.0 / width, 2.0 / height, -1.0 / 8.0));
        let projection = DMat4::from_translation(DVec3::new(0.0, 0.0, 0.5)) * scale;
        Self(size, [SliceView::new(DMat4::IDENTITY, projection, SliceVolume::Frustum, size)])
    }
}

impl SpatialDisplay for Screen {
    fn views(&self) -> &[SliceView] {
        &self.1
    }

    fn target_size(&self) -> Size {
        self.0
    }

    fn pixel_format(&self) -> PixelFormat {
        PixelFormat::Rgb1
    }

    fn shows(&self, _: DVec3) -> bool {
        true
    }
}

/// Returns a recording of draw calls for white triangles.
pub(crate) fn recording(triangles: &[Triangle]) -> CommandBuffer {
    let vertices = triangles.iter().flatten().map(|p| ColouredVertex::new(DVec3::from_array(*p), [255; 3])).collect();
    let buffer = VertexBuffer::new(vertices).expect("finite");
    let mut context = DrawContext::default();
    context.draw(&buffer, 0..buffer.len(), Topology::Triangles).expect("in range");
    context.present()
}

pub(crate) fn swept(clip: SliceClip, projection: Projection) -> SweptDisplay {
    SweptDisplay::new(SweptConfig::perspecta(clip, projection)).expect("valid")
}

/// Returns the configuration in which only the first half of the slices is drawn. Without jitter, the other half shows
/// the same slices mirrored.
pub(crate) fn half(config: VolumeConfig) -> VolumeConfig {
    VolumeConfig { strobes: Strobes::Mirror, ..config }
}

/// Returns the configuration for tests that count fragments only. It has no bins. It has tiles, so that dark pixels are
/// not packed into words that no test reads.
pub(crate) fn counting() -> VolumeConfig {
    half(VolumeConfig { tiling: Tiling { tile: Some(32), batch: 1 }, ..VolumeConfig::plain() })
}

pub(crate) fn volume(display: &dyn SpatialDisplay, commands: &CommandBuffer, config: &VolumeConfig) -> VolumeFrame {
    render_volume(display, commands, config, &HostRenderer, &OneThread).expect("valid")
}

/// Draws as [`volume`] does, and checks that the reference model gives the same voxels and counts.
pub(crate) fn both(display: &dyn SpatialDisplay, commands: &CommandBuffer, config: &VolumeConfig) -> VolumeFrame {
    let fast = volume(display, commands, config);
    let reference = render_volume(display, commands, config, &ReferenceRenderer, &Threads::all()).expect("valid");
    assert!(fast.planes == reference.planes, "the oracle has other voxels");
    assert_eq!(fast.stats, reference.stats);
    assert!(fast.colours == reference.colours);
    fast
}

/// Returns the number of fragments in slices 0 to 197 without bins, and the number of slices that are not empty. Only
/// the fast rasterizer is used. Tests that compare with the reference model at full size call [`both`].
pub(crate) fn fragments(triangles: &[Triangle], clip: SliceClip, projection: Projection) -> (u64, u64) {
    let frame = volume(&swept(clip, projection), &recording(triangles), &counting());
    (frame.stats.fragments_accepted, frame.stats.slices_rendered - frame.stats.slices_empty)
}
