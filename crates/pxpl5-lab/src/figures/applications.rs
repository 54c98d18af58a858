//! A cache of intermediate results that several measurements share. The cache holds application scenes of the papers,
//! loads of their fly-throughs, measurements of the rig, and results of experiments.

use super::measured::{FigureValue, Result, scene_named};
use crate::limit::Limit;
use pxpl5_analytic::Load;
use pxpl5_run::{Experiment, FinishedRegions, Summary};
use pxpl5_scene::Scene;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Cache key: name of a scene, and true if its back faces are removed.
type Key = (&'static str, bool);

/// Cache key: name of a scene, true if its back faces are removed, number of seeds, and number of frames.
type LoadsKey = (&'static str, bool, u64, u64);

/// Loads (amounts of work) of every frame of a fly-through, one list for each seed.
type LoadsOfSeeds = Arc<Vec<Vec<Load>>>;

/// Cache key of a rig measurement: number of finished regions that a renderer keeps, the master's rule for finished
/// regions, and changed parameters.
pub(super) type RigKey = (u64, FinishedRegions, Vec<(String, u64)>);

/// The cached value of one key. `None` until the value is computed.
type Place<T> = Arc<Mutex<Option<Arc<T>>>>;

/// The cached values, by key. A key is added when its value is first requested.
type Places<K, T> = Mutex<BTreeMap<K, Place<T>>>;

/// The cache of scenes, loads, measurements and results.
#[derive(Debug, Default)]
pub(crate) struct Applications {
    scenes: Places<Key, Scene>,
    loads: Places<LoadsKey, Vec<Vec<Load>>>,
    rigs: Places<RigKey, FigureValue>,
    summaries: Places<String, Summary>,
    limits: Places<String, Limit>,
}

/// Returns the cache key of an experiment with a built-in scene. The key contains everything that determines the
/// result: machine, pipeline, scene, length, seed and level.
pub(super) fn key_of(experiment: &Experiment, scene: &str) -> String {
    format!(
        "{scene} {} {} {:?} {:?} {:?}",
        experiment.length(),
        experiment.motion_seed(),
        experiment.modelling_level(),
        experiment.pipeline(),
        experiment.config(),
    )
}

impl Applications {
    pub(super) fn scene(&self, name: &'static str, culled: bool) -> Result<Arc<Scene>> {
        let make = || {
            let whole = scene_named(name)?;
            Ok(if culled { Arc::new(Arc::unwrap_or_clone(whole).culled()) } else { whole })
        };
        find_or_compute(&self.scenes, (name, culled), make)
    }

    /// Returns the loads (amounts of work) of a scene's fly-through. `make` computes the loads at the first request.
    pub(super) fn loads(&self, key: LoadsKey, make: impl FnOnce() -> Result<Vec<Vec<Load>>>) -> Result<LoadsOfSeeds> {
        find_or_compute(&self.loads, key, || make().map(Arc::new))
    }

    /// Returns the measurement with the pendulum rig for a cache key. `make` performs the measurement at the first
    /// request.
    pub(super) fn rig(&self, key: RigKey, make: impl FnOnce() -> Result<FigureValue>) -> Result<FigureValue> {
        find_or_compute(&self.rigs, key, || make().map(Arc::new)).map(Arc::unwrap_or_clone)
    }
}

impl Applications {
    /// Returns the summary of an experiment. `make` runs the experiment at the first request.
    pub(super) fn summary(&self, key: String, make: impl FnOnce() -> Result<Summary>) -> Result<Arc<Summary>> {
        find_or_compute(&self.summaries, key, || make().map(Arc::new))
    }

    /// Returns the result of a search for the largest number of triangles. `make` runs the search at the first request.
    pub(super) fn limit(&self, key: String, make: impl FnOnce() -> Result<Limit>) -> Result<Limit> {
        find_or_compute(&self.limits, key, || make().map(Arc::new)).map(|limit| *limit)
    }
}

/// Returns the cached value of a key, or computes it once. Other threads that request the same key wait for the result.
///
/// `make` must not run work on other threads. While the calling thread waits for such work, this thread could take over
/// other work that requests the same key. The program would then be in a deadlock.
fn find_or_compute<K: Ord, T>(all: &Places<K, T>, key: K, make: impl FnOnce() -> Result<Arc<T>>) -> Result<Arc<T>> {
    // The outer lock is held only to find the slot; the inner lock is held while the value is computed.
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
