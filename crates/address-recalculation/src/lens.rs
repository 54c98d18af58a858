//! The lens and the table of viewing vectors of all pixels.

use crate::face::Vector;
use pxpl5_sim::parameters::{FileError, FileErrorKind, SettingError};
use std::fmt;
use std::io::BufRead;
use std::str::FromStr;
use std::sync::Arc;

/// Widest angle of a flat picture or a radial lens, in degrees. All displays with flat pictures have the same limit.
const WIDEST_FLAT_DEG: f64 = 170.0;

/// The distortion of the lens in front of a display.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Lens {
    /// No lens distortion: the pixels lie on a plane.
    #[default]
    Flat,
    /// A radial polynomial that multiplies the distance rho from the middle by 1 + k1 rho^2 + k2 rho^4.
    ///
    /// rho is 1 at the left and right ends of the middle line.
    Radial { k1: f64, k2: f64 },
    /// A lens for which the viewing angle is proportional to the distance from the middle. Pictures can be up to 360
    /// degrees wide.
    Equidistant,
    /// Viewing vectors from a file, in row order (see [`Lens::read`]).
    Table(Arc<[Vector]>),
}

/// The size and the horizontal angle of the picture behind a [`Lens`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensPicture {
    pub width: u32,
    pub height: u32,
    /// Angle between the left and the right edge of the picture if there is no lens, in degrees.
    pub horizontal_deg: f64,
}

impl LensPicture {
    /// Returns the offset of a pixel's middle from the picture's middle, in pixels to the right and downwards.
    fn offset(&self, x: u32, y: u32) -> [f64; 2] {
        [f64::from(x) + 0.5 - f64::from(self.width) / 2.0, f64::from(y) + 0.5 - f64::from(self.height) / 2.0]
    }

    /// Returns the tangent of half the horizontal viewing angle.
    fn tangent(&self) -> f64 {
        libm::tan(self.horizontal_deg.to_radians() / 2.0)
    }

    /// Returns the squared distance of a pixel from the middle. The unit is the distance from the picture's middle to
    /// the left or right end of the middle line.
    fn rho_squared(&self, x: u32, y: u32) -> f64 {
        let [right, down] = self.offset(x, y).map(|p| p / (f64::from(self.width) / 2.0));
        right * right + down * down
    }
}

impl fmt::Display for Lens {
    /// Writes the text that `FromStr` parses. A lens that is defined by a table has no such text and is written as
    /// `table`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flat => f.write_str("flat"),
            Self::Radial { k1, k2 } => write!(f, "radial:{k1}:{k2}"),
            Self::Equidistant => f.write_str("equidistant"),
            Self::Table(_) => f.write_str("table"),
        }
    }
}

impl FromStr for Lens {
    type Err = SettingError;

    /// Parses `flat`, `equidistant`, `radial:K1` or `radial:K1:K2`. Only [`Lens::check`] tests if a lens suits a
    /// picture.
    fn from_str(text: &str) -> Result<Self, SettingError> {
        let wrong = || wrong_lens(Self::FORMS, excerpt(text));
        let mut parts = text.split(':');
        let name = parts.next();
        // All parts after the name must be numbers.
        let numbers: Vec<f64> = parts.map(str::parse).collect::<Result<_, _>>().map_err(|_| wrong())?;
        match (name, numbers.as_slice()) {
            (Some("flat"), []) => Ok(Self::Flat),
            (Some("equidistant"), []) => Ok(Self::Equidistant),
            (Some("radial"), [k1]) => Ok(Self::Radial { k1: *k1, k2: 0.0 }),
            (Some("radial"), [k1, k2]) => Ok(Self::Radial { k1: *k1, k2: *k2 }),
            _ => Err(wrong()),
        }
    }
}

impl Lens {
    /// The forms in which a lens can be written as text.
    pub const FORMS: &str = "flat, equidistant, radial:K1 or radial:K1:K2";

    /// Checks that no two pixels use the same point of the lens, and that the lens is suitable for the picture's
    /// viewing angle.
    ///
    /// # Errors
    ///
    /// [`SettingError`] describes the expected and the found value.
    pub fn check(&self, picture: &LensPicture) -> Result<(), SettingError> {
        let widest = if matches!(self, Self::Flat | Self::Radial { .. }) { WIDEST_FLAT_DEG } else { 360.0 };
        let angle = picture.horizontal_deg;
        if !(angle > 0.0 && angle <= widest) {
            let expected = format!("a horizontal angle above 0 and up to {widest} deg");
            return Err(wrong_lens(expected, format_args!("{angle} deg")));
        }
        match self {
            Self::Radial { k1, k2 } => check_radial(*k1, *k2, picture.rho_squared(0, 0)),
            Self::Table(vectors) => check_table(vectors, picture),
            Self::Flat | Self::Equidistant => Ok(()),
        }
    }

