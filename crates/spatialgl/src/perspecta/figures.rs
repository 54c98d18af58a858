//! The figures of the SpatialGL paper. A [`FigureRow`] compares a number of the paper with a number that the code
//! computes or counts. A [`Definition`] is an input of the model, or follows from inputs by arithmetic alone, so no
//! comparison is possible.

use crate::perspecta::timing::PerspectaConfig;
use crate::{
    BinLayout, HalfWedge, PIXELS_PER_WORD, SliceClip, SpatialDisplay, SweptDisplay, Tiling, VolumeStats, pack_dense,
    packed_word,
};
use pxpl5_sim::figures::{Definition, FigureRow, around};
use pxpl5_sim::parameters::Provenance;

/// Returns the row that compares a figure's computed value with the published value. The values agree if their
/// difference is at most `half_digit`.
pub fn row(
    id: &'static str,
    statement: &'static str,
    unit: &'static str,
    (published, half_digit): (f64, f64),
    computed: f64,
) -> FigureRow {
    let row = FigureRow::new(id, statement, unit, [published, computed], around(published, half_digit));
    FigureRow { source: source(id).into(), origin: origin(id), cause: cause(id), ..row }
}

/// Returns the provenance of a number: printed in the SpatialGL paper if `id` begins with P, and otherwise derived.
fn origin(id: &str) -> Provenance {
    if id.starts_with('P') { Provenance::Published } else { Provenance::Derived }
}

/// Returns the section of the SpatialGL paper that prints the number with this identifier.
fn source(id: &str) -> &'static str {
    match id {
        "P1" => "SpatialGL Graphics Pipeline; Slice View Volume",
        "P2" | "P3" | "P4" => "Shader Clip Planes",
        "P5" => "Slice View Volume",
        "P6" | "P7" | "P8" | "P9" | "P10" => "Image Reformatting",
        "P11" => "SpatialGL Optimizations",
        "P13" => "Vertex Outcodes",
        "P14" => "Binning",
        "P15" | "P16" | "P17" => "Tile Queries",
        "P18" => "Tile Batching",
        "P19" => "Degenerate Sections",
        "P20" => "Introduction",
        _ => "derived",
    }
}

/// Returns the known reason why the model misses the figure with this identifier, or an empty text.
fn cause(id: &str) -> &'static str {
    match id {
        "P17" => {
            "The SpatialGL paper says \"most scenes\" without naming them, and the interval from 5 to 20 is assumed. \
             A slender object such as the Mig leaves most of the volume empty."
        }
        "section 6" => {
            "The expected value holds for small triangles. The triangles of the Mig are large, so they \
             cross several of the planes between bins and go into several bins."
        }
        _ => "",
    }
}

/// Least and greatest number of months in which the performance of GPUs doubles (figure P20 of the SpatialGL paper).
pub const GPU_DOUBLES_MONTHS: [f64; 2] = [6.0, 9.0];

/// Number of months in which the performance of CPUs doubles (figure P20 of the SpatialGL paper).
pub const CPU_DOUBLES_MONTHS: f64 = 18.0;

/// Returns the inputs of the model that the SpatialGL paper prints, and the numbers that follow from them by
/// arithmetic.
pub fn definitions() -> Vec<Definition> {
    let config = PerspectaConfig::PAPERS;
    let mut all = inputs(&config);
    all.extend(arithmetic(&config));
    all.extend(doubling());
    all
}

fn defined(id: &'static str, statement: &'static str, value: f64, unit: &'static str) -> Definition {
    Definition { id, statement: statement.into(), source: source(id), value, unit, provenance: origin(id) }
}

/// Number of bits of a pixel on the GPU: 4 channels of 8 bits (figure P6 of the SpatialGL paper).
const GPU_PIXEL_BITS: f64 = 32.0;

/// Number of bits of a pixel on the projector: 3 channels of 1 bit (figure P7 of the SpatialGL paper).
const PROJECTOR_PIXEL_BITS: f64 = 3.0;

fn inputs(config: &PerspectaConfig) -> Vec<Definition> {
    let bin_planes = BinLayout::double_wedges(0.0).planes.len();
    vec![
        defined("P1", "slices strobed in a revolution", config.slices as f64, "slices"),
        defined("P6", "bits of a pixel on the GPU", GPU_PIXEL_BITS, "bits"),
        defined("P13", "planes between bins", bin_planes as f64, "planes"),
        defined("P14", "stages of binning: vertices, primitives", 2.0, "stages"),
        defined("P16", "side of a tile", f64::from(Tiling::PAPER.tile.unwrap_or(0)), "pixels"),
        defined("P18", "slices between stencil clears", f64::from(Tiling::PAPER.batch), "slices"),
    ]
}

fn arithmetic(config: &PerspectaConfig) -> Vec<Definition> {
    let slice = (config.width * config.height) as f64;
    let pixels = config.slices as f64 * slice;
    let packed = pixels / f64::from(PIXELS_PER_WORD) * 4.0;
    let tile = f64::from(Tiling::PAPER.tile.unwrap_or(0));
    // Sizes follow from the numbers of slices, pixels and bits.
    let waste = 100.0 * (1.0 - PROJECTOR_PIXEL_BITS / GPU_PIXEL_BITS);
    let stores = 2.0 * pixels * PROJECTOR_PIXEL_BITS / 8.0;
    vec![
        defined("P8", "waste of 32-bit pixels (printed: over 90 %)", waste, "%"),
        defined("P11", "image data of a frame (printed: 100s of MB)", pixels * 4.0 / 1e6, "MB"),
        defined("D5", "voxels of 198 planes", pixels / 2.0, "voxels"),
        defined("D7", "a volume in 32-bit pixels", pixels * 4.0, "B"),
        defined("D7", "a slice in 32-bit pixels", slice * 4.0, "B"),
        defined("D7", "a volume packed", packed, "B"),
        defined("D7", "a volume packed, 10 % of its tiles", packed * 0.1 / 1e6, "MB"),
        defined("D7", "a tile packed", tile * tile / f64::from(PIXELS_PER_WORD) * 4.0, "B"),
        defined("D7", "two frame stores of 3-bit pixels", stores / 1e6, "MB"),
    ]
}

