//! The SpatialGL paper's figures as rows: what it prints or what follows from it, and what this model has.

use crate::timing::PerspectaConfig;
use parameters::Standing;
use serde::Serialize;
use spatialgl::{
    BinLayout, DENSE_PIXELS, HalfWedge, PIXELS_PER_WORD, SliceClip, SliceVolume, SpatialDisplay, SweptDisplay, Tiling,
    VolumeStats,
};

/// One figure of the paper beside what the model has.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    /// Its number in the specification: P is printed in the paper, D derived from it.
    pub id: &'static str,
    /// What it states, in words.
    pub statement: &'static str,
    /// Unit of both values and of the interval.
    pub unit: &'static str,
    /// The value that is printed or derived; for "over" and "about" the middle or the end of the interval.
    pub published: f64,
    /// Smallest and largest value that agree with it.
    pub interval: [f64; 2],
    /// What the model has.
    pub computed: f64,
    /// Whether the value is printed or derived.
    pub standing: Standing,
}

impl Figure {
    /// Whether the model agrees with it.
    #[must_use]
    pub fn is_met(&self) -> bool {
        (self.interval[0]..=self.interval[1]).contains(&self.computed)
    }

    /// Distance from the published value, percent of it.
    #[must_use]
    pub fn error_percent(&self) -> f64 {
        100.0 * (self.computed - self.published) / self.published
    }
}

/// A row whose interval is half a unit of its last printed digit.
const fn row(
    id: &'static str,
    statement: &'static str,
    unit: &'static str,
    standing: Standing,
    (published, half_digit): (f64, f64),
    computed: f64,
) -> Figure {
    Figure {
        id,
        statement,
        unit,
        published,
        interval: [published - half_digit, published + half_digit],
        computed,
        standing,
    }
}

/// Months in which the performance of GPUs doubles, least and most (published, P20).
pub const GPU_DOUBLES_MONTHS: [f64; 2] = [6.0, 9.0];

/// Months in which the performance of CPUs doubles (published, P20).
pub const CPU_DOUBLES_MONTHS: f64 = 18.0;

const P: Standing = Standing::Published;
const D: Standing = Standing::Derived;

/// All figures that follow from the display and the pipeline without drawing anything.
#[must_use]
pub fn formulas() -> Vec<Figure> {
    let config = PerspectaConfig::PAPERS;
    let wedge = HalfWedge::new(config.slices as u32, config.width as f64 / 2.0);
    let mut figures = printed(&config);
    figures.extend(passes());
    figures.extend(geometry(&config, wedge));
    figures.extend(amounts(&config));
    figures.extend(means(&config, wedge));
    figures
}

/// What was counted in a volume against what the paper says of most scenes.
#[must_use]
pub fn measured(stats: &VolumeStats) -> Vec<Figure> {
    let occupancy = Figure {
        interval: [5.0, 20.0],
        ..row("P17", "tiles that are not empty, most scenes", "%", P, (10.0, 0.0), stats.tile_occupancy_percent())
    };
    let draws = 100.0 * stats.draws as f64 / stats.draws_unbinned.max(1) as f64;
    let binned = row("section 6", "draws that bins leave of all", "%", D, (28.5, 4.0), draws);
    vec![occupancy, binned]
}

fn printed(config: &PerspectaConfig) -> Vec<Figure> {
    let word_bits = 32.0;
    let pixel_bits = 3.0;
    let waste = 100.0 * (1.0 - pixel_bits / word_bits);
    let bytes = (config.slices * config.width * config.height * 4) as f64 / 1e6;
    let tiling = Tiling::PAPER;
    vec![
        row("P1", "slices strobed in a revolution", "slices", P, (396.0, 0.0), config.slices as f64),
        Figure { interval: [90.0, 100.0], ..row("P8", "waste of 32-bit pixels: over", "%", P, (90.0, 0.0), waste) },
        row("P9", "pixels in a packed word", "pixels", P, (8.0, 0.0), f64::from(PIXELS_PER_WORD)),
        row("P10", "3-bit pixels that a word could hold", "pixels", P, (10.0, 0.0), DENSE_PIXELS as f64),
        Figure {
            interval: [100.0, 1000.0],
            ..row("P11", "image data a frame: 100s of MB", "MB", P, (550.0, 0.0), bytes)
        },
        row("P13", "bin planes", "planes", P, (4.0, 0.0), BinLayout::double_wedges(0.0).planes.len() as f64),
        row("P16", "side of a tile", "pixels", P, (32.0, 0.0), f64::from(tiling.tile.unwrap_or(0))),
        row("P18", "slices between stencil clears", "slices", P, (4.0, 0.0), f64::from(tiling.batch)),
    ]
}

