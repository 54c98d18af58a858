//! Tests of slices on the renderers of Pixel-Planes 5. They cover clocks, both pixel arrays, agreement with the host's
//! picture, and lower bounds of the times.

use pxpl5_renderer::isa::Operand;
use pxpl5_renderer::{BitSerial, CommandKind, EMPTY_PLANE, Lanes, Layout, PixelArray};
use pxpl5_sim::parameters::PathSettings;
use pxpl5_volume::pixel_planes::{
    ArrayKind, PixelPlanesRenderer, RendererWork, SliceBounds, SliceCorner, SliceTraffic, SliceTriangle,
    halftone_clocks, halftone_words, lit_field, simulate, threshold_field,
};
use pxpl5_volume::spatialgl::{
    Bin, ClipQuadratic, ColouredVertex, CommandBuffer, Coverage, DrawContext, HalfWedge, Halftone, HostRenderer,
    OneThread, SliceImage, SliceRenderer, SliceWork, SpatialDisplay, Topology, VertexBuffer, render_volume,
};
use pxpl5_volume::{ProjectionKind, Volume, VolumeSettings};

/// A corner of a triangle: position in sixteenths of a pixel, distance from the slice in pixels, and colour.
type Corner = ([i32; 2], f64, [u8; 3]);

const SIZE: [u32; 2] = [768, 768];

fn settings() -> VolumeSettings {
    VolumeSettings { projection: ProjectionKind::Orthographic, ..VolumeSettings::paper() }
}

fn wedge() -> HalfWedge {
    HalfWedge::new(396, 384.0)
}

/// Returns a pseudorandom number in [0, 1) from a counter. It is an element of the low-discrepancy sequence of the
/// plastic number.
fn unit(n: u32, dimension: u32) -> f64 {
    (0.5 + f64::from(n) * 0.754_877_666_246_692_8 * f64::from(dimension + 1).sqrt()).fract()
}

/// Returns triangles of all sizes around the axis, most of which cross slice 0.
fn triangles() -> Vec<[Corner; 3]> {
    let corner = |n: u32, i: u32| {
        let reach = [40.0, 300.0, 700.0][n as usize % 3];
        let at = |d: u32| unit(n, 5 * i + d);
        let place = [0, 1].map(|d| ((384.0 + (at(d) - 0.5) * reach) * 16.0).round() as i32);
        let off = (at(2) - 0.5) * [2.0, 20.0, 150.0][n as usize / 3 % 3];
        (place, off, [at(3), at(4), at(0)].map(|x| (40.0 + 215.0 * x) as u8))
    };
    (1..=36).map(|n| [0, 1, 2].map(|i| corner(n, i))).collect()
}

/// Returns a recording of one triangle in world coordinates. In slice 0 of a display without phase, u, v and s are x, y
/// and z.
fn recording(corners: &[Corner; 3]) -> CommandBuffer {
    let vertices = corners.map(|([x, y], off, colour)| {
        let place = [f64::from(x) / 16.0 - 384.0, 384.0 - f64::from(y) / 16.0, off];
        ColouredVertex::new(place.into(), colour)
    });
    let buffer = VertexBuffer::new(vertices.to_vec()).expect("finite");
    let mut context = DrawContext::default();
    context.draw(&buffer, 0..3, Topology::Triangles).expect("in range");
    context.present()
}

fn drawn(renderer: &dyn SliceRenderer, commands: &CommandBuffer) -> SliceImage {
    let display = settings().swept_display().expect("valid");
    let mut image = SliceImage::new(SIZE);
    let bin = Bin::new(commands, vec![0]);
    let work = SliceWork { commands, bin: &bin, coverage: Coverage::Sampled };
    renderer.render(work, &display.views()[0], &mut image);
    image
}

/// Checks the clocks of a slice triangle: enable all 6, three edges 108, the hyperbola 52, three colours 72. The sum is
/// 238 clocks, 5.95 us at 40 MHz, and the command has 38 words.
#[test]
fn a_slice_triangle_takes_238_clocks_and_38_words() {
    let layout = Layout::rendering_control_phong();
    assert_eq!(SliceTriangle::clocks(&layout), 6 + 3 * 36 + 52 + 3 * 24);
    assert_eq!(SliceTriangle::words(&layout), 1 + 3 * 4 + 13 + 3 * 4);
    assert_eq!(40_000_000 / SliceTriangle::clocks(&layout), 168_067);
}

