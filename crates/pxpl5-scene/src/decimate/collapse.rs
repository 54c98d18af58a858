//! The choice of the edges to collapse during decimation, and their order.

use std::cmp::Ordering;
use std::collections::{BTreeSet, BinaryHeap};

use super::quadric::Quadric;
use super::surface::{Surface, is_degenerate};

/// Least cosine of the angle by which a triangle may turn when one of its corners moves. The value allows 78 degrees.
/// Assumed, 45 to 90 degrees.
const MIN_COSINE: f64 = 0.2;

#[derive(Clone, Copy)]
pub(super) struct Rules {
    /// True if a collapse may reverse the orientation of triangles.
    pub(super) may_flip_triangles: bool,
    /// True if a collapse may leave fewer triangles than wanted. A collapse inside a surface removes two triangles at
    /// once.
    pub(super) may_overshoot: bool,
}

#[derive(Clone)]
struct Candidate {
    cost: f64,
    from: u32,
    onto: u32,
    /// Number of changes of each end point of the edge at the time when the cost was computed. If an end point has
    /// changed since, the cost is outdated.
    changes: [u32; 2],
}

/// Orders candidates by cost, the cheapest first. Equal costs are ordered by the indices of the points, the lowest
/// first.
impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        let points = |candidate: &Self| (candidate.from, candidate.onto);
        other.cost.total_cmp(&self.cost).then_with(|| points(other).cmp(&points(self)))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

/// A surface during decimation. For each point, the decimator stores a quadric, which measures the error of moving the
/// point, and the number of changes.
#[derive(Clone)]
pub(super) struct Decimator {
    pub(super) surface: Surface,
    quadrics: Vec<Quadric>,
    changes: Vec<u32>,
    /// Smallest number of triangles that would have remained after any collapse tried so far. A decimation to at most
    /// this number of triangles would have made the same decisions so far.
    least_left: usize,
    /// True if every edge has two triangles. A collapse keeps this property.
    is_closed: bool,
}

/// Rules of the first pass. No collapse may reverse a triangle or leave fewer triangles than wanted.
const FIRST: Rules = Rules { may_flip_triangles: false, may_overshoot: false };

/// Rules of the last two passes. Both passes may leave fewer triangles than wanted. Only the last pass may reverse
/// triangles.
const LATER: [Rules; 2] =
    [Rules { may_flip_triangles: false, may_overshoot: true }, Rules { may_flip_triangles: true, may_overshoot: true }];

/// A decimation that is in its first pass over the surface. The pass can pause and continue later.
#[derive(Clone)]
pub(super) struct FirstPass {
    decimator: Decimator,
    queue: BinaryHeap<Candidate>,
}

impl FirstPass {
    pub(super) fn new(surface: Surface) -> Self {
        let decimator = Decimator::new(surface);
        let queue = decimator.queue();
        Self { decimator, queue }
    }

    /// Returns true if a decimation to `wanted` triangles also passes through the present surface. The decimation can
    /// then continue from this surface.
    pub(super) const fn serves(&self, wanted: usize) -> bool {
        wanted <= self.decimator.least_left
    }

    pub(super) const fn left(&self) -> usize {
        self.decimator.surface.left
    }

    /// Collapses edges until at most `pause` triangles remain or the pass ends. `wanted` is the number of triangles
    /// that should remain in the end.
    pub(super) fn until(&mut self, pause: usize, wanted: usize) {
        self.decimator.pass(&mut self.queue, pause, wanted, FIRST);
    }

    pub(super) fn end(mut self, wanted: usize) -> Surface {
        let whole = self.decimator.surface.triangles.len();
        if self.left() > wanted {
            self.until(wanted, wanted);
            // Further passes follow only if the first pass has removed triangles.
            if self.left() < whole {
                self.decimator.until(wanted, FIRST);
            }
        }
        LATER.into_iter().for_each(|rules| self.decimator.until(wanted, rules));
        self.decimator.surface
    }
}

impl Decimator {
    pub(super) fn new(surface: Surface) -> Self {
        let points = surface.places.len();
        let is_closed = surface.is_closed();
        let mut quadrics = vec![Quadric::default(); points];
        for (_, corners) in surface.all() {
            let normal = surface.normal(corners);
            let area = normal.length() / 2.0;
            let Some(normal) = normal.try_normalize() else { continue };
            let place = surface.places[corners[0] as usize];
            corners.iter().for_each(|point| quadrics[*point as usize] += Quadric::of_plane(normal, place, area));
            for side in 0..3 {
                let ends = [corners[side], corners[(side + 1) % 3]];
                let places = ends.map(|point| surface.places[point as usize]);
                let along = places[1] - places[0];
                // An edge at a border gets an imaginary plane perpendicular to the surface, so that moving the border
                // has a cost.
                if surface.triangles_at(ends[0], ends[1]) != 2
                    && let Some(across) = along.cross(normal).try_normalize()
                {
                    let wall = Quadric::of_plane(across, places[0], along.length_squared());
                    ends.iter().for_each(|point| quadrics[*point as usize] += wall);
                }
            }
        }
        Self { surface, quadrics, changes: vec![0; points], least_left: usize::MAX, is_closed }
    }

