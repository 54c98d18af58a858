//! Clusters of the primitives in a bin. Each cluster has a bounding sphere, so most primitives are rejected without an
//! individual test.

use super::setup::along;
use crate::command::CommandBuffer;

/// Number of primitives in a cluster. Primitives that are neighbours in a mesh are mostly neighbours in the list.
const CLUSTER: usize = 8;

/// Number of pixels by which a sphere is enlarged, to allow for rounding.
const SLACK: f64 = 1e-6;

/// A bounding sphere of all points that a primitive or a group of primitives can draw.
#[derive(Clone, Copy, Debug)]
struct Ball {
    centre: [f64; 3],
    radius: f64,
}

/// The bounding spheres of the primitives of a cluster, stored side by side so that one loop tests all spheres.
#[derive(Clone, Copy, Debug, Default)]
struct BallLanes {
    centre: [[f64; CLUSTER]; 3],
    radius: [f64; CLUSTER],
}

/// Consecutive primitives of a bin that share a bounding sphere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cluster<'a> {
    ball: &'a Ball,
    each: &'a BallLanes,
    primitives: &'a [u32],
}

impl<'a> Cluster<'a> {
    /// Returns the primitives that can have a point whose distance s from the slice lies in a range. `row` is the row
    /// of the view matrix that computes s. Omitted primitives have no point in this range.
    #[inline(always)]
    pub(crate) fn reaching(&self, row: &[f64; 4], [low, high]: [f64; 2]) -> ReachablePrimitives<'a> {
        // First test the sphere around the whole cluster, then the spheres of its primitives.
        let distance = along(row, self.ball.centre);
        if (distance - self.ball.radius > high) | (distance + self.ball.radius < low) {
            return ReachablePrimitives { rest: 0, primitives: self.primitives };
        }
        let [x, y, z] = &self.each.centre;
        let mut lanes = [0u64; CLUSTER];
        for i in 0..CLUSTER {
            let distance = row[0] * x[i] + row[1] * y[i] + row[2] * z[i] + row[3];
            let is_off = (distance - self.each.radius[i] > high) | (distance + self.each.radius[i] < low);
            lanes[i] = if is_off { 0 } else { 1 << i };
        }
        let there = (1 << self.primitives.len()) - 1;
        ReachablePrimitives {
            rest: lanes.iter().fold(0, |mask, lane| mask | lane) & there,
            primitives: self.primitives,
        }
    }
}

pub(crate) struct ReachablePrimitives<'a> {
    rest: u64,
    primitives: &'a [u32],
}

impl Iterator for ReachablePrimitives<'_> {
    type Item = u32;

    #[inline(always)]
    fn next(&mut self) -> Option<u32> {
        let at = self.rest.trailing_zeros() as usize;
        let primitive = *self.primitives.get(at)?;
        self.rest &= self.rest - 1;
        Some(primitive)
    }
}

/// The primitives of a command buffer that a group of slices draws, in the order of drawing.
#[derive(Clone, Debug, Default)]
pub struct Bin {
    primitives: Vec<u32>,
    balls: Vec<Ball>,
    each: Vec<BallLanes>,
}

impl Bin {
    /// Creates a bin from the indices of primitives in the command buffer. The indices must be in ascending order.
    ///
    /// # Panics
    ///
    /// Panics if the command buffer has no such primitive.
    pub fn new(commands: &CommandBuffer, primitives: Vec<u32>) -> Self {
        let balls = primitives.chunks(CLUSTER).map(|cluster| ball(commands, cluster)).collect();
        let each = primitives.chunks(CLUSTER).map(|cluster| balls_of_each(commands, cluster)).collect();
        Self { primitives, balls, each }
    }

    pub fn primitives(&self) -> &[u32] {
        &self.primitives
    }

    #[inline(always)]
    pub(crate) fn clusters(&self) -> impl Iterator<Item = Cluster<'_>> {
        let balls = self.balls.iter().zip(&self.each);
        balls.zip(self.primitives.chunks(CLUSTER)).map(|((ball, each), primitives)| Cluster { ball, each, primitives })
    }
}

fn balls_of_each(commands: &CommandBuffer, cluster: &[u32]) -> BallLanes {
    let mut lanes = BallLanes::default();
    for (i, primitive) in cluster.iter().enumerate() {
        let Ball { centre, radius } = ball(commands, std::slice::from_ref(primitive));
        for (axis, lane) in lanes.centre.iter_mut().enumerate() {
            lane[i] = centre[axis];
        }
        lanes.radius[i] = radius;
    }
    lanes
}

fn ball(commands: &CommandBuffer, cluster: &[u32]) -> Ball {
    let used = |i: &u32| commands.primitives[*i as usize].corners();
    let corners = || cluster.iter().flat_map(used).map(|vertex| commands.positions[*vertex as usize]);
    // The sphere is centred in the box around all corners.
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
