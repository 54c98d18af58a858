//! Comparison of all clips and projections for one scene. The comparison includes methods that the SpatialGL paper
//! rejects as too expensive.

use crate::choices::{ClipKind, ProjectionKind, name_of};
use crate::experiment::Volume;
use crate::pictures::{EyeView, grid};
use crate::settings::VolumeSettings;
use image::RgbImage;
use pxpl5_scene::Scene;
use pxpl5_sim::Watcher;
use pxpl5_sim::parameters::SettingError;
use serde::Serialize;
use spatialgl::{Coverage, Workers};

/// One row of a comparison: a combination of clip, projection, samples and coverage, with its results.
#[derive(Clone, Debug, Serialize)]
pub struct VariantRow {
    /// Name of the method that clips the scene to a slice, with its offset or bias.
    pub clip: String,
    /// Name of the projection.
    pub projection: &'static str,
    /// Number of samples per pixel.
    pub samples: u64,
    /// Rule for the pixels that a triangle covers: `sampled` or `connected`.
    pub coverage: &'static str,
    /// Number of times that the whole scene is drawn for each slice.
    pub passes: u64,
    /// Number of fragments that reached the fragment program.
    pub fragments_generated: u64,
    /// Number of fragments that lie in the volume of their slice.
    pub fragments_accepted: u64,
    /// Number of primitives drawn with bins, as a percentage of the number without bins.
    pub draws_percent: f64,
    /// Percentage of queried tiles in which a pixel was drawn.
    pub tile_occupancy_percent: f64,
    /// Percentage of shown samples, along the intersections of mesh and slices. A sample is shown if its pixel, or one
    /// of the eight neighbouring pixels, is drawn.
    pub connected_percent: f64,
    /// Radius in pixels around the axis within which no slice can show anything, or `None` if no slice can show
    /// anything.
    pub dead_zone_radius_px: Option<u32>,
    /// Number of pixels lit in any colour, in all slices.
    pub lit_voxels: u64,
    /// Number of lit pixels in each ring around the axis, from the axis outwards.
    pub brightness_by_radius: Vec<u64>,
    /// Ratio of `brightness_by_radius` to the value of the exact clip with the same projection. `None` for rings in
    /// which the exact clip lights no pixel.
    pub brightness_over_exact: Vec<Option<f64>>,
    /// Modelled times of one volume in milliseconds: processor, GPU, bus.
    pub model_ms: [f64; 3],
    /// Volumes per second of the time model if processor, GPU and bus work one after the other.
    pub volumes_hz_serial: f64,
    /// Volumes per second of the time model if processor, GPU and bus work at the same time on different volumes.
    pub volumes_hz_overlapped: f64,
    /// Hash of all bits of the volume.
    pub volume_hash: String,
    /// Settings of this variant that go beyond the SpatialGL paper.
    pub beyond_paper: Vec<&'static str>,
    /// Time in which this computer drew the volume, in seconds.
    pub host_seconds: f64,
    #[serde(skip)]
    variant: Variant,
}

/// The comparison of a scene's volumes for all combinations of clip, projection, samples and coverage.
#[derive(Clone, Debug, Serialize)]
pub struct VolumeComparison {
    /// Name and version of the JSON layout of this data.
    pub schema: &'static str,
    /// Name of the scene that all variants draw.
    pub scene: String,
    /// Number of triangles, lines and points of the scene.
    pub triangles: u64,
    /// Width of the rings in `brightness_by_radius`, pixels.
    pub ring_px: u32,
    /// Seed of the random eye positions and shears of the jittered projection.
    pub seed: u64,
    /// One row for each variant.
    pub variants: Vec<VariantRow>,
    /// Views of the variants, in the order of `variants`. All have the same exposure (brightness of one lit pixel).
    #[serde(skip)]
    pub pictures: Vec<RgbImage>,
}

/// The viewpoint of the pictures in a comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComparePoint {
    /// Azimuth of the eye: angle around the axis from +z to +x, degrees.
    pub azimuth_deg: f64,
    /// Elevation of the eye above the horizon, degrees.
    pub elevation_deg: f64,
    /// Width and height of each picture, pixels.
    pub side: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Variant {
    clip: ClipKind,
    projection: ProjectionKind,
    samples: u64,
    coverage: Coverage,
}

/// Returns all variants. The first 18 combine each of six clips with each of three projections. The remaining variants
/// use the hyperbolic clip and an orthographic projection, with more samples and with connected coverage.
fn variants() -> Vec<Variant> {
    let sampled = |clip, projection| Variant { clip, projection, samples: 1, coverage: Coverage::Sampled };
    let projected = |(_, clip)| ProjectionKind::ALL.map(|(_, projection)| sampled(clip, projection));
    let mut all: Vec<Variant> = ClipKind::ALL.into_iter().flat_map(projected).collect();
    let plain = sampled(ClipKind::Hyperbolic, ProjectionKind::Orthographic);
    all.push(Variant { samples: 4, ..plain });
    all.push(Variant { samples: 16, ..plain });
    all.push(Variant { coverage: Coverage::Connected, ..plain });
    all
}

/// Returns the number of volumes that a comparison draws: one for each variant.
pub fn variant_count() -> u64 {
    variants().len() as u64
}

