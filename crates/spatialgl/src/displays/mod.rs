//! Three displays as views and slice volumes: a swept screen, a flat one, a stack of planes.

mod flat;
mod stack;
mod swept;

pub use flat::FlatDisplay;
pub use stack::PlaneStack;
pub use swept::{Rotation, SweptConfig, SweptDisplay};