/// Returns the largest possible rounding error of the clip function at any pixel of an image, in square pixels. Each of
/// the six coefficients contributes half a unit.
fn clip_rounding_px2() -> f64 {
    let [x, y] = SIZE.map(f64::from);
    0.5 * (x * x + x * y + y * y + x + y + 1.0) / f64::from(1 << 26)
}

/// Checks that the command's quadratic is the exact hyperbola at the middle of every pixel, except for the rounding of
/// its coefficients.
#[test]
fn the_commands_quadratic_is_the_hyperbola_at_the_middle_of_pixels() {
    let one = f64::from(1 << 26);
    let within = clip_rounding_px2();
    assert!(within < 0.02, "{within}");
    let mut compared = 0;
    for corners in triangles() {
        let command = command(&corners);
        let local = corners.map(|([x, y], off, _)| [f64::from(x) / 16.0 - 384.0, 384.0 - f64::from(y) / 16.0, off]);
        let exact = ClipQuadratic::of_corners(local, wedge(), 0.25).expect("it has an area");
        for (x, y) in [(0, 0), (384, 384), (767, 0), (13, 700), (500, 301)] {
            let value = exact.at(f64::from(x) + 0.5 - 384.0, 383.5 - f64::from(y));
            let found = command.clip.at(x, y) as f64 / one;
            assert!((found - value).abs() <= within + 1e-9 * value.abs(), "({x}, {y}): {found}, not {value}");
            compared += 1;
        }
    }
    assert_eq!(compared, 36 * 5);
}

fn command(corners: &[Corner; 3]) -> SliceTriangle {
    let corners = corners.map(|(place, off, colour)| SliceCorner { place, off, colour: colour.map(f64::from) });
    SliceTriangle::of_corners(corners, SIZE, wedge(), 0.25).expect("it has an area")
}

/// Checks that the arrays draw the same pixels as the host wherever the hyperbola exceeds its rounding error. Colours
/// differ by at most one level. Both arrays agree everywhere.
#[test]
fn both_pixel_arrays_draw_the_same_pixels_as_the_host() {
    let lanes = PixelPlanesRenderer::new(&settings(), ArrayKind::Lanes).expect("supported");
    let serial = PixelPlanesRenderer::new(&settings(), ArrayKind::BitSerial).expect("supported");
    let rounding = clip_rounding_px2() * f64::from(1 << 26);
    let mut lit = 0;
    let mut undecided = 0;
    for (n, corners) in triangles().iter().enumerate() {
        let commands = recording(corners);
        let host = drawn(&HostRenderer, &commands);
        let own = drawn(&lanes, &commands);
        let definition = (n % 4 == 0).then(|| drawn(&serial, &commands));
        let clip = command(corners).clip;
        for (x, y) in (0..768).flat_map(|y| (0..768).map(move |x| (x, y))) {
            if let Some(definition) = &definition {
                assert_eq!(definition.pixel(x, y), own.pixel(x, y), "triangle {n}: the arrays differ at {x}, {y}");
            }
            if (clip.at(x as i32, y as i32) as f64).abs() <= rounding {
                undecided += u32::from(host.is_marked(x, y) != own.is_marked(x, y));
                continue;
            }
            assert_eq!(own.is_marked(x, y), host.is_marked(x, y), "triangle {n} at {x}, {y}");
            let differs = own.pixel(x, y).iter().zip(host.pixel(x, y)).any(|(a, b)| a.abs_diff(b) > 1);
            assert!(!differs, "triangle {n} at {x}, {y}: {:?}, not {:?}", own.pixel(x, y), host.pixel(x, y));
            lit += u32::from(own.is_marked(x, y));
        }
    }
    assert!(lit > 20_000, "{lit} pixels");
    assert!(undecided < lit / 100, "{undecided} of {lit} pixels lie on the hyperbola's edge");
}

