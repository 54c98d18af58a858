//! Displays that are described by numbers alone: size, rate, order of the scan, persistence.
//!
//! Each preset is a table of its own, because its numbers have sources of their own. All presets share one display.

mod board;
mod numbers;
mod presets;

pub use board::Panel;
pub use numbers::PanelNumbers;
pub use presets::{HiResConfig, LcdConfig, OledConfig, PanelConfig};