/// Draws every variant of a scene. All other settings are the same for all variants. After a stop, the result
/// has the variants that were finished.
///
/// # Errors
///
/// [`SettingError`] describes the error in a setting or in the scene.
pub fn compare(
    settings: &VolumeSettings,
    scene: &Scene,
    viewpoint: Option<ComparePoint>,
    workers: &dyn Workers,
    watcher: &mut dyn Watcher,
) -> Result<VolumeComparison, SettingError> {
    let all = variants();
    let mut comparison = VolumeComparison {
        schema: "pxpl5-volume-comparison/1",
        scene: scene.name().to_owned(),
        triangles: 0,
        ring_px: 0,
        seed: settings.seed,
        variants: Vec::new(),
        pictures: Vec::new(),
    };
    let reference = Variant {
        clip: ClipKind::Exact,
        projection: ProjectionKind::Jittered,
        samples: 1,
        coverage: Coverage::Sampled,
    };
    // One exposure for all pictures makes their brightness comparable.
    let mut exposure = None;
    if let Some(viewpoint) = viewpoint {
        let volume = reference.draw(settings, scene, workers)?;
        exposure = Some(viewpoint.eye_view(&volume).exposure(&volume, workers)?);
    }
    let stop = watcher.stop();
    for variant in all.iter().take_while(|_| !stop.is_stopped()) {
        let volume = variant.draw(settings, scene, workers)?;
        comparison.triangles = volume.frame.stats.primitives;
        comparison.ring_px = volume.brightness().ring_px;
        comparison.variants.push(variant.row(&volume));
        if let Some(viewpoint) = viewpoint {
            comparison.pictures.push(viewpoint.eye_view(&volume).picture(&volume, exposure, workers)?);
        }
        watcher.progress(comparison.variants.len() as u64, all.len() as u64);
    }
    comparison.set_brightness_ratios();
    Ok(comparison)
}

impl ComparePoint {
    fn eye_view(&self, volume: &Volume) -> EyeView {
        EyeView::around(&volume.settings, self.azimuth_deg, self.elevation_deg, self.side)
    }
}

impl Variant {
    fn draw(&self, shared: &VolumeSettings, scene: &Scene, workers: &dyn Workers) -> Result<Volume, SettingError> {
        let mut settings = shared.clone();
        // Everything else stays as in the shared settings.
        settings.clip = self.clip;
        settings.projection = self.projection;
        settings.draw.samples = self.samples;
        settings.coverage = self.coverage;
        Volume::draw(&settings, scene, workers)
    }

    fn row(&self, volume: &Volume) -> VariantRow {
        // Most columns come from the report, so that the table and the report always agree.
        let report = volume.report();
        let stats = &volume.frame.stats;
        let time = volume.time();
        VariantRow {
            clip: report.clip,
            projection: report.projection,
            samples: report.samples,
            coverage: name_of(self.coverage, &Coverage::ALL),
            passes: report.passes,
            fragments_generated: stats.fragments_generated,
            fragments_accepted: stats.fragments_accepted,
            draws_percent: 100.0 * report.draws as f64 / report.draws_unbinned.max(1) as f64,
            tile_occupancy_percent: report.tile_occupancy_percent,
            connected_percent: report.connected_percent,
            dead_zone_radius_px: report.dead_zone_radius_px,
            lit_voxels: report.lit_voxels,
            brightness_by_radius: report.brightness_by_radius.lit_voxels,
            brightness_over_exact: Vec::new(),
            model_ms: [time.cpu_ms, time.gpu_ms, time.bus_ms()],
            volumes_hz_serial: time.serial_hz(),
            volumes_hz_overlapped: time.overlapped_hz(),
            volume_hash: report.volume_hash,
            beyond_paper: report.beyond_paper,
            host_seconds: report.host_seconds,
            variant: *self,
        }
    }
}

impl VolumeComparison {
    /// Computes, for each variant and each ring, the number of lit pixels divided by the number with the exact clip and
    /// the same projection.
    fn set_brightness_ratios(&mut self) {
        let exact: Vec<(ProjectionKind, Vec<u64>)> = self
            .variants
            .iter()
            .filter(|row| row.variant.clip == ClipKind::Exact)
            .map(|row| (row.variant.projection, row.brightness_by_radius.clone()))
            .collect();
        for row in &mut self.variants {
            let Some((_, of)) = exact.iter().find(|(projection, _)| *projection == row.variant.projection) else {
                continue;
            };
            // Rings that the exact clip leaves dark have no ratio.
            let ratio = |(own, exact): (&u64, &u64)| (*exact > 0).then(|| *own as f64 / *exact as f64);
            row.brightness_over_exact = row.brightness_by_radius.iter().zip(of).map(ratio).collect();
        }
    }

    /// Returns one picture with a row for each of the six clips and a column for each of the three projections. Returns
    /// `None` for a comparison without pictures.
    pub fn clips_and_projections(&self) -> Option<RgbImage> {
        let columns = ProjectionKind::ALL.len();
        let pictures = self.pictures.get(..ClipKind::ALL.len() * columns)?;
        Some(grid(pictures, columns as u32))
    }

    /// Returns five views with the hyperbolic clip side by side. The first view has an orthographic projection and one
    /// sample per pixel. The other views differ from the first by jitter, by 4 samples, by 16 samples, and by connected
    /// coverage. Returns `None` for a comparison without pictures.
    pub fn samples_and_coverage(&self) -> Option<RgbImage> {
        let shown: Vec<RgbImage> = self
            .variants
            .iter()
            .zip(&self.pictures)
            .filter(|(row, _)| {
                let Variant { clip, projection, .. } = row.variant;
                clip == ClipKind::Hyperbolic && projection != ProjectionKind::Perspective
            })
            .map(|(_, picture)| picture.clone())
            .collect();
        (!shown.is_empty()).then(|| grid(&shown, shown.len() as u32))
    }
}
