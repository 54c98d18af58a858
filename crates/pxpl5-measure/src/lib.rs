//! What an outcome says: latencies and where they go, errors in pixels, pictures, and all of it as a report.
//!
//! | question | answer |
//! |---|---|
//! | how long, and which part of the machine takes it | [`latency_parts`], [`latency_by_surface`], [`Budget`] |
//! | how many pixels wrong, and why | [`PixelErrors`], [`Registration`], [`ErrorCauses`] |
//! | how wrong is a latency by itself | [`LatencyCurve`] |
//! | what does the viewer see | [`picture`], [`side_by_side`], [`RasterOffsets`] |
//! | everything as numbers with units | [`Report`], [`Measure`] |
//!
//! [`Measured`] gives an [`Outcome`] the most common of them as methods.

#![warn(missing_docs)]

mod budget;
mod causes;
mod content;
mod distribution;
mod drawn;
mod error_sum;
mod errors;
mod faces_report;
mod head_sum;
mod latency;
mod latency_curve;
mod measured;
mod of_outcome;
mod percentiles;
mod pictures;
mod quantity;
mod raster;
mod registration;
mod report;
mod screen;
mod shown;
mod step_sum;
mod summary;
mod too_heavy;
mod turn_sum;
mod turned;

pub use budget::Budget;
pub use causes::{ErrorCauses, ErrorPart};
pub use errors::{FieldError, PixelErrors, Showing};
pub use faces_report::{FacesReport, MemoryReport};
pub use head_sum::HeadSum;
pub use latency::{NamedStatistics, SurfaceStatistics, latency_by_surface, latency_parts};
pub use latency_curve::LatencyCurve;
pub use measured::Measured;
pub use of_outcome::pixel_errors;
pub use percentiles::Percentiles;
pub use pictures::{picture, screen, side_by_side};
pub use pxpl5_run::{LATENCY_PARTS, LatencyParts, Outcome, PartDefinition};
pub use quantity::{Measure, QUANTITIES, Quantity, Results};
pub use raster::{RasterOffsets, Vdrt};
pub use registration::Registration;
pub use report::{HeadReport, Report};
pub use summary::summary;
pub use too_heavy::TooHeavy;
pub use turn_sum::RotationPart;
