//! Tests of the ring.

mod channels_left;
mod reference;
mod rules;
mod support;
