//! Numeric cases for the policies, computed by hand: theta = 90/512 degrees, 60 frames per second.

use address_recalculation::priority::{
    Cell, CellAssignment, Distance, Falloff, ObjectView, PriorityTiming, RegionWarp, SizeRule, Threshold, Translation,
    Update, draws_per_s, level, saved_percent,
};
use glam::DVec3;

fn threshold() -> Threshold {
    Threshold::of_degrees(90.0 / 512.0)
}

fn near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found}, expected {expected}");
}

fn at(x: f64, z: f64) -> DVec3 {
    DVec3::new(x, 1.7, z)
}

#[test]
fn case_16_distance_and_speed_give_the_computed_period_and_memory() {
    for (distance, speed, ms, expected) in
        [(10.0, 1.0, 30.6796, 0), (11.0, 1.0, 33.7476, 1), (0.5, 1.0, 1.53398, 0), (3.0, 0.37, 24.8754, 0)]
    {
        let period = threshold().way(distance) / speed;
        near(1e3 * period, ms, 1e-4);
        assert_eq!(level(period, 1.0 / 60.0, 4), expected);
    }
}

/// The distances are d = 2^k/60 s x 1 m/s / (2 sin(theta / 2)).
#[test]
fn case_17_memories_begin_at_the_computed_distances() {
    for (k, distance) in [(1, 10.8650), (2, 21.7300), (3, 43.4599)] {
        near(f64::from(1 << k) / 60.0 / threshold().way(1.0), distance, 5e-5);
        let levels = [distance - 1e-3, distance + 1e-3].map(|d| level(threshold().way(d), 1.0 / 60.0, 4));
        assert_eq!(levels, [k - 1, k]);
    }
    assert_eq!(level(1e9, 1.0 / 60.0, 4), 3);
    assert_eq!(level(f64::INFINITY, 1.0 / 60.0, 1), 0);
}

#[test]
fn cases_18_and_19_the_size_of_an_object_limits_the_approach_to_the_computed_distance() {
    let disc = threshold();
    for (c, r, ms) in [(5.0, 1.0, 78.5621), (10.0, 5.0, 76.2315), (1.0, 5.0, 15.9437)] {
        near(1e3 * disc.max_approach(c, r), ms, 1e-4);
    }
    let sphere = Threshold { size: SizeRule::Sphere, ..disc };
    for (c, r, ms) in [(5.0, 1.0, 74.0137), (5.0, 4.0, 11.4550), (2.0, 1.9, 2.00535)] {
        near(1e3 * sphere.max_approach(c, r), ms, 1e-4);
    }
    // An object that is much nearer than its radius reaches an angle of 90 degrees. The limit is then the remaining
    // distance.
    near(disc.max_approach(1e-3, 5.0), 1e-3, 0.0);
    near(sphere.max_approach(5.000_001, 5.0), 1e-6, 1e-12);
    near(sphere.max_approach(4.0, 5.0), 0.0, 0.0);
}

/// Tests statement A8 of the papers. If a disc gives the size, the change of size never limits the validity period. If
/// a sphere gives the size, the change limits the period for 2 r > 1.411 c. Neither gives the published factor of 10.
#[test]
fn the_size_of_a_sphere_limits_the_period_beyond_1_411_distances_and_the_size_of_a_disc_never_does() {
    let decides = |size: SizeRule, diameter: f64| {
        let threshold = Threshold { size, ..threshold() };
        threshold.max_approach(1.0, diameter / 2.0) < threshold.way(1.0)
    };
    for diameter in (1..200).map(|n| f64::from(n) * 0.1) {
        assert!(!decides(SizeRule::Disc, diameter), "{diameter}");
    }
    assert!(!decides(SizeRule::Sphere, 1.40) && decides(SizeRule::Sphere, 1.42));
}

#[test]
fn case_20_a_rotating_object_has_the_computed_period() {
    let turn = 90_f64.to_radians();
    near(1e3 * threshold().turn_s(5.0, 1.0, turn), 9.76571, 1e-5);
    assert_eq!(threshold().turn_s(652.0, 1.0, turn), f64::INFINITY);
    assert!(threshold().turn_s(651.8, 1.0, turn).is_finite());
    assert_eq!(threshold().turn_s(5.0, 1.0, 0.0), f64::INFINITY);
}

fn assignment() -> CellAssignment {
    CellAssignment { home: Cell { x: 0, z: 0 }, side_m: 5.0, inner_rings: 1, ring_growth: 1, memories: 4 }
}

