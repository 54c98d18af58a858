use pxpl5_sim::parameters::{FileError, FileErrorKind, SettingError};
use std::fmt::{self, Display};
use std::str::FromStr;

const EXPECTED: &str = "t (or t_ms, t_us, t_ns), x, y, z (or x_cm, x_mm and so on), qw, qx, qy and qz, each with the name or number of a column";

/// A mapping from the quantities of a sample to the columns of a text file. A column is given by its name in the header
/// or by its number from 1.
///
/// The name of a quantity states its unit. `t` is in seconds, and `t_ms`, `t_us` and `t_ns` are in milliseconds,
/// microseconds and nanoseconds. `x`, `y` and `z` are in metres, `x_cm` and so on in centimetres, and `x_mm` and so on in
/// millimetres. `qw`, `qx`, `qy` and `qz` form the quaternion that rotates head axes into world axes, with real part
/// `qw`. A minus before a column, as in `z=-pz`, changes the sign of its numbers. Left-handed logs need such signs.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Columns {
    /// Mapped quantities with their columns, in the order in which the user gave them.
    given: Vec<(&'static Field, String)>,
}

#[derive(Debug, PartialEq, Eq)]
pub(super) struct Field {
    name: &'static str,
    /// Index of the quantity in the list (time, x, y, z, qw, qx, qy, qz), counted from 0.
    slot: usize,
    /// Number of decimal places of the unit: the unit is 10^-`places` seconds or metres.
    places: i32,
}

const fn field(name: &'static str, slot: usize, places: i32) -> Field {
    Field { name, slot, places }
}

static FIELDS: [Field; 17] = [
    field("t", 0, 0),
    field("t_ms", 0, 3),
    field("t_us", 0, 6),
    field("t_ns", 0, 9),
    field("x", 1, 0),
    field("y", 2, 0),
    field("z", 3, 0),
    field("x_cm", 1, 2),
    field("y_cm", 2, 2),
    field("z_cm", 3, 2),
    field("x_mm", 1, 3),
    field("y_mm", 2, 3),
    field("z_mm", 3, 3),
    field("qw", 4, 0),
    field("qx", 5, 0),
    field("qy", 6, 0),
    field("qz", 7, 0),
];

/// A column of a file. The unit of its numbers is 10^-`places` seconds or metres.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Column {
    pub(super) index: usize,
    pub(super) name: String,
    pub(super) places: i32,
    /// True if the numbers of the file have the opposite sign.
    pub(super) is_negated: bool,
}

impl Columns {
    /// Returns the names of all quantities that [`Self::map`] accepts.
    pub fn fields() -> impl Iterator<Item = &'static str> {
        FIELDS.iter().map(|field| field.name)
    }

    /// Assigns a column of the file to a quantity. `field` is the name of the quantity, and `column` the name or number
    /// of the column.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the quantity is unknown or already has a column.
    pub fn map(&mut self, field: &str, column: &str) -> Result<(), SettingError> {
        let mapping = |found: String| SettingError::value("columns", EXPECTED, found);
        let entry = FIELDS.iter().find(|entry| entry.name == field);
        let entry = entry.ok_or_else(|| mapping(format!("`{field}`")))?;
        if let Some((other, _)) = self.given.iter().find(|(other, _)| other.slot == entry.slot) {
            return Err(mapping(format!("{} and {field}", other.name)));
        }
        self.given.push((entry, column.trim().to_owned()));
        Ok(())
    }

    /// Parses a mapping of quantities to columns such as `t_ns=stamp,x=px,y=py`.
    pub fn parse(text: &str) -> Result<Self, SettingError> {
        let mut columns = Self::default();
        for part in text.split(',') {
            let mapping = || SettingError::value("columns", EXPECTED, format_args!("`{}`", part.trim()));
            let (field, column) = part.split_once('=').ok_or_else(mapping)?;
            columns.map(field.trim(), column)?;
        }
        Ok(columns)
    }

    /// Returns the names of the mapped quantities with their columns, in the order in which the user gave them.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, &str)> {
        self.given.iter().map(|(field, column)| (field.name, column.as_str()))
    }

    /// Returns true if no quantity is mapped to a column.
    pub fn is_empty(&self) -> bool {
        self.given.is_empty()
    }

    /// Returns true if every column is given by its number. The file then needs no header.
    pub(super) fn are_numbers(&self) -> bool {
        self.given.iter().all(|(_, column)| number(column.trim_start_matches('-')).is_some())
    }

    /// Returns the mapped columns of a file with the header `header`, in the order time, x, y, z, qw, qx, qy, qz. An
    /// empty `header` means that the file has no header.
    pub(super) fn in_header(&self, line: u64, header: &[&str]) -> Result<[Column; 8], FileError> {
        // Find each mapped column by its name in the header, or by its number.
        let mut found: [Option<Column>; 8] = Default::default();
        for (field, wanted) in &self.given {
            let index_of = |wanted: &str| header.iter().position(|name| *name == wanted).or_else(|| number(wanted));
            let opposite = || Some((index_of(wanted.strip_prefix('-')?.trim_start())?, true));
            let (index, is_negated) =
                index_of(wanted).map(|index| (index, false)).or_else(opposite).ok_or_else(|| {
                    let expected = format!("a column `{wanted}` for {}", field.name);
                    of_line(line, expected, header.join(", "))
                })?;
            found[field.slot] = Some(Column { index, name: wanted.clone(), places: field.places, is_negated });
        }
        // Every value of a sample needs a column. Without a column for a value, the mapping is incomplete.
        let all: Vec<Column> = found.into_iter().flatten().collect();
        all.try_into().map_err(|_| FileError::new(FileErrorKind::Syntax, EXPECTED, self).at("columns"))
    }
}

pub(super) fn of_line(line: u64, expected: impl Display, found: impl Display) -> FileError {
    FileError::new(FileErrorKind::Syntax, expected, found).at(format_args!("line {line}"))
}

/// Parses a column number that counts from 1, and returns the index that counts from 0.
fn number(column: &str) -> Option<usize> {
    column.parse::<usize>().ok()?.checked_sub(1)
}

impl FromStr for Columns {
    type Err = SettingError;

    fn from_str(text: &str) -> Result<Self, SettingError> {
        Self::parse(text)
    }
}

impl fmt::Display for Columns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, (field, column)) in self.given.iter().enumerate() {
            let comma = if i == 0 { "" } else { "," };
            write!(f, "{comma}{}={column}", field.name)?;
        }
        Ok(())
    }
}
