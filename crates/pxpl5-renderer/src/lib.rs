//! Renderer of Pixel-Planes 5: controller, expression evaluator, 128 x 128 pixel array.

mod board;
mod fifo;
mod job;
pub mod timing;

mod array;
mod bit_serial;
mod command;
pub mod conformance;
mod controller;
pub mod isa;
mod lanes;
mod layout;
mod simd;

pub use array::{EMPTY_PLANE, Executed, Fault, FaultKind, OutputRegion, PIXELS, PixelArray, Plane, execute_all};
pub use board::{MAX_CONTEXTS, Renderer, RendererEvent, RendererOutput, RendererStats};
pub use job::ArrayPool;
pub use timing::RendererTiming;
pub use bit_serial::BitSerial;
pub use command::{
    Clear, Command, CommandKind, CopyRegion, LoadBacking, PhongSphere, PhongTriangle, SPECULAR_SQUARINGS, SelectRegion,
    Shade, Sphere, StoreBacking, Triangle, Unsupported,
};
pub use lanes::Lanes;
pub use layout::{FieldRange, Layout, LayoutError, Plan};
pub use simd::Vectors;
