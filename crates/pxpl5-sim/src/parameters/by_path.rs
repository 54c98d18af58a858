//! Access to the parameters of several tables, and to named choices, by path.

use crate::parameters::{Entry, ParameterInfo, ParameterTable, SettingError, Value, find_named, unknown_parameter};
use serde::Serialize;

/// A parameter of one of several tables: path, metadata and value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// Prefix of the table and name of the parameter, such as `ring.word_ns`.
    pub path: String,
    /// Unit, provenance, range and source of the parameter.
    #[serde(flatten)]
    pub info: ParameterInfo,
    /// Value in the unit that the table states.
    pub value: Value,
    /// True if the parameter is a fixed property, such as a property of a chip. Programs cannot change the value.
    pub read_only: bool,
}

impl Parameter {
    /// Returns the parameters of one table. Paths begin with `prefix`, and `read_only` states if all these parameters
    /// are fixed.
    pub fn of_table(prefix: &str, table: &dyn ParameterTable, read_only: bool) -> impl Iterator<Item = Self> {
        table.entries().into_iter().map(move |Entry { info, value }| {
            let path = format!("{prefix}.{}", info.name);
            Self { path, info: *info, value, read_only }
        })
    }

    /// Returns true if the value lies within the range that the parameter's table derives from sources.
    pub fn is_in_range(&self) -> bool {
        let (low, high) = self.info.range;
        (low..=high).contains(&self.value)
    }

    /// Returns a warning that the value is out of range. The text contains the range and its source.
    pub fn warning(&self) -> String {
        let Self { path, info, value, .. } = self;
        let (low, high) = info.range;
        let unit = info.unit;
        format!(
            "{path} = {value} {unit} is outside its range, {low} to {high} {unit} ({}: {})",
            info.provenance, info.source
        )
    }
}

/// A table of parameters with the first part of their paths. The first part can contain dots itself.
pub type PathTable<'a> = (&'static str, &'a dyn ParameterTable);

/// A table of parameters that can be changed, with the first part of their paths.
pub type PathTableMut<'a> = (&'static str, &'a mut dyn ParameterTable);

/// Finds the parameter at a path such as `ring.word_ns`. Returns the first part of the path, the table, and the name of
/// the parameter. Returns `None` if no table has the parameter.
pub fn table_at<'a, 'p>(
    tables: impl IntoIterator<Item = PathTableMut<'a>>,
    path: &'p str,
) -> Option<(&'static str, &'a mut dyn ParameterTable, &'p str)> {
    let (prefix, name) = path.rsplit_once('.')?;
    let has = |table: &dyn ParameterTable| table.infos().iter().any(|info| info.name == name);
    tables.into_iter().find(|(own, table)| *own == prefix && has(*table)).map(|(own, table)| (own, table, name))
}

/// A setting that is not a number in a table of parameters, such as a choice among names.
pub struct Choice<S> {
    pub path: &'static str,
    /// Sets the setting to the value that a text denotes. The error states the expected texts.
    pub set: fn(&mut S, &str) -> Result<(), SettingError>,
}

