//! The report of a volume. Its layout has the name and version `pxpl5-volume/1`.

use crate::choices::{RendererKind, name_of};
use crate::experiment::Volume;
use crate::pixel_planes::{BoundRow, SimulatedRow, SliceBounds, SliceTraffic, simulate};
use crate::settings::VolumeSettings;
use pxpl5_sim::parameters::{Parameter, PathSettings, Value};
use serde::Serialize;
use spatialgl::{SpatialDisplay, VolumeTime, brightness_by_radius, connected, dead_zone_radius, innermost_lit_radius};

/// Width in pixels of the rings around the axis in which lit pixels are counted.
const RING_PX: u32 = 8;

/// The report of one volume. All counts are exact. Each time comes from a model and is reported with its formula.
#[derive(Clone, Debug, Serialize)]
pub struct VolumeReport {
    /// Name and version of the JSON layout of this data.
    pub schema: &'static str,
    /// Name of the scene that was drawn.
    pub scene: String,
    /// Display for which the volume was drawn.
    pub display: DisplayReport,
    /// Name of the method that clips the scene to a slice, with its offset or bias.
    pub clip: String,
    /// Name of the projection.
    pub projection: &'static str,
    /// Seed of the random eye positions and shears of the jittered projection.
    pub seed: u64,
    /// Name of the renderer that drew the slices.
    pub renderer: &'static str,
    /// Work and times of the renderers of Pixel-Planes 5, or `None` if this computer drew the slices.
    pub pixel_planes: Option<PixelPlanesReport>,
    /// Number of samples per pixel of a slice.
    pub samples: u64,
    /// Number of triangles, lines and points of the scene.
    pub triangles: u64,
    /// Number of slices drawn. If slices are mirrored, more slices are shown than drawn.
    pub slices_rendered: u64,
    /// Number of times that the whole scene is drawn for each slice.
    pub passes: u64,
    /// Number of primitives drawn, summed over all slices and passes.
    pub draws: u64,
    /// Number of primitives that would be drawn without bins.
    pub draws_unbinned: u64,
    /// Number of entries in all bins. A primitive has an entry in each bin that it touches.
    pub bin_memberships: u64,
    /// Number of fragments that reached the fragment program, or `None` for the renderers of Pixel-Planes 5, which
    /// count no fragments.
    pub fragments_generated: Option<u64>,
    /// Number of fragments that lie in the volume of their slice, or `None` for the renderers of Pixel-Planes 5.
    pub fragments_accepted: Option<u64>,
    /// Number of pixels added to close gaps in the intersections of surfaces with slices. Added pixels are beyond the
    /// SpatialGL paper.
    pub fragments_added: u64,
    /// Number of slices on which nothing was drawn.
    pub slices_empty: u64,
    /// Number of tiles in which a pixel was drawn, summed over all batches of slices.
    pub tiles_occupied: u64,
    /// Percentage of queried tiles in which a pixel was drawn.
    pub tile_occupancy_percent: f64,
    /// Number of occlusion queries of tiles, for all batches of slices.
    pub queries: u64,
    /// Number of stencil clears: one for each batch of slices.
    pub stencil_clears: u64,
    /// Size of all drawn slices with 32 bits per pixel, bytes.
    pub bytes_unpacked: u64,
    /// Size of all drawn slices in packed form, bytes.
    pub bytes_packed: u64,
    /// Number of bytes sent to the projector: packed words of occupied tiles, and the maps of tiles.
    pub bytes_sent: u64,
    /// Percentage of the bits in unpacked pixels that the projector does not use.
    pub waste_percent: f64,
    /// Number of pixels lit in any colour, summed over all slices.
    pub lit_voxels: u64,
    /// Connectedness of surfaces: percentage of shown samples, along the intersections of mesh and slices. A sample is
    /// shown if its pixel, or one of the eight neighbouring pixels, is drawn.
    pub connected_percent: f64,
    /// Number of lit pixels in rings around the axis.
    pub brightness_by_radius: Brightness,
    /// Radius in pixels around the axis within which no slice can show a point of any scene. `None` if no slice can
    /// show anything.
    pub dead_zone_radius_px: Option<u32>,
    /// Distance in pixels from the axis to the nearest lit pixel, or `None` if no pixel of the volume is lit.
    pub innermost_lit_px: Option<u32>,
    /// Times of one volume by the model of a host with a GPU, or `None` for the renderers of Pixel-Planes 5.
    pub model_ms: Option<ModelTimes>,
    /// Volumes per second if processor, GPU and bus work one after the other, or `None` for the renderers of
    /// Pixel-Planes 5.
    pub volumes_hz_serial: Option<f64>,
    /// Volumes per second if processor, GPU and bus work at the same time, or `None` for the renderers of Pixel-Planes
    /// 5.
    pub volumes_hz_overlapped: Option<f64>,
    /// Number of primitives with a corner outside the display's volume.
    pub outside_volume: u64,
    /// Hash of all bits of the volume, in hexadecimal digits.
    pub volume_hash: String,
    /// Settings whose numbers differ from the SpatialGL paper's values.
    pub overrides: Vec<Override>,
    /// Settings that go beyond the SpatialGL paper.
    pub beyond_paper: Vec<&'static str>,
    /// Time in which this computer drew the volume, in seconds.
    pub host_seconds: f64,
}

