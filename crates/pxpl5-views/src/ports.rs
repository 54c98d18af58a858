//! Displays with more ports than surfaces, such as displays with several memories. For each of their ports, this module
//! finds the pictures that the port showed.

use pxpl5_machine::Record;
use pxpl5_run::FinalResults;
use pxpl5_sim::Time;
use pxpl5_wire::display::Display;
use pxpl5_wire::{NodeId, PictureNumber, SurfaceId};

pub(crate) struct DisplayPort {
    pub(crate) name: String,
    pub(crate) node: NodeId,
}

/// A picture that a port has shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShownPicture {
    /// Number of the picture or update that was swapped in.
    pub picture: PictureNumber,
    /// Time of the retrace at which the picture was swapped in.
    pub begin: Time,
    /// Time of the retrace at which the next picture was swapped in, or the end of the run.
    pub end: Time,
}

/// Returns the ports of all displays that have more ports than surfaces. Each of these ports swaps independently of the
/// other ports.
pub(crate) fn display_ports(record: &Record) -> Vec<DisplayPort> {
    let many = record.displays().iter().filter(|display| has_more_ports(display.as_ref()));
    let ports = many.flat_map(|display| {
        let nodes = display.nodes().iter().enumerate();
        nodes.map(|(k, node)| DisplayPort { name: format!("{} port {k}", display.name()), node: *node })
    });
    ports.collect()
}

/// Returns true if a surface shows the content of several ports.
pub(crate) fn has_separate_ports(record: &Record, surface: SurfaceId) -> bool {
    display_of(record, surface).is_some_and(has_more_ports)
}

pub(crate) fn display_of(record: &Record, surface: SurfaceId) -> Option<&dyn Display> {
    let mut first = 0;
    for display in record.displays() {
        first += display.surfaces().len();
        if surface.index() < first {
            return Some(display.as_ref());
        }
    }
    None
}

fn has_more_ports(display: &dyn Display) -> bool {
    display.nodes().len() > display.surfaces().len()
}

/// Returns the pictures that a port has shown, in the order in which the pictures were begun. A port shows each picture
/// from one swap to the port's next swap.
pub(crate) fn shown(run: &FinalResults<'_>, node: NodeId) -> Vec<ShownPicture> {
    let shown = run.record.shown_by(node);
    let ends = shown.iter().skip(1).map(|next| next.at).chain([run.now]);
    let all = shown.iter().zip(ends);
    all.map(|(shown, end)| ShownPicture { picture: shown.picture, begin: shown.at, end }).collect()
}
