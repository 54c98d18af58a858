//! Tests of the command, as its users run it.

// All commands.
mod cli;
mod courtesy;
mod foreign;
mod outputs;
mod readers;
mod refused;
mod version;

// One command each.
mod arp;
mod compare;
mod compare_rows;
mod debug;
mod plot;
mod report;
mod rig;
mod sweep;
mod volume;

// The pipeline of the guide.
mod own_pipeline;

mod support;
