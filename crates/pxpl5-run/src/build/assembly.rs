//! Builds the machine of an experiment and loads its programs.

use crate::build::assembled::Assembled;
use crate::build::preparation::Preparation;
use crate::built_in::displays;
use crate::display_list::display_list_for;
use crate::error::ExperimentError;
use crate::experiment::{Experiment, FIELDS_RANGE, Pixels};
use crate::head::Head;
use crate::head_views::HeadViews;
use crate::keys::PipelineSettings;
use crate::level::{Level, with_clocks_of_instructions};
use crate::pipeline::{Pipeline, PipelineProperties, Setup};
use crate::pipelines;
use crate::registry::{DisplayEntry, PipelineEntry};
use crate::scene_views::{SceneViews, hmd_on};
use crate::views::ViewSource;
use pxpl5_machine::{Machine, MachineConfig};
use pxpl5_sim::Time;
use pxpl5_sim::parameters::SettingError;
use std::sync::Arc;

impl Experiment {
    pub(crate) fn assemble(&self, preparation: Preparation) -> Result<Assembled, ExperimentError> {
        if !(FIELDS_RANGE.0..=FIELDS_RANGE.1).contains(&self.fields) {
            return Err(SettingError::limits("fields", FIELDS_RANGE, self.fields).into());
        }
        // Adapt the machine to the pipeline, the scene's background and the level of modelling.
        let mut adapted = self.pipeline.adapt(self.config.clone());
        check_coverage(&adapted, self.pipeline.as_ref())?;
        let [red, green, blue] = self.scene.lighting().background;
        let background = u32::from_be_bytes([0, red, green, blue]);
        adapted.displays.iter_mut().for_each(|display| display.set_background(background));
        let PipelineProperties { eyes, layout, .. } = self.pipeline.properties();
        let config = match self.level {
            Level::Analytic => return Err(ExperimentError::Level),
            Level::Transaction => adapted,
            Level::Cycle => with_clocks_of_instructions(&adapted, &layout),
        };
        let mut machine = Machine::new(&config, eyes, layout)?;
        if self.level == Level::Cycle {
            machine.run_code();
        }
        // Load the programs, then apply the options that change no simulated time.
        let (setup, head) = self.setup(&config, &mut machine, preparation)?;
        self.pipeline.load(&mut machine, &setup)?;
        if let Some(seed) = self.shuffle {
            machine.shuffle_ties(seed);
        }
        self.disabled.iter().for_each(|optimization| machine.disable(*optimization));
        if self.pixels == Pixels::All {
            machine.compute_all_pixels(self.host.pixel_worker());
        }
        if self.traffic {
            machine.record_traffic();
        }
        machine.switch_on();
        Ok(Assembled { machine, head })
    }

    fn setup(
        &self,
        config: &MachineConfig,
        machine: &mut Machine,
        preparation: Preparation,
    ) -> Result<(Setup, Option<Arc<HeadViews>>), ExperimentError> {
        let hmd = hmd_on(machine.record().display(), &self.hmd);
        let properties = self.pipeline.properties();
        let scene = self.pipeline.prepare(&self.scene, machine)?;
        let list = Arc::new(display_list_for(&scene, &properties, config)?);
        let eyes = properties.eyes;
        // A tracker supplies the views, or the viewer follows the scene's own motion without any delay.
        let mut head = None;
        if let Some(tracked) = preparation.head.or_else(|| self.head.clone()) {
            let until = machine.record().tick(self.end());
            check_recording(&tracked, until)?;
            head = Some(Arc::new(HeadViews::new(tracked, &scene, (hmd, eyes), until, preparation.seen_times)));
        }
        let (host, seed, aim, pixels) = (config.host, self.seed, self.aim(), self.pixels != Pixels::Off);
        let views: Arc<dyn ViewSource> = match head.clone() {
            Some(head) => head,
            None => Arc::new(SceneViews { period_ns: host.view_period_ns, ..SceneViews::new(&scene, seed, hmd, eyes) }),
        };
        let on_demand = self.on_demand && head.is_some();
        Ok((Setup { list, views, scene, aim, host, seed, on_demand, pixels }, head))
    }
}

/// Checks that the display and the pipeline have the same coverage: one view, or all directions around the head.
///
/// # Errors
///
/// The [`SettingError`] states the coverage of the display and the coverage of the pipeline.
pub fn check_coverage(config: &MachineConfig, pipeline: &dyn Pipeline) -> Result<(), SettingError> {
    let Some(display) = config.displays.first() else { return Ok(()) };
    let (shown, drawn) = (display.coverage(), pipeline.properties().coverage);
    if shown == drawn {
        return Ok(());
    }
    // The first entries of the lists that match serve as examples.
    let matching = |entry: &PipelineEntry| (entry.build)(&PipelineSettings::default()).properties().coverage == shown;
    let pipelines = pipelines::entries().into_iter().find(matching).map_or("none", |entry| entry.name);
    let matching = |entry: &DisplayEntry| (entry.config)().coverage() == drawn;
    let displays = displays().into_iter().find(matching).map_or("none", |entry| entry.name);
    let (display, pipeline) = (display.name(), pipeline.name());
    Err(SettingError::combination(format_args!(
        "display {display} shows {shown}, and {pipeline} draws {drawn}: \
         expected a pipeline such as {pipelines}, or a display such as {displays}, found {display} with {pipeline}"
    )))
}

fn check_recording(head: &Head, until: Time) -> Result<(), ExperimentError> {
    let seconds = |ps: u64| ps as f64 * 1e-12;
    let run = seconds(until.0);
    let reason = if let Some((from_ps, to_ps)) = head.motion.gap_ps(until.0) {
        format!(
            "has no pose from {:.3} s to {:.3} s and the run takes {run:.3} s: simulate fewer fields, or let the head stand still there \
             (head.end = \"hold\")",
            seconds(from_ps),
            seconds(to_ps)
        )
    } else if let Some(ends_ps) = head.motion.ends_ps().filter(|ends_ps| *ends_ps < until.0) {
        format!(
            "ends after {:.3} s and the run takes {run:.3} s: simulate fewer fields, or set the behaviour after its end \
             (head.end = \"hold\" or \"loop\")",
            seconds(ends_ps)
        )
    } else {
        return Ok(());
    };
    Err(ExperimentError::Recording(format!("the recording of the head {reason}")))
}
