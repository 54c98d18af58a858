//! Figures of the SpatialGL paper that are measured on single slices: rules of the clip, bits of a pixel, stencil,
//! jitter.

use pxpl5_sim::figures::FigureRow;
use pxpl5_sim::parameters::Provenance;
use pxpl5_sim::parameters::SettingError;
use spatialgl::perspecta::PerspectaConfig;
use spatialgl::perspecta::figures::row;
use spatialgl::{
    BinLayout, ColouredVertex, CommandBuffer, DrawContext, HalfWedge, HostRenderer, Jitter, Projection, SliceClip,
    SliceView, SliceVolume, SpatialDisplay, Strobes, SweptDisplay, TieRule, Tiling, Topology, VertexBuffer,
    VolumeConfig, VolumeFrame, WedgePlanes, WedgeTest, Workers, packed_word, pixel_of_word, render_volume,
};

/// A test triangle parallel to the axis. Its corners are in pixels.
const TRIANGLE: [[f64; 3]; 3] = [[-200.3, -150.2, 40.1], [200.4, -150.2, 40.1], [0.6, 200.7, 40.1]];

/// Index of the slice in which [`TRIANGLE`] is examined. The exact volume of this slice contains 209 pixels of the
/// triangle (derived from the area of the intersection).
const SLICE: usize = 13;

pub(super) fn figures(workers: &dyn Workers) -> Result<Vec<FigureRow>, SettingError> {
    let exact = display(SliceClip::ShaderPlanes, Projection::Orthographic)?;
    let frame = draw(&exact, workers)?;
    let mut rows = boundaries(&exact);
    rows.extend(signs());
    rows.push(pixels());
    rows.extend(stencil(&frame));
    rows.extend(jitter()?);
    rows.extend(means()?);
    Ok(rows)
}

pub(super) fn display(clip: SliceClip, projection: Projection) -> Result<SweptDisplay, SettingError> {
    PerspectaConfig::PAPERS.swept(clip, projection)
}

/// Records [`TRIANGLE`] with a scale.
pub(super) fn recording(scale: f64) -> Result<CommandBuffer, SettingError> {
    let vertices = TRIANGLE.map(|corner| ColouredVertex::new(corner.map(|place| place * scale).into(), [255; 3]));
    let buffer = VertexBuffer::new(vertices.to_vec())?;
    let mut context = DrawContext::default();
    context.draw(&buffer, 0..3, Topology::Triangles)?;
    Ok(context.present())
}

fn draw(display: &SweptDisplay, workers: &dyn Workers) -> Result<VolumeFrame, SettingError> {
    let config = VolumeConfig { strobes: Strobes::Mirror, keeps_colours: true, ..VolumeConfig::paper() };
    render_volume(display, &recording(1.0)?, &config, &HostRenderer, workers)
}

/// Returns the two rows of figure P2. The first row counts the boundary planes of a slice that a circle around the axis
/// crosses. A circle crosses each plane twice. The second row counts the slices whose planes both contain the axis.
fn boundaries(display: &SweptDisplay) -> Vec<FigureRow> {
    let view = &display.views()[7];
    let steps = 100_000;
    let place = |i: u32| {
        let (sin, cos) = spatialgl::sin_cos_of_turn(i64::from(i), steps);
        [100.0 * cos, 0.0, 100.0 * sin]
    };
    let accepts = |i: u32| view.accepts(place(i % steps).into());
    // A plane is crossed twice in a turn.
    let crossings = (0..steps).filter(|i| accepts(*i) != accepts(i + 1)).count();
    let on_axis = display.views().iter().filter(|view| has_axis(view)).count();
    vec![
        row("P2", "planes that bound a slice volume", "planes", (2.0, 0.0), crossings as f64 / 2.0),
        row("P2", "slices whose planes both contain the axis", "slices", (396.0, 0.0), on_axis as f64),
    ]
}