    /// Returns the viewing vector of a pixel in head axes. The vector does not have unit length.
    ///
    /// x points right and y up. The head looks along -z.
    pub fn view(&self, picture: &LensPicture, x: u32, y: u32) -> Vector {
        let [right, down] = picture.offset(x, y);
        // At this distance in pixels, the picture's width covers its angle of view.
        let focal = f64::from(picture.width) / 2.0 / picture.tangent();
        match self {
            Self::Flat => [right / focal, -down / focal, -1.0],
            Self::Radial { k1, k2 } => {
                let square = picture.rho_squared(x, y);
                let stretch = 1.0 + k1 * square + k2 * square * square;
                [stretch * right / focal, -stretch * down / focal, -1.0]
            }
            Self::Equidistant => equidistant([right, down], picture),
            Self::Table(vectors) => {
                let place = y as usize * picture.width as usize + x as usize;
                vectors.get(place).copied().unwrap_or([0.0, 0.0, -1.0])
            }
        }
    }

    /// Reads a table of viewing vectors for a picture.
    ///
    /// The file has one line of text per pixel, in row order, with x, y and z separated by spaces. Empty lines and
    /// lines that begin with `#` are skipped. Vectors may have any length.
    ///
    /// # Errors
    ///
    /// [`FileError`] names the line, the expected and the found content.
    pub fn read(reader: impl BufRead, picture: &LensPicture) -> Result<Self, FileError> {
        let wanted = picture.width as usize * picture.height as usize;
        let mut vectors = Vec::new();
        let mut last = 0;
        for (number, line) in (1..).zip(reader.lines()) {
            last = number;
            let wrong = |expected: &str, found: String| wrong_table(number, expected, found);
            // Skip empty lines and comments.
            let line = line.map_err(|error| wrong("text in UTF-8", error.to_string()))?;
            if line.trim().is_empty() || line.trim_start().starts_with('#') {
                continue;
            }
            // Refuse surplus lines before their content is parsed.
            if vectors.len() == wanted {
                return Err(wrong(&format!("nothing after {wanted} vectors"), excerpt(&line)));
            }
            let vector =
                vector_of(&line).ok_or_else(|| wrong("three numbers, finite and not all 0", excerpt(&line)))?;
            vectors.push(vector);
        }
        if vectors.len() < wanted {
            let expected = format!("{wanted} vectors, one for each pixel");
            return Err(wrong_table(last + 1, &expected, format_args!("{} vectors", vectors.len())));
        }
        Ok(Self::Table(vectors.into()))
    }
}

fn wrong_lens(expected: impl fmt::Display, found: impl fmt::Display) -> SettingError {
    SettingError::value("arp.lens", expected, found)
}

/// Returns the error for line `line` of a file of viewing vectors. Lines are counted from 1. If data are missing,
/// `line` is the number of lines plus 1.
fn wrong_table(line: usize, expected: &str, found: impl fmt::Display) -> FileError {
    FileError::new(FileErrorKind::Syntax, expected, found).at(format_args!("arp.lens table, line {line}"))
}

/// Returns the first 40 characters of a line, to keep error messages short.
fn excerpt(line: &str) -> String {
    line.chars().take(40).collect()
}

fn vector_of(line: &str) -> Option<Vector> {
    let numbers = line.split_whitespace().map(|word| word.parse().ok());
    let numbers: Vec<f64> = numbers.collect::<Option<_>>()?;
    let vector: Vector = numbers.try_into().ok()?;
    is_direction(vector).then_some(vector)
}

/// Returns true if a vector's squared length is finite and not zero.
fn is_direction(vector: Vector) -> bool {
    let square: f64 = vector.iter().map(|component| component * component).sum();
    square.is_normal()
}

