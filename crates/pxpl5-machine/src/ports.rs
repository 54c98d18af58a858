use crate::board::Board;
use crate::config::MachineConfig;
use pxpl5_wire::NodeId;

/// The ring port of each board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ports {
    /// Port of the host computer.
    pub host: NodeId,
    /// Port of each graphics processor.
    pub gps: Vec<NodeId>,
    /// Port of each renderer.
    pub renderers: Vec<NodeId>,
    /// Ports of each display. The first display is the display for which pipelines draw.
    pub displays: Vec<Vec<NodeId>>,
}

impl Ports {
    /// Numbers the ports from 0: host, graphics processors, renderers, displays. `pictures` is the number of pictures
    /// that a pipeline draws at the same time, 2 for two eyes.
    pub(crate) fn plug(config: &MachineConfig, pictures: usize) -> Self {
        let mut next = 0;
        Self {
            host: take_ports(&mut next, 1)[0],
            gps: take_ports(&mut next, config.n_gps),
            renderers: take_ports(&mut next, config.n_renderers),
            displays: config.displays.iter().map(|display| take_ports(&mut next, display.ports(pictures))).collect(),
        }
    }

    /// Returns the ports of the first display, for which pipelines draw.
    pub fn display(&self) -> &[NodeId] {
        self.displays.first().map_or(&[], Vec::as_slice)
    }

    pub(crate) fn of_display(&self, node: NodeId) -> Option<(usize, usize)> {
        let has_node = |nodes: &Vec<NodeId>| nodes.binary_search(&node).ok();
        self.displays.iter().enumerate().find_map(|(display, nodes)| Some((display, has_node(nodes)?)))
    }

    /// Returns the board that has the port `node`.
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

fn take_ports(next: &mut u16, count: usize) -> Vec<NodeId> {
    let first = *next;
    *next += count as u16;
    (first..*next).map(NodeId).collect()
}
