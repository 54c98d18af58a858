//! Tests of the view of an eye during a revolution: positions from formulas, sums of light from counts, and reference
//! pictures.

use image::RgbImage;
use pxpl5_scene::builtin;
use pxpl5_sim::parameters::SettingError;
use spatialgl::perspecta::{Camera, PerspectaConfig, ViewOptions, film, view_planes, view_undithered};
use spatialgl::{
    BitPlanes, HostRenderer, Jitter, OneThread, Projection, Rotation, SliceClip, Strobes, Threads, VolumeConfig,
    VolumeFrame, record_scene, render_volume, sin_cos_of_turn,
};
use std::num::NonZero;

const PLAIN: ViewOptions = ViewOptions { cut_deg: None, lambert: false, phase_deg: 0.0, rotation: Rotation::XToZ };

fn case_8(azimuth_deg: f64, elevation_deg: f64) -> Camera {
    Camera { azimuth_deg, elevation_deg, distance: 1536.0, focal: 512.0, size: [512, 512] }
}

/// Returns 396 slices of 768 x 768 pixels with one lit pixel.
fn one_pixel(slice: u32, x: u32, y: u32) -> BitPlanes {
    let mut planes = BitPlanes::dark([768, 768], 396);
    planes.slice_mut(slice)[(y * 96 + x / 8) as usize] = 0x00_01_01_01 << (7 - x % 8);
    planes
}

fn centre(picture: &RgbImage) -> [f64; 2] {
    let mut sums = [0.0; 3];
    for (x, y, pixel) in picture.enumerate_pixels() {
        let light = f64::from(pixel.0[0]);
        sums[0] += light;
        sums[1] += light * (f64::from(x) + 0.5);
        sums[2] += light * (f64::from(y) + 0.5);
    }
    [sums[1] / sums[0], sums[2] / sums[0]]
}

#[test]
fn case_8_a_pixel_is_seen_at_the_position_of_its_voxel() {
    let planes = one_pixel(33, 483, 283);
    let (sin, cos) = sin_cos_of_turn(33, 396);
    let world = [99.5 * cos, 100.5, 99.5 * sin];
    for (found, expected) in world.into_iter().zip([86.169_528, 100.5, 49.75]) {
        assert!((found - expected).abs() < 1e-6);
    }
    for (azimuth, elevation, expected) in [(0.0, 0.0, [285.6846, 221.3786]), (40.0, 25.0, [268.3680, 237.2580])] {
        let camera = case_8(azimuth, elevation);
        let place = camera.project(world);
        assert!((place[0] - expected[0]).abs() < 6e-5 && (place[1] - expected[1]).abs() < 6e-5, "{place:?}");
        let light = view_planes(&planes, &camera, PLAIN, &OneThread).expect("valid");
        // With bilinear interpolation, the centre of the light is the exact position, to 1/256 px and 1/255 of
        // brightness.
        let found = centre(&light.picture(255.0));
        assert!((found[0] - expected[0]).abs() < 0.01 && (found[1] - expected[1]).abs() < 0.01, "{found:?}");
        assert!(light.total().iter().all(|sum| (sum - 1.0).abs() < 1e-9), "one pixel's light");
    }
}

/// Checks the angle of slice k: phase + k d, or phase - k d on a screen that turns the other way.
#[test]
fn phase_and_direction_of_rotation_determine_the_place_of_a_slice() {
    let camera = case_8(40.0, 25.0);
    for (phase_deg, rotation, sign) in
        [(0.0, Rotation::ZToX, -1.0), (30.0, Rotation::XToZ, 1.0), (-71.5, Rotation::ZToX, -1.0)]
    {
        let angle = (phase_deg + sign * 33.0 * 360.0 / 396.0f64).to_radians();
        let expected = camera.project([99.5 * angle.cos(), 100.5, 99.5 * angle.sin()]);
        let options = ViewOptions { phase_deg, rotation, ..PLAIN };
        let light = view_planes(&one_pixel(33, 483, 283), &camera, options, &OneThread).expect("valid");
        let found = centre(&light.picture(255.0));
        assert!((found[0] - expected[0]).abs() < 0.01 && (found[1] - expected[1]).abs() < 0.01, "{found:?}");
    }
}

