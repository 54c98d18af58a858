//! What a machine promises by itself, whatever runs on it: with programs of a few lines and a display that does what messages say.

mod configuration;
mod messages;
mod presets;
mod record;
mod rig;
mod running;
mod savings;
mod stopping;