/// P5: how often the scene is drawn for a slice.
fn passes() -> Vec<Figure> {
    let published = [
        (SliceClip::UserPlanes, 2.0, "passes with user clip planes"),
        (SliceClip::ShaderPlanes, 1.0, "passes with shader clip planes"),
        (SliceClip::Tapered(0.5), 2.0, "passes with a taper"),
        (SliceClip::Parallel(0.5), 1.0, "passes with parallel planes by evaluation bias"),
        (SliceClip::Hyperbolic(0.25), 1.0, "passes with a hyperbola"),
    ];
    let rows = published.into_iter().filter_map(|(clip, passes, statement)| {
        Some(row("P5", statement, "passes", P, (passes, 0.0), f64::from(volume_of(clip)?.passes())))
    });
    rows.collect()
}

fn volume_of(clip: SliceClip) -> Option<SliceVolume> {
    let display = display(clip)?;
    Some(display.views().first()?.volume)
}

fn display(clip: SliceClip) -> Option<SweptDisplay> {
    PerspectaConfig::PAPERS.swept(clip, spatialgl::Projection::Orthographic).ok()
}

fn geometry(config: &PerspectaConfig, wedge: HalfWedge) -> Vec<Figure> {
    let pitch = 360.0 / config.slices as f64;
    let served = display(SliceClip::ShaderPlanes).map_or(0, |display| {
        let distinct = &display.views()[..config.slices as usize / 2];
        distinct.iter().filter(|view| view.bins & 1 == 1).count()
    });
    let rim = SliceClip::ShaderPlanes.half_thickness(wedge, wedge.radius);
    let spacing = wedge.radius * pitch.to_radians();
    vec![
        row("D1", "slice pitch", "deg", D, (0.909_091, 5e-7), pitch),
        row("D1", "sine of half of it", "1", D, (0.007_933_231_6, 5e-11), wedge.sin),
        row("D1", "cosine of half of it", "1", D, (0.999_968_531_4, 5e-11), wedge.cos),
        row("D1", "tangent of half of it", "1", D, (0.007_933_481_2, 5e-11), wedge.tan),
        row("D2", "distinct planes", "planes", D, (198.0, 0.0), config.slices as f64 / 2.0),
        row("D2", "volumes a second at 600 rpm", "Hz", D, (20.0, 0.0), at_600_rpm(config).volume_hz()),
        row("D3", "half thickness at the rim", "px", D, (3.046_456_8, 5e-8), rim),
        row("D4", "radius where the slab is one pixel thick", "px", D, (63.02, 5e-3), 0.5 / wedge.tan),
        row(
            "D5",
            "voxels of 198 planes",
            "voxels",
            D,
            (116_785_152.0, 0.0),
            (config.slices / 2 * config.width * config.height) as f64,
        ),
        row("D5", "spacing of voxels around the axis at the rim", "px", D, (6.09, 5e-3), spacing),
        row("D9", "planes that a double wedge serves", "planes", D, (50.0, 0.0), served as f64),
    ]
}

fn at_600_rpm(config: &PerspectaConfig) -> PerspectaConfig {
    PerspectaConfig { spin_rpm: 600, ..*config }
}

