//! Figures of the SpatialGL paper that are counted in views of the display, or measured in drawn volumes.

use super::printed::{display, recording};
use pxpl5_sim::figures::FigureRow;
use pxpl5_sim::parameters::SettingError;
use spatialgl::perspecta::PerspectaConfig;
use spatialgl::perspecta::figures::row;
use spatialgl::{
    BinLayout, Binning, HostRenderer, Projection, SliceClip, SliceView, SpatialDisplay, SweptDisplay, Tiling,
    VolumeConfig, VolumeStats, Workers, render_volume,
};

pub(super) fn figures(workers: &dyn Workers) -> Result<Vec<FigureRow>, SettingError> {
    let exact = display(SliceClip::ShaderPlanes, Projection::Orthographic)?;
    let mut rows = passes(workers)?;
    rows.extend(batches(&exact, workers)?);
    rows.extend(planes(exact.views()));
    rows.extend(slab(exact.views()));
    rows.extend(bounds());
    Ok(rows)
}

/// Width and height in pixels of the small slices on which passes are counted. At the rim, the exact volume of such a
/// slice is thicker than a pixel. The tapered clip needs such slices, because its volume is a pixel thick at the axis
/// and becomes thicker towards the rim.
const SMALL: u64 = 192;

/// Returns figure P5: the number of draws of one triangle per slice, without bins.
fn passes(workers: &dyn Workers) -> Result<Vec<FigureRow>, SettingError> {
    let published = [
        (SliceClip::UserPlanes, 2.0, "draws of a triangle for a slice with user clip planes"),
        (SliceClip::ShaderPlanes, 1.0, "with shader clip planes"),
        (SliceClip::Tapered(0.5), 2.0, "with a taper"),
        (SliceClip::Parallel(0.5), 1.0, "with parallel planes by evaluation bias"),
        (SliceClip::Hyperbolic(0.25), 1.0, "with a hyperbola"),
    ];
    let small = PerspectaConfig { width: SMALL, height: SMALL, ..PerspectaConfig::PAPERS };
    let recording = recording(SMALL as f64 / PerspectaConfig::PAPERS.width as f64)?;
    let count = |(clip, passes, statement)| {
        // Without bins every slice issues the triangle once per pass.
        let display = small.swept(clip, Projection::Orthographic)?;
        let stats = render_volume(&display, &recording, &VolumeConfig::plain(), &HostRenderer, workers)?.stats;
        Ok(row("P5", statement, "draws", (passes, 0.0), stats.draws as f64 / stats.slices_rendered as f64))
    };
    published.into_iter().map(count).collect()
}

/// Returns figures P9 (pixels per word), D7 (bytes of a packed slice) and D8. D8 is the number of queries and stencil
/// clears of a volume, with and without batches.
fn batches(display: &SweptDisplay, workers: &dyn Workers) -> Result<Vec<FigureRow>, SettingError> {
    let drawn = |batch| {
        // The same triangle is drawn with batches of one slice and of four slices.
        let tiling = Tiling { batch, ..Tiling::PAPER };
        let config = VolumeConfig { tiling, binning: Binning::AllPlanes, ..VolumeConfig::paper() };
        render_volume(display, &recording(1.0)?, &config, &HostRenderer, workers)
    };
    let by_slice: VolumeStats = drawn(1)?.stats;
    let batched = drawn(Tiling::PAPER.batch)?;
    let [width, height] = batched.planes.size().map(f64::from);
    let words = batched.planes.slice(0).len() as f64;
    let stats = batched.stats;
    Ok(vec![
        row("P9", "pixels in a word of a slice that was drawn", "pixels", (8.0, 0.0), width * height / words),
        row("D7", "a slice packed", "B", (294_912.0, 0.0), 4.0 * words),
        row("D8", "queries of a volume, slice by slice", "queries", (228_096.0, 0.0), by_slice.queries as f64),
        row("D8", "queries of a volume, in batches", "queries", (57_024.0, 0.0), stats.queries as f64),
        row("D8", "stencil clears of a volume, slice by slice", "clears", (396.0, 0.0), by_slice.stencil_clears as f64),
        row("D8", "stencil clears, in batches", "clears", (99.0, 0.0), stats.stencil_clears as f64),
    ])
}

