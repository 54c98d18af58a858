//! The settings with which figures are measured.

use crate::choices::ProjectionKind;
use crate::settings::VolumeSettings;

/// Returns the SpatialGL paper's settings, with the hyperbolic clip and an orthographic projection. This projection has
/// no jitter.
pub(super) fn plain() -> VolumeSettings {
    VolumeSettings { projection: ProjectionKind::Orthographic, ..VolumeSettings::paper() }
}