fn amounts(config: &PerspectaConfig) -> Vec<Figure> {
    let pixels = (config.slices * config.width * config.height) as f64;
    let word_pixels = f64::from(PIXELS_PER_WORD);
    let packed = pixels / word_pixels * 4.0;
    let grid = Tiling::PAPER.grid([config.width as u32, config.height as u32]);
    let tiles = f64::from(grid.tiles());
    let slices = config.slices as f64;
    let batch = f64::from(Tiling::PAPER.batch);
    vec![
        row("D6", "waste of a packed word", "%", D, (25.0, 0.0), 100.0 * (1.0 - 3.0 * word_pixels / 32.0)),
        row("D6", "waste of ten pixels a word", "%", D, (6.25, 0.0), 100.0 * (1.0 - 3.0 * DENSE_PIXELS as f64 / 32.0)),
        row("D7", "a volume in 32-bit pixels", "B", D, (934_281_216.0, 0.0), pixels * 4.0),
        row("D7", "a volume packed", "B", D, (116_785_152.0, 0.0), packed),
        row("D7", "a slice in 32-bit pixels", "B", D, (2_359_296.0, 0.0), pixels * 4.0 / slices),
        row("D7", "a volume packed, 10 % of its tiles", "MB", D, (11.68, 5e-3), packed * 0.1 / 1e6),
        row("D7", "a slice packed", "B", D, (294_912.0, 0.0), packed / slices),
        row("D7", "a tile packed", "B", D, (512.0, 0.0), grid.words(0) as f64 * 4.0),
        row("D7", "two frame stores of 3-bit pixels", "MB", D, (175.2, 0.05), 2.0 * pixels * 3.0 / 8.0 / 1e6),
        row("D8", "tiles of a slice", "tiles", D, (576.0, 0.0), tiles),
        row("D8", "queries of a volume, slice by slice", "queries", D, (228_096.0, 0.0), tiles * slices),
        row("D8", "queries of a volume, in batches", "queries", D, (57_024.0, 0.0), tiles * slices / batch),
        row("D8", "stencil clears of a volume, slice by slice", "clears", D, (396.0, 0.0), slices),
        row("D8", "stencil clears, in batches", "clears", D, (99.0, 0.0), slices / batch),
    ]
}

fn means(config: &PerspectaConfig, wedge: HalfWedge) -> Vec<Figure> {
    let planes = config.slices as f64 / 2.0;
    // Equal times today, and what is left of them in 18 months.
    let share = |months: f64| {
        let cpu = 0.5f64;
        let gpu = libm::exp2(-CPU_DOUBLES_MONTHS / months);
        100.0 * cpu / (cpu + gpu)
    };
    vec![
        row("P20", "months in which a GPU doubles, at least", "months", P, (6.0, 0.0), GPU_DOUBLES_MONTHS[0]),
        row("P20", "months in which a GPU doubles, at most", "months", P, (9.0, 0.0), GPU_DOUBLES_MONTHS[1]),
        row("P20", "months in which a CPU doubles", "months", P, (18.0, 0.0), CPU_DOUBLES_MONTHS),
        row(
            "D10",
            "planes that show a point, mean over the disc, prism",
            "planes",
            D,
            (2.0, 5e-4),
            mean(SliceClip::Prism, wedge, planes),
        ),
        row(
            "D11",
            "the same of the hyperbola",
            "planes",
            D,
            (1.081, 5e-4),
            mean(SliceClip::Hyperbolic(0.25), wedge, planes),
        ),
        row(
            "D12",
            "share of the CPU in 18 months, GPU doubling in 9",
            "%",
            D,
            (67.0, 0.5),
            share(GPU_DOUBLES_MONTHS[1]),
        ),
        row(
            "D12",
            "share of the CPU in 18 months, GPU doubling in 6",
            "%",
            D,
            (80.0, 0.5),
            share(GPU_DOUBLES_MONTHS[0]),
        ),
    ]
}

/// Planes that show a point, on the mean over the disc: the area of a slice's slab within it, times the planes.
fn mean(clip: SliceClip, wedge: HalfWedge, planes: f64) -> f64 {
    let steps = 100_000;
    let radius = wedge.radius;
    let step = radius / f64::from(steps);
    let area: f64 = (0..steps)
        .map(|i| {
            let u = (f64::from(i) + 0.5) * step;
            let chord = (radius * radius - u * u).sqrt();
            4.0 * step * clip.half_thickness(wedge, u).min(chord)
        })
        .sum();
    planes * area / (std::f64::consts::PI * radius * radius)
}
