//! Tests of the ideal renderer. The expected shapes and colours of the pictures are computed by hand.

use glam::{Mat4, Vec3};
use image::Rgb;
use pphigs::oracle::{IdealPicture, ideal_picture};
use pphigs::{DisplayList, DisplayStructure, EyeView, FrameView, ModelFrame, Picture, RegionBinning, Shading};
use pxpl5_geometry::{Culling, Viewport, WorldSphere};
use pxpl5_renderer::Layout;
use pxpl5_wire::{FieldParity, ViewNumber};

const RED: [u8; 3] = [200, 0, 0];
const GREEN: [u8; 3] = [0, 200, 0];
const BACKGROUND: [u8; 3] = [1, 2, 3];

/// Returns a display list in which a unit of length is one pixel. x increases to the right, and y increases upwards
/// from the picture's lower border. The eye looks along -z, from depth 0 to 100.
fn list() -> DisplayList {
    DisplayList {
        structures: vec![DisplayStructure {
            triangles: 0..0,
            spheres: 0..0,
            frame: ModelFrame::World,
            culling: Culling::None,
        }],
        towards_light: Vec3::Z,
        ambient: 1.0,
        diffuse: 0.0,
        background: BACKGROUND,
        ..DisplayList::default()
    }
}

/// Adds a rectangle of two triangles.
fn square(list: &mut DisplayList, across: [f32; 2], down: [f32; 2], distance: f32, colour: [u8; 3]) {
    let first = list.positions.len() as u32;
    for (x, y) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
        list.positions.push(Vec3::new(across[x], 480.0 - down[y], -distance));
        list.normals.push(Vec3::Z);
        list.colours.push(colour);
    }
    list.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|corners| corners.map(|i| first + i)));
    list.structures[0].triangles.end = list.triangles.len();
}

fn view() -> FrameView {
    let projection = Mat4::orthographic_rh(0.0, 640.0, 0.0, 480.0, 0.0, 100.0);
    let eye = EyeView { world_to_eye: Mat4::IDENTITY, head_to_eye: Mat4::IDENTITY, projection };
    FrameView { number: ViewNumber::FIRST, eyes: vec![eye], edits: Vec::new() }
}

fn drawn_in(list: &DisplayList, viewport: Viewport, shading: Shading) -> IdealPicture {
    let layout = match shading {
        Shading::Gouraud | Shading::Precomputed => Layout::slats(),
        Shading::Phong => Layout::rendering_control_phong(),
    };
    ideal_picture(
        list,
        &view(),
        0,
        &Picture { viewport, shading, binning: RegionBinning::Touched, layout, pixels: true },
    )
}

fn drawn(list: &DisplayList) -> IdealPicture {
    drawn_in(list, Viewport::FRAME, Shading::Gouraud)
}

#[test]
fn a_square_covers_exactly_its_pixels_once() {
    let mut list = list();
    square(&mut list, [10.0, 30.0], [20.0, 45.0], 50.0, RED);
    let picture = drawn(&list);
    for (x, y, Rgb(colour)) in picture.image().enumerate_pixels() {
        let inside = (10..30).contains(&x) && (20..45).contains(&y);
        assert_eq!(*colour, if inside { RED } else { BACKGROUND }, "{x}, {y}");
    }
    assert_eq!(picture.ties().len(), 0);
}

#[test]
fn a_field_is_every_second_line_of_its_frame() {
    let mut list = list();
    square(&mut list, [10.3, 300.7], [20.2, 401.9], 50.0, RED);
    square(&mut list, [100.1, 500.0], [3.0, 77.5], 20.0, GREEN);
    let frame = drawn(&list);
    for parity in [FieldParity::Even, FieldParity::Odd] {
        let field = drawn_in(&list, Viewport::field(parity), Shading::Gouraud);
        for (x, y, colour) in field.image().enumerate_pixels() {
            assert_eq!(colour, frame.image().get_pixel(x, 2 * y + parity.first_line()));
        }
    }
}

