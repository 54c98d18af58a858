//! Reader of Protein Data Bank files. Columns have fixed positions and count from 1, as in the format's guide, version
//! 3.3.

use pxpl5_sim::parameters::FileError;
use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::mesh::{Fit, seen_by};
use super::source::{excerpt, text};
use super::{Placement, Source};
use crate::error::{FilePlace, nothing_to_draw};
use crate::scene::{Scene, Sphere};

pub(crate) struct Atom {
    /// Name of the atom within its residue, such as "CA" for the alpha carbon.
    pub(crate) name: String,
    /// Position of the atom's centre in the coordinates of the file, Ångström.
    pub(crate) position: DVec3,
    pub(crate) element: Element,
}

#[derive(Clone, Copy)]
pub(crate) struct Element {
    symbol: &'static str,
    /// Van der Waals radius of the element, Ångström.
    pub(crate) radius: f64,
    /// Colour of the element, as in the plastic models of Corey, Pauling and Koltun.
    pub(crate) colour: [u8; 3],
}

const fn element(symbol: &'static str, radius: f64, colour: [u8; 3]) -> Element {
    Element { symbol, radius, colour }
}

/// The elements with radii and colours. Radii are published by Bondi 1964, and those of Rb and Cs by Mantina 2009. Bondi
/// has no radii for Fe, Ca, Mn and Co: 2.0 is assumed (1.4 to 2.5). Colours follow the custom of molecular graphics
/// (assumed).
const ELEMENTS: [Element; 23] = [
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
    element("LI", 1.82, [204, 128, 255]),
    element("RB", 3.03, [112, 46, 176]),
    element("CS", 3.43, [87, 23, 143]),
];

/// Radius and colour of an element that is not in the table. The radius is assumed, within the range of the table.
const OTHER: Element = element("?", 1.80, [255, 20, 147]);

pub(super) fn read(source: &Source<'_>, placement: Placement) -> Result<Scene, FileError> {
    let atoms = read_atoms(source)?;
    if atoms.is_empty() {
        return Err(nothing_to_draw(source.name, "atom"));
    }
    let fit = placement.fit(atoms.iter().map(|a| (a.position, a.element.radius)));
    let spheres = atoms.iter().map(|a| a.sphere(a.position, &fit)).collect();
    Ok(seen_by(placement.motion(), source.name, Vec::new(), Vec::new(), spheres))
}

impl Atom {
    pub(crate) fn sphere(&self, position: DVec3, fit: &Fit) -> Sphere {
        Sphere {
            centre: fit.place(position).as_vec3(),
            radius: (self.element.radius * fit.scale) as f32,
            colour: self.element.colour,
        }
    }
}

/// Reads the atoms of the first model in the file, in their order. If an atom has alternate locations, only the first
/// is kept.
pub(crate) fn read_atoms(source: &Source<'_>) -> Result<Vec<Atom>, FileError> {
    let mut atoms = Vec::new();
    let mut alternates = Alternates::default();
    let is_atom = |line: &[u8]| matches!(columns(line, 1, 6), b"ATOM" | b"HETATM");
    // In the format, a name begins in column 13 only if its element has two letters. Some programs begin every name
    // there, so these columns say nothing.
    let begins_left = |line: &[u8]| matches!(line.get(12..14), Some([b'N' | b'C' | b'O', b' ']));
    let are_left = source.lines().any(|(_, line)| is_atom(line) && begins_left(line));
    for (number, line) in source.lines() {
        let at = FilePlace::Line(number);
        // The first six columns name the record. A second model may begin without an end of the first one.
        match columns(line, 1, 6) {
            b"ATOM" | b"HETATM" if alternates.is_first(line) => atoms.push(atom(source, at, line, are_left)?),
            b"ENDMDL" => break,
            b"MODEL" | b"END" if !atoms.is_empty() => break,
            _ => {}
        }
    }
    Ok(atoms)
}

/// The alternate locations of atoms that were read so far. The tables are only searched and never iterated, so their
/// order has no effect.
#[derive(Default)]
struct Alternates<'a> {
    /// Name of the first residue at each position of the chain (columns 22 to 27) with alternate locations. A residue
    /// with a different name at the same position belongs to another molecule.
    residues: HashMap<&'a [u8], &'a [u8]>,
    /// Position in the chain and name of every atom with alternate locations.
    atoms: HashSet<(&'a [u8], &'a [u8])>,
}

impl<'a> Alternates<'a> {
    /// Returns true for the first location of an atom, and for an atom with a single location.
    fn is_first(&mut self, line: &'a [u8]) -> bool {
        if columns(line, 17, 17).is_empty() {
            return true;
        }
        let place = columns(line, 22, 27);
        let residue = columns(line, 18, 20);
        *self.residues.entry(place).or_insert(residue) == residue && self.atoms.insert((place, columns(line, 13, 16)))
    }
}

fn atom(source: &Source<'_>, at: FilePlace, line: &[u8], are_left: bool) -> Result<Atom, FileError> {
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
        element: element_of(line, are_left),
    })
}

