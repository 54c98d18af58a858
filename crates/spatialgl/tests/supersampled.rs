//! Tests of supersampling: colours follow from the covered area, and counts from the number of samples.

use crate::support::*;
use spatialgl::*;

/// Returns a recording of a white rectangle in slice 0. It covers rows 300 to 310, from column 400 to `beyond` pixels
/// after it.
fn rectangle(beyond: f64) -> CommandBuffer {
    let [left, right, top, bottom] = [16.0, 16.0 + beyond, 84.0, 74.0];
    recording(&[
        [[left, bottom, 0.0], [right, bottom, 0.0], [right, top, 0.0]],
        [[left, bottom, 0.0], [right, top, 0.0], [left, top, 0.0]],
    ])
}

fn drawn(commands: &CommandBuffer, samples: u32, inner: &'static str) -> VolumeFrame {
    let config = VolumeConfig { keeps_colours: true, ..half(VolumeConfig::paper()) };
    let display = swept(SliceClip::ShaderPlanes, Projection::Orthographic);
    let renderer: Box<dyn SliceRenderer> = match inner {
        "oracle" => Box::new(Supersampled::new(ReferenceRenderer, samples).expect("4 or 16")),
        _ => Box::new(Supersampled::new(HostRenderer, samples).expect("4 or 16")),
    };
    render_volume(&display, commands, &config, renderer.as_ref(), &OneThread).expect("valid")
}

fn colour(frame: &VolumeFrame, x: u32, y: u32) -> Option<[u8; 3]> {
    let colours = frame.colours.as_ref().expect("kept");
    colours[0].iter().find(|sample| sample.pixel == y * 768 + x).map(|sample| sample.colour)
}

/// Checks the brightness of a partly covered pixel. Samples lie at 1/4 and 3/4 of a pixel, or at 1/8, 3/8, 5/8 and 7/8.
/// The pixel is as bright as the fraction of its samples inside a white rectangle.
#[test]
fn the_brightness_of_a_pixel_is_its_coverage() {
    for (samples, beyond, expected) in [(4, 10.5, 128), (16, 10.25, 64), (16, 10.75, 191), (16, 10.5, 128)] {
        let frame = drawn(&rectangle(beyond), samples, "host");
        assert_eq!(colour(&frame, 400, 305), Some([255; 3]));
        assert_eq!(colour(&frame, 409, 300), Some([255; 3]));
        assert_eq!(colour(&frame, 410, 305), Some([expected; 3]), "{samples} samples, {beyond}");
        assert_eq!(colour(&frame, 411, 305), None);
        assert_eq!(colour(&frame, 399, 305), None);
    }
}

/// Checks that every sample counts as a fragment. Only slice 0 contains the rectangle: 10 x 10 pixels, each with all
/// samples.
#[test]
fn every_sample_is_counted_as_a_fragment() {
    for samples in [4, 16] {
        let frame = drawn(&rectangle(10.0), samples, "host");
        assert_eq!(frame.stats.fragments_accepted, u64::from(100 * samples));
        assert_eq!(frame.stats.samples, u64::from(samples));
        assert_eq!(frame.planes.lit_voxels(), 2 * 100, "slice 0, and 198, which mirrors it");
    }
}

#[test]
fn both_rasterisers_take_the_same_samples() {
    let commands = recording(&[T4, T5]);
    let fast = drawn(&commands, 4, "host");
    let reference = drawn(&commands, 4, "oracle");
    assert!(fast.planes == reference.planes && fast.colours == reference.colours);
    assert_eq!(fast.stats, reference.stats);
}

/// Checks that the width of a line stays the same: the numbers of lit pixels differ by at most one on each side.
#[test]
fn a_line_keeps_its_width() {
    let ends = [[20.0, -50.0, 0.0], [20.0, 50.0, 0.0]].map(|p| ColouredVertex::new(p.into(), [255; 3]));
    let buffer = VertexBuffer::new(ends.to_vec()).expect("finite");
    let mut context = DrawContext::default();
    context.line_width = 6.0;
    context.draw(&buffer, 0..2, Topology::Lines).expect("valid");
    let commands = context.present();
    let frame = drawn(&commands, 16, "host");
    let width = (300..460).filter(|x| colour(&frame, *x, 384).is_some()).count();
    assert_eq!(width, 6);
}

/// Checks the time model with more samples. Fill, clears and reads grow with the number of samples, but the bytes sent
/// do not.
#[test]
fn more_samples_take_fill_time_and_no_bytes() {
    let size = [768, 768];
    let one = VolumeStats { slices_rendered: 396, bytes_sent: 1000, samples: 1, ..VolumeStats::default() };
    let many = VolumeStats { samples: 16, ..one.clone() };
    let time = |stats| TimeModel::GEFORCE_6800.packed(stats, size, 32);
    // This is the time to fill 396 targets of 768 x 768 pixels at 6.4 Gpixel/s.
    assert!((time(&one).gpu_ms - 36.495_36).abs() < 1e-6);
    assert!((time(&many).gpu_ms - 16.0 * 36.495_36).abs() < 1e-6);
    assert_eq!(time(&many).bus_ms().to_bits(), time(&one).bus_ms().to_bits());
}

#[test]
fn only_4_or_16_samples_are_accepted() {
    for samples in [0, 1, 2, 9, 64] {
        let error = Supersampled::new(HostRenderer, samples).expect_err("neither 4 nor 16");
        assert_eq!(error.to_string(), format!("draw.samples: expected 4 or 16, found {samples}"));
    }
}
