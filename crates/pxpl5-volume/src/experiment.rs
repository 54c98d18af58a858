//! A volume that is drawn from a scene with the settings of an experiment.

use crate::choices::RendererKind;
use crate::pixel_planes::{ArrayKind, PixelPlanesRenderer, SliceBounds, SliceTraffic};
use crate::settings::VolumeSettings;
use pxpl5_scene::Scene;
use pxpl5_sim::parameters::SettingError;
use serde::{Serialize, Serializer};
use spatialgl::{
    CommandBuffer, HostRenderer, SliceRenderer, SpatialDisplay, Supersampled, SweptDisplay, VolumeFrame, Workers,
    record_scene, render_volume,
};
use std::time::Instant;

/// A drawn volume, with the settings, the display and the recorded graphics commands from which it was drawn.
#[derive(Clone, Debug)]
pub struct Volume {
    /// Settings with which the volume was drawn.
    pub settings: VolumeSettings,
    /// Name of the scene that the volume shows.
    pub scene: String,
    /// Display, with the part of space and the bins of each slice.
    pub display: SweptDisplay,
    /// Recorded graphics commands that were replayed for every slice.
    pub commands: CommandBuffer,
    /// Bits of the volume, counts of the drawing, and colours before halftoning.
    pub frame: VolumeFrame,
    /// Work of the renderers of Pixel-Planes 5, or `None` if the host drew the volume.
    pub bounds: Option<SliceBounds>,
    /// Ring messages of the volume. `None` if the host drew the volume, or if its tiles cannot be sent.
    pub traffic: Option<SliceTraffic>,
    /// Time in which this computer drew the volume, in seconds.
    pub host_seconds: f64,
}

/// As JSON, a volume is its report.
impl Serialize for Volume {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.report().serialize(serializer)
    }
}

impl Volume {
    /// Draws a scene. The middle of the scene is on the axis, and its farthest corner is at 0.9 times the radius of the
    /// display.
    ///
    /// # Errors
    ///
    /// [`SettingError`] describes the error in a setting or in the scene.
    pub fn draw(settings: &VolumeSettings, scene: &Scene, workers: &dyn Workers) -> Result<Self, SettingError> {
        let commands = record_scene(scene, settings.radius(), settings.is_lit)?;
        Self::draw_commands(settings, scene.name(), commands, workers)
    }

    /// Draws recorded graphics commands whose vertices are already in pixels.
    ///
    /// # Errors
    ///
    /// The same as [`Self::draw`].
    pub fn draw_commands(
        settings: &VolumeSettings,
        scene: &str,
        commands: CommandBuffer,
        workers: &dyn Workers,
    ) -> Result<Self, SettingError> {
        let display = settings.swept_display()?;
        let config = settings.volume_config()?;
        let commands = commands.combining(settings.combine);
        let draw = |renderer: &dyn SliceRenderer| render_volume(&display, &commands, &config, renderer, workers);
        let started = Instant::now();
        let mut bounds = None;
        let mut traffic = None;
        // The renderers of Pixel-Planes 5 also count their work and messages.
        let frame = match (settings.renderer, settings.draw.samples) {
            (RendererKind::Host, 1) => draw(&HostRenderer)?,
            (RendererKind::Host, samples) => draw(&Supersampled::new(HostRenderer, samples as u32)?)?,
            (RendererKind::PixelPlanes, _) => {
                let renderer = PixelPlanesRenderer::new(settings, ArrayKind::Lanes)?;
                let frame = draw(&renderer)?;
                let drawn = &display.views()[..frame.stats.slices.len()];
                traffic = SliceTraffic::of(&renderer, drawn, &frame, config.tiling);
                bounds = Some(SliceBounds::of(renderer.work(), &frame, config.tiling, traffic.as_ref()));
                frame
            }
        };
        let host_seconds = started.elapsed().as_secs_f64();
        let settings = settings.clone();
        Ok(Self { settings, scene: scene.to_owned(), display, commands, frame, bounds, traffic, host_seconds })
    }

    /// Returns the index of a slice after checking that the slice exists.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the volume has fewer slices.
    pub fn check_slice(&self, slice: u32) -> Result<u32, SettingError> {
        let slices = self.frame.planes.slices();
        if slice < slices {
            return Ok(slice);
        }
        Err(SettingError::value("slice", format_args!("0 to {}", slices - 1), slice))
    }
}
