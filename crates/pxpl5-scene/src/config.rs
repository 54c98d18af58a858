//! Every number of this crate that is a choice or a published figure: unit, source, standing.
//!
//! Shapes of the built-in models are geometry, not parameters; they stay in [`crate::builtin`]'s own files.

/// Radius of the sphere around the centre of its box into which an imported model is scaled, in metres.
///
/// Assumed, 0.1 to 1: a model the size of a ball held at arm's length, so that walking half around it in a few
/// seconds gives the published mean translation of a head, 0.37 m/s.
pub const FIT_RADIUS_M: f64 = 0.25;

/// Distance of the eye from the centre of a fitted model, in radii of the model.
///
/// Derived: a sphere fills the height of the default view (half angle atan(0.75 tan 30 deg) = 23.4 deg) at
/// 1 / sin 23.4 deg = 2.52 radii; 2.6 leaves a margin.
pub const FIT_DISTANCE_RADII: f64 = 2.6;

/// Largest absolute coordinate that an importer accepts, in units of the file.
///
/// Assumed, 1e6 to 1e18: its square stays far from the limit of f32 (3.4e38), and no model needs it.
pub const MAX_COORDINATE: f64 = 1e15;

/// Largest file that an importer reads, in bytes.
///
/// Assumed, 16 MiB to 1 GiB: a parsed model needs up to seven times its file, and a run should stay under 2 GiB.
pub const MAX_FILE_BYTES: u64 = 256 << 20;

/// Colour of imported surfaces without one of their own: 8-bit red, green, blue. Assumed, any.
pub const DEFAULT_COLOUR: [u8; 3] = [200, 196, 188];

/// Largest N of the scene `full-screen:N`. Assumed, from 12 (published TR94) upwards: it bounds memory only.
pub const MAX_FULL_SCREEN_TRIANGLES: u32 = 1_000_000;

/// Mean angular speed of the head under [`crate::Sway`] of scale 1 on [`crate::HeadPath::Look`], degrees per second.
///
/// Published: recorded traces of headset use have mean 40, 99.9th percentile 283.
pub const MEAN_HEAD_SPEED_DEG_PER_S: f64 = 40.0;

/// Largest angular speed that the same motion reaches, degrees per second. Published: 99.9th percentile of traces.
pub const MAX_HEAD_SPEED_DEG_PER_S: f64 = 283.0;

/// Upper end of the band of head motion, hertz. Published: recorded yaw has practically all its energy below it.
pub const HEAD_BAND_HZ: f64 = 2.0;
