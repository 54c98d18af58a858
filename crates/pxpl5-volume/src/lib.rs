//! Experiments on a volumetric display: from settings and a scene to a volume, its report and its pictures.
//!
//! ```text
//!  VolumeSettings --+                                    +--> VolumeReport   "pxpl5-volume/1"
//!                   +--> Volume::draw --> VolumeFrame ---+--> pictures       sheet, slices, tiles, views
//!  Scene -----------+                                    +--> compare        every clip and projection side by side
//!                                                        +--> figures        the paper's numbers beside the model's
//! ```
//!
//! The crate `spatialgl` has the pipeline, and `perspecta` the display. This crate adds no rules of its own for drawing
//! or measuring.
//!
//! # Settings
//!
//! Every number and choice has a path, such as `clip.bias_px2` or `gpu.readback_mb_s` ([`PathSettings::set`]). Tables
//! hold the numbers with unit, provenance, range and source.
//!
//! # Beyond the paper
//!
//! Connected coverage, mirrored strobes and the renderers of Pixel-Planes 5 are not in the SpatialGL paper. Every
//! report lists the features beyond the paper that its volume uses ([`VolumeReport::beyond_paper`]).

#![warn(missing_docs)]

mod choices;
pub mod compare;
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
pub use experiment::Volume;
pub use numbers::{ClipNumbers, DrawNumbers, EyeNumbers, JitterNumbers, SweepNumbers, TileNumbers, ViewerNumbers};
pub use pxpl5_sim::parameters::{PathSettings, SettingError};
pub use report::{Brightness, DisplayReport, ModelPart, ModelTimes, Override, PixelPlanesReport, VolumeReport};
pub use settings::VolumeSettings;
pub use spatialgl;
pub use spatialgl::perspecta;
pub use workers::Counted;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
