//! Tests of the renderer.

// Instructions and pixel arrays.
mod arrays;
mod conformance;
mod instruction_effects;
mod instruction_words;
mod streams;

// The board.
mod board;
mod board_pixels;
mod support;
