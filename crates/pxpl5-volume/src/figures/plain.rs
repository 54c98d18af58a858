//! The settings for measured figures.

use crate::choices::ProjectionKind;
use crate::settings::VolumeSettings;

/// Returns the paper's settings with its hyperbolic clip and an orthographic projection, so that jitter has no
/// influence.
pub(super) fn plain() -> VolumeSettings {
    VolumeSettings { projection: ProjectionKind::Orthographic, ..VolumeSettings::paper() }
}
