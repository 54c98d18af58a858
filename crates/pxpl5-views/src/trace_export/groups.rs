//! Groups of tracks, which have headings in a trace viewer.

use pxpl5_machine::Record;
use pxpl5_wire::display::{Display, Surface};
use pxpl5_wire::{NodeId, SurfaceId};

/// A group of tracks with a heading. The group stands for a board at a port of the ring or for a surface of a display.
///
/// A frame buffer is both a board and a surface, and has one group.
pub(super) struct Group {
    pub(super) name: String,
    pub(super) node: Option<NodeId>,
    pub(super) surface: Option<SurfaceId>,
}

impl Group {
    const fn of_port(name: String, node: NodeId) -> Self {
        Self { name, node: Some(node), surface: None }
    }
}

/// Returns all boards and surfaces of a machine, in the order host, graphics processors, renderers, displays.
pub(super) fn groups(record: &Record) -> Vec<Group> {
    let ports = record.ports();
    let mut groups = vec![Group::of_port("host".to_owned(), ports.host)];
    groups.extend(numbered("GP", &ports.gps));
    groups.extend(numbered("renderer", &ports.renderers));
    let mut surfaces = record.surfaces();
    for display in record.displays() {
        let own: Vec<(SurfaceId, &Surface)> = surfaces.by_ref().take(display.surfaces().len()).collect();
        groups.extend(of_display(record, display.as_ref(), &own));
    }
    groups
}

fn numbered(name: &str, nodes: &[NodeId]) -> impl Iterator<Item = Group> {
    nodes.iter().enumerate().map(move |(i, node)| Group::of_port(format!("{name} {i}"), *node))
}

fn of_display(record: &Record, display: &dyn Display, surfaces: &[(SurfaceId, &Surface)]) -> Vec<Group> {
    let nodes = display.nodes();
    let paired = nodes.len() == surfaces.len();
    let mut groups = Vec::new();
    if !paired {
        groups.extend(numbered(&format!("{} port", display.name()), nodes));
    }
    for (i, (id, surface)) in surfaces.iter().enumerate() {
        let node = if paired { nodes.get(i).copied() } else { None };
        groups.push(Group { name: named(record, surface.title, display), node, surface: Some(*id) });
    }
    groups
}

/// Returns a name for a group or track of a display. If the machine has several displays, the name includes the
/// display's name.
pub(super) fn named(record: &Record, name: &str, display: &dyn Display) -> String {
    if record.displays().len() == 1 { name.to_owned() } else { format!("{name}, {}", display.name()) }
}
