//! What an experiment is made of, by path.

use crate::choices::{ClipKind, Named, ProjectionKind, RendererKind};
use crate::error::VolumeError;
use crate::numbers::{ClipNumbers, DrawNumbers, EyeNumbers, JitterNumbers, SweepNumbers, TileNumbers, ViewerNumbers};
use parameters::ParameterTable;
use perspecta::PerspectaConfig;
use spatialgl::{
    BinTolerance, Binning, Combine, Coverage, GpuTiming, Halftone, Jitter, Projection, Rotation, SliceClip, Strobes,
    SweptConfig, SweptDisplay, TieRule, Tiling, TimeModel, VolumeConfig,
};

/// Everything that decides what a volume is, and the numbers of the model of its time.
///
/// [`Self::paper`] has the paper's values where it gives any, and our choices, within their ranges, where it does not.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeSettings {
    /// The display: slices, width, height, spin.
    pub display: PerspectaConfig,
    /// Where its turn begins.
    pub sweep: SweepNumbers,
    /// Which way its screen turns.
    pub rotation: Rotation,
    /// Which of the six clips is used.
    pub clip: ClipKind,
    /// Offset, bias and precision of the clips.
    pub clip_numbers: ClipNumbers,
    /// What becomes of points in the planes between slices.
    pub ties: TieRule,
    /// Which of the three projections is used.
    pub projection: ProjectionKind,
    /// The law of the jittered projection.
    pub jitter: JitterNumbers,
    /// The eye of the perspective projection.
    pub eye: EyeNumbers,
    /// Names the sequence of the jitter.
    pub seed: u64,
    /// How primitives are sorted.
    pub binning: Binning,
    /// How far from a plane a vertex counts for both sides.
    pub bin_tolerance: BinTolerance,
    /// Side of tiles and length of batches.
    pub tile: TileNumbers,
    /// Samples and dither of the slices.
    pub draw: DrawNumbers,
    /// What of a primitive is drawn.
    pub coverage: Coverage,
    /// Which slices are drawn and which are mirrored.
    pub strobes: Strobes,
    /// What becomes of several fragments on one pixel.
    pub combine: Combine,
    /// Whether the scene's light shines.
    pub is_lit: bool,
    /// Who draws the slices.
    pub renderer: RendererKind,
    /// Rates and times of the host and its GPU.
    pub gpu: GpuTiming,
    /// Who stands before the display; decides nothing of the volume.
    pub viewer: ViewerNumbers,
}

/// A table and the first part of its paths.
pub(crate) type NamedTable<'a> = (&'static str, &'a dyn ParameterTable);

impl VolumeSettings {
    /// The display of the paper, hyperbolic clip, jittered eyes.
    #[must_use]
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

    /// All tables of numbers, with the first part of their paths.
    pub(crate) fn tables(&self) -> [NamedTable<'_>; 9] {
        [
            ("display", &self.display),
            ("display", &self.sweep),
            ("clip", &self.clip_numbers),
            ("jitter", &self.jitter),
            ("eye", &self.eye),
            ("tile", &self.tile),
            ("draw", &self.draw),
            ("gpu", &self.gpu),
            ("viewer", &self.viewer),
        ]
    }

    /// The clip with its offset or bias.
    #[must_use]
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

    /// The clip as options and reports write it: its name, and its offset or bias after a colon.
    #[must_use]
    pub fn clip_text(&self) -> String {
        let name = self.clip.name();
        match self.slice_clip() {
            SliceClip::Tapered(number) | SliceClip::Parallel(number) | SliceClip::Hyperbolic(number) => {
                format!("{name}:{number}")
            }
            _ => name.to_owned(),
        }
    }

    /// The projection with its eye or the law of its jitter.
    #[must_use]
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

    /// What the projection is called in options and reports.
    #[must_use]
    pub fn projection_text(&self) -> &'static str {
        self.projection.name()
    }

    /// Radius of the display, pixels.
    #[must_use]
    pub const fn radius(&self) -> f64 {
        self.display.width as f64 / 2.0
    }

    /// The display as the pipeline sees it.
    ///
    /// # Errors
    ///
    /// [`VolumeError`] names the first number that is wrong, what was expected and what was found.
    pub fn swept_display(&self) -> Result<SweptDisplay, VolumeError> {
        self.check_tables()?;
        let bits = self.clip_numbers.plane_fraction_bits;
        Ok(SweptDisplay::new(SweptConfig {
            slices: self.display.slices as u32,
            width: self.display.width as u32,
            height: self.display.height as u32,
            phase: self.sweep.phase_deg.to_radians(),
            rotation: self.rotation,
            clip: self.slice_clip(),
            ties: self.ties,
            plane_fraction_bits: (bits < 53).then_some(bits as u32),
            projection: self.slice_projection(),
        })?)
    }

    /// How a volume is made.
    ///
    /// # Errors
    ///
    /// As [`Self::swept_display`].
    pub fn volume_config(&self) -> Result<VolumeConfig, VolumeError> {
        self.check_tables()?;
        let size = self.tile.size as u32;
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

    /// The model of time with the numbers of these settings.
    #[must_use]
    pub const fn time_model(&self) -> TimeModel {
        TimeModel { timing: self.gpu }
    }

    /// What the renderer is called in options and reports.
    #[must_use]
    pub fn renderer_text(&self) -> &'static str {
        self.renderer.name()
    }

    /// What of these settings is not the paper's.
    #[must_use]
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

    /// Checks every number against the limits of its table, and those that only a few values suit.
    fn check_tables(&self) -> Result<(), VolumeError> {
        for (prefix, table) in self.tables() {
            if let Some(entry) = table.entries().into_iter().find(|entry| !entry.is_within_limits()) {
                let (least, most) = entry.info.limits;
                return Err(Self::wrong(prefix, entry.info.name, &format!("{least} to {most}"), entry.value));
            }
        }
        let DrawNumbers { samples, .. } = self.draw;
        if ![1, 4, 16].contains(&samples) {
            return Err(Self::wrong("draw", "samples", "1, 4 or 16", samples));
        }
        Ok(())
    }

    fn wrong(prefix: &str, name: &str, expected: &str, found: impl ToString) -> VolumeError {
        VolumeError::Value {
            place: "settings".to_owned(),
            key: format!("{prefix}.{name}"),
            expected: expected.to_owned(),
            found: found.to_string(),
        }
    }
}
