//! Tests of frame buffers, the beam, and displays.

mod board;
mod display;
mod never_shown;
mod panel;
mod seen;
mod support;
mod video;