/// Checks that strobes k and k + 198 show the same plane from opposite sides, so that the same voxel is at the mirrored
/// pixel.
#[test]
fn the_second_half_turn_shows_the_same_voxels() {
    let camera = case_8(40.0, 25.0);
    let one = view_planes(&one_pixel(33, 483, 283), &camera, PLAIN, &OneThread).expect("valid");
    let other = view_planes(&one_pixel(231, 767 - 483, 283), &camera, PLAIN, &OneThread).expect("valid");
    assert_eq!(one, other);
}

#[test]
fn a_cutaway_leaves_out_a_range_of_angles() {
    let camera = case_8(10.0, 20.0);
    // The voxel of the numbered case 8 is at 30 degrees from +x to +z. The voxel of the mirrored pixel is at 210
    // degrees.
    let total = |x: u32, cut: [f64; 2]| {
        let options = ViewOptions { cut_deg: Some(cut), ..PLAIN };
        view_planes(&one_pixel(33, x, 283), &camera, options, &OneThread).expect("valid").total()[0]
    };
    for (cut, first, second) in [
        ([0.0, 90.0], 0.0, 1.0),
        ([29.9, 30.1], 0.0, 1.0),
        ([31.0, 120.0], 1.0, 1.0),
        ([180.0, 270.0], 1.0, 0.0),
        ([300.0, 400.0], 0.0, 1.0),
        ([-90.0, -60.0], 1.0, 1.0),
        ([0.0, 360.0], 0.0, 0.0),
    ] {
        assert!((total(483, cut) - first).abs() < 1e-9, "{cut:?}");
        assert!((total(767 - 483, cut) - second).abs() < 1e-9, "{cut:?}");
    }
}

#[test]
fn lamberts_factor_is_the_cosine_between_screen_and_eye() {
    // Seen along +z from far away, the screen of slice k has the normal e_s = (-sin, 0, cos), so |view . e_s| is about
    // |cos theta|.
    let camera = Camera { azimuth_deg: 0.0, elevation_deg: 0.0, distance: 1e6, focal: 5e5, size: [512, 512] };
    let lambert = ViewOptions { lambert: true, ..PLAIN };
    for k in [0, 33, 66, 99, 150] {
        let light = view_planes(&one_pixel(k, 483, 283), &camera, lambert, &OneThread).expect("valid");
        let (_, cos) = sin_cos_of_turn(i64::from(k), 396);
        assert!((light.total()[0] - cos.abs()).abs() < 0.005, "{k}");
    }
}

fn mig(strobes: Strobes) -> VolumeFrame {
    let commands = record_scene(&builtin("mig").expect("built in"), 384.0, true).expect("valid");
    let projection = Projection::Jittered(Jitter::new(1));
    let display = PerspectaConfig::PAPERS.swept(SliceClip::Hyperbolic(0.25), projection).expect("valid");
    let config = VolumeConfig { strobes, keeps_colours: true, ..VolumeConfig::paper() };
    render_volume(&display, &commands, &config, &HostRenderer, &Threads::all()).expect("valid")
}

#[test]
fn the_light_is_the_sum_of_all_lit_voxels_for_any_number_of_threads() {
    let frame = mig(Strobes::Each);
    let camera = Camera::around(384.0, 40.0, 25.0, 512);
    let alone = view_planes(&frame.planes, &camera, PLAIN, &OneThread).expect("valid");
    for threads in [2, 5] {
        let workers = Threads(NonZero::new(threads).expect("not zero"));
        assert_eq!(view_planes(&frame.planes, &camera, PLAIN, &workers).expect("valid"), alone);
    }
    let most = alone.total().into_iter().fold(0.0, f64::max);
    assert!(most <= frame.planes.lit_voxels() as f64 && most > 0.5 * frame.planes.lit_voxels() as f64);
}

