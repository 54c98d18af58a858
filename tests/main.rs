//! Tests of the whole: machines, pipelines, studies and documents.

// The papers: latencies, limits, figures, and questions that they leave open.
mod beyond_the_prototype;
mod head;
mod hmd;
mod interpretations;
mod jitp;
mod latency;
mod limited_by;
mod published;

// The same result by every way.
mod cycle;
mod determinism;
mod hashes;
mod optimizations;
mod stepper;

// Pictures and views.
mod images;
mod results;
mod still_scenes;
mod timeline;

// Machines and messages that the papers do not have.
mod any_words;
mod random_machines;

// The library as its users see it.
mod examples;
mod facade;
mod front_ends;
mod names;
mod typed;

// The documents and the workspace.
mod house;
mod paper;
mod readme;

mod support;
