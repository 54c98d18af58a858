//! The settings of an experiment with a volume. Each setting has a path such as `clip.bias_px2`.

use crate::choices::{ClipKind, ProjectionKind, RendererKind, name_of};
use crate::numbers::{ClipNumbers, DrawNumbers, EyeNumbers, JitterNumbers, SweepNumbers, TileNumbers, ViewerNumbers};
use pxpl5_sim::parameters::{PathSettings, SettingError};
use spatialgl::perspecta::PerspectaConfig;
use spatialgl::{
    BinTolerance, Binning, Combine, Coverage, GpuTiming, Halftone, Jitter, Projection, Rotation, SliceClip, Strobes,
    SweptConfig, SweptDisplay, TieRule, Tiling, TimeModel, VolumeConfig,
};

/// All settings that determine a volume, and the numbers of its time model.
///
/// [`Self::paper`] has the values of the SpatialGL paper. Values that the paper does not give are assumed, each within
/// a stated range.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeSettings {
    /// Number of slices, width, height and spin of the display.
    pub display: PerspectaConfig,
    /// Angle of the first slice of a turn, measured around the axis.
    pub sweep: SweepNumbers,
    /// Direction in which the screen turns.
    pub rotation: Rotation,
    /// Method of clipping the scene to a slice.
    pub clip: ClipKind,
    /// Offset and bias of the methods that clip to a slice, and the precision of their planes.
    pub clip_numbers: ClipNumbers,
    /// Rule for points that lie exactly in the planes between slices.
    pub ties: TieRule,
    /// Projection that maps points near a slice to the image of the slice.
    pub projection: ProjectionKind,
    /// Parameters of the jittered projection.
    pub jitter: JitterNumbers,
    /// Eye of the perspective projection.
    pub eye: EyeNumbers,
    /// Seed of the random eye positions and shears of the jittered projection.
    pub seed: u64,
    /// Method of sorting primitives into bins.
    pub binning: Binning,
    /// Distance from a plane within which a vertex counts as lying on both sides.
    pub bin_tolerance: BinTolerance,
    /// Size of tiles, and number of slices per batch of queries.
    pub tile: TileNumbers,
    /// Number of samples per pixel, and size of the dither matrix.
    pub draw: DrawNumbers,
    /// Rule for the pixels of a slice that a primitive covers.
    pub coverage: Coverage,
    /// Rule that determines which slices of a turn are drawn, and which slices are mirrored copies.
    pub strobes: Strobes,
    /// Rule for the colour of a pixel with several fragments.
    pub combine: Combine,
    /// True if the scene is shaded by its light source.
    pub is_lit: bool,
    /// Hardware that draws the slices.
    pub renderer: RendererKind,
    /// Rates and times of the host and its GPU.
    pub gpu: GpuTiming,
    /// Position of the viewer in front of the display. The position has no influence on the volume.
    pub viewer: ViewerNumbers,
}

impl VolumeSettings {
    /// Returns the settings of the SpatialGL paper: its display, the hyperbolic clip and the jittered projection.
    pub const fn paper() -> Self {
        Self {
            display: PerspectaConfig::PAPERS,
            sweep: SweepNumbers::PAPERS,
            rotation: Rotation::XToZ,
            clip: ClipKind::Hyperbolic,
            clip_numbers: ClipNumbers::PAPERS,
            ties: TieRule::HalfOpen,
            projection: ProjectionKind::Jittered,
            jitter: JitterNumbers::PAPERS,
            eye: EyeNumbers::PAPERS,
            seed: 1,
            binning: Binning::AllPlanes,
            bin_tolerance: BinTolerance::OfTheClip,
            tile: TileNumbers::PAPERS,
            draw: DrawNumbers::PAPERS,
            coverage: Coverage::Sampled,
            strobes: Strobes::Each,
            combine: Combine::Last,
            is_lit: true,
            renderer: RendererKind::Host,
            gpu: GpuTiming::PAPERS,
            viewer: ViewerNumbers::PAPERS,
        }
    }

    /// Returns the clip, with its offset or bias.
    pub const fn slice_clip(&self) -> SliceClip {
        let ClipNumbers { offset_px, bias_px2, .. } = self.clip_numbers;
        match self.clip {
            ClipKind::Prism => SliceClip::Prism,
            ClipKind::UserPlanes => SliceClip::UserPlanes,
            ClipKind::Exact => SliceClip::ShaderPlanes,
            ClipKind::Tapered => SliceClip::Tapered(offset_px),
            ClipKind::Parallel => SliceClip::Parallel(offset_px),
            ClipKind::Hyperbolic => SliceClip::Hyperbolic(bias_px2),
        }
    }

