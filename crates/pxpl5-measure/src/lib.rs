//! Measurements of a run: latencies and their parts, errors in pixels, pictures, and a report of all these results.
//!
//! | question | answer |
//! |---|---|
//! | How long is the latency, and which part of the machine causes it? | [`Outcome::latency_parts`], [`latency_by_surface`], [`Budget`] |
//! | How many pixels is the content displaced, and why? | [`PixelErrors`], [`Registration`], [`ErrorCauses`] |
//! | How large is the error that a latency alone causes? | [`LatencyCurve`] |
//! | What does the viewer see? | [`picture`], [`side_by_side`], [`RasterOffsets`] |
//! | What pictures result from a device that moves pictures to the newest pose? | [`EyeReport`], [`reproject`], [`reproject_with_depth`] |
//! | How busy was each board, and what does the latency wait for? | [`Utilisation`], [`CriticalPath`] |
//! | All results as numbers with units | [`Report`], [`Measure`] |
//!
//! [`Measured`] offers the most common measurements as methods of [`Outcome`].

#![warn(missing_docs)]

mod budget;
mod causes;
mod content;
mod critical_path;
mod depth_warp;
mod distribution;
mod drawn;
mod error_observer;
mod errors;
mod eye_report;
mod faces_report;
mod head_results;
mod latency;
mod latency_curve;
mod measured;
mod moved;
mod percentiles;
mod picture_mover;
mod pictures;
pub mod program;
mod quantity;
mod raster;
mod registration;
mod report;
mod reproject;
mod reprojector;
mod resource;
mod rows;
mod screen;
mod shown;
mod step_observer;
mod too_heavy;
mod trail;
mod turn_observer;
mod turned;
mod utilisation;

pub use budget::{Budget, HeadTimes, head_times, tracking_and_rendering_ms};
pub use causes::{ErrorCauses, ErrorPart};
pub use critical_path::{CriticalPath, PICTURES_FOLLOWED, PathPart};
pub use depth_warp::{DepthPicture, reproject_with_depth};
pub use errors::{FieldMisregistration, PixelErrors, Showing};
pub use eye_report::{EyeReport, ReprojectionReport};
pub use faces_report::{FacesReport, MemoryReport};
pub use head_results::{HeadSum, pixel_errors};
pub use latency::{LatencyPartStatistics, LatencyPercentiles, SurfaceStatistics, latency_by_surface};
pub use latency_curve::LatencyCurve;
pub use measured::Measured;
pub use percentiles::Percentiles;
pub use pictures::{picture, screen, side_by_side};
pub use pxpl5_run::{LATENCY_PARTS, LatencyParts, Outcome, PartDefinition};
pub use quantity::{Measure, QUANTITIES, Quantity, Results};
pub use raster::RasterOffsets;
pub use registration::Registration;
pub use report::{HeadReport, Report};
pub use reproject::reproject;
pub use resource::Resource;
pub use too_heavy::TooHeavy;
pub use turn_observer::RotationPart;
pub use utilisation::{
    GpUtilisation, PortShare, PortUtilisation, RendererUtilisation, RingUtilisation, Shares, Utilisation,
};

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
