//! Renderer of Pixel-Planes 5: controller, expression evaluator, 128 x 128 pixel array.

mod fifo;

mod array;
mod command;
mod controller;
pub mod isa;
mod lanes;
mod layout;

pub use array::{EMPTY_PLANE, Executed, Fault, FaultKind, OutputRegion, PIXELS, PixelArray, Plane, execute_all};
pub use command::{
    Clear, Command, CommandKind, CopyRegion, LoadBacking, PhongSphere, PhongTriangle, SPECULAR_SQUARINGS, SelectRegion,
    Shade, Sphere, StoreBacking, Triangle, Unsupported,
};
pub use lanes::Lanes;
pub use layout::{FieldRange, Layout, LayoutError, Plan};
