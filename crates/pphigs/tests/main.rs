//! Tests of PPHIGS: its i860 code equals its native code.

// Each program of a pass.
mod begin;
mod bin_handoff;
mod code;
mod cube_transform;
mod spheres;

// Kernels of triangles, and the ideal picture.
mod kernels;
mod memo;
mod pictures;

mod kernel;
mod native;
mod numbers;
