//! Tests of the i860: instructions, clocks and assembler.

// Against the manual, published vectors and published counts of clocks.
mod anchors;
mod conformance;
mod manual;

// Clocks: freezes, fills of lines, profiles, and their memory.
mod fills;
mod freezes;
mod memo;
mod profile;

// Assembler, scheduler, and any input.
mod assembler;
mod linear;
mod robustness;
