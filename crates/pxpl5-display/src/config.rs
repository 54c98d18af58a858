//! Configuration of displays.

use crate::Display;
use parameters::ParameterTable;
use pxpl5_wire::NodeId;
use std::any::Any;
use std::fmt::Debug;

/// The numbers of a display, and the function that builds the display from them.
pub trait DisplayConfig: Any + Debug + Send + Sync {
    /// Returns the name of the display's kind, as in `--display`.
    fn name(&self) -> &'static str;

    /// Returns a description of the display with its source.
    fn about(&self) -> &'static str;

    /// Returns the tables of numbers, each with its path prefix, such as `video` in `video.frame_lines`.
    fn tables(&self) -> Vec<(&'static str, &dyn ParameterTable)>;

    /// Returns the tables of numbers for changes, each with its path prefix.
    fn tables_mut(&mut self) -> Vec<(&'static str, &mut dyn ParameterTable)>;

    /// Returns the number of ring ports for a pipeline that draws `pictures` pictures at a time (1, or 2 for two eyes).
    /// The default is one port for each picture.
    fn ports(&self, pictures: usize) -> usize {
        pictures
    }

    /// Checks that the display can be built. The default checks every number against the limits of its table.
    ///
    /// # Errors
    ///
    /// [`DisplayError`] with the name of the number, the expected range and the found value.
    fn check(&self) -> Result<(), DisplayError> {
        let mut tables = self.tables().into_iter();
        tables.try_for_each(|(name, table)| table.check().map_err(|error| DisplayError(format!("{name}.{error}"))))
    }

    /// Builds the display at ring ports `nodes`, whose number [`DisplayConfig::ports`] returns.
    ///
    /// # Errors
    ///
    /// The errors of [`DisplayConfig::check`].
    fn build(&self, nodes: &[NodeId]) -> Result<Box<dyn Display>, DisplayError>;

    /// Returns a boxed copy of the numbers.
    fn boxed(&self) -> Box<dyn DisplayConfig>;

    /// Sets the number of past periods that the display remembers. The default is 2. Displays without memory ignore the
    /// number.
    fn remember(&mut self, _periods: u64) {}

    /// Sets the background colour 0x00RRGGBB of places where nothing is drawn. Displays whose pictures contain their
    /// own background ignore it.
    fn set_background(&mut self, _background: u32) {}

    /// Returns true if the display shows faces of a cube around the head, with depth, instead of pictures of an eye's
    /// view.
    fn shows_cube_faces(&self) -> bool {
        false
    }

    /// Returns true if both displays are of one kind and have the same numbers.
    fn equals(&self, other: &dyn DisplayConfig) -> bool {
        self.name() == other.name() && values(self.tables()) == values(other.tables())
    }
}

impl Clone for Box<dyn DisplayConfig> {
    fn clone(&self) -> Self {
        self.boxed()
    }
}

/// Returns the values of all tables, in order.
fn values(tables: Vec<(&'static str, &dyn ParameterTable)>) -> Vec<parameters::Entry> {
    tables.into_iter().flat_map(|(_, table)| table.entries()).collect()
}

/// The reason why a display cannot be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct DisplayError(
    /// Message with the expected and the found value.
    pub String,
);
