//! The application scenes of the papers, the loads of their fly-throughs, what the rig measures, and the results of experiments: made once
//! for all benches that share them.

use super::measured::{FigureValue, Result, scene_named};
use crate::limit::Limit;
use pxpl5_analytic::Load;
use pxpl5_run::{Experiment, FinishedRegions, Summary};
use pxpl5_scene::Scene;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A scene by its name, and whether its back faces are dropped.
type Key = (&'static str, bool);

/// The same, with the number of seeds and of frames.
type LoadsKey = (&'static str, bool, u64, u64);

/// Loads of every view of a fly-through, a list for each seed.
type LoadsOfSeeds = Arc<Vec<Vec<Load>>>;

/// Regions kept, the master's rule, and changed parameters.
pub(super) type RigKey = (u64, FinishedRegions, Vec<(String, u64)>);

/// What one key stands for, if it has been made.
type Place<T> = Arc<Mutex<Option<Arc<T>>>>;

/// What all keys that were asked for stand for.
type Places<K, T> = Mutex<BTreeMap<K, Place<T>>>;

/// What was made so far.
#[derive(Debug, Default)]
pub(crate) struct Applications {
    scenes: Places<Key, Scene>,
    loads: Places<LoadsKey, Vec<Vec<Load>>>,
    rigs: Places<RigKey, FigureValue>,
    summaries: Places<String, Summary>,
    limits: Places<String, Limit>,
}

/// All that decides what comes of an experiment with a built-in scene: machine, pipeline, scene, length, seed and level.
pub(super) fn key_of(experiment: &Experiment, scene: &str) -> String {
    format!(
        "{scene} {} {} {:?} {:?} {:?}",
        experiment.length(),
        experiment.seed_of_motion(),
        experiment.level_of_modelling(),
        experiment.pipeline(),
        experiment.config(),
    )
}

impl Applications {
    /// A built-in scene.
    pub(super) fn scene(&self, name: &'static str, culled: bool) -> Result<Arc<Scene>> {
        let make = || {
            let whole = scene_named(name)?;
            Ok(if culled { Arc::new(Arc::unwrap_or_clone(whole).culled()) } else { whole })
        };
        find_or_make(&self.scenes, (name, culled), make)
    }

    /// The loads of a scene, from `make` where they are asked for the first time.
    pub(super) fn loads(&self, key: LoadsKey, make: impl FnOnce() -> Result<Vec<Vec<Load>>>) -> Result<LoadsOfSeeds> {
        find_or_make(&self.loads, key, || make().map(Arc::new))
    }

    /// What the pendulum rig measures with these rules, from `make` where it is asked for the first time.
    pub(super) fn rig(&self, key: RigKey, make: impl FnOnce() -> Result<FigureValue>) -> Result<FigureValue> {
        find_or_make(&self.rigs, key, || make().map(Arc::new)).map(Arc::unwrap_or_clone)
    }
}

impl Applications {
    /// What comes of an experiment, from `make` where it is asked for the first time.
    pub(super) fn summary(&self, key: String, make: impl FnOnce() -> Result<Summary>) -> Result<Arc<Summary>> {
        find_or_make(&self.summaries, key, || make().map(Arc::new))
    }

    /// The answer of a search, from `make` where it is asked for the first time.
    pub(super) fn limit(&self, key: String, make: impl FnOnce() -> Result<Limit>) -> Result<Limit> {
        find_or_make(&self.limits, key, || make().map(Arc::new)).map(|limit| *limit)
    }
}

/// Others who ask for the same wait until it is made. What makes it must not run anything on other threads: who waits for them could be given
/// work that asks for the same.
fn find_or_make<K: Ord, T>(all: &Places<K, T>, key: K, make: impl FnOnce() -> Result<Arc<T>>) -> Result<Arc<T>> {
    let place = Arc::clone(locked(all).entry(key).or_default());
    let mut known = locked(&place);
    if let Some(known) = &*known {
        return Ok(Arc::clone(known));
    }
    let made = make()?;
    *known = Some(Arc::clone(&made));
    Ok(made)
}

fn locked<T>(all: &Mutex<T>) -> MutexGuard<'_, T> {
    all.lock().unwrap_or_else(PoisonError::into_inner)
}