#[test]
fn the_nearer_square_wins_in_any_drawing_order_without_ties() {
    for order in [[(10.0, RED), (20.0, GREEN)], [(20.0, GREEN), (10.0, RED)]] {
        let mut list = list();
        order.iter().for_each(|(distance, colour)| square(&mut list, [0.0, 8.0], [0.0, 8.0], *distance, *colour));
        let picture = drawn(&list);
        assert_eq!(picture.image().get_pixel(3, 3).0, RED);
        assert_eq!(picture.ties().len(), 0);
    }
}

#[test]
fn a_pixel_at_equal_depth_shows_one_of_the_two_colours() {
    let mut list = list();
    square(&mut list, [0.0, 8.0], [0.0, 8.0], 10.0, RED);
    square(&mut list, [4.0, 12.0], [0.0, 8.0], 10.0, GREEN);
    // This square is behind both other squares, so its pixels have no tie.
    square(&mut list, [0.0, 12.0], [0.0, 8.0], 30.0, [9; 3]);
    let picture = drawn(&list);
    let ties: Vec<_> = picture.ties().map(|tie| [tie.x, tie.y]).collect();
    let expected: Vec<_> = (0..8).flat_map(|y| (4..8).map(move |x| [x, y])).collect();
    assert_eq!(ties, expected);
    assert!(picture.ties().all(|tie| tie.colours == [RED, GREEN]));
    let mut other = picture.image().clone();
    other.put_pixel(5, 5, Rgb(GREEN));
    assert_eq!(picture.differences(&other), Vec::<[u32; 2]>::new());
    other.put_pixel(6, 5, Rgb([9; 3]));
    other.put_pixel(1, 2, Rgb(GREEN));
    assert_eq!(picture.differences(&other), [[1, 2], [6, 5]]);
}

#[test]
fn a_sphere_hides_a_square_that_cuts_the_sphere_behind_its_front() {
    let mut list = list();
    let centre = [200.3_f32, 100.2];
    list.spheres.push(WorldSphere {
        centre: Vec3::new(centre[0], 480.0 - centre[1], -50.0),
        radius: 30.0,
        colour: RED,
    });
    list.structures[0].spheres = 0..1;
    // The square cuts the sphere 18 units before its middle. A disc of radius 24 is in front of the square.
    square(&mut list, [100.0, 300.0], [50.0, 150.0], 32.0, GREEN);
    let picture = drawn(&list);
    for (x, y, Rgb(colour)) in picture.image().enumerate_pixels() {
        let from_middle = f32::hypot(x as f32 + 0.5 - centre[0], y as f32 + 0.5 - centre[1]);
        if from_middle < 23.9 {
            assert!(colour[0] > 190 && colour[1] == 0, "{x}, {y}: {colour:?}");
        } else if from_middle > 24.1 && (100..300).contains(&x) && (50..150).contains(&y) {
            assert_eq!(*colour, GREEN, "{x}, {y}");
        }
    }
}

/// The light comes from the eye. A surface that faces the eye has full light and a highlight of 96 of 255. A surface at
/// 60 degrees has half the light, and the 32nd power of the highlight's cosine is 0.
#[test]
fn phong_shading_follows_the_cosine() {
    for (turn_deg, light, highlight) in [(0.0_f32, 1.0_f32, 96.0), (60.0, 0.5, 0.0)] {
        let mut list = DisplayList { ambient: 0.25, diffuse: 0.5, ..list() };
        // Two-sided light depends on the visible side, so the square is far enough from the origin to show its front.
        square(&mut list, [0.0, 8.0], [0.0, 8.0], 90.0, [160, 80, 0]);
        let turn = turn_deg.to_radians();
        list.normals.fill(Vec3::new(turn.sin(), 0.0, turn.cos()));
        let picture = drawn_in(&list, Viewport::FRAME, Shading::Phong);
        let Rgb(seen) = *picture.image().get_pixel(4, 4);
        for (component, full) in seen.into_iter().zip([160.0, 80.0, 0.0]) {
            let expected = full * (0.25 + 0.5 * light) + highlight;
            assert!((f32::from(component) - expected).abs() < 6.0, "{turn_deg}: {seen:?}, {expected}");
        }
        assert_eq!(picture.image().get_pixel(100, 100).0, BACKGROUND, "not shaded");
    }
}
