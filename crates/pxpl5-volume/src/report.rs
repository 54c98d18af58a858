//! What a volume's report says: `pxpl5-volume/1`.

use crate::experiment::Volume;
use crate::pixel_planes::{BoundRow, SimulatedRow, SliceBounds, SliceTraffic, simulate};
use crate::settings::VolumeSettings;
use parameters::Value;
use serde::Serialize;
use spatialgl::{SpatialDisplay, VolumeTime, brightness_by_radius, connected, dead_zone_radius, innermost_lit_radius};

/// Width of the rings in which brightness is reported, pixels.
const RING_PX: u32 = 8;

/// One volume in numbers; all counts are exact, times are a model whose definitions stand beside them.
#[derive(Clone, Debug, Serialize)]
pub struct VolumeReport {
    /// Name and version of this record's layout.
    pub schema: &'static str,
    /// Name of the scene that was drawn.
    pub scene: String,
    /// The display that it was drawn for.
    pub display: DisplayReport,
    /// The clip with its offset or bias.
    pub clip: String,
    /// Name of the projection.
    pub projection: &'static str,
    /// Names the sequence of the jitter.
    pub seed: u64,
    /// Who drew the slices.
    pub renderer: &'static str,
    /// What the renderers of Pixel-Planes 5 did, and their bounds; none if this computer drew.
    pub pixel_planes: Option<PixelPlanesReport>,
    /// Samples taken of each pixel.
    pub samples: u64,
    /// Triangles, lines and points of the scene.
    pub triangles: u64,
    /// Slices drawn; fewer than are shown if some are mirrored.
    pub slices_rendered: u64,
    /// How often the scene is drawn for a slice.
    pub passes: u64,
    /// Primitives issued for all slices and passes.
    pub draws: u64,
    /// What they would be without bins.
    pub draws_unbinned: u64,
    /// Entries in all bins.
    pub bin_memberships: u64,
    /// Fragments that reached the fragment program; none if the renderers of Pixel-Planes 5 drew, which count no fragments.
    pub fragments_generated: Option<u64>,
    /// Fragments that lie in their slice's volume; none likewise.
    pub fragments_accepted: Option<u64>,
    /// Pixels added to connect intersections, which is beyond the paper.
    pub fragments_added: u64,
    /// Slices on which nothing was drawn.
    pub slices_empty: u64,
    /// Tiles of batches that hold something.
    pub tiles_occupied: u64,
    /// Part of the queried tiles that holds something, percent.
    pub tile_occupancy_percent: f64,
    /// Queries of tiles of all batches.
    pub queries: u64,
    /// Stencil clears, one a batch.
    pub stencil_clears: u64,
    /// Bytes of all slices with 32 bits a pixel.
    pub bytes_unpacked: u64,
    /// Bytes of all slices packed.
    pub bytes_packed: u64,
    /// Bytes sent: packed words of occupied tiles and the maps of tiles.
    pub bytes_sent: u64,
    /// Bits of unpacked pixels that the projector has no use for, percent.
    pub waste_percent: f64,
    /// Pixels lit in any colour, in all slices.
    pub lit_voxels: u64,
    /// Samples on the mesh's intersections with the slices that have a drawn pixel beside them, percent.
    pub connected_percent: f64,
    /// Lit pixels by their distance from the axis.
    pub brightness_by_radius: Brightness,
    /// Radius in pixels within which no slice can show a point, whatever the scene; none if no slice can show anything.
    pub dead_zone_radius_px: Option<u32>,
    /// Distance in pixels from the axis to the nearest lit pixel; none of a dark volume.
    pub innermost_lit_px: Option<u32>,
    /// Times of the model of a host with a GPU; none if the renderers of Pixel-Planes 5 drew.
    pub model_ms: Option<ModelTimes>,
    /// Volumes a second if processor, GPU and bus follow each other; none likewise.
    pub volumes_hz_serial: Option<f64>,
    /// Volumes a second if they work at the same time; none likewise.
    pub volumes_hz_overlapped: Option<f64>,
    /// Primitives with a corner outside what the display shows.
    pub outside_volume: u64,
    /// A number, in hexadecimal digits, that any other bit of the volume would change.
    pub volume_hash: String,
    /// Numbers that are not the papers'.
    pub overrides: Vec<Override>,
    /// What of it is not the paper's.
    pub beyond_paper: Vec<&'static str>,
    /// Seconds that this computer took.
    pub host_seconds: f64,
}

