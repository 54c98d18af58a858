//! Tests of views of runs on displays of several kinds.

mod displays;
mod six_faces;