/// The cost of a volume that the renderers of Pixel-Planes 5 draw. The SpatialGL paper does not have these renderers.
#[derive(Clone, Debug, Serialize)]
pub struct PixelPlanesReport {
    /// Counts of clocks, commands, words and sent tiles.
    #[serde(flatten)]
    pub counts: SliceBounds,
    /// Formulas for the numbers in `bounds` and `simulated`.
    pub definition: &'static str,
    /// Volumes per second of several machines. The slowest part alone limits each rate.
    pub bounds: Vec<BoundRow>,
    /// Results of the event-by-event simulation of the same machines. The list is empty if the volume's tiles cannot be
    /// sent.
    pub simulated: Vec<SimulatedRow>,
}

/// Pairs of the numbers of renderers and graphics processors for which bounds are reported. The third pair is the
/// largest machine that was built.
const BOARDS: [[u64; 2]; 5] = [[1, 4], [5, 13], [20, 50], [20, 13], [5, 50]];

const BOUNDS: &str = "renderers: clocks of clears, triangles and halftones and of the moves to the backing store / 40 MHz; ring: words of commands and of occupied tiles with \
                      their overhead; port: the tiles at the display's one port; processors: slice triangles as triangles of a frame, and commands as entries of bins; each by itself. \
                      simulated: one volume through the ring, the renderers and the display, event by event";

impl PixelPlanesReport {
    fn of(counts: SliceBounds, traffic: Option<&SliceTraffic>) -> Self {
        let bounds = BOARDS.map(|[renderers, processors]| counts.with(renderers, processors));
        let rows = |traffic| BOARDS.iter().filter_map(move |[r, p]| simulate(traffic, &counts, *r, *p).ok()).collect();
        let simulated = traffic.map(rows).unwrap_or_default();
        Self { counts, definition: BOUNDS, bounds: bounds.to_vec(), simulated }
    }
}

/// Size, number of slices and rotation of the display.
#[derive(Clone, Debug, Serialize)]
pub struct DisplayReport {
    /// Name of the display in options and files.
    pub name: &'static str,
    /// Number of slices per turn.
    pub slices: u64,
    /// Width of a slice, pixels.
    pub width: u64,
    /// Height of a slice, pixels.
    pub height: u64,
    /// Turns of the screen per minute.
    pub spin_rpm: u64,
    /// Volumes per second that an eye sees: two per turn.
    pub volumes_hz: f64,
}

/// The numbers of lit pixels in rings around the axis of the display.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Brightness {
    /// Width of each ring around the axis, pixels.
    pub ring_px: u32,
    /// Number of lit pixels in each ring, over all slices. The innermost ring is first.
    pub lit_voxels: Vec<u64>,
}

/// One part of the modelled time, with its formula.
#[derive(Clone, Debug, Serialize)]
pub struct ModelPart {
    /// Time for one volume, milliseconds.
    pub ms: f64,
    /// Formula by which `ms` is computed.
    pub definition: &'static str,
}

/// The modelled times for one volume, each with its formula.
#[derive(Clone, Debug, Serialize)]
pub struct ModelTimes {
    /// Processor time for vertices, sorting into bins, and graphics calls.
    pub cpu: ModelPart,
    /// GPU time for vertices, fragments, clears, queries and packing.
    pub gpu: ModelPart,
    /// Bus time for transfers from the GPU and to the projector.
    pub bus: ModelPart,
    /// Bus time if the same volume were sent as 32-bit pixels, without queries and packing.
    pub bus_unpacked: ModelPart,
}

/// A setting whose number differs from the SpatialGL paper's value.
#[derive(Clone, Debug, Serialize)]
pub struct Override {
    /// Path of the setting, as written after `--set`.
    pub path: String,
    /// Value of the setting with which the volume was drawn.
    pub value: Value,
    /// Value or range of the setting that the SpatialGL paper gives.
    pub papers: Value,
}

const CPU: &str = "vertices t_vertex + primitives t_primitive + slices passes t_call + draws t_issue";
const GPU: &str = "3 draws / vertex rate + fragments generated / fill + W H (slices + batches) / fill + queries t_query \
                   + queries tile^2 / fill + pixels packed / texel rate";
const BUS: &str = "bytes sent / readback, and the same to the projector";
const BUS_UNPACKED: &str = "4 bytes a pixel of all slices / readback, and the same to the projector";

impl Volume {
    /// Returns the modelled time of the volume, computed with the time model of its settings.
    pub fn time(&self) -> VolumeTime {
        let tile = self.settings.tile.size as u32;
        self.settings.time_model().packed(&self.frame.stats, self.display.target_size(), tile)
    }