/// Checks the clocks of the 36 regions of a slice: each is selected (6 clocks), cleared (62) and halftoned (72). A
/// triangle in one region takes 238 more.
#[test]
fn the_clocks_and_words_of_a_slice_follow_from_its_programs() {
    let renderer = PixelPlanesRenderer::new(&settings(), ArrayKind::Lanes).expect("supported");
    let corners = [([6400, 6400], 0.0, [200; 3]), ([6560, 6400], 0.0, [200; 3]), ([6400, 6560], 0.0, [200; 3])];
    drawn(&renderer, &recording(&corners));
    let work = renderer.work();
    assert_eq!((work.regions, work.triangles, work.commands, work.left_out), (36, 1, 1, 0));
    assert_eq!(work.clocks, 36 * (6 + 62 + 72) + 238);
    assert_eq!(work.command_words, 36 * (2 + 5 + 12) + 38);
    // Clearing all regions of 198 slices takes one renderer 11.05 ms.
    let layout = Layout::rendering_control_phong();
    let clears = 198 * 36 * CommandKind::Clear.clocks(&layout).expect("every layout");
    assert!((f64::from(clears) / 40e6 * 1e3 - 11.05).abs() < 0.005);
}

/// Checks numbers that were computed by hand. A tile takes 7.2 us on the ring. 10 % of the tiles of 198 slices take 82
/// ms of one channel, or 10.3 ms of eight. Renderers and processors divide their work.
#[test]
fn the_lower_bounds_of_a_volume_follow_from_its_counts() {
    let bounds = SliceBounds { work: RendererWork::default(), tiles: 11_405, tile_words: 128, copies: 0 };
    let row = bounds.with(1, 1);
    assert!((row.ms[1] - 11_405.0 * 7.2e-3 / 8.0).abs() < 1e-9 && (row.ms[1] - 10.3).abs() < 0.05, "{row:?}");
    // All messages arrive at the display's one port.
    assert!((row.ms[2] - 11_405.0 * 7.2e-3).abs() < 1e-9 && (row.ms[2] - 82.0).abs() < 0.5, "{row:?}");
    assert_eq!(row.limited_by, "port");
    let work = RendererWork { clocks: 4_000_000_000, triangles: 1_000, commands: 1_000, ..RendererWork::default() };
    let bounds = SliceBounds { work, ..bounds };
    let row = bounds.with(10, 5);
    assert!((row.ms[0] - 10_000.0).abs() < 1e-6 && row.limited_by == "renderers");
    assert!((row.ms[3] - 1_000.0 * (21.7e-3 + 1e-3) / 5.0).abs() < 1e-9);
    assert!((row.volumes_hz - 0.1).abs() < 1e-9);
    // A region on its way to the backing store keeps its renderer for 2,040 clocks, 51 us.
    let copying = SliceBounds { copies: 1_000, ..bounds }.with(10, 5);
    assert!((copying.ms[0] - row.ms[0] - 1_000.0 * 0.051 / 10.0).abs() < 1e-6);
}

/// Checks the halftone program: enable all (6 clocks), compare eight bits (12) and store Enable (6), for each of three
/// channels. The program has 12 words. Both arrays give the bits of the host's halftone, for every level and threshold
/// of Bayer's matrix.
#[test]
fn the_halftone_program_gives_the_bits_of_the_host_in_72_clocks() {
    let layout = Layout::rendering_control_phong();
    assert_eq!(halftone_clocks(&layout), 3 * (6 + 12 + 6));
    assert_eq!(halftone_words(&layout).len(), 3 * (1 + 2 + 1));
    let matrix = Halftone::bayer(8).expect("a size");
    halftone_on(&mut Lanes::new(&layout), &layout, &matrix);
    halftone_on(&mut BitSerial::new(&layout), &layout, &matrix);
}

/// Stores colours in an array and halftones them. Pixel (x, y) gets level 2 x + y / 64 in red, its complement in green
/// and x in blue.
fn halftone_on(array: &mut impl PixelArray, layout: &Layout, matrix: &Halftone) {
    let levels = |x: u32, y: u32| [(2 * x + y / 64) as u8, !((2 * x + y / 64) as u8), x as u8];
    let mut load = |field: Operand, value: &dyn Fn(u32, u32) -> u8| {
        for bit in 0..usize::from(field.width) {
            let mut plane = EMPTY_PLANE;
            for (x, y) in (0..128).flat_map(|y| (0..128).map(move |x| (x, y))) {
                plane[(2 * y + x / 64) as usize] |= u64::from(value(x, y) >> bit & 1) << (x % 64);
            }
            array.set_plane(usize::from(field.address) + bit, &plane);
        }
    };
    load(threshold_field(layout), &|x, y| matrix.threshold(x, y));
    for channel in 0..3 {
        load(layout.component(channel), &|x, y| levels(x, y)[usize::from(channel)]);
    }
    let executed = array.execute(&halftone_words(layout)).expect("legal");
    assert_eq!(executed.clocks, halftone_clocks(layout));
    for channel in 0..3 {
        let plane = array.plane(usize::from(lit_field(layout, channel).address));
        for (x, y) in (0..128).flat_map(|y| (0..128).map(move |x| (x, y))) {
            let bit = plane[(2 * y + x / 64) as usize] >> (x % 64) & 1 == 1;
            let level = levels(x, y)[usize::from(channel)];
            assert_eq!(bit, level > matrix.threshold(x, y), "channel {channel} at {x}, {y}");
        }
    }
}