/// Returns true if the closed volume of a slice contains a point of the axis, and does not contain a point slightly
/// beside the axis.
fn has_axis(view: &SliceView) -> bool {
    let SliceVolume::Wedge(planes, _) = view.volume else { return false };
    let closed = SliceVolume::Wedge(planes, WedgeTest::Shader(TieRule::Closed));
    let across = view.view.transpose().z_axis;
    closed.contains([0.0, 33.0, 0.0], 0.0, 0.0) && !closed.contains([1e-6 * across.x, 33.0, 1e-6 * across.z], 0.0, 1e-6)
}

/// Returns points of a grid beside the axis. Many points lie in boundary planes.
fn grid() -> impl Iterator<Item = [f64; 3]> {
    let side = -60..=60i32;
    let places = side.clone().flat_map(move |x| side.clone().map(move |z| [f64::from(x), 7.0, f64::from(z)]));
    places.filter(|[x, _, z]| *x != 0.0 || *z != 0.0)
}

fn percent(total: usize, agreeing: usize) -> f64 {
    100.0 * agreeing as f64 / total as f64
}

/// Returns figures P3 and P4. P3 is the percentage of grid points whose bin code agrees with the rule in the SpatialGL
/// paper. P4 is the percentage of grid points at which the clip agrees with the paper's sign of the product of
/// distances. There are two rows for P4, with the normals of the left and of the right part of the paper's figure 5.
fn signs() -> Vec<FigureRow> {
    let layout = BinLayout::double_wedges(0.0);
    let rule = |plane: &[f64; 4], p: [f64; 3]| plane[0] * p[0] + plane[1] * p[1] + plane[2] * p[2] + plane[3] >= 0.0;
    let expected = |p: [f64; 3]| {
        let bits = layout.planes.iter().enumerate().map(|(i, plane)| u32::from(rule(plane, p)) << i);
        bits.sum::<u32>()
    };
    // Count the grid points for which model and printed rule agree.
    let coded = grid().filter(|p| layout.code(*p) == expected(*p)).count();
    let left = grid().filter(|p| agrees(*p, 1.0)).count();
    let right = grid().filter(|p| agrees(*p, -1.0)).count();
    let total = grid().count();
    vec![
        row("P3", "points that have the sign of the printed rule", "%", (100.0, 0.0), percent(total, coded)),
        row("P4", "points accepted as printed, normals as in figure 5 left", "%", (100.0, 0.0), percent(total, left)),
        row("P4", "points accepted as printed, normals as in figure 5 right", "%", (100.0, 0.0), percent(total, right)),
    ]
}

/// Returns true if slice 50 agrees at a point with the rule in the SpatialGL paper. By this rule, the slice contains
/// the point if and only if the product of the signed distances is positive. With `orientation` -1 the second normal is
/// reversed, and the product must be negative.
fn agrees(p: [f64; 3], orientation: f64) -> bool {
    let (sin, cos) = spatialgl::sin_cos_of_turn(99, 792);
    let (next_sin, next_cos) = spatialgl::sin_cos_of_turn(101, 792);
    let planes = WedgePlanes { a: [-sin, cos], b: [next_sin, -next_cos], fraction_bits: None };
    let volume = SliceVolume::Wedge(planes, WedgeTest::Shader(TieRule::ProductPositive));
    let first = p[2] * cos - p[0] * sin;
    let second = orientation * (p[0] * next_sin - p[2] * next_cos);
    let printed = orientation * (first * second) > 0.0;
    volume.contains(p, 0.0, 0.0) == printed
}

/// Returns figure P7: the number of bits per pixel that the projector can distinguish, from a word of eight white
/// pixels.
fn pixels() -> FigureRow {
    let white = packed_word(0xFF, 0xFF, 0xFF);
    let projector = (0..8).map(|pixel| pixel_of_word(white, pixel).count_ones()).sum::<u32>();
    row("P7", "bits of a pixel on the projector", "bits", (3.0, 0.0), f64::from(projector) / 8.0)
}

