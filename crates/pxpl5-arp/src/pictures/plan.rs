//! Drawings: cells from above, and a row of updates for each memory.

use super::MEMORY_COLOURS;
use crate::simulation::Simulation;
use crate::walk::WalkTally;
use crate::world::World;
use glam::DVec3;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use tracking::motion::Walk;

/// Pixels of a metre, and of the margin.
const SCALE: f64 = 14.0;
const MARGIN: f64 = 30.0;

fn colour(memory: usize) -> String {
    format!("#{:06x}", MEMORY_COLOURS[memory % MEMORY_COLOURS.len()])
}

/// Cells by their memories, partitions, the path, the eye and its home cell, from above, -z at the top.
#[must_use]
pub fn cells_svg(world: &World, simulation: &Simulation<'_>, path: &Walk, eye: DVec3) -> String {
    let side = simulation.settings().numbers.cell_m;
    let cells: BTreeSet<(i64, i64)> = world.cells().map(|cell| (cell.x, cell.z)).collect();
    let low = [cells.iter().map(|cell| cell.0).min(), cells.iter().map(|cell| cell.1).min()]
        .map(|n| n.unwrap_or(0) as f64 * side);
    let high = [cells.iter().map(|cell| cell.0).max(), cells.iter().map(|cell| cell.1).max()]
        .map(|n| (n.unwrap_or(0) + 1) as f64 * side);
    let at = |x: f64, z: f64| [(x - low[0]) * SCALE + MARGIN, (z - low[1]) * SCALE + MARGIN];
    let [width, depth] = [high[0] - low[0], high[1] - low[1]].map(|metres| metres * SCALE + 2.0 * MARGIN);
    let height = depth + 40.0;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    for (x, z) in &cells {
        let cell = priority_rendering::Cell { x: *x, z: *z };
        let memory = simulation.dealing().map_or(0, |dealing| dealing.memory(cell));
        let [left, top] = at(*x as f64 * side, *z as f64 * side);
        let is_home = simulation.dealing().is_some_and(|dealing| dealing.home == cell);
        let (line, stroke) = if is_home { (3, "black") } else { (1, "white") };
        let size = side * SCALE;
        let _ = writeln!(
            svg,
            "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{size:.1}\" height=\"{size:.1}\" fill=\"{}\" fill-opacity=\"0.55\" stroke=\"{stroke}\" stroke-width=\"{line}\"/>",
            colour(memory)
        );
    }
    upright_edges(&mut svg, world, at);
    let steps = (path.length_m() / 0.5).ceil() as u32;
    let points: Vec<String> = (0..=steps)
        .map(|step| path.place(f64::from(step) / f64::from(steps) * path.length_m()))
        .map(|place| at(place.x, place.z))
        .map(|[x, y]| format!("{x:.1},{y:.1}"))
        .collect();
    let _ = writeln!(
        svg,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#333\" stroke-width=\"1.5\" stroke-dasharray=\"5 4\"/>",
        points.join(" ")
    );
    let [x, y] = at(eye.x, eye.z);
    let _ = writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"5\" fill=\"black\"/>");
    for memory in 0..simulation.shown().len() {
        let left = MARGIN + 150.0 * memory as f64;
        let text = format!("memory {memory}");
        let top = depth + 4.0;
        let _ = writeln!(
            svg,
            "<rect x=\"{left:.0}\" y=\"{top:.0}\" width=\"16\" height=\"16\" fill=\"{}\" fill-opacity=\"0.55\"/><text x=\"{:.0}\" y=\"{:.0}\">{text}</text>",
            colour(memory),
            left + 22.0,
            top + 13.0
        );
    }
    svg.push_str("</svg>\n");
    svg
}

/// Edges of triangles that stand upright, seen from above: walls and partitions.
fn upright_edges(svg: &mut String, world: &World, at: impl Fn(f64, f64) -> [f64; 2]) {
    for three in world.segments.iter().flat_map(|segment| &segment.triangles) {
        let [a, b, c] = three.map(|i| world.vertices[i as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        if normal.y.abs() > 0.01 {
            continue;
        }
        let ends = [[a, b], [b, c], [c, a]];
        let longest = ends
            .iter()
            .max_by(|p, q| (p[0] - p[1]).with_y(0.0).length().total_cmp(&(q[0] - q[1]).with_y(0.0).length()));
        let Some([from, to]) = longest else { continue };
        let [[x1, y1], [x2, y2]] = [at(from.x, from.z), at(to.x, to.z)];
        let _ = writeln!(svg, "<path d=\"M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}\" stroke=\"#222\" stroke-width=\"2\"/>");
    }
}

/// For each frame of a range a mark in the row of each memory: due and shown, due and missed, dealt anew.
#[must_use]
pub fn updates_svg(tally: &WalkTally, frames: std::ops::Range<u64>) -> String {
    let memories = tally.memories.len();
    let step = 8.0;
    let left = 90.0;
    let width = left + step * (frames.end - frames.start) as f64 + 20.0;
    let height = 34.0 * memories as f64 + 70.0;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    for memory in 0..memories {
        let top = 20.0 + 34.0 * memory as f64;
        let _ = writeln!(svg, "<text x=\"8\" y=\"{:.0}\">memory {memory}</text>", top + 17.0);
        let _ = writeln!(svg, "<path d=\"M{left:.0} {0:.0}H{1:.0}\" stroke=\"#ccc\"/>", top + 26.0, width - 20.0);
    }
    for (column, frame) in frames.clone().enumerate() {
        let Some(outcome) = tally.outcomes.get(frame as usize) else { break };
        let x = left + step * column as f64;
        if outcome.deals_anew {
            let _ = writeln!(
                svg,
                "<path d=\"M{x:.0} 12V{:.0}\" stroke=\"black\" stroke-dasharray=\"3 2\"/>",
                height - 46.0
            );
        }
        for memory in 0..memories {
            let top = 22.0 + 34.0 * memory as f64;
            if outcome.swapped[memory] {
                let fill = colour(memory);
                let _ = writeln!(svg, "<rect x=\"{x:.0}\" y=\"{top:.0}\" width=\"6\" height=\"24\" fill=\"{fill}\"/>");
            }
            if outcome.missed[memory] {
                let _ = writeln!(
                    svg,
                    "<rect x=\"{x:.0}\" y=\"{top:.0}\" width=\"6\" height=\"24\" fill=\"none\" stroke=\"red\"/>"
                );
            }
        }
        if frame % 15 == 0 {
            let _ = writeln!(svg, "<text x=\"{x:.0}\" y=\"{:.0}\">{frame}</text>", height - 30.0);
        }
    }
    let _ = writeln!(
        svg,
        "<text x=\"8\" y=\"{:.0}\">Frames of 1/60 s; a bar: drawn and shown; dashes: cells dealt anew; red: not whole at its retrace.</text>",
        height - 8.0
    );
    svg.push_str("</svg>\n");
    svg
}
