//! Tests of properties that hold for every direction, rotation and content.

use crate::support::{noise, painted, texels, turned};
use address_recalculation::{
    ArpConfig, ArpTiming, CubeFace, DEPTH_FARTHEST, FaceGeometry, FaceSet, Lens, LensTable, Lookup, Orientation,
    TexelAddress, Vector,
};
use glam::{DMat3, DQuat, DVec3};
use proptest::prelude::*;
use pxpl5_sim::SplitMix64;
use std::sync::LazyLock;

const GUARDED: FaceGeometry = FaceGeometry { texels: 512, guard: 1 };

fn unit(vector: Vector) -> DVec3 {
    DVec3::from_array(vector).normalize()
}

fn degrees_between(a: Vector, b: Vector) -> f64 {
    let [a, b] = [unit(a), unit(b)];
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}

/// Interpolates a function of direction on the faces in floating point, as an ideal display would.
fn interpolated(geometry: FaceGeometry, direction: Vector, field: impl Fn(Vector) -> f64) -> f64 {
    let (face, [a, b]) = geometry.between_texels(direction).expect("a direction");
    let at = |column: f64, row: f64| {
        let texel = TexelAddress { face, column: column as u32, row: row as u32 };
        field(geometry.direction(texel))
    };
    let [i, j] = [a.floor(), b.floor()];
    let [s, t] = [a - i, b - j];
    let top = at(i, j) * (1.0 - s) + at(i + 1.0, j) * s;
    let bottom = at(i, j + 1.0) * (1.0 - s) + at(i + 1.0, j + 1.0) * s;
    top * (1.0 - t) + bottom * t
}

/// Returns the position at which a direction meets the plane of a face. The position can lie outside the face.
fn on_face(face: CubeFace, direction: Vector) -> [f64; 2] {
    let along = |axis: [i64; 3]| (0..3).map(|i| direction[i] * axis[i] as f64).sum::<f64>();
    [along(face.right()) / along(face.forward()), -along(face.up()) / along(face.forward())]
}

static TABLE: LazyLock<LensTable> = LazyLock::new(|| ArpConfig::IDEAL.table().expect("valid"));

proptest! {
    #[test]
    fn the_texel_of_a_direction_does_not_depend_on_its_length(
        direction in prop::array::uniform3(-1.0..1.0_f64),
        exponent in -280..280_i32,
        guard in 0_u32..=8,
    ) {
        prop_assume!(direction.iter().any(|c| c.abs() > 1e-3));
        let geometry = FaceGeometry { texels: 512, guard };
        let texel = geometry.texel(direction).expect("a direction");
        let inside = guard..512 - guard;
        prop_assert!(inside.contains(&texel.column) && inside.contains(&texel.row));
        prop_assert_eq!(geometry.texel(direction.map(|c| c * 2_f64.powi(exponent))), Some(texel));
    }

    /// Checks that looking up pixels for a new orientation equals drawing for it. The drawn function is linear on each
    /// face.
    #[test]
    fn a_head_rotation_shows_the_same_as_a_redraw(axes in prop::array::uniform4(-1.0..1.0_f64), x in 0_u32..640, y in 0_u32..480) {
        prop_assume!(axes.iter().map(|a| a * a).sum::<f64>() > 1e-3);
        let picture = ArpConfig::IDEAL.picture();
        let seen = Orientation::from_quaternion(axes).expect("a rotation").turn(Lens::Flat.view(&picture, x, y));
        let face = CubeFace::of(seen).expect("a direction");
        let linear = |direction: Vector| { let [u, v] = on_face(face, direction); 0.3 + 0.5 * u - 0.7 * v };
        prop_assert!((interpolated(GUARDED, seen, linear) - linear(seen)).abs() < 1e-9);
        // The interpolation error is at most h^2 / 8 times the second derivative, with h = 2/510 and 20^2 = 400.
        let smooth = |direction: Vector| (20.0 * on_face(face, direction)[0]).sin();
        prop_assert!((interpolated(GUARDED, seen, smooth) - smooth(seen)).abs() <= 7.69e-4);
    }

    /// Checks rotations that map axes to axes. A texel is mapped to the same position on another face, so hardware
    /// words lose no precision.
    #[test]
    fn orientations_along_the_axes_are_exact(index in 0_usize..24, x in 0_u32..640, y in 0_u32..480) {
        let orientation = axis_aligned()[index];
        let words = TABLE.entry(x, y);
        let turned = orientation.words(16).turn(words).map(|word| word as f64 / 32_767.0);
        prop_assert_eq!(turned, orientation.turn(words.map(f64::from)));
    }
}

