//! Tests of volumes.

mod document;
mod heads;
mod pixel_planes;
mod settings;
mod volume;
