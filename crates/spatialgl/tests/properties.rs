//! Tests of general properties of volumes, on random triangles, points and settings.

use crate::support::*;
use glam::DVec3;
use proptest::prelude::*;
use spatialgl::*;

const ORTHOGRAPHIC: Projection = Projection::Orthographic;
const EXACT: SliceClip = SliceClip::ShaderPlanes;

/// Returns a small display, so that tests can draw many volumes in a short time.
fn small(clip: SliceClip, projection: Projection) -> SweptDisplay {
    let config = SweptConfig { slices: 44, width: 64, height: 56, ..SweptConfig::perspecta(clip, projection) };
    SweptDisplay::new(config).expect("valid")
}

fn corner() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-40.0f64..40.0)
}

fn mesh() -> impl Strategy<Value = Vec<Triangle>> {
    prop::collection::vec(prop::array::uniform3(corner()), 1..12)
}

fn projections() -> impl Strategy<Value = Projection> {
    prop_oneof![
        Just(ORTHOGRAPHIC),
        any::<u64>().prop_map(|seed| Projection::Jittered(Jitter::new(seed))),
        Just(Projection::Perspective { eye: [10.0, -15.0], distance: 60.0, shear: [0.05, 0.1] }),
        // The eye is so near that corners can lie behind the eye.
        Just(Projection::Perspective { eye: [3.0, 5.0], distance: 12.0, shear: [0.0, 0.0] }),
    ]
}

fn clips() -> impl Strategy<Value = SliceClip> {
    prop::sample::select(SliceClip::ALL.to_vec())
}

/// Returns recorded commands for triangles of different colours, some drawn as lines or points. `combine` is the rule
/// for several fragments on one pixel.
fn mixed(triangles: &[Triangle], combine: Combine) -> CommandBuffer {
    let mut context = DrawContext::default();
    context.combine = combine;
    context.line_width = 2.5;
    context.point_size = 3.5;
    for (i, triangle) in triangles.iter().enumerate() {
        let colour = |corner: usize| [(i * 53 + corner * 90) as u8, (i * 31) as u8, 255 - (i * 17) as u8];
        let vertices = (0..3).map(|k| ColouredVertex::new(DVec3::from_array(triangle[k]), colour(k))).collect();
        let buffer = VertexBuffer::new(vertices).expect("finite");
        let topology = [Topology::Triangles, Topology::Triangles, Topology::LineStrip, Topology::Points][i % 4];
        context.draw(&buffer, 0..3, topology).expect("valid");
    }
    context.present()
}

fn kept(config: VolumeConfig) -> VolumeConfig {
    VolumeConfig { keeps_colours: true, ..config }
}

