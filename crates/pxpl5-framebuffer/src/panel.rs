//! Displays that are described only by parameters: size, rate, order of the scan, persistence.
//!
//! Each preset has its own table, because its parameters have their own sources. All presets share one implementation.

mod board;
mod numbers;
mod presets;

pub use board::Panel;
pub use numbers::PanelNumbers;
pub use presets::{HiResConfig, LcdConfig, OledConfig, PanelConfig};
