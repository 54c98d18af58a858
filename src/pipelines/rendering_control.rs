//! Rendering Control on the emulated machine.

use super::{PictureTimes, Pipeline, Setup};
use crate::config::ConfigError;
use crate::machine::Machine;
use crate::observation::{LateRegion, StageSpan};
use image::RgbImage;
use pphigs::{Binning, Picture, Shading};
use pxpl5_geometry::Viewport;
use pxpl5_gp::{Priority, Stage};
use pxpl5_renderer::Layout;
use pxpl5_sim::Time;
use pxpl5_wire::Eye;
use rendering_control::{Config, host, master, slave};

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

    fn config(self, machine: &Machine, pixels: bool) -> Result<Config, ConfigError> {
        let ports = machine.ports();
        let [master, slaves @ ..] = &ports.gps[..] else { return Err(too_few_gps(0)) };
        if slaves.is_empty() {
            return Err(too_few_gps(1));
        }
        let viewport = Viewport::FRAME;
        let picture =
            Picture { viewport, shading: self.shading, binning: Binning::Touched, layout: self.layout(), pixels };
        Ok(Config {
            host: ports.host,
            master: *master,
            slaves: slaves.to_vec(),
            renderers: ports.renderers.clone(),
            frame_buffers: ports.frame_buffers.clone(),
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
        "rendering-control"
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
        let program = host(gp, config.clone(), setup.host, move |frame, time| views(frame, time));
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

    fn pictures(&self, machine: &Machine, end: Time) -> Vec<PictureTimes> {
        let observation = machine.observation();
        let stages = observation.stages(machine.ring().timing().occupancy(pxpl5_wire::MAX_MESSAGE_WORDS));
        let shown = observation.swap_fields(self.eyes());
        let shown = shown.iter().map(|field| machine.video().retrace(*field));
        (0..)
            .zip(shown)
            .filter(|(_, shown_at)| *shown_at < end)
            .filter_map(|(frame, at)| times(&stages, frame, at))
            .collect()
    }

    fn late_regions(&self, _: &Machine, _: Time) -> Vec<LateRegion> {
        Vec::new()
    }

    /// Two fields a frame are what two copies of 15.6 ms need; more are counted.
    fn missed_retraces(&self, pictures: &[PictureTimes]) -> u64 {
        let field = 16_683_333_334;
        let fields = |pair: &[PictureTimes]| (pair[1].shown_at - pair[0].shown_at).0.div_ceil(field);
        pictures.windows(2).map(|pair| fields(pair).saturating_sub(self.eyes() as u64)).sum()
    }

    fn latency_definition(&self) -> &'static str {
        "from the start of TRANSFORM of the frame's first eye on the first slave to the retrace at which the frame is swapped in"
    }

    fn missed_definition(&self) -> &'static str {
        "retraces between two swaps beyond one for each eye's copy"
    }

    fn picture(&self, machine: &Machine, eye: Eye) -> Option<RgbImage> {
        Some(machine.frame_buffers().get(eye.index())?.displayed_frame().picture())
    }
}

fn times(stages: &[StageSpan], frame: u64, shown_at: Time) -> Option<PictureTimes> {
    let of = |stage: Stage| stages.iter().filter(move |s| s.picture == frame && s.stage == stage);
    Some(PictureTimes {
        picture: frame,
        view: frame,
        sampled_at: of(Stage::Sample).map(|s| s.begin).min(),
        transform_at: of(Stage::Transform).map(|s| s.begin).min()?,
        copied_at: of(Stage::Copy).filter_map(|s| s.end).max(),
        shown_at,
        complete: true,
    })
}
