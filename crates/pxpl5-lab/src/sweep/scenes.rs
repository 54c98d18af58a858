//! A cache of the scenes that points of a sweep share.

use crate::experiment_file::{FileError, Plan};
use pxpl5_scene::{Placement, Scene};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Loaded scenes by cache key. Most points of a sweep share one scene.
#[derive(Debug, Default)]
pub(super) struct Scenes(Mutex<BTreeMap<SceneKey, Arc<Scene>>>);

/// Cache key of a scene: its name, true if a model file keeps its own coordinates, and true if back faces are removed.
type SceneKey = (String, bool, bool);

impl Scenes {
    /// Returns the scene of a plan (the checked experiment at a point). Each scene is loaded once for all points that
    /// share it.
    pub(super) fn scene_of(&self, plan: &Plan) -> Result<Arc<Scene>, FileError> {
        // The lock is held while loading, so that no other thread loads the same scene.
        let mut loaded = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let key = (plan.scene.name.clone(), plan.scene.placement == Placement::AsInFile, plan.scene.culled);
        let whole = match loaded.get(&key) {
            Some(whole) => Arc::clone(whole),
            None => {
                let whole = Arc::new(plan.scene.load_whole()?);
                loaded.insert(key, Arc::clone(&whole));
                whole
            }
        };
        drop(loaded);
        plan.scene.prepared(whole)
    }
}
