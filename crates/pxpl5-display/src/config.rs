//! What a display is built of.

use crate::Display;
use parameters::ParameterTable;
use pxpl5_wire::NodeId;
use std::any::Any;
use std::fmt::Debug;

/// The numbers of a display, and how one is built of them.
pub trait DisplayConfig: Any + Debug + Send + Sync {
    /// Name of its kind, as in `--display`.
    fn name(&self) -> &'static str;

    /// What it is and where it was published.
    fn about(&self) -> &'static str;

    /// Its tables of numbers, each with the first part of their paths, such as `video` in `video.frame_lines`.
    fn tables(&self) -> Vec<(&'static str, &dyn ParameterTable)>;

    /// The same tables, to change numbers in.
    fn tables_mut(&mut self) -> Vec<(&'static str, &mut dyn ParameterTable)>;

    /// Ring ports that it has when a pipeline draws so many pictures at a time (1, or 2 for two eyes): one for
    /// each, unless said.
    fn ports(&self, pictures: usize) -> usize {
        pictures
    }

    /// Checks that it can be built: every number against the limits of its table, unless there are more rules.
    ///
    /// # Errors
    ///
    /// [`DisplayError`] names the number, what was expected and what was found.
    fn check(&self) -> Result<(), DisplayError> {
        let mut tables = self.tables().into_iter();
        tables.try_for_each(|(name, table)| table.check().map_err(|error| DisplayError(format!("{name}.{error}"))))
    }

    /// Builds it at as many ports of the ring as [`DisplayConfig::ports`] said.
    ///
    /// # Errors
    ///
    /// As [`DisplayConfig::check`].
    fn build(&self, nodes: &[NodeId]) -> Result<Box<dyn Display>, DisplayError>;

    /// A copy of the numbers.
    fn boxed(&self) -> Box<dyn DisplayConfig>;

    /// Has it remember so many past periods, where it remembers any; 2 unless said.
    fn remember(&mut self, _periods: u64) {}

    /// Tells it what is to be seen where nothing is drawn, 0x00RRGGBB; without effect where pictures hold their own background.
    fn show_behind_all(&mut self, _background: u32) {}

    /// Whether it shows faces of a cube around the head, with depth, instead of pictures of what an eye sees.
    fn takes_faces(&self) -> bool {
        false
    }

    /// Whether two displays are of one kind and of the same numbers.
    fn equals(&self, other: &dyn DisplayConfig) -> bool {
        self.name() == other.name() && values(self.tables()) == values(other.tables())
    }
}

impl Clone for Box<dyn DisplayConfig> {
    fn clone(&self) -> Self {
        self.boxed()
    }
}

/// The values of all tables, in order.
fn values(tables: Vec<(&'static str, &dyn ParameterTable)>) -> Vec<parameters::Entry> {
    tables.into_iter().flat_map(|(_, table)| table.entries()).collect()
}

/// Why a display cannot be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct DisplayError(
    /// What was expected and what was found, for people.
    pub String,
);