/// Returns figure P15: the pixels marked in the stencil, for a slice with drawn pixels and for an empty slice.
fn stencil(frame: &VolumeFrame) -> Vec<FigureRow> {
    let marked = |slice: usize| frame.colours.as_ref().map_or(0, |colours| colours[slice].len()) as f64;
    let queries = Tiling::PAPER.grid(frame.planes.size()).tiles();
    // Every batch is cleared once and queried tile by tile.
    let per_batch = frame.stats.queries as f64 / frame.stats.stencil_clears.max(1) as f64;
    vec![
        row(
            "P15",
            "pixels equal to 1 after the clear: slice 99, which the triangle does not meet",
            "pixels",
            (0.0, 0.0),
            marked(99),
        ),
        FigureRow {
            origin: Provenance::Derived,
            ..row("P15", "pixels equal to 1 after 209 fragments", "pixels", (209.0, 2.0), marked(SLICE))
        },
        row("D8", "queries between two clears", "queries", (f64::from(queries), 0.0), per_batch),
    ]
}

/// Returns the rows of figure P19. The first row is the largest shift of a point by the shear, at the near or far plane
/// of a slice. The other rows are the numbers of distinct eyes and of distinct matrices.
fn jitter() -> Result<Vec<FigureRow>, SettingError> {
    let clip = SliceClip::Hyperbolic(0.25);
    let wedge = HalfWedge::new(396, 384.0);
    let reach = clip.reach(wedge);
    let projection = Projection::Jittered(Jitter::new(1));
    let eyes: Vec<_> = (0..396).map(|slice| projection.eye(slice, wedge.radius, reach)).collect();
    let shift = eyes.iter().map(|eye| reach * (eye.shear[0].powi(2) + eye.shear[1].powi(2)).sqrt());
    let largest = shift.fold(0.0, f64::max);
    // Count distinct eyes and distinct projection matrices.
    let mut places: Vec<_> = eyes.iter().filter_map(|eye| eye.eye.map(|place| place.map(f64::to_bits))).collect();
    places.sort_unstable();
    places.dedup();
    let display = display(clip, projection)?;
    let mut matrices: Vec<_> =
        display.views().iter().map(|view: &SliceView| view.projection.to_cols_array().map(f64::to_bits)).collect();
    matrices.sort_unstable();
    matrices.dedup();
    Ok(vec![
        row("P19", "largest shift by the shear: below a pixel", "px", (1.0, 0.0), largest).with_accepted([0.0, 1.0]),
        row("P19", "eyes, one for each slice", "eyes", (396.0, 0.0), places.len() as f64),
        row("P19", "matrices, one for all of a slice", "matrices", (396.0, 0.0), matrices.len() as f64),
    ])
}

/// Returns figures D10 and D11: the mean number of planes that contain a point, for points spread evenly over the disc.
fn means() -> Result<Vec<FigureRow>, SettingError> {
    let prism = mean_planes(SliceClip::Prism)?;
    let hyperbola = mean_planes(SliceClip::Hyperbolic(0.25))?;
    let exact = mean_planes(SliceClip::ShaderPlanes)?;
    Ok(vec![
        row("D10", "planes that accept a point, mean over 20,000 points, prism", "planes", (2.0, 0.02), prism),
        row("D11", "the same of the hyperbola, accepted", "planes", (1.081, 0.01), hyperbola),
        row("D11", "the same of the exact clip", "planes", (1.0, 0.0), exact),
    ])
}

fn mean_planes(clip: SliceClip) -> Result<f64, SettingError> {
    let display = display(clip, Projection::Orthographic)?;
    let views = &display.views()[..198];
    let points = 20_000;
    let golden = (5f64.sqrt() - 1.0) / 2.0;
    let accepted: usize = (0..points)
        .map(|i| {
            // The points form a sunflower pattern: equal areas, and angles that never coincide.
            let radius = 384.0 * ((f64::from(i) + 0.5) / f64::from(points)).sqrt();
            let angle = std::f64::consts::TAU * (f64::from(i) * golden).fract();
            let point = [radius * angle.cos(), 0.0, radius * angle.sin()];
            views.iter().filter(|view| view.accepts(point.into())).count()
        })
        .sum();
    Ok(accepted as f64 / f64::from(points))
}
