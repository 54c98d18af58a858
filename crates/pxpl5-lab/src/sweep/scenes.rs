//! Scenes that points share.

use crate::experiment_file::{FileError, Plan};
use pxpl5_scene::{Placement, Scene};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Scenes that were loaded, by what decides on them: points mostly share one.
#[derive(Debug, Default)]
pub(super) struct Scenes(Mutex<BTreeMap<SceneKey, Arc<Scene>>>);

/// Name of a scene, whether it is placed as in its file, and whether it drops its back faces: what loading depends on.
type SceneKey = (String, bool, bool);

impl Scenes {
    /// The scene of a plan, loaded once for all points that share it.
    pub(super) fn scene_of(&self, plan: &Plan) -> Result<Arc<Scene>, FileError> {
        // Loading under the lock: nobody else should load the same.
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