    /// Returns the report of the volume.
    pub fn report(&self) -> VolumeReport {
        let stats = &self.frame.stats;
        let planes = &self.frame.planes;
        let settings = &self.settings;
        // The time model and the fragment counts apply only to a GPU.
        let fragments = self.bounds.is_none().then_some(stats);
        let time = self.bounds.is_none().then(|| self.time());
        VolumeReport {
            schema: "pxpl5-volume/1",
            scene: self.scene.clone(),
            display: DisplayReport::of(settings),
            clip: settings.clip_text(),
            projection: settings.projection_text(),
            seed: settings.seed,
            renderer: name_of(settings.renderer, &RendererKind::ALL),
            pixel_planes: self.bounds.map(|counts| PixelPlanesReport::of(counts, self.traffic.as_ref())),
            samples: stats.samples,
            triangles: stats.primitives,
            slices_rendered: stats.slices_rendered,
            passes: stats.passes,
            draws: stats.draws,
            draws_unbinned: stats.draws_unbinned,
            bin_memberships: stats.bin_memberships,
            fragments_generated: fragments.map(|stats| stats.fragments_generated),
            fragments_accepted: fragments.map(|stats| stats.fragments_accepted),
            fragments_added: stats.fragments_added,
            slices_empty: stats.slices_empty,
            tiles_occupied: stats.tiles_occupied,
            tile_occupancy_percent: stats.tile_occupancy_percent(),
            queries: stats.queries,
            stencil_clears: stats.stencil_clears,
            bytes_unpacked: stats.bytes_unpacked,
            bytes_packed: stats.bytes_packed,
            bytes_sent: stats.bytes_sent,
            waste_percent: waste_percent(stats.bytes_unpacked, settings),
            lit_voxels: planes.lit_voxels(),
            connected_percent: self.connected_percent(),
            brightness_by_radius: self.brightness(),
            dead_zone_radius_px: dead_zone_radius(&self.display),
            innermost_lit_px: innermost_lit_radius(planes),
            model_ms: time.as_ref().map(|time| self.model_times(time)),
            volumes_hz_serial: time.as_ref().map(VolumeTime::serial_hz),
            volumes_hz_overlapped: time.as_ref().map(VolumeTime::overlapped_hz),
            outside_volume: stats.outside_volume,
            volume_hash: format!("{:016x}", planes.hash()),
            overrides: settings.overrides(),
            beyond_paper: settings.beyond_paper(),
            host_seconds: self.host_seconds,
        }
    }

    /// Returns the percentage of samples that are shown. The samples lie at most a pixel apart on the curves in which
    /// the slices intersect the mesh. A sample is shown if its pixel, or one of the eight neighbouring pixels, is
    /// drawn. The result is NaN if the frame has no colours.
    pub fn connected_percent(&self) -> f64 {
        connected(&self.display, &self.commands, &self.frame).map_or(f64::NAN, |found| found.percent())
    }

    /// Returns the number of lit pixels in rings around the axis.
    pub fn brightness(&self) -> Brightness {
        Brightness { ring_px: RING_PX, lit_voxels: brightness_by_radius(&self.frame.planes, RING_PX) }
    }

    fn model_times(&self, time: &VolumeTime) -> ModelTimes {
        let unpacked = self.settings.time_model().unpacked(&self.frame.stats, self.display.target_size());
        ModelTimes {
            cpu: ModelPart { ms: time.cpu_ms, definition: CPU },
            gpu: ModelPart { ms: time.gpu_ms, definition: GPU },
            bus: ModelPart { ms: time.bus_ms(), definition: BUS },
            bus_unpacked: ModelPart { ms: unpacked.bus_ms(), definition: BUS_UNPACKED },
        }
    }
}

fn waste_percent(bytes_unpacked: u64, settings: &VolumeSettings) -> f64 {
    let display = &settings.display;
    let slices = if settings.strobes == spatialgl::Strobes::Mirror { display.slices / 2 } else { display.slices };
    let used = 3.0 * (slices * display.width * display.height) as f64;
    100.0 * (1.0 - used / (8 * bytes_unpacked) as f64)
}

impl DisplayReport {
    fn of(settings: &VolumeSettings) -> Self {
        let display = &settings.display;
        Self {
            name: "perspecta",
            slices: display.slices,
            width: display.width,
            height: display.height,
            spin_rpm: display.spin_rpm,
            volumes_hz: display.volume_hz(),
        }
    }
}

impl VolumeSettings {
    /// Returns the settings whose numbers differ from the SpatialGL paper's values.
    pub fn overrides(&self) -> Vec<Override> {
        let changed = self.numbers().into_iter().filter(|number| number.value != number.info.papers);
        changed.map(|Parameter { path, value, info, .. }| Override { path, value, papers: info.papers }).collect()
    }
}