#[test]
fn case_22_the_borders_of_memories_give_the_computed_distances_and_periods() {
    let eye = at(2.0, 1.0);
    for (k, distance, way_mm, frames) in [(1, 6.0, 18.408, 2.0), (2, 11.0, 33.748, 3.0), (3, 16.0, 49.087, 3.0)] {
        near(assignment().distance(eye, k), distance, 1e-12);
        let way = threshold().way(distance);
        near(1e3 * way, way_mm, 5e-4);
        near((way * 60.0).ceil(), frames, 0.0);
    }
    assert_eq!(assignment().distance(eye, 0), 0.0);
    // A memory ends at the border where the next slower memory begins.
    assert_eq!([0, 1, 2, 3].map(|k| assignment().to_slower(eye, k)), [Some(6.0), Some(11.0), Some(16.0), None]);
    assert_eq!(assignment().to_slower(at(99.0, 1.0), 1), Some(0.0), "outside");
    assert_eq!(assignment().distance(at(99.0, 1.0), 2), 0.0, "outside");
}

#[test]
fn cases_23_and_24_positions_belong_to_the_expected_cells_and_memories() {
    let cells = [(12.3, -0.1), (5.0, 0.0), (-5.0, 4.999)].map(|(x, z)| Cell::of(x, z, 5.0));
    assert_eq!(cells, [Cell { x: 2, z: -1 }, Cell { x: 1, z: 0 }, Cell { x: -1, z: 0 }]);
    let memories = [(0, 0), (1, -1), (2, 0), (3, -3), (4, 1), (9, 9)].map(|(x, z)| assignment().memory(Cell { x, z }));
    assert_eq!(memories, [0, 0, 1, 2, 3, 3]);
    let far = Cell { x: i64::MAX, z: i64::MIN };
    assert_eq!(assignment().memory(far), 3);
}

/// Memory k begins outside ring q + 1 + g + ... + g^(k-2). With q = 1 and g = 2, memories 1 to 3 begin outside rings 1,
/// 2 and 4.
#[test]
fn with_doubling_rings_memories_1_to_3_begin_outside_rings_1_2_and_4() {
    let doubling = CellAssignment { ring_growth: 2, ..assignment() };
    assert_eq!([0, 1, 2].map(|memory| doubling.last_ring(memory)), [1, 2, 4]);
    let memories = (0..=7).map(|ring| doubling.memory(Cell { x: -ring, z: 0 })).collect::<Vec<_>>();
    assert_eq!(memories, [0, 0, 1, 2, 2, 3, 3, 3]);
    let eye = at(2.0, 1.0);
    assert_eq!([1, 2, 3].map(|memory| doubling.distance(eye, memory)), [6.0, 11.0, 21.0]);
    assert_eq!([0, 1, 2, 3].map(|memory| doubling.to_slower(eye, memory)), [Some(6.0), Some(11.0), Some(21.0), None]);
    let eight = CellAssignment { memories: 8, ..doubling };
    assert_eq!(eight.last_ring(6), 64);
    assert_eq!(eight.memory(Cell { x: 64, z: 0 }), 6);
    assert_eq!(eight.memory(Cell { x: 65, z: 0 }), 7);
}

#[test]
fn case_25_a_warped_vertex_has_the_same_direction_and_depth_in_both_memories() {
    let faster = at(0.0, 0.0);
    let slower = at(-0.0255, 0.0);
    let vertex = DVec3::new(4.7, 1.0, 2.0);
    let moved = RegionWarp::new(Falloff::Linear, 5.0, faster, slower).expect("a length").moved(vertex, Some(0.0));
    assert!((moved - DVec3::new(4.7255, 1.0, 2.0)).length() < 1e-12);
    let seen = [moved - faster, vertex - slower];
    for direction in seen.map(DVec3::normalize) {
        assert!((direction - DVec3::new(0.912463592, -0.135165488, 0.386187109)).length() < 1e-9, "{direction}");
    }
    assert!((seen[0] - seen[1]).length() < 1e-12, "depth too");
    let torn = (vertex - faster).angle_between(vertex - slower).to_degrees();
    near(torn, 0.115952, 1e-6);
    near(torn * 512.0 / 90.0, 0.660, 5e-4);
}

