//! The gallery, the scene of all experiments.

use crate::hall::{Route, path_of, scaled};
use pxpl5_scene::{Scene, builtin};
use pxpl5_sim::parameters::SettingError;
use tracking::motion::Walk;

/// Scale of the gallery in the experiments. The scaled gallery is 20 m wide: eight cells of 2.5 m. The gallery then has
/// 191 segments (parts of objects in one cell). The two rows of table 2 of the paper CPR05 have 183 and 213 segments.
const HALL_SCALE: f64 = 0.5;

pub(crate) fn gallery() -> Result<(Scene, Walk), SettingError> {
    let scene = builtin("gallery")?;
    let scene = scaled(&scene, HALL_SCALE)?;
    let path = path_of(&scene, Route::Scene)?;
    Ok((scene, path))
}
