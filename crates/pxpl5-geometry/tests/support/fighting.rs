//! Z fighting: visibility of two surfaces with nearly equal depths.

use super::exact::ExactTriangle;
use super::native::Piece;
use super::{HEIGHT, WIDTH, at_pixel, pixel_view};
use glam::Vec3;
use pxpl5_geometry::{Culling, Light, SetupStats, Transform, Triangle, ViewTransform, Viewport};

/// The number of pixels in which two surfaces overlap, and the number of pixels in which the farther surface is
/// visible.
#[derive(Clone, Debug)]
pub struct Fight {
    pub name: String,
    pub pixels: u64,
    pub wrong: u64,
    /// Median distance of the two surfaces, in units of pixel depth.
    pub apart: f64,
}

fn view() -> ViewTransform {
    pixel_view(64.0, 16_384.0)
}

/// Returns a triangle over most of the screen. The distances of its three corners are multiplied by `scale`.
fn surface(scale: [f32; 3]) -> Triangle {
    Triangle {
        positions: [at_pixel(10.3, 20.1, scale[0]), at_pixel(630.7, 90.4, scale[1]), at_pixel(200.9, 470.2, scale[2])],
        normals: [Vec3::Z; 3],
        colours: [[128; 3]; 3],
    }
}

fn fight(name: String, first: [f32; 3], second: [f32; 3]) -> Fight {
    let transform = Transform::new(&view(), Viewport::FRAME, Culling::None).expect("a finite view");
    let pair = [surface(first), surface(second)];
    let pieces = pair.map(|t| {
        let mut stats = SetupStats::default();
        let mut found = Vec::new();
        transform.gouraud(&t, &Light::NONE, &mut stats, |s| found.push(s));
        Piece::new(found[0], &mut stats)
    });
    let exact = pair.map(|t| ExactTriangle::new(&view(), &t).expect("it has an area"));
    let mut apart = Vec::new();
    let mut wrong = 0;
    for y in 0..HEIGHT {
        let spans = [exact[0].span(y), exact[1].span(y)];
        let range = spans[0][0].max(spans[1][0])..=spans[0][1].min(spans[1][1]);
        for x in range.filter(|x| (0..WIDTH).contains(x) && (x + y) % 4 == 0) {
            if !pieces.iter().all(|p| p.inside_edges(x, y)) {
                continue;
            }
            // The surfaces are drawn in order. The second surface is visible only if its depth is strictly nearer.
            let seen = pieces[1].depth(x, y) < pieces[0].depth(x, y);
            wrong += u64::from(seen != exact[1].nearer_than(&exact[0], x, y));
            let units = (exact[1].depth(x, y) - exact[0].depth(x, y)) * 16_777_216.0;
            apart.push(units.abs());
        }
    }
    apart.sort_by(f64::total_cmp);
    Fight { name, pixels: apart.len() as u64, wrong, apart: apart[apart.len() / 2] }
}

/// Measures pairs of parallel surfaces with decreasing distances, then pairs that cross at decreasing angles.
pub fn all() -> Vec<Fight> {
    let base = [1.0, 1.5, 2.0];
    let mut fights = Vec::new();
    for power in [8_u8, 12, 16, 18, 20, 22] {
        let nearer = 1.0 - 1.0 / (1_u32 << power) as f32;
        fights.push(fight(format!("parallel, 2^-{power}"), base, base.map(|s| s * nearer)));
    }
    for power in [4_u8, 8, 12, 16, 20] {
        let tilt = 1.0 / (1_u32 << power) as f32;
        let crossing = [1.0 - tilt, 1.5, 2.0 + tilt];
        fights.push(fight(format!("crossing, 2^-{power}"), base, crossing));
    }
    fights
}
