//! Tests of spheres as i860 code on a board. The words and bins must equal the words and bins of the native firmware.

use crate::native::native;
use crate::numbers::Numbers;
use glam::{Mat4, Quat, Vec3};
use pphigs::{
    DisplayList, DisplayStructure, EyeView, FrameView, ModelEdit, ModelFrame, Picture, RegionBinning, Shading, Share,
};
use pxpl5_geometry::{Culling, SetupStats, Viewport, WorldSphere};
use pxpl5_gp::{CodeVersion, Processor};
use pxpl5_renderer::Layout;
use pxpl5_sim::SplitMix64;
use pxpl5_wire::{FieldParity, Lines, NodeId, RegionGrid, RegionId, ViewNumber};
use std::sync::Arc;

impl Numbers {
    fn any_colour(&mut self) -> [u8; 3] {
        [0; 3].map(|_| self.0.bits() as u8)
    }

    /// Returns a matrix that rotates, moves and scales uniformly. Every third matrix also mirrors.
    fn near_model(&mut self, n: usize) -> Mat4 {
        let size = 4.0_f32.powf(self.next());
        let mirror = if n.is_multiple_of(3) { -1.0 } else { 1.0 };
        let turn = Quat::from_scaled_axis(self.vector(3.0));
        Mat4::from_rotation_translation(turn, self.vector(2.0)) * Mat4::from_scale(Vec3::new(mirror * size, size, size))
    }

    /// Returns a projection matrix: perspective, also off centre, or parallel.
    fn near_projection(&mut self, n: usize) -> Mat4 {
        let mut lens = Mat4::perspective_rh(1.0 + 0.4 * self.next(), 4.0 / 3.0, 0.25, 60.0);
        match n % 4 {
            0 => Mat4::orthographic_rh(-12.0 + self.next(), 13.0, -9.0, 10.0 + self.next(), 0.1, 60.0),
            1 => {
                lens.z_axis.x = 0.3 * self.next();
                lens.z_axis.y = 0.2 * self.next();
                lens
            }
            _ => lens,
        }
    }

    /// Returns a sphere of random size, from tiny to larger than the picture. Most spheres are in front of the eye.
    /// Some spheres are behind the eye, around the eye, or across the near or far plane.
    fn sphere(&mut self) -> WorldSphere {
        let radius = 10.0_f32.powf(1.5 * self.next() - 1.0);
        let along = Vec3::new(0.5 * self.next(), 0.4 * self.next(), -1.0);
        let centre = along * (28.0 + 36.0 * self.next()) + self.vector(0.5);
        WorldSphere { centre, radius, colour: self.any_colour() }
    }
}

/// Returns difficult spheres: with NaN or too large numbers, of zero size, around the eye, or barely touching the
/// picture's border.
fn odd_spheres() -> Vec<WorldSphere> {
    let mut all = Vec::new();
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 2e30, -3e38, 1e30, -1e29, 0.0] {
        for axis in 0..3 {
            let mut centre = Vec3::new(0.1, 0.2, -5.0);
            centre[axis] = value;
            all.push(WorldSphere { centre, radius: 1.0, colour: [10, 20, 30] });
        }
        all.push(WorldSphere { centre: Vec3::new(0.0, 0.0, -5.0), radius: value, colour: [255; 3] });
    }
    for radius in [-1.0, -0.0, 1e-40, 1e-30, 1e-12, 1e-3, 4.7, 4.75, 4.76, 10.0, 1e4] {
        all.push(WorldSphere { centre: Vec3::new(0.0, 0.0, -5.0), radius, colour: [255, 0, 128] });
        all.push(WorldSphere { centre: Vec3::new(0.3, -0.2, -59.0), radius, colour: [0, 255, 1] });
    }
    all
}

fn list(numbers: &mut Numbers, spheres: usize) -> Arc<DisplayList> {
    let mut all = odd_spheres();
    let first = all.len();
    all.extend((0..spheres).map(|_| numbers.sphere()));
    let structure = |spheres, frame| DisplayStructure { triangles: 0..0, spheres, frame, culling: Culling::None };
    let end = all.len();
    Arc::new(DisplayList {
        spheres: all,
        structures: vec![
            structure(0..first, ModelFrame::Head),
            structure(first..first, ModelFrame::World),
            structure(first..first + spheres / 2, ModelFrame::World),
            structure(first + spheres / 2..end, ModelFrame::Head),
        ],
        towards_light: numbers.vector(1.0).normalize(),
        ambient: 0.3,
        diffuse: 0.6,
        ..DisplayList::default()
    })
}

