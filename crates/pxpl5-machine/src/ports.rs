//! Which board is plugged in where.

use crate::board::Board;
use crate::config::MachineConfig;
use pxpl5_wire::NodeId;

/// Which port of the ring each board has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ports {
    /// Where the host computer is plugged into the ring.
    pub host: NodeId,
    /// Where the graphics processors are, in the order of their boards.
    pub gps: Vec<NodeId>,
    /// Where the renderers are, in the order of their boards.
    pub renderers: Vec<NodeId>,
    /// The ports of each display, in the machine's order.
    pub displays: Vec<Vec<NodeId>>,
}

impl Ports {
    /// Ports in the order of the schematic, from 0.
    pub(crate) fn plug(config: &MachineConfig, pictures: usize) -> Self {
        let mut next = 0;
        Self {
            host: take_ports(&mut next, 1)[0],
            gps: take_ports(&mut next, config.n_gps),
            renderers: take_ports(&mut next, config.n_renderers),
            displays: config.displays.iter().map(|display| take_ports(&mut next, display.ports(pictures))).collect(),
        }
    }

    /// The ports of the first display: those that pipelines draw for.
    #[must_use]
    pub fn display(&self) -> &[NodeId] {
        self.displays.first().map_or(&[], Vec::as_slice)
    }

    /// The display that has a port, and which of its ports that is.
    pub(crate) fn of_display(&self, node: NodeId) -> Option<(usize, usize)> {
        let has_node = |nodes: &Vec<NodeId>| nodes.binary_search(&node).ok();
        self.displays.iter().enumerate().find_map(|(display, nodes)| Some((display, has_node(nodes)?)))
    }

    /// The board that a port belongs to.
    #[must_use]
    pub fn board(&self, node: NodeId) -> Board {
        if let Some((display, _)) = self.of_display(node) {
            return Board::Display(display);
        }
        match self.renderers.binary_search(&node) {
            Ok(renderer) => Board::Renderer(renderer),
            Err(_) => Board::of_processor(usize::from(node.0)),
        }
    }

    pub(crate) fn count(&self) -> u16 {
        let displays: usize = self.displays.iter().map(Vec::len).sum();
        (1 + self.gps.len() + self.renderers.len() + displays) as u16
    }
}

/// The next `count` ports.
fn take_ports(next: &mut u16, count: usize) -> Vec<NodeId> {
    let first = *next;
    *next += count as u16;
    (first..*next).map(NodeId).collect()
}
