//! Ports of displays that have more of them than surfaces, such as display memories: what each of them showed when.

use pxpl5_display::Display;
use pxpl5_machine::Record;
use pxpl5_run::SoFar;
use pxpl5_sim::Time;
use pxpl5_wire::{NodeId, PictureNumber, SurfaceId};

/// A port by its name.
pub(crate) struct DisplayPort {
    pub(crate) name: String,
    pub(crate) node: NodeId,
}

/// A picture that a port showed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PortShown {
    /// The picture, or update, that was swapped in.
    pub picture: PictureNumber,
    /// The retrace at which it was.
    pub begin: Time,
    /// The retrace at which the next one was, or the end of the run.
    pub end: Time,
}

/// The ports of all displays that have more of them than surfaces.
pub(crate) fn display_ports(record: &Record) -> Vec<DisplayPort> {
    let many = record.displays().iter().filter(|display| has_more_ports(display.as_ref()));
    let ports = many.flat_map(|display| {
        let nodes = display.nodes().iter().enumerate();
        nodes.map(|(k, node)| DisplayPort { name: format!("{} port {k}", display.name()), node: *node })
    });
    ports.collect()
}

/// Whether a surface shows what several ports received.
pub(crate) fn is_behind_ports(record: &Record, surface: SurfaceId) -> bool {
    let mut first = 0;
    record.displays().iter().any(|display| {
        let own = first..first + display.surfaces().len();
        first = own.end;
        own.contains(&surface.index()) && has_more_ports(display.as_ref())
    })
}

fn has_more_ports(display: &dyn Display) -> bool {
    display.nodes().len() > display.surfaces().len()
}

/// What a port showed: its pictures in the order in which they were begun, each from a swap to the next.
pub(crate) fn shown(run: &SoFar<'_>, node: NodeId) -> Vec<PortShown> {
    let shown = run.record().shown_by(node);
    let ends = shown.iter().skip(1).map(|next| next.at).chain([run.end()]);
    let all = shown.iter().zip(ends);
    all.map(|(shown, end)| PortShown { picture: shown.picture, begin: shown.at, end }).collect()
}
