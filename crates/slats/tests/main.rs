//! Tests of Slats: the processor on a test bench, and its renderers.

mod bind;
mod processor;
