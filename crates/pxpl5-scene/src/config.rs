//! Every assumed or published number of this crate, with unit, source and provenance.
//!
//! The shapes of the built-in models are geometry rather than parameters, and are defined in the files of
//! [`crate::builtin`].

/// Radius to which most built-in models are scaled, metres. The radius is measured from the centre of the model's
/// bounding box.
///
/// Assumed, 0.1 to 1: the size of a ball held at arm's length. A head that walks half-way around such a model in a few
/// seconds has about the published mean speed of 0.37 m/s.
pub const FIT_RADIUS_M: f64 = 0.25;

/// Radius to which an imported model is scaled, metres. The radius is measured from the centre of the model's bounding
/// box.
///
/// Derived: the head has the same distance from an imported model as from a built-in model, [`FIT_RADIUS_M`] times
/// [`FIT_DISTANCE_RADII`] = 0.65 m. The radius is this distance divided by [`WHOLE_DISTANCE_RADII`].
pub const IMPORT_RADIUS_M: f64 = 0.148;

/// Distance of the eye from the centre of a model that must always be visible as a whole, as a multiple of the model's
/// radius.
///
/// Derived for [`crate::Sway`] of scale 1. The gaze deviates by at most 8.5 degrees sideways and 6.5 vertically, with a
/// tilt of at most 7.5 degrees. The greatest vertical deviation is 6.5 cos 7.5 + 8.5 sin 7.5 = 7.6 degrees. Half the
/// view's height is 23.4 degrees, so 15.8 degrees remain for the model. The head comes as near as 0.9 times its mean
/// distance, where the model's angular radius is asin(1 / (0.9 x 4.4)) = 14.6 degrees. The margin is 1.2 degrees.
pub const WHOLE_DISTANCE_RADII: f64 = 4.4;

/// Distance of the eye from the centre of a built-in model, as a multiple of the model's radius.
///
/// Derived: half of the default view's height is atan(0.75 tan 30 deg) = 23.4 deg. At a distance of 1 / sin 23.4 deg =
/// 2.52 radii, a sphere fills this height. The value 2.6 leaves a margin.
pub const FIT_DISTANCE_RADII: f64 = 2.6;

/// Largest absolute coordinate that an importer accepts, in units of the file.
///
/// Assumed, 1e6 to 1e18. The square of this number is far below the largest f32 (3.4e38), and real models have smaller
/// coordinates.
pub const MAX_COORDINATE: f64 = 1e15;

/// Size of the largest file that an importer reads, in bytes.
///
/// Assumed, 16 MiB to 1 GiB. An imported model needs up to seven times the memory of its file, and a run should need
/// less than 2 GiB.
pub const MAX_FILE_BYTES: u64 = 256 << 20;

/// Greatest memory that an importer may take for a model, as a multiple of the size of its file. Importers refuse
/// models that need more.
///
/// Assumed, at least 6.5: a file that consists of triangles with two bytes per corner needs 6.5 times its size,
/// including the file itself.
pub const MEMORY_TIMES_FILE: u64 = 7;

/// Number of bytes that an imported model may take in addition to [`MEMORY_TIMES_FILE`] times the size of its file.
/// Models from small files cannot exhaust the memory, so their limit need not be strict. Assumed: any value is
/// plausible.
pub const MEMORY_FLOOR_BYTES: u64 = 4 << 20;

/// Colour of an imported surface if its file has no colour: red, green and blue, 8 bits each. Assumed: any value is
/// plausible.
pub const DEFAULT_COLOUR: [u8; 3] = [200, 196, 188];

/// Largest N of the scenes `full-screen:N`, `typical:N` and `sphere:N`. Assumed: the value must be at least the
/// published 12 (TR94), and only prevents excessive use of memory.
pub const MAX_TRIANGLES: u32 = 1_000_000;

/// Least N of the scene `sphere:N`. A sphere of 8 triangles is an octahedron.
pub const MIN_SPHERE_TRIANGLES: u32 = 8;

/// Length of the two legs of a right-angled triangle in the scene `typical:N`, in pixels of a 640 x 480 picture.
/// Derived: the triangle's bounding box touches (1 + 18/128)^2 = 1.30 regions of 128 x 128 pixels on average, as
/// published (TR94).
pub const TYPICAL_LEG_PX: f64 = 18.0;

/// Width and height of the area over which the corners of the scene `typical:N` are spread, pixels. Assumed: triangles
/// at the edge of this area stay within the 640 x 480 pixels of both eyes' pictures.
pub const TYPICAL_SPREAD_PX: [f64; 2] = [540.0, 420.0];

/// Mean angular speed of the head on the path [`crate::HeadPath::Look`] under [`crate::Sway`] of scale 1, degrees per
/// second.
///
/// Published: recorded traces of headset use have a mean of 40 and a 99.9th percentile of 283.
pub const MEAN_HEAD_SPEED_DEG_PER_S: f64 = 40.0;

/// Largest angular speed of the head under [`crate::Sway`] of scale 1, degrees per second. Published: the 99.9th
/// percentile of the speed in recorded traces of headset use.
pub const MAX_HEAD_SPEED_DEG_PER_S: f64 = 283.0;