/// Checks that dither preserves the light: on average, a channel of value c lights c/255 of its pixels.
#[test]
fn halftoned_and_undithered_light_agree() {
    for strobes in [Strobes::Each, Strobes::Mirror] {
        let frame = mig(strobes);
        let camera = Camera::around(384.0, 100.0, -10.0, 256);
        let dithered = view_planes(&frame.planes, &camera, PLAIN, &OneThread).expect("valid").total();
        let whole = view_undithered(&frame, &camera, PLAIN, &OneThread).expect("valid").expect("kept").total();
        for channel in 0..3 {
            let ratio = dithered[channel] / whole[channel];
            assert!((ratio - 1.0).abs() < 0.03, "{channel}: {ratio}");
        }
    }
}

#[test]
fn a_film_turns_around_the_volume() {
    let planes = mig(Strobes::Mirror).planes;
    let camera = Camera::around(384.0, 0.0, 15.0, 96);
    let turn: Result<Vec<RgbImage>, SettingError> = film(&planes, camera, PLAIN, 4, &OneThread).collect();
    let turn = turn.expect("valid");
    let exposure = view_planes(&planes, &camera, PLAIN, &OneThread).expect("valid").exposure(0.98);
    let quarter = Camera { azimuth_deg: 90.0, ..camera };
    assert_eq!(turn[1], view_planes(&planes, &quarter, PLAIN, &OneThread).expect("valid").picture(exposure));
    assert!(turn.len() == 4 && turn[0] != turn[1]);
}

#[test]
fn cameras_that_see_nothing_are_refused() {
    let planes = BitPlanes::dark([64, 64], 4);
    let camera = Camera::around(32.0, 0.0, 0.0, 64);
    for (camera, expected) in [
        (Camera { distance: 40.0, ..camera }, "view.distance: expected an eye outside of the display, found 40"),
        (Camera { focal: 0.0, ..camera }, "view.focal: expected a length above 0 px, found 0"),
        (Camera { azimuth_deg: f64::NAN, ..camera }, "view.azimuth: expected a finite angle, found NaN"),
        (Camera { size: [64, 0], ..camera }, "view.size: expected 1 to 8192 px, found 0"),
    ] {
        assert_eq!(view_planes(&planes, &camera, PLAIN, &OneThread).expect_err(expected).to_string(), expected);
    }
    let dark = view_planes(&planes, &camera, PLAIN, &OneThread).expect("valid");
    assert_eq!(dark.total(), [0.0; 3]);
    assert!(dark.picture(dark.exposure(0.98)).pixels().all(|pixel| pixel.0 == [0; 3]));
}

/// Compares a picture with the reference picture, or writes the reference picture if `PXPL5_UPDATE_GOLDEN` is set.
fn golden(name: &str, picture: &RgbImage) {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
    if std::env::var_os("PXPL5_UPDATE_GOLDEN").is_some() {
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        return picture.save(&path).expect("written");
    }
    let expected = image::open(&path).expect("a golden picture").to_rgb8();
    assert!(*picture == expected, "{name} is another picture");
}

/// Compares the view, a cutaway and the view without dither with reference pictures. The code uses libm and integers,
/// so the bits are the same on every host.
#[test]
fn the_picture_of_mig_is_unchanged() {
    let frame = mig(Strobes::Each);
    let camera = Camera::around(384.0, 40.0, 25.0, 256);
    let swept = view_planes(&frame.planes, &camera, PLAIN, &OneThread).expect("valid");
    golden("mig-swept.png", &swept.picture(swept.exposure(0.98)));
    let cut = ViewOptions { cut_deg: Some([0.0, 90.0]), ..PLAIN };
    let cutaway = view_planes(&frame.planes, &camera, cut, &OneThread).expect("valid");
    golden("mig-cutaway.png", &cutaway.picture(swept.exposure(0.98)));
    let whole = view_undithered(&frame, &camera, PLAIN, &OneThread).expect("valid").expect("kept");
    golden("mig-undithered.png", &whole.picture(whole.exposure(0.98)));
    assert!(swept != whole && swept != cutaway);
}
