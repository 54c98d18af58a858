use crate::NodeId;
use crate::display::Display;
use pxpl5_sim::Span;
use pxpl5_sim::parameters::{ParameterTable, SettingError};
use std::any::Any;
use std::fmt::{self, Debug};

/// The directions that a picture shows. A display and its pipeline must have the same coverage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coverage {
    /// A picture shows only the view of one eye in the direction of the head.
    View,
    /// A picture shows all directions around the eye, with depth. At scan-out, the display selects the view by the
    /// newest direction of the head.
    Surroundings,
}

impl fmt::Display for Coverage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::View => "the view of an eye",
            Self::Surroundings => "all directions around the head",
        })
    }
}

/// The parameters of a display, and the function that builds the display from them.
pub trait DisplayConfig: Any + Debug + Send + Sync {
    /// Returns the name of this kind of display, which is the value of the option `--display`.
    fn name(&self) -> &'static str;

    /// Returns a description of the display, with the source of its numbers.
    fn about(&self) -> &'static str;

    /// Returns the parameter tables, each with the prefix of its parameters' paths. An example is `video` in
    /// `video.frame_lines`.
    fn tables(&self) -> Vec<(&'static str, &dyn ParameterTable)>;

    /// Returns the parameter tables for modification, each with the prefix of its parameters' paths.
    fn tables_mut(&mut self) -> Vec<(&'static str, &mut dyn ParameterTable)>;

    /// Returns the number of ring ports that the display needs. `pictures` is the number of pictures that the pipeline
    /// draws at the same time: 1, or 2 for two eyes. The default is one port for each picture.
    fn ports(&self, pictures: usize) -> usize {
        pictures
    }

    /// Checks that the display can be built. The default implementation checks every parameter against the limits in
    /// its table.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] with the name of the parameter, the expected range and the found value.
    fn check(&self) -> Result<(), SettingError> {
        let mut tables = self.tables().into_iter();
        tables.try_for_each(|(name, table)| table.check().map_err(|error| error.in_table(name)))
    }

    /// Builds the display at the ring ports `nodes`. There must be as many ports as [`DisplayConfig::ports`] returns. Each
    /// port receives one word in the ring's word time `word`, because a channel holds the ports of the sender and of the
    /// receiver during a transfer (TR94, F89).
    ///
    /// # Errors
    ///
    /// Returns the errors of [`DisplayConfig::check`].
    fn build(&self, nodes: &[NodeId], word: Span) -> Result<Box<dyn Display>, SettingError>;

    /// Returns a copy of the configuration in a box.
    fn boxed(&self) -> Box<dyn DisplayConfig>;

    /// Sets the number of past periods whose pictures the display keeps. The default is 2. Displays that keep no past
    /// pictures ignore the call.
    fn remember(&mut self, _periods: u64) {}

    /// Sets the background colour 0x00RRGGBB, the colour of pixels where nothing is drawn. Displays whose pictures have
    /// their own background ignore the call.
    fn set_background(&mut self, _background: u32) {}

    /// Returns the directions that a picture for this display shows.
    fn coverage(&self) -> Coverage {
        Coverage::View
    }

    /// Returns true if both configurations describe the same kind of display and have equal parameters.
    fn equals(&self, other: &dyn DisplayConfig) -> bool {
        self.name() == other.name() && values(self.tables()) == values(other.tables())
    }
}

impl Clone for Box<dyn DisplayConfig> {
    fn clone(&self) -> Self {
        self.boxed()
    }
}

fn values(tables: Vec<(&'static str, &dyn ParameterTable)>) -> Vec<pxpl5_sim::parameters::Entry> {
    tables.into_iter().flat_map(|(_, table)| table.entries()).collect()
}
