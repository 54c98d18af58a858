//! Tests of slices of a volume.

// Numbered cases, computed by hand, and figures of the paper.
mod bins;
mod figures;
mod fragments;
mod geometry;
mod words;

// In general, and on the ring.
mod arithmetic;
mod display;
mod displays;
mod hard_cases;
mod properties;
mod supersampled;
mod viewer;

mod support;
