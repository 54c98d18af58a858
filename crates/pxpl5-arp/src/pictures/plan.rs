//! Drawings of the cells seen from above, and of the frames in which each memory was updated.

use crate::simulation::{FrameOutcome, Simulation};
use crate::walk::WalkTally;
use crate::world::World;
use address_recalculation::priority::Cell;
use glam::DVec3;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use tracking::motion::Walk;

/// Colours for display memories 0 to 7. People with colour blindness can distinguish these colours.
pub(crate) const MEMORY_COLOURS: [u32; 8] =
    [0x00D5_5E00, 0x00E6_9F00, 0x0000_9E73, 0x0056_B4E9, 0x0000_72B2, 0x00CC_79A7, 0x00F0_E442, 0x0099_9999];

/// Pixels of the drawing per metre of the hall.
const SCALE: f64 = 14.0;
/// Width of the empty border around a drawing, in pixels.
const MARGIN: f64 = 30.0;

fn colour(memory: usize) -> String {
    format!("#{:06x}", MEMORY_COLOURS[memory % MEMORY_COLOURS.len()])
}

struct Plan {
    low: [f64; 2],
    size: [f64; 2],
}

impl Plan {
    fn of(cells: &BTreeSet<(i64, i64)>, side: f64) -> Self {
        let ends = |columns: &[i64]| {
            let low = columns.iter().min().copied().unwrap_or(0);
            [low, columns.iter().max().map_or(0, |high| high + 1)].map(|column| column as f64 * side)
        };
        let x = ends(&cells.iter().map(|cell| cell.0).collect::<Vec<i64>>());
        let z = ends(&cells.iter().map(|cell| cell.1).collect::<Vec<i64>>());
        let size = [x, z].map(|[low, high]| (high - low) * SCALE + 2.0 * MARGIN);
        Self { low: [x[0], z[0]], size }
    }

    fn at(&self, x: f64, z: f64) -> [f64; 2] {
        [(x - self.low[0]) * SCALE + MARGIN, (z - self.low[1]) * SCALE + MARGIN]
    }
}

fn head(width: f64, height: f64) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    )
}

/// Draws the cells seen from above, coloured by memory, with partitions, path, eye and the viewer's cell. The direction
/// -z is at the top.
pub fn cells_svg(world: &World, simulation: &Simulation<'_>, path: &Walk, eye: DVec3) -> String {
    let side = simulation.settings.numbers.cell_m;
    let cells: BTreeSet<(i64, i64)> = world.cells().map(|cell| (cell.x, cell.z)).collect();
    let plan = Plan::of(&cells, side);
    let [width, depth] = plan.size;
    let mut svg = head(width, depth + 40.0);
    // Cells in the colours of their memories.
    for (x, z) in &cells {
        let cell = Cell { x: *x, z: *z };
        let memory = simulation.assignment().map_or(0, |assignment| assignment.memory(cell));
        cell_box(
            &mut svg,
            &plan,
            cell,
            side,
            &format!("fill=\"{}\" fill-opacity=\"0.55\" stroke=\"white\"", colour(memory)),
        );
    }
    // Outline of the home cell.
    if let Some(assignment) = simulation.assignment() {
        cell_box(&mut svg, &plan, assignment.home, side, "fill=\"none\" stroke=\"black\" stroke-width=\"3\"");
    }
    // Walls, path and eye.
    upright_edges(&mut svg, world, &plan);
    walked(&mut svg, path, &plan);
    let [x, y] = plan.at(eye.x, eye.z);
    let _ = writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"5\" fill=\"black\"/>");
    (0..simulation.shown.len()).for_each(|memory| legend(&mut svg, memory, depth + 4.0));
    svg.push_str("</svg>\n");
    svg
}

fn cell_box(svg: &mut String, plan: &Plan, cell: Cell, side: f64, style: &str) {
    let [left, top] = plan.at(cell.x as f64 * side, cell.z as f64 * side);
    let size = side * SCALE;
    let _ = writeln!(svg, "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{size:.1}\" height=\"{size:.1}\" {style}/>");
}

fn walked(svg: &mut String, path: &Walk, plan: &Plan) {
    let steps = (path.length_m() / 0.5).ceil() as u32;
    let places = (0..=steps).map(|step| path.place(f64::from(step) / f64::from(steps) * path.length_m()));
    let points = places.map(|place| plan.at(place.x, place.z)).map(|[x, y]| format!("{x:.1},{y:.1}"));
    let points: Vec<String> = points.collect();
    let style = "fill=\"none\" stroke=\"#333\" stroke-width=\"1.5\" stroke-dasharray=\"5 4\"";
    let _ = writeln!(svg, "<polyline points=\"{}\" {style}/>", points.join(" "));
}

