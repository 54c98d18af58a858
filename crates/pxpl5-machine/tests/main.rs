//! Tests of the machine itself, with short programs and a display that the test controls by messages.

mod configuration;
mod messages;
mod optimizations;
mod presets;
mod record;
mod rig;
mod running;
mod stopping;
