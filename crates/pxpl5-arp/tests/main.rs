//! Tests of address recalculation without a machine.

mod faces;
mod figures;
mod walks;
