//! Three displays, each defined by views and slice volumes: a swept (rotating) screen, a flat screen and a stack of
//! planes.

mod flat;
mod stack;
mod swept;

pub use flat::FlatDisplay;
pub use stack::PlaneStack;
pub use swept::{Rotation, SweptConfig, SweptDisplay};
