//! Tests of geometry, most of them against exact integers.

mod binning;
mod input;
mod numerics;
mod setup;
mod support;
mod watertight;
