//! The text of docs/numerics.md, made from measurements of all cases.

use super::cases::{self, Case};
use super::fighting::{self, Fight};
use super::measure::{Row, SUBPIXEL_BITS, measure};
use super::spheres::{self, SphereCase, SphereRow};
use pxpl5_geometry::SetupStats;
use std::fmt::Write;
use std::thread::ScopedJoinHandle;

const HEAD: &str = include_str!("numerics_head.md.in");
const SINGLE: &str = include_str!("numerics_single.md.in");
const FORMATS: &str = include_str!("numerics_formats.md.in");

fn short(v: f64) -> String {
    match v {
        0.0 => "0".into(),
        v if v < 10.0 => format!("{v:.1}"),
        v => grouped(v as u64),
    }
}

fn grouped(v: u64) -> String {
    let digits = v.to_string();
    let groups: Vec<&str> = digits.as_bytes().rchunks(3).rev().filter_map(|g| std::str::from_utf8(g).ok()).collect();
    groups.join(",")
}

/// Describes the counts of dropped, clipped and flattened primitives.
fn counted(s: &SetupStats) -> String {
    let counts = [
        (s.clipped, "clipped"),
        (s.outside, "outside"),
        (s.degenerate, "degenerate"),
        (s.untouched, "on no pixel"),
        (s.not_finite, "not finite"),
        (s.flattened_planes, "flattened planes"),
        (s.spheres_outside, "outside"),
        (s.spheres_across_near, "across near"),
        (s.spheres_across_far, "across far"),
        (s.spheres_not_finite, "not finite"),
    ];
    let named = counts.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}"));
    let all: Vec<String> = named.collect();
    if all.is_empty() { "-".into() } else { all.join(", ") }
}

fn pipeline_row(out: &mut String, case: &Case, row: &Row) {
    let colour = if row.colour == 0.0 { "-".into() } else { short(row.colour) };
    let _ = writeln!(
        out,
        "| {} | {} | {} | {} | {} | {} | {} |",
        case.name,
        grouped(row.exact),
        short(Row::per_million(row.wrong, row.exact)),
        short(row.depth),
        short(row.depth_plane),
        colour,
        counted(&row.stats),
    );
}

fn grid_row(out: &mut String, case: &Case, row: &Row) {
    let cells = row.grids.map(|wrong| short(Row::per_million(wrong, row.grid_exact)));
    let _ = writeln!(out, "| {} | {} |", case.name, cells.join(" | "));
}

fn sphere_row(out: &mut String, case: &SphereCase, row: &SphereRow) {
    let _ = writeln!(
        out,
        "| {} | {} | {} | {} | {} | {} |",
        case.name,
        grouped(row.exact),
        short(row.depth),
        if row.depth_of_bulge == 0.0 { "-".into() } else { format!("1/{:.0}", 1.0 / row.depth_of_bulge) },
        row.bits,
        counted(&row.stats),
    );
}

fn heading(out: &mut String, title: &str, columns: &[&str]) {
    if !title.is_empty() {
        let _ = writeln!(out, "\n## {title}");
    }
    let _ = write!(out, "\n| {} |\n|{}\n", columns.join(" | "), "---|".repeat(columns.len()));
}

pub struct Measured {
    pub triangles: Vec<(Case, Row)>,
    /// The same by the program of Slats.
    pub single: Vec<(Case, Row)>,
    pub spheres: Vec<(SphereCase, SphereRow)>,
    pub fights: Vec<Fight>,
}

impl Measured {
    /// Measures all cases, with one thread for each case.
    pub fn all() -> Self {
        std::thread::scope(|scope| {
            let fights = scope.spawn(fighting::all);
            let [triangles, single] = [(cases::all(), false), (cases::single(), true)].map(|(cases, single)| {
                let measured = |case: Case| scope.spawn(move || (case.clone(), measure(&case, single)));
                cases.into_iter().map(measured).collect::<Vec<_>>()
            });
            let spheres: Vec<_> = spheres::all()
                .into_iter()
                .map(|case| scope.spawn(move || (case.clone(), spheres::measure(&case))))
                .collect();
            Self {
                triangles: joined(triangles),
                single: joined(single),
                spheres: joined(spheres),
                fights: fights.join().expect("no measurement panics"),
            }
        })
    }
}