/// Returns figures D1, D2 and D5, computed from the matrices of the views and the instants of the strobes (flashes). D1
/// is the angle between neighbouring slices. D2 has two numbers: the number of distinct planes, and the number of times
/// per second that each plane is shown. D5 is the distance at the rim between a pixel of one slice and the same pixel
/// of the next slice.
fn planes(views: &[SliceView]) -> Vec<FigureRow> {
    let across = |k: usize| views[k].view.transpose().x_axis.truncate();
    let angle = |k: usize| {
        let [this, next] = [across(k), across(k + 1)];
        this.cross(next).length().atan2(this.dot(next)).to_degrees()
    };
    // D1: the angle between neighbouring slices.
    let pitch = (0..views.len() - 1).map(angle).fold(0.0, f64::max);
    // D2: the number of slices after which the plane of slice 0 occurs again, and the number of distinct planes.
    let mut distinct: Vec<_> = views.iter().map(plane).collect();
    let again = distinct.iter().skip(1).position(|other| *other == distinct[0]).map_or(0, |k| k as u64 + 1);
    distinct.sort_unstable();
    distinct.dedup();
    let slow = PerspectaConfig { spin_rpm: 600, ..PerspectaConfig::PAPERS };
    let period_s = slow.strobe(0, again).0.0 as f64 / 1e12;
    let rim = glam::DVec3::new(PerspectaConfig::PAPERS.width as f64 / 2.0, 0.0, 0.0);
    let voxel = |k: usize| views[k].view.inverse().transform_point3(rim);
    vec![
        row("D1", "greatest angle between neighbouring slices", "deg", (0.909_091, 5e-7), pitch),
        row("D2", "distinct planes", "planes", (198.0, 0.0), distinct.len() as f64),
        row("D2", "times a second that a plane is strobed at 600 rpm", "Hz", (20.0, 1e-9), 1.0 / period_s),
        row(
            "D5",
            "distance of the same pixel in neighbouring slices at the rim",
            "px",
            (6.09, 5e-3),
            (voxel(0) - voxel(1)).length(),
        ),
    ]
}

/// Returns the plane of a slice in a form that can be compared: the bits of its normal. Both directions of the normal
/// give the same bits.
fn plane(view: &SliceView) -> [u64; 2] {
    let normal = view.view.transpose().z_axis;
    let sign = if normal.x < 0.0 || (normal.x == 0.0 && normal.z < 0.0) { -1.0 } else { 1.0 };
    [normal.x, normal.z].map(|coordinate| (sign * coordinate + 0.0).to_bits())
}

/// Returns figures D3 and D4 by bisection. D3 is half the thickness of slice 0 at the rim. D4 is the radius at which
/// half the thickness is half a pixel.
fn slab(views: &[SliceView]) -> Vec<FigureRow> {
    let radius = PerspectaConfig::PAPERS.width as f64 / 2.0;
    let has = |u: f64, s: f64| views[0].volume.contains([u, 0.0, s], u, s);
    let rim = bisect([0.0, radius], |s| has(radius, s));
    let thin = bisect([0.0, radius], |u| !has(u, 0.5));
    vec![
        row("D3", "half thickness at the rim", "px", (3.046_456_8, 5e-8), rim),
        row("D4", "radius where the slab is one pixel thick", "px", (63.02, 5e-3), thin),
    ]
}

/// Returns the number at which `holds` changes from true to false, by bisection between `low` and `high`.
fn bisect([mut low, mut high]: [f64; 2], holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if holds(middle) { low = middle } else { high = middle }
    }
    low
}

/// Number of equal arcs into which a circle around the axis is divided. The middle of each arc is tested. No middle
/// lies exactly on a plane that separates bins.
const STEPS: u32 = 3_600;

/// Returns figure P14: for each region, the number of planes that bound the region. Two conditions make a plane a
/// bound. The plane's sign changes where a circle around the axis enters or leaves the region, and the layout lists the
/// plane as a bound.
fn bounds() -> Vec<FigureRow> {
    let layout = BinLayout::double_wedges(0.0);
    let code = |step: u32| {
        let (sin, cos) = spatialgl::sin_cos_of_turn(i64::from(2 * step + 1), 2 * STEPS);
        layout.code([cos, 0.0, sin])
    };
    let counts: Vec<u32> = layout
        .regions
        .iter()
        .map(|region| {
            // A step between two different codes crosses a plane.
            let changes = (0..STEPS).map(|step| (code(step), code((step + 1) % STEPS)));
            let ends = changes.filter(|(here, next)| here != next && [*here, *next].contains(&region.signs));
            (ends.fold(0, |planes, (here, next)| planes | (here ^ next)) & region.bounds).count_ones()
        })
        .collect();
    let least = counts.iter().min().copied().unwrap_or(0);
    let most = counts.iter().max().copied().unwrap_or(0);
    vec![
        row("P14", "planes that bound a bin region, fewest", "planes", (2.0, 0.0), f64::from(least)),
        row("P14", "planes that bound a bin region, most", "planes", (2.0, 0.0), f64::from(most)),
    ]
}
