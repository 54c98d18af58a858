//! Tests of measurements.

// Against formulas.
mod closed_forms;
mod ideal_faces;
mod raster;
mod reprojection;

// Numbers that agree with each other.
mod budget;
mod long_runs;
mod numbers;
mod outcomes;

mod support;
