//! A cache of the scenes that points of a sweep share.

use crate::experiment_file::SceneChoice;
use pxpl5_scene::{Placement, Scene};
use pxpl5_sim::parameters::SettingError;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Loaded scenes by cache key. Usually, all points of a sweep share one scene.
#[derive(Debug, Default)]
pub struct SceneCache(Mutex<BTreeMap<SceneKey, Arc<Scene>>>);

/// Name of a scene, true if a model file keeps its own coordinates, and true if back faces are removed.
type SceneKey = (String, bool, bool);

impl SceneCache {
    /// Returns the scene of these settings. Each scene is loaded once for all points that share it.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`SceneChoice::load`].
    pub fn load(&self, choice: &SceneChoice) -> Result<Arc<Scene>, SettingError> {
        // The lock is held while loading, so that no other thread loads the same scene.
        let mut loaded = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let key = (choice.name.clone(), choice.placement == Placement::AsInFile, choice.culled);
        let whole = match loaded.get(&key) {
            Some(whole) => Arc::clone(whole),
            None => {
                let whole = Arc::new(choice.load_whole()?);
                loaded.insert(key, Arc::clone(&whole));
                whole
            }
        };
        drop(loaded);
        choice.prepared(whole)
    }
}
