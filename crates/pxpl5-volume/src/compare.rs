//! All clips and projections of a scene beside each other, and what the paper rejects as too dear.

use crate::choices::{ClipKind, Named, ProjectionKind};
use crate::error::VolumeError;
use crate::experiment::Volume;
use crate::pictures::{Look, grid};
use crate::settings::VolumeSettings;
use image::RgbImage;
use pxpl5_scene::Scene;
use serde::Serialize;
use spatialgl::{Coverage, Workers};

/// One variant of how slices are made.
#[derive(Clone, Debug, Serialize)]
pub struct VariantRow {
    /// The clip with its offset or bias.
    pub clip: String,
    /// Name of the projection.
    pub projection: &'static str,
    /// Samples taken of each pixel.
    pub samples: u64,
    /// `sampled` or `connected`.
    pub coverage: &'static str,
    /// How often the scene is drawn for a slice.
    pub passes: u64,
    /// Fragments that reached the fragment program.
    pub fragments_generated: u64,
    /// Fragments that lie in their slice's volume.
    pub fragments_accepted: u64,
    /// Draws that bins leave of all, percent.
    pub draws_percent: f64,
    /// Part of the queried tiles that holds something, percent.
    pub tile_occupancy_percent: f64,
    /// Part of the mesh's intersections with the slices that is shown, percent.
    pub connected_percent: f64,
    /// Radius in pixels within which no slice can show a point, whatever the scene; none if no slice can show anything.
    pub dead_zone_radius_px: Option<u32>,
    /// Pixels lit in any colour, in all slices.
    pub lit_voxels: u64,
    /// Lit pixels in rings around the axis.
    pub brightness_by_radius: Vec<u64>,
    /// The same over those of the exact clip with the same projection; none where that shows nothing.
    pub brightness_over_exact: Vec<Option<f64>>,
    /// Milliseconds of the model: processor, GPU, bus.
    pub model_ms: [f64; 3],
    /// Volumes a second if the three follow each other.
    pub volumes_hz_serial: f64,
    /// Volumes a second if they work at the same time.
    pub volumes_hz_overlapped: f64,
    /// A number that any other bit of the volume would change.
    pub volume_hash: String,
    /// What of it is not the paper's.
    pub beyond_paper: Vec<&'static str>,
    /// Seconds that this computer took.
    pub host_seconds: f64,
    #[serde(skip)]
    variant: Variant,
}

/// Every variant of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct VolumeComparison {
    /// Name and version of this record's layout.
    pub schema: &'static str,
    /// Name of the scene that all draw.
    pub scene: String,
    /// Triangles, lines and points of the scene.
    pub triangles: u64,
    /// Width of the rings of brightness, pixels.
    pub ring_px: u32,
    /// Names the sequence of the jitter.
    pub seed: u64,
    /// A row for each variant.
    pub variants: Vec<VariantRow>,
    /// What an eye sees of them, in their order, all of one exposure.
    #[serde(skip)]
    pub pictures: Vec<RgbImage>,
}

/// From where the pictures of a comparison are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Angle around the axis from +z to +x, degrees.
    pub azimuth_deg: f64,
    /// Angle above the horizon, degrees.
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

/// Six clips by three projections; then the hyperbola along the normal with more samples and with connected intersections.
fn variants() -> Vec<Variant> {
    let sampled = |clip, projection| Variant { clip, projection, samples: 1, coverage: Coverage::Sampled };
    let mut all: Vec<Variant> = ClipKind::ALL
        .into_iter()
        .flat_map(|clip| ProjectionKind::ALL.map(|projection| sampled(clip, projection)))
        .collect();
    let plain = sampled(ClipKind::Hyperbolic, ProjectionKind::Orthographic);
    all.push(Variant { samples: 4, ..plain });
    all.push(Variant { samples: 16, ..plain });
    all.push(Variant { coverage: Coverage::Connected, ..plain });
    all
}

/// How many volumes a comparison draws.
#[must_use]
pub fn variant_count() -> u64 {
    variants().len() as u64
}

/// Draws every variant of a scene; all other settings are shared. `finished` hears how many of them are done.
///
/// # Errors
///
/// [`VolumeError`] names what is wrong with a setting or with the scene.
pub fn compare(
    settings: &VolumeSettings,
    scene: &Scene,
    viewpoint: Option<Viewpoint>,
    workers: &dyn Workers,
    finished: impl Fn(u64, u64),
) -> Result<VolumeComparison, VolumeError> {
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
    let mut exposure = None;
    if let Some(viewpoint) = viewpoint {
        let volume = reference.draw(settings, scene, workers)?;
        exposure = Some(viewpoint.look(&volume).exposure(&volume, workers)?);
    }
    for variant in &all {
        let volume = variant.draw(settings, scene, workers)?;
        comparison.triangles = volume.frame.stats.primitives;
        comparison.ring_px = volume.brightness().ring_px;
        comparison.variants.push(variant.row(&volume));
        if let Some(viewpoint) = viewpoint {
            comparison.pictures.push(viewpoint.look(&volume).picture(&volume, exposure, workers)?);
        }
        finished(comparison.variants.len() as u64, all.len() as u64);
    }
    comparison.relate_to_exact();
    Ok(comparison)
}

impl Viewpoint {
    fn look(&self, volume: &Volume) -> Look {
        Look::around(&volume.settings, self.azimuth_deg, self.elevation_deg, self.side)
    }
}

impl Variant {
    fn draw(&self, shared: &VolumeSettings, scene: &Scene, workers: &dyn Workers) -> Result<Volume, VolumeError> {
        let mut settings = shared.clone();
        settings.clip = self.clip;
        settings.projection = self.projection;
        settings.draw.samples = self.samples;
        settings.coverage = self.coverage;
        Volume::draw(&settings, scene, workers)
    }

    fn row(&self, volume: &Volume) -> VariantRow {
        let report = volume.report();
        let stats = &volume.frame.stats;
        let time = volume.time();
        VariantRow {
            clip: report.clip,
            projection: report.projection,
            samples: report.samples,
            coverage: self.coverage.name(),
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
    /// Divides each row's brightness by that of the exact clip with the same projection.
    fn relate_to_exact(&mut self) {
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
            let ratio = |(own, exact): (&u64, &u64)| (*exact > 0).then(|| *own as f64 / *exact as f64);
            row.brightness_over_exact = row.brightness_by_radius.iter().zip(of).map(ratio).collect();
        }
    }

    /// The six clips by three projections: a row for each clip. Nothing of a comparison without pictures.
    #[must_use]
    pub fn clips_and_projections(&self) -> Option<RgbImage> {
        let columns = ProjectionKind::ALL.len();
        let pictures = self.pictures.get(..ClipKind::ALL.len() * columns)?;
        Some(grid(pictures, columns as u32))
    }

    /// The hyperbola along the normal with 1, 4 and 16 samples, connected, and jittered. Nothing without pictures.
    #[must_use]
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
