//! The settings of what is measured.

use crate::choices::ProjectionKind;
use crate::settings::VolumeSettings;

/// The paper's settings for what it measures: its hyperbola, along the normal, so that jitter decides nothing.
pub(super) fn plain() -> VolumeSettings {
    VolumeSettings { projection: ProjectionKind::Orthographic, ..VolumeSettings::paper() }
}
