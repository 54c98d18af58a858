//! Tests of the display that computes addresses from the head's rotation.

// Numbered cases, computed by hand.
mod numeric;
mod priority_numeric;

// Against the reference model, and in general.
mod equal;
mod footprints;
mod properties;
mod segments;

// On the ring, over many frames, and with invalid input.
mod bad_input;
mod display;
mod interface;
mod policies;

mod support;