/// Returns the index of the slice and the index of the pixel for every drawn voxel.
fn drawn(frame: &VolumeFrame) -> std::collections::BTreeSet<(usize, u32)> {
    let slices = frame.colours.as_ref().expect("kept").iter().enumerate();
    slices.flat_map(|(k, samples)| samples.iter().map(move |sample| (k, sample.pixel))).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn the_fast_model_draws_every_voxel_of_the_reference_model(
        triangles in mesh(), clip in clips(), projection in projections(),
        combine in prop::sample::select(vec![Combine::Last, Combine::Max, Combine::Add]),
        bits in prop::option::of(2u32..12),
        coverage in prop::sample::select(vec![Coverage::Sampled, Coverage::Connected]),
    ) {
        let config = SweptConfig { slices: 44, width: 64, height: 56, plane_fraction_bits: bits,
            ..SweptConfig::perspecta(clip, projection) };
        let Ok(display) = SweptDisplay::new(config) else { return Ok(()) };
        both(&display, &mixed(&triangles, combine), &kept(VolumeConfig { coverage, ..VolumeConfig::paper() }));
    }

    #[test]
    fn bins_tiles_and_batches_change_no_voxel(
        triangles in mesh(), clip in clips(), projection in projections(),
        tile in prop::sample::select(vec![8u32, 24, 32, 64]), batch in 1u32..60,
        binning in prop::sample::select(vec![Binning::TwoPlanes, Binning::AllPlanes]),
    ) {
        let display = small(clip, projection);
        let commands = mixed(&triangles, Combine::Last);
        let plain = volume(&display, &commands, &kept(VolumeConfig::plain()));
        let tiling = Tiling { tile: Some(tile), batch };
        let saving = volume(&display, &commands, &kept(VolumeConfig { tiling, binning, ..VolumeConfig::paper() }));
        prop_assert!(saving.planes == plain.planes);
        prop_assert_eq!(saving.stats.fragments_accepted, plain.stats.fragments_accepted);
        prop_assert_eq!(saving.planes.hash(), plain.planes.hash());
    }

    #[test]
    fn max_and_add_do_not_depend_on_drawing_order(triangles in mesh(), clip in clips(), projection in projections()) {
        let display = small(clip, projection);
        for combine in [Combine::Max, Combine::Add] {
            let forward = mixed(&triangles, combine);
            let backward = forward.reversed();

            let config = kept(VolumeConfig::paper());
            prop_assert!(volume(&display, &forward, &config).colours == volume(&display, &backward, &config).colours);
        }
    }

    #[test]
    fn the_hyperbola_contains_the_exact_clip_and_lies_in_the_parallel_planes(triangles in mesh(), q in 0.05f64..1.5) {
        let commands = recording(&triangles);
        let set = |clip| drawn(&volume(&small(clip, ORTHOGRAPHIC), &commands, &kept(VolumeConfig::plain())));
        let exact = set(EXACT);
        let hyperbola = set(SliceClip::Hyperbolic(q * q));
        prop_assert!(exact.is_subset(&hyperbola));
        prop_assert!(hyperbola.is_subset(&set(SliceClip::Parallel(q))));
    }

    #[test]
    fn without_offset_and_bias_all_clips_equal_the_exact_clip(triangles in mesh()) {
        let commands = recording(&triangles);
        let draw = |clip| volume(&small(clip, ORTHOGRAPHIC), &commands, &VolumeConfig::plain()).planes;
        let exact = draw(EXACT);
        for clip in [SliceClip::UserPlanes, SliceClip::Hyperbolic(0.0), SliceClip::Parallel(0.0), SliceClip::Tapered(0.0)] {
            prop_assert!(draw(clip) == exact, "{:?}", clip);
        }
    }

    #[test]
    fn two_passes_with_user_planes_equal_one_shader_pass(triangles in mesh(), projection in projections()) {
        let commands = mixed(&triangles, Combine::Max);
        let draw = |clip| volume(&small(clip, projection), &commands, &kept(VolumeConfig::plain())).colours;
        prop_assert!(draw(SliceClip::UserPlanes) == draw(EXACT));
    }

    #[test]
    fn the_second_half_turn_shows_mirrored_slices_of_the_first_half_turn(triangles in mesh(), clip in clips()) {
        let frame = volume(&small(clip, ORTHOGRAPHIC), &recording(&triangles), &kept(VolumeConfig::plain()));
        let mirrored: std::collections::BTreeSet<(usize, u32)> = drawn(&frame)
            .into_iter()
            .map(|(k, pixel)| ((k + 22) % 44, pixel / 64 * 64 + 63 - pixel % 64))
            .collect();
        prop_assert!(mirrored == drawn(&frame));
    }

    #[test]
    fn a_point_off_the_axis_lies_in_exactly_one_slice(x in -300.0f64..300.0, z in -240.0f64..240.0, y in -300.0f64..300.0) {
        prop_assume!(x.hypot(z) > 1e-3);
        let exact = swept(EXACT, ORTHOGRAPHIC);
        let count = (0..198).filter(|k| exact.accepts(*k, DVec3::new(x, y, z))).count();
        prop_assert_eq!(count, 1);
        for clip in [SliceClip::Prism, SliceClip::Hyperbolic(0.25), SliceClip::Parallel(0.5), SliceClip::Tapered(0.5)] {
            let display = swept(clip, ORTHOGRAPHIC);
            prop_assert!((0..198).any(|k| display.accepts(k, DVec3::new(x, y, z))), "{:?}", clip);
        }
    }

    /// Checks that the two triangles of a quad together cover each sample once, for any position of the common edge.
    #[test]
    fn a_shared_edge_is_lit_by_one_of_its_triangles(
        x in prop::array::uniform4(-28i32..28), y in prop::array::uniform4(-28i32..28),
    ) {
        // Coordinates are multiples of half a pixel, so that edges run through pixel centres.
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| [f64::from(x[i]) / 2.0, f64::from(y[i]) / 2.0, 0.0]);
        let side = |p: [f64; 3]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        prop_assume!(side(c) * side(d) < 0.0);
        let count = |triangles: &[Triangle]| {
            let display = Screen::new([64, 64]);
            let frame = volume(&display, &recording(triangles), &kept(VolumeConfig::plain()));
            (frame.stats.fragments_accepted, drawn(&frame).len() as u64)
        };
        let (fragments, pixels) = count(&[[a, b, c], [b, a, d]]);
        prop_assert_eq!(fragments, pixels, "no pixel twice");
        let (one, _) = count(&[[a, b, c]]);
        let (other, _) = count(&[[a, b, d]]);
        prop_assert_eq!(fragments, one + other);
    }

    #[test]
    fn packed_bits_equal_the_halftone_of_the_colours(triangles in mesh()) {
        let frame = volume(&small(SliceClip::Hyperbolic(0.25), ORTHOGRAPHIC), &mixed(&triangles, Combine::Last), &kept(VolumeConfig::paper()));
        let halftone = Halftone::bayer(8).expect("valid");
        let mut lit = 0;
        for (k, samples) in frame.colours.as_ref().expect("kept").iter().enumerate() {
            for sample in samples {
                let [x, y] = [sample.pixel % 64, sample.pixel / 64];
                let bit = |c: usize| u8::from(sample.colour[c] > halftone.threshold(x, y)) << c;
                prop_assert_eq!(frame.planes.pixel(k as u32, x, y), bit(0) | bit(1) | bit(2));
                lit += u64::from(bit(0) | bit(1) | bit(2) != 0);
            }
        }
        prop_assert_eq!(lit, frame.planes.lit_voxels());
    }
}

