//! Protein Data Bank files: fixed columns, counted from 1 as in the format's guide, version 3.3.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::mesh::{Fit, seen_by};
use super::source::{excerpt, text};
use super::{Placement, Source};
use crate::error::{FilePlace, LoadError};
use crate::scene::{Scene, Sphere};

/// One atom of a file.
pub(crate) struct Atom {
    /// Such as "CA": the name within its residue.
    pub(crate) name: String,
    /// Place in the coordinates of the file, Ångström.
    pub(crate) position: DVec3,
    pub(crate) element: Element,
}

/// How an element is drawn.
#[derive(Clone, Copy)]
pub(crate) struct Element {
    symbol: &'static str,
    /// Van der Waals radius, Ångström.
    pub(crate) radius: f64,
    /// After the colours of Corey, Pauling and Koltun's models.
    pub(crate) colour: [u8; 3],
}

const fn element(symbol: &'static str, radius: f64, colour: [u8; 3]) -> Element {
    Element { symbol, radius, colour }
}

/// Radii: published, Bondi 1964, for H to I; metals assumed 2.0 (1.4 to 2.5), as Bondi gives none for Fe, Ca, Mn and Co.
/// Colours: the custom of molecular graphics; assumed, any.
const ELEMENTS: [Element; 20] = [
    element("H", 1.20, [255, 255, 255]),
    element("D", 1.20, [255, 255, 255]),
    element("C", 1.70, [144, 144, 144]),
    element("N", 1.55, [48, 80, 248]),
    element("O", 1.52, [240, 24, 24]),
    element("F", 1.47, [144, 224, 80]),
    element("P", 1.80, [255, 128, 0]),
    element("S", 1.80, [255, 216, 48]),
    element("CL", 1.75, [32, 224, 32]),
    element("BR", 1.85, [166, 41, 41]),
    element("I", 1.98, [148, 0, 148]),
    element("SE", 1.90, [255, 161, 0]),
    element("NA", 2.27, [171, 92, 242]),
    element("MG", 1.73, [138, 255, 0]),
    element("K", 2.75, [143, 64, 212]),
    element("ZN", 1.39, [125, 128, 176]),
    element("FE", 2.00, [224, 102, 51]),
    element("CA", 2.00, [61, 255, 0]),
    element("MN", 2.00, [156, 122, 199]),
    element("CO", 2.00, [240, 144, 160]),
];

/// Any other element. Assumed: within the range of the table.
const OTHER: Element = element("?", 1.80, [255, 20, 147]);

pub(super) fn read(source: &Source<'_>, placement: Placement) -> Result<Scene, LoadError> {
    let atoms = read_atoms(source)?;
    if atoms.is_empty() {
        return Err(LoadError::NothingToDraw { file: source.name.to_owned(), expected: "atom" });
    }
    let fit = placement.fit(atoms.iter().map(|a| (a.position, a.element.radius)));
    let spheres = atoms.iter().map(|a| a.sphere(a.position, &fit)).collect();
    Ok(seen_by(placement.motion(), source.name, Vec::new(), Vec::new(), spheres))
}

impl Atom {
    /// The atom as a sphere, moved to `position` (Ångström).
    pub(crate) fn sphere(&self, position: DVec3, fit: &Fit) -> Sphere {
        Sphere {
            centre: fit.place(position).as_vec3(),
            radius: (self.element.radius * fit.scale) as f32,
            colour: self.element.colour,
        }
    }
}

/// The atoms of the first model, in the order of the file; of an atom's alternate locations the first.
pub(crate) fn read_atoms(source: &Source<'_>) -> Result<Vec<Atom>, LoadError> {
    let mut atoms = Vec::new();
    let mut alternates = Alternates::default();
    for (number, line) in source.lines() {
        let at = FilePlace::Line(number);
        match columns(line, 1, 6) {
            b"ATOM" | b"HETATM" if alternates.is_first(line) => atoms.push(atom(source, at, line)?),
            b"ENDMDL" => break,
            _ => {}
        }
    }
    Ok(atoms)
}

/// Alternate locations that were met. Looked up only, never walked, so that no order shows anywhere.
#[derive(Default)]
struct Alternates<'a> {
    /// Name of the first residue at a place of the chain (columns 22 to 27) that has alternates: others there are another
    /// molecule's.
    residues: HashMap<&'a [u8], &'a [u8]>,
    /// Place and name of every atom that has alternates.
    atoms: HashSet<(&'a [u8], &'a [u8])>,
}

impl<'a> Alternates<'a> {
    /// Whether an atom has one location only, or this is the first of them.
    fn is_first(&mut self, line: &'a [u8]) -> bool {
        if columns(line, 17, 17).is_empty() {
            return true;
        }
        let place = columns(line, 22, 27);
        let residue = columns(line, 18, 20);
        *self.residues.entry(place).or_insert(residue) == residue && self.atoms.insert((place, columns(line, 13, 16)))
    }
}

