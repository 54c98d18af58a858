//! Tests of the pipeline whose regions a policy distributes, on displays of several sizes.

use pphigs::Shading;
use pxpl5_framebuffer::PanelConfig;
use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, Outcome, Pixels, PolicyFrame, PolicyPipeline, RegionAssignment, RegionPolicy};
use pxpl5_scene::builtin;
use pxpl5_wire::{RegionId, SurfaceId};
use std::sync::{Arc, Mutex};

/// A policy that gives the regions to the renderers in turn. Stores the numbers of columns and of all regions of each
/// frame.
#[derive(Debug, Default)]
struct InTurn(Mutex<Vec<(u32, usize)>>);

impl RegionPolicy for InTurn {
    fn name(&self) -> &str {
        "in turn"
    }

    fn assign(&self, frame: &PolicyFrame) -> Option<Vec<RegionAssignment>> {
        let regions = frame.primitives.len();
        self.0.lock().expect("one thread").push((frame.columns, regions));
        Some((0..regions).map(|region| (RegionId(region as u16), region % frame.renderers)).collect())
    }
}

/// Draws triangles that cover the screen.
fn run(machine: MachineConfig, policy: &Arc<InTurn>) -> Outcome {
    let policy: Arc<dyn RegionPolicy> = Arc::clone(policy) as _;
    let scene = builtin("full-screen:1").expect("built in");
    let pipeline = PolicyPipeline::new(policy, Shading::Gouraud);
    Experiment::new(machine, pipeline, scene).fields(150).pixels(Pixels::All).run().expect("it is small")
}

#[test]
fn a_policy_gets_all_regions_of_the_display_and_every_pixel_is_drawn() {
    let panel = PanelConfig { width: 1_080, height: 1_200, ..PanelConfig::PAPERS };
    let small = MachineConfig::small_hmd();
    let large = MachineConfig::small_hmd().with_renderers(20).with_display(panel);
    for (machine, [width, height]) in [(small, [640_u32, 480]), (large, [1_080, 1_200])] {
        let policy = Arc::new(InTurn::default());
        let outcome = run(machine, &policy);
        let [columns, rows] = [width, height].map(|pixels| pixels.div_ceil(128));
        let frames = policy.0.lock().expect("one thread").clone();
        assert!(!frames.is_empty() && frames.iter().all(|frame| *frame == (columns, (columns * rows) as usize)));
        let picture = outcome.pipeline().picture(outcome.record(), SurfaceId(0)).expect("a picture was shown");
        assert_eq!(picture.dimensions(), (width, height));
        let black = picture.pixels().filter(|pixel| pixel.0 == [0; 3]).count();
        assert_eq!(black, 0, "{width} x {height}");
    }
}
