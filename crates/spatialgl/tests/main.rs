//! Tests of slices of a volume.

// Numbered cases, computed by hand.
mod bins;
mod fragments;
mod geometry;
mod words;

// In general, and on the ring.
mod display;
mod displays;
mod hard_cases;
mod properties;
mod supersampled;
mod viewer;

mod support;