/// Returns the 24 rotations that map axes to axes.
fn axis_aligned() -> Vec<Orientation> {
    let axes = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let pairs = axes.into_iter().flat_map(|a| axes.into_iter().map(move |b| (a, b))).filter(|(a, b)| a.dot(*b) == 0.0);
    let rows = pairs.map(|(a, b)| DMat3::from_cols(a, b, a.cross(b)).transpose().to_cols_array_2d());
    rows.map(|rows| Orientation::new(rows).expect("a rotation")).collect()
}

#[test]
fn the_centre_of_a_texel_maps_to_that_texel() {
    for guard in [0, 1, 8] {
        let geometry = FaceGeometry { texels: 128, guard };
        let inner = guard..128 - guard;
        for texel in texels(128).filter(|texel| inner.contains(&texel.column) && inner.contains(&texel.row)) {
            assert_eq!(geometry.texel(geometry.direction(texel)), Some(texel));
        }
    }
}

/// Checks that the nearest texels on both sides of a cube edge are half a texel away from it. They are 0.1121 degrees
/// apart; texels in the middle of a face are 0.1758 degrees apart.
#[test]
fn texels_on_both_sides_of_an_edge_are_neighbours() {
    let geometry = FaceGeometry { texels: 512, guard: 0 };
    let mut random = SplitMix64::new(1);
    for _ in 0..20_000 {
        let along = 2.0 * f64::from(random.unit()) - 1.0;
        let axis = random.below(3) as usize;
        let mut edge = [1.0; 3].map(|c| if random.bits() & 1 == 0 { c } else { -c });
        edge[axis] = along;
        let mut sides = [edge, edge];
        sides[0][(axis + 1) % 3] *= 1.0 + 1e-9;
        sides[1][(axis + 2) % 3] *= 1.0 + 1e-9;
        let [a, b] = sides.map(|side| geometry.texel(side).expect("a direction"));
        assert_ne!(a.face, b.face);
        let apart = degrees_between(geometry.direction(a), geometry.direction(b));
        assert!(apart <= 0.65 * 90.0 / 512.0, "{apart} degrees between {a:?} and {b:?}");
    }
}

/// Checks that a guard texel shows the neighbouring face. Its nearest texel there is at most half a texel's diagonal
/// away.
#[test]
fn guard_texels_equal_the_texels_of_the_neighbouring_face() {
    let geometry = FaceGeometry { texels: 128, guard: 2 };
    let guard = texels(128).filter(|t| [t.column, t.row].iter().any(|n| !(2..126).contains(n)));
    for texel in guard {
        let direction = geometry.direction(texel);
        let neighbour = geometry.texel(direction).expect("a direction");
        assert_ne!(neighbour.face, texel.face);
        let [u, v] = on_face(neighbour.face, direction);
        let middle = on_face(neighbour.face, geometry.direction(neighbour));
        assert!((u - middle[0]).abs().max((v - middle[1]).abs()) <= 1.0 / 124.0 + 1e-12);
    }
}

/// Checks that half a texel in the middle of a face is f / 510 = 1.0868 pixels.
#[test]
fn the_nearest_texel_is_at_most_1_087_pixels_away_at_the_centre() {
    let focal = 320.0 / 30_f64.to_radians().tan();
    let mut worst = 0.0_f64;
    for y in 200..280 {
        for x in 280..360 {
            let seen = Lens::Flat.view(&ArpConfig::IDEAL.picture(), x, y);
            let shown = GUARDED.direction(GUARDED.texel(seen).expect("a direction"));
            worst = worst.max((shown[0] - seen[0]).abs() * focal).max((shown[1] - seen[1]).abs() * focal);
        }
    }
    assert!(worst <= 1.087 && worst > 1.0, "{worst}");
}