/// The angle of a chord at 5 m is 2 asin(D / 10).
#[test]
fn case_26_the_greatest_tear_at_5_metres_has_the_computed_angle() {
    let way = threshold().way(5.0);
    near(1e3 * way, 15.340, 5e-4);
    let degrees = |chord: f64| (2.0 * (chord / 10.0).asin()).to_degrees();
    near(degrees(way), 0.17578, 5e-6);
    near(degrees(way + 1.0 / 60.0), 0.36677, 1e-5);
    near(1e3 * (way + 1.0 / 60.0), 32.006, 1e-3);
}

#[test]
fn case_27_each_falloff_has_the_computed_weights() {
    let weights = |falloff: Falloff| [0.0, 2.0, 5.0, 7.0].map(|s| falloff.weight(s, 5.0));
    assert_eq!(weights(Falloff::Linear), [1.0, 0.6, 0.0, 0.0]);
    assert_eq!(weights(Falloff::Step), [1.0, 1.0, 0.0, 0.0]);
    assert_eq!(weights(Falloff::None), [0.0; 4]);
    let smooth = weights(Falloff::Smoothstep);
    near(smooth[1], 0.36 * 1.8, 1e-12);
    assert_eq!([smooth[0], smooth[2], smooth[3]], [1.0, 0.0, 0.0]);
}

#[test]
fn case_28_the_printed_tables_give_the_computed_draws_per_second() {
    let rates = [60.0, 39.25, 28.21, 16.15];
    let all = |segments: [u64; 4]| 60.0 * segments.iter().sum::<u64>() as f64;
    let with = [87, 14, 20, 62];
    let without = [160, 8, 3, 42];
    near(draws_per_s(&rates, &with), 7_335.0, 1e-9);
    near(draws_per_s(&rates, &without), 10_676.93, 1e-9);
    near(saved_percent(7_335.0, draws_per_s(&rates, &without)), 31.300, 5e-4);
    near(saved_percent(7_335.0, all(with)), 33.197, 5e-4);
    near(saved_percent(draws_per_s(&rates, &without), all(without)), 16.456, 5e-4);
}

#[test]
fn the_chord_rule_exceeds_the_sine_rule_by_1_2_millionths() {
    let sine = Threshold { translation: Translation::Sine, ..threshold() };
    let more = threshold().way(10.0) / sine.way(10.0) - 1.0;
    near(more, 1.2e-6, 5e-8);
}

#[test]
fn the_period_of_an_object_is_the_least_of_its_limits() {
    let still = ObjectView { distance_m: 5.0, radius_m: 1.0, speed: 0.0, turn: 0.0, animation_s: f64::INFINITY };
    assert_eq!(threshold().period(&still).least(), f64::INFINITY);
    assert_eq!(threshold().period(&ObjectView { distance_m: 0.9, ..still }).least(), 0.0, "inside");
    assert_eq!(threshold().period(&ObjectView { animation_s: 0.25, ..still }).least(), 0.25);
    let walking = threshold().period(&ObjectView { speed: 1.0, ..still });
    near(1e3 * walking.size_s, 78.5621, 1e-4);
    near(walking.least(), threshold().way(4.0), 1e-15);
    assert_eq!(threshold().period(&ObjectView { distance_m: 1.0, ..still }).least(), 0.0, "on its surface");
}

/// Checks validity periods against values computed by hand. The distance that counts for translation is the nearest
/// point or the centre. A rotating object also has a period.
#[test]
fn the_validity_period_uses_the_distance_to_the_nearest_point_or_to_the_centre_of_an_object() {
    let seen = ObjectView { distance_m: 5.0, radius_m: 0.5, speed: -2.0, turn: -0.5, animation_s: f64::INFINITY };
    let theta = (90.0_f64 / 512.0).to_radians();
    for (distance, counted) in [(Distance::Nearest, 4.5), (Distance::Centre, 5.0)] {
        let period = Threshold { distance, ..threshold() }.period(&seen);
        near(period.translation_s, 2.0 * counted * (theta / 2.0).sin() / 2.0, 1e-12);
        near(period.turn_s, 2.0 / 0.5 * (4.5 * theta.sin() / (2.0 * 0.5)).asin(), 1e-12);
        near(period.size_s, threshold().max_approach(5.0, 0.5) / 2.0, 1e-15);
        assert_eq!(period.animation_s, f64::INFINITY);
    }
}