fn legend(svg: &mut String, memory: usize, top: f64) {
    let left = MARGIN + 150.0 * memory as f64;
    let fill = colour(memory);
    let _ = writeln!(
        svg,
        "<rect x=\"{left:.0}\" y=\"{top:.0}\" width=\"16\" height=\"16\" fill=\"{fill}\" fill-opacity=\"0.55\"/>\
         <text x=\"{:.0}\" y=\"{:.0}\">memory {memory}</text>",
        left + 22.0,
        top + 13.0
    );
}

/// Draws the edges of upright triangles, seen from above. These triangles are the walls and partitions.
fn upright_edges(svg: &mut String, world: &World, plan: &Plan) {
    for three in world.segments.iter().flat_map(|segment| &segment.triangles) {
        // Only upright triangles form walls.
        let [a, b, c] = three.map(|i| world.vertices[i as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        if normal.y.abs() > 0.01 {
            continue;
        }
        // Seen from above, a wall is its longest horizontal edge.
        let ends = [[a, b], [b, c], [c, a]];
        let longest = ends
            .iter()
            .max_by(|p, q| (p[0] - p[1]).with_y(0.0).length().total_cmp(&(q[0] - q[1]).with_y(0.0).length()));
        let Some([from, to]) = longest else { continue };
        let [[x1, y1], [x2, y2]] = [plan.at(from.x, from.z), plan.at(to.x, to.z)];
        let _ = writeln!(svg, "<path d=\"M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}\" stroke=\"#222\" stroke-width=\"2\"/>");
    }
}

/// Draws a row per memory. A rectangle marks each frame in which the memory showed an update or missed the retrace.
/// Other rectangles mark new assignments of cells.
pub fn updates_svg(tally: &WalkTally, frames: std::ops::Range<u64>) -> String {
    let memories = tally.memories.len();
    let step = 8.0;
    let left = 90.0;
    let width = left + step * (frames.end - frames.start) as f64 + 20.0;
    let height = 34.0 * memories as f64 + 70.0;
    let mut svg = head(width, height);
    // Labels and base lines of the memories.
    for memory in 0..memories {
        let top = 20.0 + 34.0 * memory as f64;
        let _ = writeln!(svg, "<text x=\"8\" y=\"{:.0}\">memory {memory}</text>", top + 17.0);
        let _ = writeln!(svg, "<path d=\"M{left:.0} {0:.0}H{1:.0}\" stroke=\"#ccc\"/>", top + 26.0, width - 20.0);
    }
    // One column per frame.
    for (column, frame) in frames.clone().enumerate() {
        let Some(outcome) = tally.outcomes.get(frame as usize) else { break };
        let x = left + step * column as f64;
        // A dashed line marks a new assignment of cells.
        if outcome.reassigns_cells {
            let _ = writeln!(
                svg,
                "<path d=\"M{x:.0} 12V{:.0}\" stroke=\"black\" stroke-dasharray=\"3 2\"/>",
                height - 46.0
            );
        }
        (0..memories).for_each(|memory| mark(&mut svg, outcome, memory, x));
        if frame % 15 == 0 {
            let _ = writeln!(svg, "<text x=\"{x:.0}\" y=\"{:.0}\">{frame}</text>", height - 30.0);
        }
    }
    let _ = writeln!(
        svg,
        "<text x=\"8\" y=\"{:.0}\">Frames of 1/60 s; bar: an update that was drawn and shown; dashes: new assignment of cells; red: not complete at its retrace.</text>",
        height - 8.0
    );
    svg.push_str("</svg>\n");
    svg
}

fn mark(svg: &mut String, outcome: &FrameOutcome, memory: usize, x: f64) {
    let top = 22.0 + 34.0 * memory as f64;
    let place = format!("x=\"{x:.0}\" y=\"{top:.0}\" width=\"6\" height=\"24\"");
    if outcome.swapped[memory] {
        let _ = writeln!(svg, "<rect {place} fill=\"{}\"/>", colour(memory));
    }
    if outcome.missed[memory] {
        let _ = writeln!(svg, "<rect {place} fill=\"none\" stroke=\"red\"/>");
    }
}
