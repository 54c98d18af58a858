//! Tests of the studies.

mod support;

// Figures and levels.
mod auto_level;
mod code_times;
mod effects;
mod groups;
mod levels_of_code;
mod limits;

// What is counted and measured.
mod counts;
mod evaluation;
mod retraces;
mod rig;

// Settings.
mod parameters;
mod predictors;
mod today;