fn view(numbers: &mut Numbers, n: usize) -> FrameView {
    let turn = Mat4::from_rotation_y(0.2 * numbers.next()) * Mat4::from_rotation_x(0.2 * numbers.next());
    let eye = EyeView {
        world_to_eye: Mat4::from_translation(numbers.vector(1.0)) * turn,
        head_to_eye: Mat4::IDENTITY,
        projection: numbers.near_projection(n),
    };
    let edits = vec![
        ModelEdit { structure: 2, model: Mat4::from_scale(Vec3::splat(1.0 + 0.5 * numbers.next())) },
        ModelEdit { structure: 3, model: numbers.near_model(n) },
    ];
    FrameView { number: ViewNumber::FIRST, eyes: vec![eye], edits }
}

fn add(sum: &mut SetupStats, of: SetupStats) {
    sum.spheres += of.spheres;
    sum.screen_spheres += of.screen_spheres;
    sum.spheres_outside += of.spheres_outside;
    sum.spheres_across_near += of.spheres_across_near;
    sum.spheres_across_far += of.spheres_across_far;
    sum.spheres_not_finite += of.spheres_not_finite;
}

#[test]
fn code_draws_spheres_with_the_words_and_bins_of_the_native_firmware() {
    let mut numbers = Numbers(SplitMix64::new(41));
    let mut all = SetupStats::default();
    let frame = |width, height| {
        let grid = RegionGrid { width, height, ..RegionGrid::FRAME };
        Viewport::new(grid, Lines::Frame).expect("at most 128 regions")
    };
    let ntsc = [Viewport::FRAME, Viewport::field(FieldParity::Even), Viewport::field(FieldParity::Odd)];
    // Faces of a cube, and a frame with partial regions.
    let pictures = [ntsc.as_slice(), &[frame(256, 256), frame(1408, 1408), frame(700, 500)]].concat();
    for n in 0..8 {
        let list = list(&mut numbers, 2000);
        let view = view(&mut numbers, n);
        let share = Share::new(Arc::clone(&list), n % 2, 2);
        let mut processor = Processor::new(NodeId(1), 8 << 20, CodeVersion::Scheduled, i860::Config::functional());
        share.install(&mut processor).expect("it fits");
        for viewport in pictures.iter().copied() {
            for (shading, words) in [(Shading::Gouraud, 53), (Shading::Phong, 38)] {
                let layout = Layout::rendering_control_phong();
                let picture = Picture { viewport, shading, binning: RegionBinning::Touched, layout, pixels: true };
                let pass = share.transform(&view, 0, picture);
                add(&mut all, pass.stats());
                let made = pass.run_code(&mut processor, 0).expect("it returns").expect("it has a kernel");
                let drawn = (made.commands.end - made.commands.start) / (4 * words as u32);
                assert_eq!(u64::from(drawn), pass.stats().screen_spheres, "view {n}, {shading:?}, {viewport:?}");
                for (region, bin) in (0..).zip(&made.bins) {
                    let entries = processor.read(bin.start, (bin.end - bin.start) as usize / 4).expect("in memory");
                    let expected = native(&pass, RegionId(region));
                    assert_eq!(entries.len(), expected.len() / words, "region {region}, view {n}, {viewport:?}");
                    for (at, expected) in entries.iter().zip(expected.chunks(words)) {
                        let found = processor.read(*at, words).expect("in memory");
                        assert_eq!(found, expected, "region {region}, view {n}, {shading:?}, {viewport:?}");
                    }
                }
            }
        }
    }
    let counts = [
        all.screen_spheres,
        all.spheres_outside,
        all.spheres_across_near,
        all.spheres_across_far,
        all.spheres_not_finite,
    ];
    assert!(all.spheres > 40_000 && all.screen_spheres > 10_000 && counts.iter().all(|n| *n > 100), "{all:?}");
}