/// What a volume costs on Pixel-Planes 5, which is beyond the paper.
#[derive(Clone, Debug, Serialize)]
pub struct PixelPlanesReport {
    /// Counted clocks, commands and words, and the tiles sent.
    #[serde(flatten)]
    pub counts: SliceBounds,
    /// What the milliseconds of the bounds are.
    pub definition: &'static str,
    /// Volumes a second with more and more boards, by the slowest part alone.
    pub bounds: Vec<BoundRow>,
    /// The same machines event by event; none if the volume's tiles cannot be sent.
    pub simulated: Vec<SimulatedRow>,
}

/// Renderers and graphics processors of the bounds; the third is the largest machine that was built.
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

/// The display in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct DisplayReport {
    /// What it is called.
    pub name: &'static str,
    /// Slices of a turn.
    pub slices: u64,
    /// Width of a slice, pixels.
    pub width: u64,
    /// Height of a slice, pixels.
    pub height: u64,
    /// Turns of the screen a minute.
    pub spin_rpm: u64,
    /// Volumes a second that an eye gets: two a turn.
    pub volumes_hz: f64,
}

/// Lit pixels in rings around the axis.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Brightness {
    /// Width of each ring, pixels.
    pub ring_px: u32,
    /// Lit pixels of all slices in each ring, from the axis outwards.
    pub lit_voxels: Vec<u64>,
}

/// A part of the model's time.
#[derive(Clone, Debug, Serialize)]
pub struct ModelPart {
    /// Milliseconds of one volume.
    pub ms: f64,
    /// The formula that it is computed by.
    pub definition: &'static str,
}

/// Milliseconds of one volume, each with its formula.
#[derive(Clone, Debug, Serialize)]
pub struct ModelTimes {
    /// The processor: vertices, bins and calls.
    pub cpu: ModelPart,
    /// The GPU: vertices, fragments, clears, queries and packing.
    pub gpu: ModelPart,
    /// The bus: from the GPU and to the projector.
    pub bus: ModelPart,
    /// The same volume sent as pixels of 32 bits, without queries and packing: bus.
    pub bus_unpacked: ModelPart,
}

/// A number that was set.
#[derive(Clone, Debug, Serialize)]
pub struct Override {
    /// Its path, as after `--set`.
    pub path: String,
    /// The value that it has.
    pub value: Value,
    /// The value that the paper gives or allows.
    pub papers: Value,
}

const CPU: &str = "vertices t_vertex + primitives t_primitive + slices passes t_call + draws t_issue";
const GPU: &str = "3 draws / vertex rate + fragments generated / fill + W H (slices + batches) / fill + queries t_query \
                   + queries tile^2 / fill + pixels packed / texel rate";
const BUS: &str = "bytes sent / readback, and the same to the projector";
const BUS_UNPACKED: &str = "4 bytes a pixel of all slices / readback, and the same to the projector";

impl Volume {
    /// Milliseconds of the volume by the model of its settings.
    #[must_use]
    pub fn time(&self) -> VolumeTime {
        let tile = self.settings.tile.size as u32;
        self.settings.time_model().packed(&self.frame.stats, self.display.target_size(), tile)
    }

    /// The volume in numbers.
    #[must_use]
    pub fn report(&self) -> VolumeReport {
        let stats = &self.frame.stats;
        let planes = &self.frame.planes;
        let settings = &self.settings;
        // The model of time and its counts of fragments are a GPU's.
        let fragments = self.bounds.is_none().then_some(stats);
        let time = self.bounds.is_none().then(|| self.time());
        VolumeReport {
            schema: "pxpl5-volume/1",
            scene: self.scene.clone(),
            display: DisplayReport::of(settings),
            clip: settings.clip_text(),
            projection: settings.projection_text(),
            seed: settings.seed,
            renderer: settings.renderer_text(),
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

    /// Part of the mesh's intersections with the slices that is shown, percent.
    #[must_use]
    pub fn connected_percent(&self) -> f64 {
        connected(&self.display, &self.commands, &self.frame).map_or(f64::NAN, |found| found.percent())
    }

    /// Lit pixels in rings around the axis.
    #[must_use]
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

/// Bits that the projector has no use for, of all bits that are sent unpacked.
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
    /// The numbers that are not the papers'.
    #[must_use]
    pub fn overrides(&self) -> Vec<Override> {
        let changed = self.numbers().into_iter().filter(|(_, entry)| entry.value != entry.info.papers);
        changed.map(|(path, entry)| Override { path, value: entry.value, papers: entry.info.papers }).collect()
    }
}