    /// Returns the clip as text for options and reports: its name, and after a colon its offset or bias.
    pub fn clip_text(&self) -> String {
        let name = name_of(self.clip, &ClipKind::ALL);
        match self.slice_clip() {
            SliceClip::Tapered(number) | SliceClip::Parallel(number) | SliceClip::Hyperbolic(number) => {
                format!("{name}:{number}")
            }
            _ => name.to_owned(),
        }
    }

    /// Returns the projection, with the position of its eye or the limits of its random eye positions.
    pub const fn slice_projection(&self) -> Projection {
        match self.projection {
            ProjectionKind::Orthographic => Projection::Orthographic,
            ProjectionKind::Perspective => {
                let EyeNumbers { across_px, up_px, distance, shear_across, shear_up } = self.eye;
                Projection::Perspective {
                    eye: [across_px, up_px],
                    distance: distance * self.radius(),
                    shear: [shear_across, shear_up],
                }
            }
            ProjectionKind::Jittered => {
                let JitterNumbers { eye_distance, eye_radius, shear_px } = self.jitter;
                Projection::Jittered(Jitter { seed: self.seed, eye_distance, eye_radius, shear_px })
            }
        }
    }

    /// Returns the name of the projection in options and reports.
    pub fn projection_text(&self) -> &'static str {
        name_of(self.projection, &ProjectionKind::ALL)
    }

    /// Returns the radius of the display, pixels.
    pub const fn radius(&self) -> f64 {
        self.display.width as f64 / 2.0
    }

    /// Returns the display in the form that the rendering pipeline needs.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the first number that is out of range, the expected and the found value.
    pub fn swept_display(&self) -> Result<SweptDisplay, SettingError> {
        self.check_tables()?;
        let bits = self.clip_numbers.plane_fraction_bits;
        SweptDisplay::new(SweptConfig {
            slices: self.display.slices as u32,
            width: self.display.width as u32,
            height: self.display.height as u32,
            phase: self.sweep.phase_deg.to_radians(),
            rotation: self.rotation,
            clip: self.slice_clip(),
            ties: self.ties,
            // 53 bits are the full double precision.
            plane_fraction_bits: (bits < 53).then_some(bits as u32),
            projection: self.slice_projection(),
        })
    }

    /// Returns the settings for rendering a volume.
    ///
    /// # Errors
    ///
    /// The same as [`Self::swept_display`].
    pub fn volume_config(&self) -> Result<VolumeConfig, SettingError> {
        self.check_tables()?;
        let size = self.tile.size as u32;
        // A size of 0 turns tiles off.
        let tiling = Tiling { tile: (size > 0).then_some(size), batch: self.tile.batch as u32 };
        tiling.check()?;
        Ok(VolumeConfig {
            binning: self.binning,
            bin_tolerance: self.bin_tolerance,
            tiling,
            halftone: Halftone::bayer(self.draw.matrix as u32)?,
            coverage: self.coverage,
            strobes: self.strobes,
            keeps_colours: true,
        })
    }

    /// Returns the time model with the numbers of these settings.
    pub const fn time_model(&self) -> TimeModel {
        TimeModel { timing: self.gpu }
    }

    /// Returns the features of these settings that go beyond the SpatialGL paper.
    pub fn beyond_paper(&self) -> Vec<&'static str> {
        let mut beyond = Vec::new();
        if self.coverage == Coverage::Connected {
            beyond.push("connected coverage");
        }
        if self.strobes == Strobes::Mirror {
            beyond.push("mirrored strobes");
        }
        if self.renderer == RendererKind::PixelPlanes {
            beyond.push("renderers of Pixel-Planes 5");
        }
        beyond
    }

    /// Checks every number against the limits of its table, and the number of samples against the allowed values.
    fn check_tables(&self) -> Result<(), SettingError> {
        for (prefix, table) in self.tables() {
            table.check().map_err(|error| error.in_table(prefix).at("settings"))?;
        }
        // A range cannot express the allowed numbers of samples.
        let DrawNumbers { samples, .. } = self.draw;
        if ![1, 4, 16].contains(&samples) {
            return Err(SettingError::value("draw.samples", "1, 4 or 16", samples).at("settings"));
        }
        Ok(())
    }
}
