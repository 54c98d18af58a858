//! The native part of the Python package `pxpl5`. This crate makes the Rust library `pxpl5` available to Python.
//!
//! ```text
//!   python/pxpl5/*.py   what users import: keywords, docstrings, notebooks, progress, Dask
//!        |
//!   pxpl5._native       this crate: settings in; outcomes, pictures, tables, processors out
//!        |
//!   pxpl5, i860         the library
//! ```
//!
//! # Behaviour
//!
//! - Long work runs on a separate thread without the interpreter's lock. The calling thread reports progress and reacts
//!   to Ctrl-C (in_background.rs).
//! - Pictures are passed to NumPy without a copy of their pixels. Tables are passed through the Arrow PyCapsule
//!   interface without a copy of their columns. Vertices from NumPy are copied once.
//! - Errors become exceptions of `pxpl5._errors` with the same messages.
//!
//! **Not here:** numbers, models and file formats of the emulator. Code that only Python needs (defaults of keywords,
//! HTML) is in python/pxpl5.

mod arrays;
mod background;
mod catalogue;
mod command;
mod errors;
mod experiment;
mod frames;
mod lab;
mod motion;
mod outcome;
mod picture;
mod policy;
mod processor;
mod scene;
mod settings;
mod stepper;
mod sweep;
mod table;
mod volume;

use pyo3::prelude::*;

/// Native part of pxpl5. Users import the package `pxpl5` instead of this module.
#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::catalogue::{
        builtin_scenes, displays, keys, machine_parameters, pipelines, presets, quantities, tracking_parameters,
    };
    #[pymodule_export]
    use crate::command::{command, plot, version};
    #[pymodule_export]
    use crate::experiment::Experiment;
    #[pymodule_export]
    use crate::frames::Frames;
    #[pymodule_export]
    use crate::lab::{compare, diff, figure, figure_ids, figures, interpretations, levels, limit, limit_over, rig};
    #[pymodule_export]
    use crate::motion::{Motion, motion_of_text};
    #[pymodule_export]
    use crate::outcome::Outcome;
    #[pymodule_export]
    use crate::picture::{Picture, picture_of_parts, picture_of_png};
    #[pymodule_export]
    use crate::processor::{Processor, Program, assemble, disassemble};
    #[pymodule_export]
    use crate::scene::{Scene, scene_of_json};
    #[pymodule_export]
    use crate::settings::Settings;
    #[pymodule_export]
    use crate::stepper::Stepper;
    #[pymodule_export]
    use crate::sweep::{Store, Sweep};
    #[pymodule_export]
    use crate::table::{Table, table_of_columns, table_of_rows};
    #[pymodule_export]
    use crate::volume::{Volume, volume_figures, volume_keys};
}