/// The period is infinite if the argument of the arcsine is 1 or more, and for objects that do not rotate or have no
/// size.
#[test]
fn an_object_without_visible_rotation_stays_correct_for_ever() {
    let right_angle = Threshold::of_degrees(90.0);
    assert_eq!(right_angle.turn_s(2.0, 1.0, 1.0), f64::INFINITY, "2 x sin 90 / 2 is 1");
    near(right_angle.turn_s(1.0, 1.0, 1.0), 2.0 * 0.5_f64.asin(), 1e-12);
    assert_eq!(threshold().turn_s(0.0, 0.0, 1.0), f64::INFINITY, "a point");
}

#[test]
fn a_frame_lasts_a_sixtieth_of_a_second() {
    near(PriorityTiming::PAPERS.frame_s(), 1.0 / 60.0, 1e-15);
}

#[test]
fn the_memories_that_swap_together_are_encoded_as_a_bit_mask() {
    let update =
        Update { due: vec![true, false, true, true], together: vec![true, false, true, false], reassigns_cells: false };
    assert_eq!(update.together_bits(), 0b0101);
    assert!(update.memories().eq([0, 2, 3]));
    assert_eq!(Update { together: vec![true; 8], ..update }.together_bits(), 0xFF);
}

/// A vertex far from any border, or beyond the falloff, does not move. Half-way, it moves by half of the displacement.
#[test]
fn the_displacement_of_a_vertex_depends_on_its_distance_from_the_border() {
    let displacement = DVec3::new(0.2, -0.1, 0.4);
    let warp = RegionWarp::new(Falloff::Linear, 5.0, at(3.0, 4.0) + displacement, at(3.0, 4.0)).expect("a length");
    let vertex = DVec3::new(7.0, 8.0, 9.0);
    for (to_slower, share) in [(None, 0.0), (Some(6.0), 0.0), (Some(2.5), 0.5), (Some(0.0), 1.0)] {
        let moved = warp.moved(vertex, to_slower);
        assert!((moved - vertex - displacement * share).length() < 1e-12, "{to_slower:?}: {moved}");
    }
    for length in [0.0, -1.0, f64::INFINITY] {
        let error = RegionWarp::new(Falloff::Linear, length, DVec3::ZERO, DVec3::ZERO).expect_err("no length");
        assert_eq!(error.to_string(), format!("priority.falloff_m: expected a length above 0, found {length}"));
    }
}

proptest::proptest! {
    /// The cell of a position is exact, although the division is rounded, even next to a border.
    #[test]
    fn a_position_lies_between_the_borders_of_its_cell(number in -1_000_000i64..1_000_000, side in 1e-3..1e3_f64, beside in -2i8..3) {
        let border = number as f64 * side;
        let x = match beside {
            -2 => border - side / 3.0,
            -1 => border.next_down(),
            0 => border,
            1 => border.next_up(),
            _ => border + side / 3.0,
        };
        let cell = Cell::of(x, -x, side);
        let expected = if x < border { number - 1 } else { number };
        proptest::prop_assert_eq!(cell.x, expected);
        proptest::prop_assert!(cell.z as f64 * side <= -x && -x < (cell.z + 1) as f64 * side);
    }
}

#[test]
fn invalid_numbers_are_refused_with_their_name() {
    PriorityTiming::PAPERS.check().expect("valid");
    let papers = PriorityTiming { cell_m: 5.0, falloff_m: 5.0, ..PriorityTiming::PAPERS };
    papers.check().expect("valid");
    let refusal = |timing: PriorityTiming| timing.check().expect_err("refused").to_string();
    let wide = refusal(PriorityTiming { falloff_m: 6.0, ..papers });
    assert_eq!(wide, "priority.falloff_m: expected at most a cell's side of 5 m, found 6");
    for theta_deg in [0.0, -1.0, f64::NAN] {
        assert!(refusal(PriorityTiming { theta_deg, ..papers }).starts_with("priority.theta_deg must be"));
    }
    for cell_m in [0.5, 2.0, 9.0] {
        let timing = PriorityTiming { cell_m, ..PriorityTiming::PAPERS };
        timing.check().expect("the falloff follows the cell");
        assert_eq!(timing.falloff_length_m(), cell_m);
    }
    assert_eq!(PriorityTiming { falloff_m: 1.5, ..papers }.falloff_length_m(), 1.5);
    for cell_m in [0.0, -1.0, f64::NAN] {
        assert!(refusal(PriorityTiming { cell_m, ..papers }).contains("priority.cell_m must be"));
    }
    RegionWarp::new(Falloff::Linear, f64::NAN, DVec3::ZERO, DVec3::ZERO).expect_err("no length");
}
