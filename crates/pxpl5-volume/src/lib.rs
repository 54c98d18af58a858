//! Experiments on a volumetric display: settings and a scene in, a volume, its report and its pictures out.
//!
//! ```text
//!  VolumeSettings --+                                    +--> VolumeReport   "pxpl5-volume/1"
//!                   +--> Volume::draw --> VolumeFrame ---+--> pictures       sheet, slices, tiles, views
//!  Scene -----------+                                    +--> compare        every clip and projection side by side
//!                                                        +--> figures        the paper's numbers beside the model's
//! ```
//!
//! The pipeline is `spatialgl`'s, the display `perspecta`'s; nothing is drawn or measured here by rules of its own.
//!
//! # Settings
//!
//! Every number and choice has a path, such as `clip.bias_px2` or `gpu.readback_mb_s` ([`VolumeSettings::set`]); numbers stand
//! in tables with unit, standing, range and source.
//!
//! # Beyond the paper
//!
//! Connected coverage, mirrored strobes and the renderers of Pixel-Planes 5 are not the paper's. Every report names those that it
//! used ([`VolumeReport::beyond_paper`]).

#![warn(missing_docs)]

mod choices;
pub mod compare;
mod error;
mod experiment;
pub mod figures;
pub mod heads;
mod keys;
mod numbers;
pub mod pictures;
pub mod pixel_planes;
mod report;
mod settings;
mod workers;

pub use choices::{ClipKind, ProjectionKind, RendererKind};
pub use error::VolumeError;
pub use experiment::Volume;
pub use numbers::{ClipNumbers, DrawNumbers, EyeNumbers, JitterNumbers, SweepNumbers, TileNumbers, ViewerNumbers};
pub use perspecta;
pub use report::{Brightness, DisplayReport, ModelPart, ModelTimes, Override, PixelPlanesReport, VolumeReport};
pub use settings::VolumeSettings;
pub use spatialgl;
pub use workers::Counted;
