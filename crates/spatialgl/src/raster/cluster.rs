//! The primitives of a bin in clusters with a sphere around each, so that most are rejected without being looked at.

use crate::command::CommandBuffer;

/// Primitives of one cluster; neighbours in a mesh are mostly neighbours in its list.
pub(super) const CLUSTER: usize = 8;

/// Pixels by which a sphere is larger than it must be, against rounding.
const SLACK: f64 = 1e-6;

/// A ball around everything that some primitives can draw.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    pub(super) centre: [f64; 3],
    pub(super) radius: f64,
}

/// The primitives of a recording that a group of slices draws, in their order.
#[derive(Clone, Debug, Default)]
pub struct Bin {
    primitives: Vec<u32>,
    balls: Vec<Ball>,
}

impl Bin {
    /// A bin of these primitives, given by their numbers in the recording in rising order.
    ///
    /// # Panics
    /// If the recording has no such primitive.
    #[must_use]
    pub fn new(commands: &CommandBuffer, primitives: Vec<u32>) -> Self {
        let balls = primitives.chunks(CLUSTER).map(|cluster| ball(commands, cluster)).collect();
        Self { primitives, balls }
    }

    /// Numbers of the primitives.
    #[must_use]
    pub fn primitives(&self) -> &[u32] {
        &self.primitives
    }

    /// The primitives cluster by cluster, each with its ball.
    pub(super) fn clusters(&self) -> impl Iterator<Item = (&Ball, &[u32])> {
        self.balls.iter().zip(self.primitives.chunks(CLUSTER))
    }
}

fn ball(commands: &CommandBuffer, cluster: &[u32]) -> Ball {
    let used = |i: &u32| commands.primitives[*i as usize].corners();
    let corners = || cluster.iter().flat_map(used).map(|vertex| commands.positions[*vertex as usize]);
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for corner in corners() {
        for axis in 0..3 {
            low[axis] = low[axis].min(corner[axis]);
            high[axis] = high[axis].max(corner[axis]);
        }
    }
    let centre = [0, 1, 2].map(|axis| low[axis].midpoint(high[axis]));
    let distance = |corner: [f64; 3]| {
        let squares = [0, 1, 2].map(|axis| (corner[axis] - centre[axis]) * (corner[axis] - centre[axis]));
        squares.iter().sum::<f64>()
    };
    let farthest = corners().map(distance).fold(0.0, f64::max);
    Ball { centre, radius: farthest.sqrt() * (1.0 + 1e-9) + SLACK }
}