/// Returns figures P20 and D12. P20 states how fast processors improve. CPU and GPU are assumed to take equal times
/// today. D12 is then the CPU's percentage of the total time after 18 months.
fn doubling() -> Vec<Definition> {
    // In 18 months the CPU takes half of its time. A GPU that doubles every m months takes 2^(-18/m) of its time.
    let share = |months: f64| 100.0 / (1.0 + libm::exp2(1.0 - CPU_DOUBLES_MONTHS / months));
    let [least, most] = GPU_DOUBLES_MONTHS;
    vec![
        defined("P20", "months in which a GPU doubles, at least", least, "months"),
        defined("P20", "months in which a GPU doubles, at most", most, "months"),
        defined("P20", "months in which a CPU doubles", CPU_DOUBLES_MONTHS, "months"),
        defined("D12", "share of the CPU in 18 months, GPU doubling in 9", share(most), "%"),
        defined("D12", "share of the CPU in 18 months, GPU doubling in 6", share(least), "%"),
    ]
}

/// Returns the figures that the model computes without drawing: trigonometry, bins, and the thickness of slice volumes.
pub fn formulas() -> Vec<FigureRow> {
    let config = PerspectaConfig::PAPERS;
    let wedge = HalfWedge::new(config.slices as u32, config.width as f64 / 2.0);
    let mut figures = geometry(&config, wedge);
    figures.extend(means(&config, wedge));
    figures
}

/// Returns figures that compare the counts of a volume with the SpatialGL paper's statements about "most scenes".
pub fn measured(stats: &VolumeStats) -> Vec<FigureRow> {
    let occupied = stats.tile_occupancy_percent();
    let occupancy = row("P17", "tiles that are not empty, most scenes", "%", (10.0, 0.0), occupied);
    let draws = 100.0 * stats.draws as f64 / stats.draws_unbinned.max(1) as f64;
    let binned = row("section 6", "share of draws left after binning", "%", (28.5, 4.0), draws);
    vec![occupancy.with_accepted([5.0, 20.0]), binned]
}

/// Returns figures from the packed words of white pixels. P10 is the ten pixels per word of the dense packing. D6 is the
/// percentage of unused bits in the usual and in the dense packing.
pub fn packing() -> Vec<FigureRow> {
    let white = |pixels: usize| pack_dense(&vec![0b111; pixels]);
    let fits = (1..=32).take_while(|pixels| white(*pixels).len() == 1).count();
    let waste = |word: u32| 100.0 * (1.0 - f64::from(word.count_ones()) / 32.0);
    let dense = white(fits).first().map_or(f64::NAN, |word| waste(*word));
    vec![
        row("P10", "3-bit pixels that a densely packed word holds", "pixels", (10.0, 0.0), fits as f64),
        row("D6", "waste of a packed word", "%", (25.0, 0.0), waste(packed_word(0xFF, 0xFF, 0xFF))),
        row("D6", "waste of a densely packed word", "%", (6.25, 0.0), dense),
    ]
}

fn geometry(config: &PerspectaConfig, wedge: HalfWedge) -> Vec<FigureRow> {
    let exact = config.swept(SliceClip::ShaderPlanes, crate::Projection::Orthographic).ok();
    let served = |display: SweptDisplay| {
        // The second half turn has the same planes.
        let distinct = &display.views()[..config.slices as usize / 2];
        distinct.iter().filter(|view| view.bins & 1 == 1).count()
    };
    let served = exact.map_or(0, served);
    vec![
        row("D1", "sine of half the slice pitch", "1", (0.007_933_231_6, 5e-11), wedge.sin),
        row("D1", "cosine of half of it", "1", (0.999_968_531_4, 5e-11), wedge.cos),
        row("D1", "tangent of half of it", "1", (0.007_933_481_2, 5e-11), wedge.tan),
        row("D9", "planes that a double wedge serves", "planes", (50.0, 0.0), served as f64),
    ]
}

fn means(config: &PerspectaConfig, wedge: HalfWedge) -> Vec<FigureRow> {
    let planes = config.slices as f64 / 2.0;
    let [prism, hyperbola] = [SliceClip::Prism, SliceClip::Hyperbolic(0.25)].map(|clip| mean(clip, wedge, planes));
    vec![
        row("D10", "planes that show a point, mean over the disc, prism", "planes", (2.0, 5e-4), prism),
        row("D11", "the same of the hyperbola", "planes", (1.081, 5e-4), hyperbola),
    ]
}

/// Returns the mean number of planes that show a point of the display's disc. This mean is the area that one slice's
/// volume has in common with the disc, times the number of planes, divided by the area of the disc.
fn mean(clip: SliceClip, wedge: HalfWedge, planes: f64) -> f64 {
    let steps = 100_000;
    let radius = wedge.radius;
    let step = radius / f64::from(steps);
    let area: f64 = (0..steps)
        .map(|i| {
            // Integrate the thickness over u, limited to the disc.
            let u = (f64::from(i) + 0.5) * step;
            let chord = (radius * radius - u * u).sqrt();
            4.0 * step * clip.half_thickness(wedge, u).min(chord)
        })
        .sum();
    planes * area / (std::f64::consts::PI * radius * radius)
}
