//! Two displays, each defined by views and slice volumes: a swept (rotating) screen and a flat screen.

mod flat;
mod swept;

pub use flat::FlatDisplay;
pub use swept::{Rotation, SweptConfig, SweptDisplay};
