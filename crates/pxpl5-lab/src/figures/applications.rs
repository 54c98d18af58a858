//! A cache for results that several measurements share. The cache holds application scenes of the papers, loads of
//! their fly-throughs, measurements of the pendulum rig, and results of experiments.

use super::rig_lines::RigLines;
use super::value::{FigureValue, Result, scene_named};
use pxpl5_analytic::Load;
use pxpl5_run::{Experiment, FinishedRegions, Summary};
use pxpl5_scene::Scene;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Name of a scene, and true if its back faces are removed.
type Key = (&'static str, bool);

/// Name of a scene, true if its back faces are removed, number of seeds, and number of frames.
type LoadsKey = (&'static str, bool, u64, u64);

/// Loads (amounts of work) of all frames of a fly-through, in one list for each seed.
type LoadsOfSeeds = Arc<Vec<Vec<Load>>>;

/// The master's rule for finished regions, and the changed parameters.
pub(super) type RigKey = (FinishedRegions, Vec<(String, u64)>);

/// Results by the capacity of a backing store, in finished regions.
///
/// If no backing store was full in a run ([`Record::met_full_store`]), the result is the same for all larger
/// capacities.
///
/// [`Record::met_full_store`]: pxpl5_machine::Record::met_full_store
#[derive(Debug)]
struct ByCapacity<K, T> {
    /// Results by key and capacity. The boolean is true if a backing store was full at some time of the run.
    exact: Places<(K, u64), (Arc<T>, bool)>,
    /// Smallest capacity with which no backing store was full, and the result of this run.
    roomy: Mutex<BTreeMap<K, (u64, Arc<T>)>>,
}

impl<K, T> Default for ByCapacity<K, T> {
    fn default() -> Self {
        Self { exact: Mutex::default(), roomy: Mutex::default() }
    }
}

impl<K: Ord + Clone, T> ByCapacity<K, T> {
    /// Returns the result for a capacity. `make` computes the result, and returns true if a backing store may have been
    /// full. `make` is not called if no backing store was ever full in an earlier run with a smaller capacity.
    fn get(&self, key: K, capacity: u64, make: impl FnOnce() -> Result<(T, bool)>) -> Result<Arc<T>> {
        if let Some((least, known)) = locked(&self.roomy).get(&key)
            && *least <= capacity
        {
            return Ok(Arc::clone(known));
        }
        let make = || make().map(|(made, met_full_store)| Arc::new((Arc::new(made), met_full_store)));
        let found = find_or_compute(&self.exact, (key.clone(), capacity), make)?;
        let (result, met_full_store) = &*found;
        if !met_full_store {
            let mut roomy = locked(&self.roomy);
            let least = roomy.entry(key).or_insert_with(|| (capacity, Arc::clone(result)));
            if capacity < least.0 {
                *least = (capacity, Arc::clone(result));
            }
        }
        Ok(Arc::clone(result))
    }
}

type Place<T> = Arc<Mutex<Option<Arc<T>>>>;

type Places<K, T> = Mutex<BTreeMap<K, Place<T>>>;

#[derive(Debug, Default)]
pub(crate) struct Applications {
    scenes: Places<Key, Scene>,
    loads: Places<LoadsKey, Vec<Vec<Load>>>,
    rigs: ByCapacity<RigKey, RigLines>,
    summaries: ByCapacity<String, Summary>,
    limits: Places<String, u32>,
    values: Places<String, FigureValue>,
}

/// Returns a cache key and the capacity of a backing store in finished regions. These values contain everything that
/// determines the result: machine, pipeline, scene, length, seed and level.
pub(super) fn key_of(experiment: &Experiment, scene: &str) -> (String, u64) {
    let mut machine = experiment.config().clone();
    let capacity = machine.renderer.backing_regions();
    // The capacity has its own place in the key.
    machine.renderer.kept_bits = 0;
    let key = format!(
        "{scene} {} {} {:?} {:?} {:?}",
        experiment.fields,
        experiment.seed,
        experiment.level,
        experiment.pipeline(),
        machine,
    );
    (key, capacity)
}

impl Applications {
    pub(super) fn scene(&self, name: &'static str, culled: bool) -> Result<Arc<Scene>> {
        let make = || {
            if !culled {
                return scene_named(name);
            }
            Ok(Arc::new(Scene::clone(&*self.scene(name, false)?).culled()))
        };
        find_or_compute(&self.scenes, (name, culled), make)
    }

    /// Returns the loads (amounts of work) of a scene's fly-through. The first request computes the loads with `make`.
    pub(super) fn loads(&self, key: LoadsKey, make: impl FnOnce() -> Result<Vec<Vec<Load>>>) -> Result<LoadsOfSeeds> {
        find_or_compute(&self.loads, key, || make().map(Arc::new))
    }

    /// Returns the measurements with the pendulum rig. `kept` is the number of regions that a backing store holds. The
    /// first request performs the measurements with `make`. `make` returns the measurements and a boolean. The boolean
    /// is true if a backing store was full at some time of the run.
    pub(super) fn rig(
        &self,
        key: RigKey,
        kept: u64,
        make: impl FnOnce() -> Result<(RigLines, bool)>,
    ) -> Result<Arc<RigLines>> {
        self.rigs.get(key, kept, make)
    }

    /// Returns the summary of an experiment. The first request runs the experiment with `make`. `make` returns the
    /// summary and a boolean. The boolean is true if a backing store may have been full.
    pub(super) fn summary(
        &self,
        (key, capacity): (String, u64),
        make: impl FnOnce() -> Result<(Summary, bool)>,
    ) -> Result<Arc<Summary>> {
        self.summaries.get(key, capacity, make)
    }

    /// Returns the result of a search for the largest number of triangles. The first request runs the search with
    /// `make`.
    pub(super) fn limit(&self, key: String, make: impl FnOnce() -> Result<u32>) -> Result<u32> {
        find_or_compute(&self.limits, key, || make().map(Arc::new)).map(|limit| *limit)
    }

    /// Returns the value of a figure that does not depend on the level of detail. The first request measures the figure
    /// with `make`. `key` contains everything that determines the value.
    pub(super) fn value(&self, key: String, make: impl FnOnce() -> Result<FigureValue>) -> Result<FigureValue> {
        find_or_compute(&self.values, key, || make().map(Arc::new)).map(Arc::unwrap_or_clone)
    }
}

/// Returns the cached value of a key, or computes it once. Other threads that request the same key wait for the result.
///
/// `make` must not run work on other threads. While the calling thread waits for such work, it could take over work
/// that requests the same key. The program would then be in a deadlock.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::Interpretation;
    use pxpl5_machine::MachineConfig;
    use pxpl5_run::{Outcome, Pixels};

    /// Runs a scene with backing stores for `kept` finished regions. `finished` is the rule for the use of the backing
    /// store.
    fn run(scene: &str, kept: u64, finished: FinishedRegions) -> Outcome {
        let interpretation = Interpretation { kept, finished, ..Interpretation::USUAL };
        let machine = interpretation.on(MachineConfig::small_hmd()).expect("in range");
        let scene = scene_named(scene).expect("built in");
        Experiment::new(machine, interpretation.pipeline(), scene)
            .fields(40)
            .pixels(Pixels::Off)
            .run()
            .expect("it runs")
    }

    /// Tests that a run whose backing stores were never full has the same trace as each run with larger stores. Runs
    /// with a full store must differ in more than five cases, or the test would prove nothing.
    #[test]
    fn a_run_without_a_full_store_equals_the_run_with_any_larger_store() {
        let (mut shared, mut differing) = (0, 0);
        for scene in ["full-screen:12", "full-screen:60"] {
            for finished in FinishedRegions::ALL {
                let runs: Vec<Outcome> =
                    [1, 2, 3, 4, 8, 128].into_iter().map(|kept| run(scene, kept, finished)).collect();
                for (place, one) in runs.iter().enumerate() {
                    for larger in &runs[place + 1..] {
                        let is_same = one.record().trace_hash() == larger.record().trace_hash();
                        assert!(is_same || one.record().met_full_store(), "{scene}, {finished:?}, run {place}");
                        shared += usize::from(!one.record().met_full_store());
                        differing += usize::from(!is_same);
                    }
                }
            }
        }
        assert!(shared > 5 && differing > 5, "{shared} shared, {differing} differ");
    }

    #[test]
    fn a_result_is_reused_for_larger_stores_if_no_store_was_full() {
        let cache = ByCapacity::<&str, u64>::default();
        let get = |capacity, met_full_store| {
            *cache.get("key", capacity, || Ok((capacity, met_full_store))).expect("no run fails")
        };
        assert_eq!([get(1, true), get(2, true), get(4, false)], [1, 2, 4]);
        assert_eq!([get(8, false), get(4, true), get(5, true)], [4; 3], "these stores are as large");
        assert_eq!([get(1, false), get(2, true), get(3, true)], [1, 2, 3], "these stores are smaller");
        assert_eq!(*cache.get("other", 8, || Ok((9, true))).expect("no run fails"), 9);
    }
}