fn displayed(
    config: &ArpConfig,
    orientation: &Orientation,
    memories: &[FaceSet],
    behind: Option<&FaceSet>,
) -> Vec<u32> {
    let table = config.table().expect("valid");
    let mut pixels = vec![0; (table.width() * table.height()) as usize];
    let mut lookup = Lookup::new(config, &table, memories.iter().collect(), behind);
    lookup.run(0, &orientation.words(config.timing.matrix_bits), &mut pixels);
    pixels
}

/// Returns a colour that changes slowly with the direction.
///
/// Its slope is at most 100 x 6 per radian. The error of linear interpolation is therefore at most 100 x 36 / 2 x
/// (texel / 2)^2.
fn soft(direction: Vector) -> f64 {
    let d = unit(direction);
    128.0 + 50.0 * (6.0 * d.x + 2.0 * d.y).sin() + 50.0 * (5.0 * d.z).cos()
}

/// Checks that the error of a rotated picture in hardware words stays below a limit.
///
/// Fractions rounded to 1/16 move the position by at most 1/32 texel along each axis. A texel in the middle covers
/// 2/510 rad. The address adds an error of 0.03 texels. Colours are rounded in the face and in the pixel.
#[test]
fn a_rotated_picture_equals_a_redraw_for_that_orientation() {
    let grey = |direction: Vector| soft(direction).round() as u32 * 0x01_01_01;
    let config = ArpConfig { timing: ArpTiming { display_memories: 1, ..ArpConfig::IDEAL.timing }, ..ArpConfig::IDEAL };
    let faces = [painted(&config, 77, grey)];
    let slope = 50.0 * (6_f64.hypot(2.0) + 5.0);
    let curvature = 50.0 * (40.0 + 25.0) * 3.0;
    let texel = 2.0 / 510.0;
    let bound = 1.0 + slope * 2.0 * texel * (1.0 / 32.0 + 0.03) + 2.0 * curvature * texel * texel / 8.0;
    for quaternion in
        [DQuat::IDENTITY, DQuat::from_rotation_y(3.0), DQuat::from_euler(glam::EulerRot::XYZ, 0.7, 0.8, 2.0)]
    {
        let orientation = turned(quaternion);
        let pixels = displayed(&config, &orientation, &faces, None);
        for (place, pixel) in (0_u32..).zip(&pixels) {
            let seen = orientation.turn(Lens::Flat.view(&config.picture(), place % 640, place / 640));
            let off = (f64::from(pixel & 0xFF) - soft(seen)).abs();
            assert!(off <= bound, "pixel {place}: {off}, bound {bound}");
        }
    }
}

#[test]
fn a_pixel_shows_the_nearest_memory_and_at_equal_depth_the_memory_with_the_lowest_number() {
    for n in 1..=8 {
        let timing = ArpTiming { face_texels: 128, display_memories: n, ..ArpTiming::PAPERS };
        let config = ArpConfig { timing, background: 0x30_20_10, ..ArpConfig::MACHINE };
        for (depths, winner) in
            [([9, 8, 7, 6, 5, 4, 3, 2], n - 1), ([5; 8], 0), ([4, 2, 3, 2, 9, 9, 9, 9], (n - 1).min(1))]
        {
            let faces: Vec<FaceSet> = (0..n).map(|k| painted(&config, depths[k as usize], |_| 10 + k as u32)).collect();
            let pixels = displayed(&config, &Orientation::IDENTITY, &faces, None);
            assert!(pixels.iter().all(|pixel| u64::from(*pixel) == 10 + winner), "{n} memories");
            let table = config.table().expect("valid");
            let mut winners = vec![None; 640];
            let lookup = Lookup::new(&config, &table, faces.iter().collect(), None);
            lookup.winners(640 * 7, &Orientation::IDENTITY.words(16), &mut winners);
            assert!(winners.iter().all(|memory| *memory == Some(winner as u8)));
        }
        let empty: Vec<FaceSet> = (0..n).map(|k| painted(&config, DEPTH_FARTHEST, |_| k as u32)).collect();
        assert!(displayed(&config, &Orientation::IDENTITY, &empty, None).iter().all(|pixel| *pixel == 0x30_20_10));
        let table = config.table().expect("valid");
        let mut winners = vec![Some(0); 640];
        let lookup = Lookup::new(&config, &table, empty.iter().collect(), None);
        lookup.winners(640 * 7, &Orientation::IDENTITY.words(16), &mut winners);
        assert!(winners.iter().all(Option::is_none), "an empty texel has no winner");
    }
}

