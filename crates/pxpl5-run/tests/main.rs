//! Tests of runs of experiments.

// Firmware on small machines.
mod faces;
mod firmware;
mod hires_ports;
mod policy;
mod slats;

// Runs of any length.
mod deadlock;
mod dry_run;
mod due;
mod identity;
mod long_runs;