fn check_table(vectors: &[Vector], picture: &LensPicture) -> Result<(), SettingError> {
    let wanted = picture.width as usize * picture.height as usize;
    if vectors.len() != wanted {
        let expected = format!("{wanted} vectors for {} x {} pixels", picture.width, picture.height);
        return Err(wrong_lens(expected, format_args!("{} vectors", vectors.len())));
    }
    match vectors.iter().position(|vector| !is_direction(*vector)) {
        Some(place) => {
            let found = format!("{:?} as vector {place}", vectors[place]);
            Err(wrong_lens("vectors that are finite and not all 0", found))
        }
        None => Ok(()),
    }
}

/// Checks that the lens does not fold the picture. The slope of rho (1 + k1 rho^2 + k2 rho^4) must be positive up to
/// the corner of the picture.
fn check_radial(k1: f64, k2: f64, corner: f64) -> Result<(), SettingError> {
    let slope = |square: f64| 1.0 + 3.0 * k1 * square + 5.0 * k2 * square * square;
    let turn = -3.0 * k1 / (10.0 * k2);
    let inside = if turn > 0.0 && turn < corner { slope(turn) } else { 1.0 };
    let least = inside.min(slope(corner));
    if k1.is_finite() && k2.is_finite() && least > 0.0 {
        return Ok(());
    }
    let expected = "1 + 3 k1 rho^2 + 5 k2 rho^4 above 0 up to the corner pixel";
    Err(wrong_lens(expected, format_args!("{least} for k1 {k1}, k2 {k2}")))
}

fn equidistant(from_middle: [f64; 2], picture: &LensPicture) -> Vector {
    let half = f64::from(picture.width) / 2.0;
    let [right, down] = from_middle.map(|p| p / half);
    let distance = libm::hypot(right, down);
    if distance == 0.0 {
        return [0.0, 0.0, -1.0];
    }
    let angle = distance * picture.horizontal_deg.to_radians() / 2.0;
    let sine = libm::sin(angle);
    [sine * right / distance, -sine * down / distance, -libm::cos(angle)]
}

/// Table of viewing vectors in hardware words. Each pixel has a unit vector in signed words, and the largest word
/// represents 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LensTable {
    width: u32,
    height: u32,
    /// Components of all viewing vectors in row order, separately for x, y and z.
    words: [Vec<i32>; 3],
}

impl LensTable {
    /// Creates the table of a lens and a picture, in words of `vector_bits` bits.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Lens::check`].
    pub fn new(lens: &Lens, picture: &LensPicture, vector_bits: u64) -> Result<Self, SettingError> {
        lens.check(picture)?;
        Ok(Self::of_checked(lens, picture, vector_bits))
    }

    pub(crate) fn of_checked(lens: &Lens, picture: &LensPicture, vector_bits: u64) -> Self {
        let mut words = [Vec::new(), Vec::new(), Vec::new()];
        for y in 0..picture.height {
            for x in 0..picture.width {
                let entry = unit_words(lens.view(picture, x, y), vector_bits);
                for (column, word) in words.iter_mut().zip(entry) {
                    column.push(word);
                }
            }
        }
        Self { width: picture.width, height: picture.height, words }
    }

    pub const fn width(&self) -> u32 {
        self.width
    }

    pub const fn height(&self) -> u32 {
        self.height
    }

    /// Returns the three words of a pixel's viewing vector.
    ///
    /// # Panics
    ///
    /// Panics if the pixel is outside the picture.
    pub fn entry(&self, x: u32, y: u32) -> [i32; 3] {
        let place = y as usize * self.width as usize + x as usize;
        [0, 1, 2].map(|axis| self.words[axis][place])
    }

    /// Returns the viewing vectors of consecutive pixels, as signed words: one list for each axis.
    pub(crate) fn run(&self, first: usize, count: usize) -> [&[i32]; 3] {
        [0, 1, 2].map(|axis| &self.words[axis][first..first + count])
    }
}

/// Normalizes a vector and converts it to signed words of `bits` bits. Halves are rounded to even.
pub(crate) fn unit_words(vector: Vector, bits: u64) -> [i32; 3] {
    let length = libm::sqrt(vector.iter().map(|component| component * component).sum());
    vector.map(|component| signed_word(component / length, bits))
}

/// Converts a number from -1 to 1 to a signed word of `bits` bits. The largest word represents 1, and halves are
/// rounded to even.
pub(crate) fn signed_word(value: f64, bits: u64) -> i32 {
    let largest = f64::from((1_i32 << (bits - 1)) - 1);
    (value * largest).round_ties_even().clamp(-largest, largest) as i32
}