/// Symbols, two letters long, of elements that occur in no residue of [`RESIDUES`]. Symbols that begin with H are left
/// out: in an atom's name, H and a second letter stand for a hydrogen at a certain position.
const OTHER_SYMBOLS: [&str; 48] = [
    "LI", "BE", "NE", "AL", "SI", "AR", "SC", "TI", "CR", "NI", "CU", "GA", "GE", "AS", "KR", "RB", "SR", "ZR", "NB",
    "MO", "RU", "RH", "PD", "AG", "CD", "IN", "SN", "SB", "TE", "XE", "CS", "BA", "LA", "CE", "PR", "SM", "EU", "GD",
    "TB", "YB", "LU", "TA", "RE", "OS", "IR", "PT", "AU", "PB",
];

/// Names of residues that consist only of H, D, C, N, O, S and P: amino acids and their variants in force fields,
/// nucleotides and water. Selenomethionine (MSE) also has selenium.
const RESIDUES: [&str; 73] = [
    "ALA", "ARG", "ASN", "ASP", "ASX", "CYS", "GLN", "GLU", "GLX", "GLY", "HIS", "ILE", "LEU", "LYS", "MET", "PHE",
    "PRO", "SER", "THR", "TRP", "TYR", "VAL", "A", "C", "G", "U", "I", "T", "DA", "DC", "DG", "DT", "DU", "DI", "HOH",
    "DOD", "WAT", "ACE", "HSD", "HSE", "HSP", "HID", "HIE", "HIP", "HSC", "CYX", "CYM", "CYH", "CYP", "CSS", "LYN",
    "LYP", "LSN", "ASH", "GLH", "MSE", "HYP", "SEP", "TPO", "PTR", "NME", "NMA", "CT3", "NH2", "PCA", "ORN", "NLE",
    "ADE", "CYT", "GUA", "THY", "URA", "TIP",
];

/// Names that simulation programs give to ions, and the symbols of their elements.
const IONS: [(&str, &str); 9] = [
    ("SOD", "NA"),
    ("POT", "K"),
    ("CLA", "CL"),
    ("CAL", "CA"),
    ("LIT", "LI"),
    ("RUB", "RB"),
    ("CES", "CS"),
    ("BAR", "BA"),
    ("CAD", "CD"),
];

/// Returns the element of an atom. Most files state the element in columns 77 and 78. Other files have a line number or
/// nothing in these columns. The element then follows from the atom's name in columns 13 to 16.
fn element_of(line: &[u8], are_left: bool) -> Element {
    let symbol = text(columns(line, 77, 78));
    if !symbol.is_empty() && symbol.bytes().all(|byte| byte.is_ascii_alphabetic()) {
        return listed_element(symbol);
    }
    let name: Vec<u8> = line.iter().skip(12).take(4).map(u8::to_ascii_uppercase).collect();
    let residue = text(columns(line, 18, 20)).to_ascii_uppercase();
    listed_element(symbol_of_name(text(&name), &residue, are_left))
}

fn listed_element(symbol: &str) -> Element {
    let element = ELEMENTS.iter().find(|e| e.symbol.eq_ignore_ascii_case(symbol));
    element.copied().unwrap_or(OTHER)
}

/// Returns the symbol of the element in an atom's name of four columns. The symbol is right-aligned in the first two
/// columns, unless the name fills all four or all names of the file begin in the first column (`are_left`).
fn symbol_of_name<'n>(name: &'n str, residue: &str, are_left: bool) -> &'n str {
    if let Some((_, symbol)) = IONS.iter().find(|(ion, _)| *ion == name.trim() && *ion == residue) {
        return symbol;
    }
    // An ion may have its charge in its name, as in ZN2 and CL-.
    let residue = residue.trim_end_matches(|c: char| !c.is_ascii_alphabetic());
    let letters = name.trim().trim_start_matches(|c: char| c.is_ascii_digit());
    let first = letters.get(..1).unwrap_or_default();
    let symbol = letters.get(..2).filter(|two| two.bytes().all(|byte| byte.is_ascii_alphabetic()));
    let is_single = matches!(first, "H" | "D" | "B" | "C" | "N" | "O" | "F" | "P" | "S" | "K" | "I");
    match symbol {
        None => first,
        // An ion forms a residue of its own, with the same name or with that of the ion.
        Some(two) if two == residue || IONS.contains(&(residue, two)) => two,
        Some("SE") if residue == "MSE" => "SE",
        _ if RESIDUES.contains(&residue) => first,
        Some(two @ ("CL" | "BR" | "FE")) => two,
        // Column 13 is empty or holds the number of a hydrogen, so the symbol has one letter.
        _ if is_single && !name.starts_with(|c: char| c.is_ascii_alphabetic()) => first,
        // Greek letters of positions (A, B, G, D, E, Z, H) make no elements with C, N and O in such a file.
        Some(two) if are_left && is_position(two) => first,
        _ if matches!(first, "H" | "D") => first,
        Some(two) if name.trim().len() == 4 && is_single && !matches!(two, "SE" | "SI") => first,
        Some(two) if ELEMENTS.iter().any(|e| e.symbol == two) || OTHER_SYMBOLS.contains(&two) => two,
        _ => first,
    }
}

fn is_position(two: &str) -> bool {
    matches!(two.as_bytes(), [b'C' | b'N' | b'O', b'A' | b'B' | b'G' | b'D' | b'E' | b'Z' | b'H'])
}

/// Returns the text in columns `first` to `last` without white space around it. The result is empty if the line ends
/// before these columns.
fn columns(line: &[u8], first: usize, last: usize) -> &[u8] {
    let end = last.min(line.len());
    line.get(first - 1..end).unwrap_or_default().trim_ascii()
}
