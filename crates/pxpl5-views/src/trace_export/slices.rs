//! Slices, which are events with a duration, for stages, messages and regions.

use super::model::Slice;
use crate::palette::class_of;
use pxpl5_gp::Stage;
use pxpl5_machine::{Arrival, Transfer};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::PictureNumber;

pub(super) fn stage_name(stage: Stage) -> String {
    class_of(stage).to_uppercase()
}

/// Returns the slice for a stage of a picture. A slice is an event with a duration. `label` names the surface for which
/// the stage works, and `None` stands for all surfaces.
pub(super) fn stage_slice(stage: Stage, picture: PictureNumber, label: Option<&str>, [begin, end]: [Time; 2]) -> Slice {
    let surface = label.map_or_else(String::new, |label| format!(" {label}"));
    let name = format!("{} {picture}{surface}", stage_name(stage));
    Slice { name, begin, end, picture: Some(picture), flow: None }
}

/// Returns the slice for a message. A slice is an event with a duration. `toward` names the sender or the receiver.
pub(super) fn message_slice(transfer: &Transfer, toward: &str) -> Slice {
    let name = format!("{} words {toward}", transfer.words);
    Slice { name, begin: transfer.begin, end: transfer.end, picture: None, flow: None }
}

/// Returns the slice (event with a duration) for the transfer of a region to a surface. `message` is the duration of
/// one ring message with a part of the region.
pub(super) fn region_slice(arrival: &Arrival, message: Span) -> Slice {
    Slice {
        name: format!("COPY region {}", arrival.target.region.0),
        begin: arrival.begins_at(message),
        end: arrival.last_part_at,
        picture: Some(arrival.target.picture),
        flow: None,
    }
}

/// Sorts slices (events with a duration) by time. If a slice overlaps the previous slice, it begins at the previous
/// slice's end instead.
pub(super) fn apart(slices: impl Iterator<Item = Slice>) -> Vec<Slice> {
    let mut slices: Vec<Slice> = slices.collect();
    slices.sort_by_key(|slice| (slice.end, slice.begin));
    let mut free_at = Time::ZERO;
    for slice in &mut slices {
        slice.begin = slice.begin.max(free_at).min(slice.end);
        free_at = slice.end;
    }
    slices
}