/// Sets a choice to the value that has the name `text` in a list of names and values.
///
/// # Errors
///
/// Returns a [`SettingError`] with the most similar name and all valid names.
pub fn choose<T: Copy>(field: &mut T, all: &[(&'static str, T)], text: &str) -> Result<(), SettingError> {
    *field = find_named("value", text, all.iter().copied())?;
    Ok(())
}

/// Settings that users change with texts such as `screen.lines = 480`. The settings are the numbers of tables and a
/// list of choices.
///
/// ```
/// use pxpl5_sim::parameters::{Choice, PathSettings, choose};
///
/// pxpl5_sim::parameters::parameter_table! {
///     /// A screen.
///     pub struct Screen {
///         /// Number of lines.
///         lines: 240, "lines", Published, 240..=240 in 1..=4096, "NTSC";
///     }
/// }
///
/// struct Picture { screen: Screen, is_lit: bool }
///
/// impl PathSettings for Picture {
///     const CHOICES: &'static [Choice<Self>] =
///         &[Choice { path: "lit", set: |all, text| choose(&mut all.is_lit, &[("on", true), ("off", false)], text) }];
///
///     pxpl5_sim::parameters::tables_at! { "screen": screen }
/// }
///
/// let mut picture = Picture { screen: Screen::PAPERS, is_lit: true };
/// picture.assign("screen.lines = 480", "--set")?;
/// picture.set("lit", "off", "--lit")?;
/// assert_eq!((picture.screen.lines, picture.is_lit), (480, false));
/// let error = picture.set("screen.line", "1", "--set").expect_err("no such path");
/// assert_eq!(error.to_string(), "--set: there is no key `screen.line`; did you mean `screen.lines`?");
/// let error = picture.set("screen.lines", "0", "--set").expect_err("too few");
/// assert_eq!(error.to_string(), "--set: screen.lines: expected a whole number of 1 to 4096 lines, found 0");
/// let error = picture.set("lit", "of", "--set").expect_err("no such name");
/// assert_eq!(error.to_string(), "--set: lit: expected off or on, found `of`");
/// # Ok::<(), pxpl5_sim::parameters::SettingError>(())
/// ```
pub trait PathSettings: Sized + 'static {
    /// Settings that are not numbers in a table of parameters, such as choices among names.
    const CHOICES: &'static [Choice<Self>];

    /// Returns all tables of parameters, each with the first part of their paths.
    fn tables(&self) -> Vec<PathTable<'_>>;

    /// Returns the same tables as [`PathSettings::tables`], with mutable access.
    fn tables_mut(&mut self) -> Vec<PathTableMut<'_>>;

    /// Is called after a text has changed the setting at `_path`.
    fn was_set(&mut self, _path: &str, _text: &str) {}

    /// Returns all numbers with their paths and current values.
    fn numbers(&self) -> Vec<Parameter> {
        self.tables().into_iter().flat_map(|(prefix, table)| Parameter::of_table(prefix, table, false)).collect()
    }

    /// Returns all paths that [`PathSettings::set`] accepts.
    fn keys(&self) -> Vec<String> {
        let numbers = self.numbers().into_iter().map(|number| number.path);
        Self::CHOICES.iter().map(|choice| choice.path.to_owned()).chain(numbers).collect()
    }

    /// Returns a warning for each number outside the range that its sources allow.
    fn warnings(&self) -> Vec<String> {
        self.numbers().iter().filter(|number| !number.is_in_range()).map(Parameter::warning).collect()
    }

    /// Sets the setting at a path to the value that a text denotes. Errors name `place`, the source of the text, such
    /// as `--set`.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] with the most similar path, or with the allowed values.
    fn set(&mut self, path: &str, text: &str, place: &str) -> Result<(), SettingError> {
        let done = match Self::CHOICES.iter().find(|choice| choice.path == path) {
            // If the option has the name of the path, the message already states the path.
            Some(choice) if place.strip_prefix("--") == Some(path) => (choice.set)(self, text),
            Some(choice) => (choice.set)(self, text).map_err(|error| error.at(path)),
            None => match table_at(self.tables_mut(), path) {
                Some((_, table, name)) => set_number(table, name, path, text),
                None => Err(SettingError::unknown_path("key", path, self.keys())),
            },
        };
        done.map_err(|error| error.at(place))?;
        self.was_set(path, text);
        Ok(())
    }

    /// Applies an assignment `path=value`, as after `--set`.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`PathSettings::set`], and for a text without an equals sign.
    fn assign(&mut self, assignment: &str, place: &str) -> Result<(), SettingError> {
        let (path, text) = assignment_of(assignment, place)?;
        self.set(path, text, place)
    }
}

/// Splits an assignment `path=value` into path and value.
///
/// # Errors
///
/// Returns a [`SettingError`] for a text without an equals sign.
pub fn assignment_of<'a>(assignment: &'a str, place: &str) -> Result<(&'a str, &'a str), SettingError> {
    let parts = assignment.split_once('=').map(|(path, text)| (path.trim(), text.trim()));
    parts.ok_or_else(|| SettingError::value("PATH=VALUE", "an equals sign", assignment).at(place))
}

fn set_number(table: &mut dyn ParameterTable, name: &str, path: &str, text: &str) -> Result<(), SettingError> {
    let Some(entry) = table.entries().into_iter().find(|entry| entry.info.name == name) else {
        return Err(unknown_parameter(name, table.infos()));
    };
    let expected = || SettingError::value(path, entry.info.expected(), text);
    // A whole number is also valid for a real setting, but not the reverse.
    let is_real = matches!(entry.value, Value::Real(_));
    let real = || text.parse::<f64>().ok().map(Value::Real);
    let whole = || text.parse().ok().or_else(|| real()?.whole()).map(Value::Whole);
    let value = if is_real { real() } else { whole() };
    let value = value.filter(|value| Entry { value: *value, ..entry }.is_within_limits()).ok_or_else(expected)?;
    table.set(name, value).map_err(|_| expected())
}

/// Defines [`PathSettings::tables`] and [`PathSettings::tables_mut`] for fields that are tables of parameters. The list
/// has the first part of the parameters' paths before each field, as in `"screen": screen`.
#[macro_export]
macro_rules! tables_at {
    ($($prefix:literal : $($field:ident).+),+ $(,)?) => {
        fn tables(&self) -> ::std::vec::Vec<$crate::parameters::PathTable<'_>> {
            ::std::vec![$(($prefix, &self.$($field).+ as &dyn $crate::parameters::ParameterTable)),+]
        }

        fn tables_mut(&mut self) -> ::std::vec::Vec<$crate::parameters::PathTableMut<'_>> {
            ::std::vec![$(($prefix, &mut self.$($field).+ as &mut dyn $crate::parameters::ParameterTable)),+]
        }
    };
}