/// Checks that the sum over 198 slices of fragments / |n . e_s| approaches the triangle's area, for the exact clip.
#[test]
fn the_sum_of_fragments_divided_by_the_cosine_of_the_angle_to_each_slice_is_the_area() {
    let [a, b, c] = T4.map(DVec3::from_array);
    let cross = (b - a).cross(c - a);
    let area = cross.length() / 2.0;
    let display = swept(EXACT, ORTHOGRAPHIC);
    let frame = volume(&display, &recording(&[T4]), &half(VolumeConfig::plain()));
    let slices = frame.stats.slices.iter().zip(display.views());
    let sum: f64 = slices
        .map(|(slice, view)| {
            slice.accepted as f64 / cross.normalize().dot(view.view.transpose().z_axis.truncate()).abs()
        })
        .sum();
    assert!((area - 18_630.0).abs() < 1.0, "{area}");
    assert!((sum - 18_690.0).abs() < 15.0, "{sum}");
}

#[test]
fn the_hash_is_the_same_for_any_number_of_threads() {
    let display = swept(SliceClip::Hyperbolic(0.25), Projection::Jittered(Jitter::new(1)));
    let commands = recording(&[T1, T4, T5]);
    let hash = |workers: &dyn Workers| {
        let frame = render_volume(&display, &commands, &VolumeConfig::paper(), &HostRenderer, workers).expect("valid");
        (frame.planes.hash(), frame.stats)
    };
    let alone = hash(&OneThread);
    for threads in [1, 2, 3, 7] {
        assert_eq!(hash(&Threads(std::num::NonZero::new(threads).expect("not zero"))), alone);
    }
    let other = swept(SliceClip::Hyperbolic(0.25), Projection::Jittered(Jitter::new(2)));
    assert_ne!(volume(&other, &commands, &VolumeConfig::paper()).planes.hash(), alone.0, "another seed");
}

#[test]
fn accepted_fragments_do_not_depend_on_the_number_of_slices() {
    let count = |slices| {
        let config = SweptConfig { slices, ..SweptConfig::perspecta(EXACT, ORTHOGRAPHIC) };
        let display = SweptDisplay::new(config).expect("valid");
        volume(&display, &recording(&[T1, T4]), &half(VolumeConfig::plain())).stats.fragments_accepted as f64
    };
    let reference = count(396);
    for slices in [200, 398, 1000] {
        let share = count(slices) / reference;
        assert!((share - 1.0).abs() < 0.01, "{slices}: {share}");
    }
}

#[test]
fn a_mirrored_volume_has_the_second_half_turned_over() {
    let display = swept(SliceClip::Hyperbolic(0.25), Projection::Jittered(Jitter::new(1)));
    let frame = volume(&display, &recording(&[T1, T4]), &half(VolumeConfig::paper()));
    assert_eq!(frame.stats.slices_rendered, 198);
    for k in [0, 33, 197] {
        for (x, y) in (0..768).flat_map(|x| (0..768).map(move |y| (x, y))) {
            assert_eq!(frame.planes.pixel(k, x, y), frame.planes.pixel(k + 198, 767 - x, y));
        }
    }
}
