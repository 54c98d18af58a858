//! Tests of faces at the cycle level: the times differ from the transaction level, and the texels are equal to the bit.

use super::cells::{CELLS, WARPED};
use super::{FULL, OBJECTS, assert_no_faults, machine, memory, texels};
use pxpl5_run::{Experiment, ExperimentError, FacePipeline, Level, Outcome};
use pxpl5_scene::{HeadMotion, Scene, builtin};

/// Number of fields after which every memory has been drawn at both levels.
const FIELDS: u64 = 40;

fn still(name: &str) -> Scene {
    let scene = builtin(name).expect("built in");
    let mut parts = scene.posed(&scene.edits_at(0)).into_parts();
    parts.structures.iter_mut().for_each(|structure| structure.hinge = None);
    let (target, radius) = scene.bounding_sphere();
    parts.motion = HeadMotion::still(target + glam::Vec3::Z * radius, target).expect("in range");
    Scene::new(parts).expect("what is kept is whole")
}

/// One slave draws, so that ties are resolved in the order of the display list.
fn run(pipeline: FacePipeline, scene: &Scene, level: Level) -> Outcome {
    let mut config = machine("small-hmd", &pipeline, &[("arp.face_texels", 256)]);
    config.n_gps = 2;
    let experiment = Experiment::new(config, pipeline, scene.clone()).fields(FIELDS).level(level);
    match experiment.run() {
        Ok(outcome) => outcome,
        Err(ExperimentError::TooShort { partial, .. }) => *partial,
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn every_memory_shows_the_same_texels_at_the_cycle_level() {
    for scene in ["molecules", "gallery"].map(still) {
        for pipeline in [FULL, OBJECTS, CELLS, WARPED] {
            let outcomes = [Level::Transaction, Level::Cycle].map(|level| run(pipeline.clone(), &scene, level));
            let [table, code] = outcomes.each_ref().map(Outcome::record);
            [table, code].into_iter().for_each(assert_no_faults);
            let memories = if pipeline == FULL { 1 } else { 4 };
            let mut drawn = 0;
            for k in 0..memories {
                let [expected, found] = [table, code].map(|record| memory(record, k));
                assert_eq!(expected.stats().swaps > 0, found.stats().swaps > 0, "{pipeline:?}, memory {k}");
                let [expected, found] = [expected, found].map(|memory| memory.shown_faces());
                drawn += texels(256).filter(|texel| expected.texel(*texel).is_some()).count();
                let other = texels(256).find(|texel| expected.texel(*texel) != found.texel(*texel));
                assert_eq!(other, None, "{pipeline:?}, memory {k}, {}", scene.name());
            }
            assert!(drawn > 1_000, "{pipeline:?}: {drawn} texels of {}", scene.name());
        }
    }
}