fn joined<T>(threads: Vec<ScopedJoinHandle<'_, T>>) -> Vec<T> {
    threads.into_iter().map(|thread| thread.join().expect("no measurement panics")).collect()
}

/// Returns the whole text of docs/numerics.md.
pub fn text(measured: &Measured) -> String {
    let rows = &measured.triangles;
    let mut out = HEAD.to_string();
    triangles(&mut out, "Triangles: the pipeline against exact geometry", rows);
    out.push_str(SINGLE);
    triangles(&mut out, "", measured.single.iter().filter(|(case, row)| differs(case, row, rows)));
    fights(&mut out, &measured.fights);
    all_spheres(&mut out, &measured.spheres);
    grids(&mut out, rows);
    bits(&mut out, rows);
    out.push('\n');
    out.push_str(FORMATS);
    out
}

/// Returns true if a case has other wrong pixels by the program of Slats than by the pipeline, or a plane that is off by
/// more than 4 units of depth or 0.65 units of colour.
fn differs(case: &Case, row: &Row, pipeline: &[(Case, Row)]) -> bool {
    let other = pipeline.iter().find(|(other, _)| other.name == case.name);
    row.depth_plane > 4.0 || row.colour_plane > 0.65 || other.is_some_and(|(_, other)| other.wrong != row.wrong)
}

fn triangles<'a>(out: &mut String, title: &str, rows: impl IntoIterator<Item = &'a (Case, Row)>) {
    let columns = ["case", "pixels", "wrong per million", "depth error", "of the plane", "colour error", "counted"];
    heading(out, title, &columns);
    rows.into_iter().for_each(|(case, row)| pipeline_row(out, case, row));
}

fn fights(out: &mut String, fights: &[Fight]) {
    heading(
        out,
        "Z fighting: surfaces that are 2^-n of their distance apart, or tilted by 2^-n",
        &["case", "depth units apart", "wrong per million"],
    );
    for f in fights {
        let part = short(Row::per_million(f.wrong, f.pixels));
        let _ = writeln!(out, "| {} | {} | {part} |", f.name, short(f.apart));
    }
}

fn all_spheres(out: &mut String, rows: &[(SphereCase, SphereRow)]) {
    let columns = ["case", "pixels", "depth error", "as part of the bulge", "bits", "counted"];
    heading(out, "Spheres, which have no wrong pixel", &columns);
    rows.iter().for_each(|(case, row)| sphere_row(out, case, row));
}

/// Writes the wrong pixels of the first eight cases on finer and coarser grids.
fn grids(out: &mut String, rows: &[(Case, Row)]) {
    let bits = SUBPIXEL_BITS.map(|bits| format!("{bits} bits"));
    let mut columns = vec!["case"];
    columns.extend(bits.iter().map(String::as_str));
    heading(out, "Subpixel bits: wrong pixels per million with exact vertices", &columns);
    rows.iter().take(8).for_each(|(case, row)| grid_row(out, case, row));
}

/// Writes the greatest numbers of bits that any case needs.
fn bits(out: &mut String, rows: &[(Case, Row)]) {
    let [edge, edge_c, depth, colour] =
        [0, 1, 2, 3].map(|place| rows.iter().map(|(_, row)| row.bits[place]).max().unwrap_or(0));
    let _ = writeln!(
        out,
        "\nWith their signs, the coefficients of these cases need at most {edge} bits (A and B of an edge), {edge_c} (C), {depth} (depth)\n\
         and {colour} (colour)."
    );
}