fn atom(source: &Source<'_>, at: FilePlace, line: &[u8]) -> Result<Atom, LoadError> {
    let mut position = [0.0; 3];
    for (x, (axis, first)) in position.iter_mut().zip([("x", 31), ("y", 39), ("z", 47)]) {
        let field = text(columns(line, first, first + 7));
        *x = field.parse().map_err(|_| {
            let expected = format!("a number for {axis} in columns {first} to {}", first + 7);
            source.syntax(at, expected, excerpt(field))
        })?;
    }
    Ok(Atom {
        name: text(columns(line, 13, 16)).to_owned(),
        position: DVec3::from_array(source.coordinates(at, position)?),
        element: element_of(line),
    })
}

/// Symbols of two letters that are in no residue of [`RESIDUES`], and are not in [`ELEMENTS`]. H with a second letter is left out:
/// in a molecule it is a hydrogen with the name of its place.
const OTHER_SYMBOLS: [&str; 48] = [
    "LI", "BE", "NE", "AL", "SI", "AR", "SC", "TI", "CR", "NI", "CU", "GA", "GE", "AS", "KR", "RB", "SR", "ZR", "NB",
    "MO", "RU", "RH", "PD", "AG", "CD", "IN", "SN", "SB", "TE", "XE", "CS", "BA", "LA", "CE", "PR", "SM", "EU", "GD",
    "TB", "YB", "LU", "TA", "RE", "OS", "IR", "PT", "AU", "PB",
];

/// Residues that consist of H, D, C, N, O, S and P alone: amino acids, nucleotides and water.
const RESIDUES: [&str; 38] = [
    "ALA", "ARG", "ASN", "ASP", "ASX", "CYS", "GLN", "GLU", "GLX", "GLY", "HIS", "ILE", "LEU", "LYS", "MET", "PHE",
    "PRO", "SER", "THR", "TRP", "TYR", "VAL", "A", "C", "G", "U", "I", "T", "DA", "DC", "DG", "DT", "DU", "DI", "HOH",
    "DOD", "WAT", "ACE",
];

/// Columns 77 and 78 where they hold an element; other files have nothing there, or a number of the line, and name the atom in
/// columns 13 to 16.
fn element_of(line: &[u8]) -> Element {
    let symbol = text(columns(line, 77, 78));
    if !symbol.is_empty() && symbol.bytes().all(|byte| byte.is_ascii_alphabetic()) {
        return known(symbol);
    }
    let name: Vec<u8> = line.iter().skip(12).take(4).map(u8::to_ascii_uppercase).collect();
    let residue = text(columns(line, 18, 20)).to_ascii_uppercase();
    known(symbol_of_name(text(&name), &residue))
}

fn known(symbol: &str) -> Element {
    let known = ELEMENTS.iter().find(|e| e.symbol.eq_ignore_ascii_case(symbol));
    known.copied().unwrap_or(OTHER)
}

/// The symbol in the four columns of an atom's name: its element stands to the right in the first two of them, unless the name takes
/// all four.
fn symbol_of_name<'n>(name: &'n str, residue: &str) -> &'n str {
    let letters = name.trim().trim_start_matches(|c: char| c.is_ascii_digit());
    let first = letters.get(..1).unwrap_or_default();
    let symbol = letters.get(..2).filter(|two| two.bytes().all(|byte| byte.is_ascii_alphabetic()));
    let is_single = matches!(first, "H" | "D" | "B" | "C" | "N" | "O" | "F" | "P" | "S" | "K" | "I");
    match symbol {
        None => first,
        // An ion is its own residue.
        Some(two) if two == residue => two,
        _ if RESIDUES.contains(&residue) => first,
        Some(two @ ("CL" | "BR" | "FE")) => two,
        // Column 13 is empty, or holds the number of a hydrogen: the symbol is one letter.
        _ if is_single && !name.starts_with(|c: char| c.is_ascii_alphabetic()) => first,
        _ if matches!(first, "H" | "D") => first,
        Some(two) if name.trim().len() == 4 && is_single && !matches!(two, "SE" | "SI") => first,
        Some(two) if ELEMENTS.iter().any(|e| e.symbol == two) || OTHER_SYMBOLS.contains(&two) => two,
        _ => first,
    }
}

/// Columns `first` to `last` without white space around; empty beyond the line's end.
fn columns(line: &[u8], first: usize, last: usize) -> &[u8] {
    let end = last.min(line.len());
    line.get(first - 1..end).unwrap_or_default().trim_ascii()
}