/// Checks a simulated volume of few slices. Every tile arrives at the display without a fault. No part is faster than
/// its lower bound. One renderer with one processor needs about as long as the slower of the two.
#[test]
fn a_simulated_volume_arrives_whole_and_is_never_faster_than_its_bounds() {
    let mut settings = settings();
    for (path, text) in [("display.slices", "24"), ("display.width", "256"), ("display.height", "256")] {
        settings.set(path, text, "test").expect("a setting");
    }
    settings.set("on", "pixel-planes", "test").expect("a setting");
    let scene = pxpl5_scene::builtin("mig").expect("built in");
    let volume = Volume::draw(&settings, &scene, &OneThread).expect("drawn");
    let traffic = volume.traffic.as_ref().expect("32 x 32 pixels fit a message");
    let bounds = volume.bounds.expect("renderers drew it");
    // A tile is sent for all four slices of its batch if any of their pixels is lit. Tiles that the dither leaves dark
    // are not sent.
    let planes = &volume.frame.planes;
    let is_lit = |batch: u32, tile: u32| {
        let pixels = (0..32).flat_map(|y| (0..32).map(move |x| (tile % 8 * 32 + x, tile / 8 * 32 + y)));
        (4 * batch..4 * batch + 4).any(|k| pixels.clone().any(|(x, y)| planes.pixel(k, x, y) != 0))
    };
    let lit = (0..6).flat_map(|batch| (0..64).map(move |tile| (batch, tile))).filter(|(b, t)| is_lit(*b, *t)).count();
    assert_eq!(bounds.tiles, 4 * lit as u64);
    for (renderers, processors) in [(1, 1), (1, 8), (4, 4), (8, 50)] {
        let row = simulate(traffic, &bounds, renderers, processors).expect("few boards");
        assert_eq!(row.faults, 0, "{row:?}");
        assert!(row.over_bound_percent >= 0.0, "{row:?}");
        assert!(row.renderers_busy_percent <= 100.0 && row.processors_busy_percent <= 100.0, "{row:?}");
    }
    let least = simulate(traffic, &bounds, 1, 1).expect("few boards");
    assert!(least.over_bound_percent < 25.0, "{least:?}");
    let more = simulate(traffic, &bounds, 4, 4).expect("few boards");
    assert!(more.ms < least.ms, "{more:?}");
}

#[test]
fn more_boards_than_a_ring_has_ports_are_refused() {
    let settings = settings();
    let traffic = SliceTraffic::of(
        &PixelPlanesRenderer::new(&settings, ArrayKind::Lanes).expect("supported"),
        &[],
        &render_volume(
            &settings.swept_display().expect("valid"),
            &CommandBuffer::default(),
            &settings.volume_config().expect("valid"),
            &HostRenderer,
            &OneThread,
        )
        .expect("a dark volume"),
        settings.volume_config().expect("valid").tiling,
    );
    let bounds = SliceBounds { work: RendererWork::default(), tiles: 0, tile_words: 128, copies: 0 };
    let error = simulate(&traffic.expect("tiles fit"), &bounds, 60_000, 6_000).expect_err("too many");
    assert!(error.to_string().contains("66001"), "{error}");
}

#[test]
fn a_surface_that_is_not_one_quadratic_is_refused() {
    for (path, text, part) in [
        ("clip.variant", "exact", "hyperbolic"),
        ("projection", "jittered", "orthographic"),
        ("draw.combine", "max", "last"),
        ("draw.coverage", "connected", "sampled"),
    ] {
        let mut settings = settings();
        settings.set(path, text, "test").expect("a setting");
        let error = PixelPlanesRenderer::new(&settings, ArrayKind::Lanes).expect_err("not supported").to_string();
        assert!(error.contains(part) && error.contains("on Pixel-Planes 5"), "{error}");
    }
}