    pub(super) fn until(&mut self, wanted: usize, rules: Rules) {
        while self.surface.left > wanted && !self.is_stuck(wanted, rules) {
            let before = self.surface.left;
            let mut queue = self.queue();
            self.pass(&mut queue, wanted, wanted, rules);
            if self.surface.left == before {
                return;
            }
        }
    }

    fn queue(&self) -> BinaryHeap<Candidate> {
        let mut queue = BinaryHeap::new();
        for point in 0..self.surface.places.len() as u32 {
            self.enter(point, &mut queue);
        }
        queue
    }

    fn pass(&mut self, queue: &mut BinaryHeap<Candidate>, pause: usize, wanted: usize, rules: Rules) {
        while self.surface.left > pause && !self.is_stuck(wanted, rules) {
            let Some(candidate) = queue.pop() else { return };
            let Candidate { from, onto, changes, .. } = candidate;
            // Drop an outdated cost. A newer candidate for these points is in the queue.
            let is_current = changes == [self.changes[from as usize], self.changes[onto as usize]];
            if !is_current || !self.may_collapse(from, onto, wanted, rules) {
                continue;
            }
            self.surface.collapse(from, onto);
            // The remaining point adds the removed point's quadric to its own. All costs around it are computed again.
            let moved = self.quadrics[from as usize];
            self.quadrics[onto as usize] += moved;
            self.changes[from as usize] += 1;
            self.changes[onto as usize] += 1;
            self.enter(onto, queue);
            for neighbour in self.surface.neighbours(onto) {
                queue.push(self.candidate(neighbour, onto));
            }
        }
    }

    /// Returns true if no collapse is possible any more, because the surface is closed and has one triangle more than
    /// `wanted`, and each collapse removes two.
    const fn is_stuck(&self, wanted: usize, rules: Rules) -> bool {
        self.is_closed && !rules.may_overshoot && self.surface.left == wanted + 1
    }

    fn enter(&self, point: u32, queue: &mut BinaryHeap<Candidate>) {
        queue.extend(self.surface.neighbours(point).into_iter().map(|onto| self.candidate(point, onto)));
    }

    fn candidate(&self, from: u32, onto: u32) -> Candidate {
        let quadric = self.quadrics[from as usize] + self.quadrics[onto as usize];
        let cost = quadric.at(self.surface.places[onto as usize]);
        Candidate { cost, from, onto, changes: [from, onto].map(|point| self.changes[point as usize]) }
    }

    /// Returns true if a collapse keeps the surface intact. A closed surface stays closed, no triangle occurs twice,
    /// and no connected piece vanishes.
    fn may_collapse(&mut self, from: u32, onto: u32, wanted: usize, rules: Rules) -> bool {
        let round = self.surface.round(from);
        let (going, staying): (Vec<_>, Vec<_>) = round.partition(|(_, points)| points.contains(&onto));
        self.least_left = self.least_left.min(self.surface.left.saturating_sub(going.len()));
        let surface = &self.surface;
        let leaves_too_few = surface.left < wanted + going.len();
        if going.is_empty() || (leaves_too_few && !rules.may_overshoot) {
            return false;
        }
        // Both points may have common neighbours only at the triangles that the collapse removes. Otherwise the surface
        // would fold onto itself.
        let opposite: BTreeSet<u32> =
            going.iter().flat_map(|(_, points)| *points).filter(|point| ![from, onto].contains(point)).collect();
        let own = surface.neighbours(from);
        let common = own.intersection(&surface.neighbours(onto)).count();
        let vanishes = staying.is_empty() && surface.round(onto).count() == going.len();
        if common != opposite.len() || vanishes || !self.keeps_borders(from, onto, &own) {
            return false;
        }
        staying.iter().all(|(_, points)| self.may_move(*points, from, onto, rules.may_flip_triangles))
    }

    /// Returns true if a collapse keeps the borders of the surface in place. A point on a border may move only along
    /// the border. A point where borders meet must not move.
    fn keeps_borders(&self, from: u32, onto: u32, neighbours: &BTreeSet<u32>) -> bool {
        let on_border = |other: &&u32| self.surface.triangles_at(from, **other) != 2;
        let borders: Vec<u32> = neighbours.iter().filter(on_border).copied().collect();
        borders.is_empty() || (borders.len() == 2 && borders.contains(&onto))
    }

    /// Returns true if a triangle is still valid after one of its points moves. A valid triangle equals no other
    /// triangle and is not folded over.
    fn may_move(&self, points: [u32; 3], from: u32, onto: u32, may_flip_triangles: bool) -> bool {
        let moved = points.map(|point| if point == from { onto } else { point });
        let is_same = |(_, other): (u32, [u32; 3])| moved.iter().all(|point| other.contains(point));
        if is_degenerate(moved) || self.surface.round(onto).any(is_same) {
            return false;
        }
        let before = self.surface.normal(points);
        let after = self.surface.normal(moved);
        may_flip_triangles || after.dot(before) > MIN_COSINE * after.length() * before.length()
    }
}
