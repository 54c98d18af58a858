//! Tests of views of runs on displays of several kinds, and of waveforms.

mod displays;
mod six_faces;
mod waveform;