/// Checks that lookups, which share a buffer in each thread, do not affect each other. Earlier faces of another size or
/// with other contents must leave no traces.
#[test]
fn a_snapshot_does_not_depend_on_earlier_snapshots() {
    let drawings = [(128, 1), (256, 2), (128, 3), (128, 1), (256, 2)].map(|(face_texels, seed)| {
        move || {
            let timing = ArpTiming { face_texels, display_memories: 1, ..ArpTiming::PAPERS };
            let config = ArpConfig { timing, ..ArpConfig::MACHINE };
            let faces = [noise(&config, &mut SplitMix64::new(seed))];
            displayed(&config, &turned(DQuat::from_rotation_y(0.6)), &faces, None)
        }
    });
    for (number, draw) in drawings.into_iter().enumerate() {
        let alone = std::thread::spawn(draw).join().expect("it draws");
        assert!(draw() == alone, "picture {number}");
    }
}

/// Checks experiment E2. Objects distributed over several memories, all drawn from one position, give the same bits as
/// a single memory with all objects.
#[test]
fn several_memories_show_the_same_as_one_memory() {
    let timing = ArpTiming { face_texels: 128, ..ArpTiming::PAPERS };
    let four = ArpConfig { timing, ..ArpConfig::MACHINE };
    let one = ArpConfig { timing: ArpTiming { display_memories: 1, ..timing }, ..ArpConfig::MACHINE };
    let mut random = SplitMix64::new(2);
    let parts: Vec<FaceSet> = (0..4).map(|_| noise(&four, &mut random)).collect();
    let mut whole = FaceSet::new(128, one.format());
    for texel in texels(128) {
        for (colour, depth) in parts.iter().filter_map(|part| part.texel(texel)) {
            if whole.texel(texel).is_none_or(|(_, before)| depth < before) {
                whole.set(texel, colour, depth);
            }
        }
    }
    for quaternion in [DQuat::IDENTITY, DQuat::from_rotation_y(std::f64::consts::PI), DQuat::from_rotation_x(0.9)] {
        let orientation = turned(quaternion);
        assert_eq!(displayed(&four, &orientation, &parts, None), displayed(&one, &orientation, &[whole.clone()], None));
    }
}

/// Checks that a straight edge of the world, seen through the lens, is straight on a flat picture (RP93; E9).
///
/// The position of a texel on the flat picture does not depend on the lens.
#[test]
fn a_straight_edge_in_the_world_is_straight_when_seen_through_the_lens() {
    let picture = ArpConfig::IDEAL.picture();
    let lens = Lens::Radial { k1: 0.32, k2: 0.05 };
    let focal = 320.0 / 30_f64.to_radians().tan();
    for (x, y) in (0..640).step_by(13).flat_map(|x| (0..480).step_by(11).map(move |y| (x, y))) {
        let seen = lens.view(&picture, x, y);
        let radius = |x: f64, y: f64| x.hypot(y) / 320.0;
        let [right, down] = [f64::from(x) + 0.5 - 320.0, f64::from(y) + 0.5 - 240.0];
        let rho = radius(right, down);
        let stretch = 1.0 + 0.32 * rho.powi(2) + 0.05 * rho.powi(4);
        let back = [seen[0] * focal / stretch, -seen[1] * focal / stretch];
        assert!((back[0] - right).abs() < 1e-9 && (back[1] - down).abs() < 1e-9);
        // Three pixels of a line on the flat picture stay in one plane through the eye.
        let [left, middle, far] = [0, 300, 639].map(|x| DVec3::from_array(Lens::Flat.view(&picture, x, y)));
        assert!(left.cross(far).dot(middle).abs() < 1e-12);
    }
}
