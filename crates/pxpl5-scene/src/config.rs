//! Every number of this crate that is a choice or a published figure: unit, source, standing.
//!
//! Shapes of the built-in models are geometry, not parameters; they stay in [`crate::builtin`]'s own files.

/// Radius of the sphere around the centre of its box into which the built-in models are scaled, in metres.
///
/// Assumed, 0.1 to 1: a model the size of a ball held at arm's length, so that walking half around it in a few
/// seconds gives the published mean translation of a head, 0.37 m/s.
pub const FIT_RADIUS_M: f64 = 0.25;

/// Radius of the sphere around the centre of its box into which an imported model is scaled, metres.
///
/// Derived: from the same place, [`FIT_RADIUS_M`] times [`FIT_DISTANCE_RADII`] = 0.65 m away, it is
/// [`WHOLE_DISTANCE_RADII`] of its radii off; so the head walks as far as before the built-in models.
pub const IMPORT_RADIUS_M: f64 = 0.148;

/// Distance of the eye from the centre of a model that is to be seen whole all the time, in radii of the model.
///
/// Derived: under [`crate::Sway`] of scale 1 the gaze strays by at most 8.5 degrees sideways and 6.5 up or down, tilted by at
/// most 7.5: 6.5 cos 7.5 + 8.5 sin 7.5 = 7.6 degrees up or down. Of half the view's height, 23.4 degrees, 15.8 are left. The head
/// comes as near as 0.9 of its distance, where the model takes asin(1 / (0.9 x 4.4)) = 14.6 degrees; 1.2 are margin.
pub const WHOLE_DISTANCE_RADII: f64 = 4.4;

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

/// Memory that an imported model may take while it is read, in sizes of its file. What would take more is refused.
///
/// Assumed, from 6.5 (a list of triangles of two bytes a corner, and the file itself, take it) upwards.
pub const MEMORY_TIMES_FILE: u64 = 7;

/// Bytes that a model may take on top of that, whatever its size: small files are nobody's trouble. Assumed, any.
pub const MEMORY_FLOOR_BYTES: u64 = 4 << 20;

/// Colour of imported surfaces without one of their own: 8-bit red, green, blue. Assumed, any.
pub const DEFAULT_COLOUR: [u8; 3] = [200, 196, 188];

/// Largest N of the scenes `full-screen:N`, `typical:N` and `sphere:N`. Assumed, from 12 (published TR94) upwards: it bounds
/// memory only.
pub const MAX_TRIANGLES: u32 = 1_000_000;

/// Least N of the scene `sphere:N`: an octahedron.
pub const LEAST_SPHERE_TRIANGLES: u32 = 8;

/// Legs of a triangle of `typical:N`, pixels of a 640 x 480 picture. Derived: its box touches (1 + 18/128)^2 = 1.30 regions
/// of 128 x 128 on average, as published (TR94).
pub const TYPICAL_LEG_PX: f64 = 18.0;

/// Width and height of the place that the corners of `typical:N` are spread over, pixels. Assumed: with the disparity of the
/// eyes and the triangle itself they stay inside the 640 x 480 pixels.
pub const TYPICAL_SPREAD_PX: [f64; 2] = [540.0, 420.0];

/// Mean angular speed of the head under [`crate::Sway`] of scale 1 on [`crate::HeadPath::Look`], degrees per second.
///
/// Published: recorded traces of headset use have mean 40, 99.9th percentile 283.
pub const MEAN_HEAD_SPEED_DEG_PER_S: f64 = 40.0;

/// Largest angular speed that the same motion reaches, degrees per second. Published: 99.9th percentile of traces.
pub const MAX_HEAD_SPEED_DEG_PER_S: f64 = 283.0;

/// Upper end of the band of head motion, hertz. Published: recorded yaw has practically all its energy below it.
pub const HEAD_BAND_HZ: f64 = 2.0;
