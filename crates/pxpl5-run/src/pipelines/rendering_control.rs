//! Rendering Control on the emulated machine.

use crate::keys::{Key, KeyValue, KeyValues, PipelineSettings};
use crate::pipeline::{PictureTimes, Pipeline, Setup};
use crate::registry::{Goal, LimitCriterion, PipelineEntry, TestScene};
use image::RgbImage;
use pphigs::{Binning, Picture, Shading};
use pxpl5_geometry::Viewport;
use pxpl5_gp::{Priority, Stage};
use pxpl5_machine::{Arrival, ConfigError, Machine, Record, StageSpan};
use pxpl5_renderer::Layout;
use pxpl5_sim::Time;
use pxpl5_wire::{Lines, PictureNumber, SurfaceId, ViewNumber};
use rendering_control::{RenderingControlConfig, host, master, slave};
use std::sync::Arc;

/// The pipeline under PPHIGS (TR94).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderingControl {
    /// One picture instead of a stereo pair.
    pub mono: bool,
    /// Where colours are computed.
    pub shading: Shading,
}

impl RenderingControl {
    /// Stereo with Phong shading, as measured in TR94.
    #[must_use]
    pub const fn stereo() -> Self {
        Self { mono: false, shading: Shading::Phong }
    }

    /// One picture with Phong shading.
    #[must_use]
    pub const fn mono() -> Self {
        Self { mono: true, shading: Shading::Phong }
    }

    fn config(self, machine: &Machine, pixels: bool) -> Result<RenderingControlConfig, ConfigError> {
        let ports = machine.ports();
        let [master, slaves @ ..] = &ports.gps[..] else { return Err(too_few_gps(0)) };
        if slaves.is_empty() {
            return Err(too_few_gps(1));
        }
        let display = machine.record().display();
        let surface = display.surfaces().first();
        let grid = surface.map_or(Viewport::FRAME.grid(), |surface| surface.grid());
        let viewport = Viewport::new(grid, Lines::Frame).map_err(|error| ConfigError::Board(error.to_string()))?;
        let picture =
            Picture { viewport, shading: self.shading, binning: Binning::Touched, layout: self.layout(), pixels };
        Ok(RenderingControlConfig {
            host: ports.host,
            master: *master,
            slaves: slaves.to_vec(),
            renderers: ports.renderers.clone(),
            frame_buffers: ports.display().to_vec(),
            picture,
        })
    }
}

fn too_few_gps(found: u64) -> ConfigError {
    ConfigError::Value {
        what: "n_gps of Rendering Control (a master and slaves)".to_owned(),
        expected: (2, 1_000),
        found,
    }
}

impl Pipeline for RenderingControl {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn settings(&self) -> Vec<(&'static str, KeyValue)> {
        let (shading, _) = SHADINGS[usize::from(self.shading == SHADINGS[1].1)];
        vec![("mono", KeyValue::Flag(self.mono)), ("shading", KeyValue::Name(shading))]
    }

    fn eyes(&self) -> usize {
        if self.mono { 1 } else { 2 }
    }

    fn layout(&self) -> Layout {
        Layout::rendering_control_phong()
    }

    fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), ConfigError> {
        let config = self.config(machine, setup.pixels)?;
        let (foreground, views) = (Priority::Foreground, setup.views.clone());
        let gp = machine.processor(config.host, foreground);
        let program = host(gp, config.clone(), setup.host, move |view, time| views(view, time));
        machine.load(config.host, foreground, Box::pin(program));
        let gp = machine.processor(config.master, foreground);
        machine.load(config.master, foreground, Box::pin(master(gp, config.clone())));
        for (index, node) in config.slaves.iter().enumerate() {
            let gp = machine.processor(*node, foreground);
            for (level, program) in slave(&gp, &config, config.share(&setup.list, index), index) {
                machine.load(*node, level, Box::pin(program));
            }
        }
        Ok(())
    }

    fn pictures(&self, record: &Record, end: Time) -> Vec<PictureTimes> {
        let stages = record.stages();
        let shown = record.observation().swap_ticks(self.eyes());
        let shown = shown.iter().map(|tick| record.tick(*tick));
        PictureNumber::FIRST
            .onwards()
            .zip(shown)
            .filter(|(_, shown_at)| *shown_at < end)
            .filter_map(|(frame, at)| times(&stages, frame, at))
            .collect()
    }

    /// One for each eye's copy.
    fn retraces_a_picture(&self) -> Option<u64> {
        Some(self.eyes() as u64)
    }

    /// Two fields a frame are what two copies of 15.6 ms need; more are counted.
    fn missed_retraces(&self, record: &Record, pictures: &[PictureTimes]) -> u64 {
        let display = record.display();
        let ticks =
            |pair: &[PictureTimes]| display.period_at(pair[1].shown_at).since(display.period_at(pair[0].shown_at));
        pictures.windows(2).map(|pair| ticks(pair).saturating_sub(self.eyes() as u64)).sum()
    }

    fn latency_definition(&self) -> &'static str {
        "from the start of TRANSFORM of the frame's first eye on the first slave to the retrace at which the frame is swapped in"
    }

    fn missed_definition(&self) -> &'static str {
        "retraces between two swaps beyond one for each eye's copy"
    }

    /// An eye's copy is timed by itself.
    fn copy_part(&self, arrival: &Arrival) -> u8 {
        arrival.surface.0 as u8
    }

    /// The frame in the buffer that is shown: it is complete, though the beam may not have been everywhere yet.
    fn picture(&self, record: &Record, surface: SurfaceId) -> Option<RgbImage> {
        record.display().shown(surface.index())
    }
}

fn times(stages: &[StageSpan], frame: PictureNumber, shown_at: Time) -> Option<PictureTimes> {
    let of = |stage: Stage| stages.iter().filter(move |s| s.picture == frame && s.stage == stage);
    Some(PictureTimes {
        picture: frame,
        view: ViewNumber::taken_for(frame),
        sampled_at: of(Stage::Sample).map(|s| s.begin).min(),
        transform_at: of(Stage::Transform).map(|s| s.begin).min()?,
        copied_at: of(Stage::Copy).filter_map(|s| s.end).max(),
        shown_at,
        complete: true,
    })
}

const SHADINGS: [(&str, Shading); 2] = [("phong", Shading::Phong), ("gouraud", Shading::Gouraud)];

/// Rendering Control in the registry.
pub(super) const ENTRY: PipelineEntry = PipelineEntry {
    name: "rendering-control",
    family: "rendering-control",
    about: "frames drawn region by region, three stages overlapping, under PPHIGS (TR94)",
    preset: "small-hmd",
    keys: &[
        Key {
            name: "mono",
            about: "one picture instead of a stereo pair: true or false",
            values: KeyValues::Flag,
            sets: &[],
        },
        Key {
            name: "shading",
            about: "phong or gouraud",
            values: KeyValues::Names(&[SHADINGS[0].0, SHADINGS[1].0]),
            sets: &[],
        },
    ],
    build,
    limit: |_| LimitCriterion { goal: Goal::NoMissedRetrace, scene: TestScene::Typical, fields: 90 },
    tables: &[],
    closed_form: None,
    compared: true,
};

fn build(settings: &PipelineSettings) -> Arc<dyn Pipeline> {
    let stereo = RenderingControl::stereo();
    let shading = SHADINGS.iter().find(|(name, _)| settings.name("shading") == Some(name));
    Arc::new(RenderingControl {
        mono: settings.flag("mono").unwrap_or(stereo.mono),
        shading: shading.map_or(stereo.shading, |(_, shading)| *shading),
    })
}
