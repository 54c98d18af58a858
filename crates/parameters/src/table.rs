//! Tables as their users see them: by name, without knowing which table it is.

use crate::{ParameterError, ParameterInfo, Value};

/// A number of a table: what is known of it, and its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Name, unit, standing, range, limits and source.
    pub info: &'static ParameterInfo,
    /// The value that the table holds now.
    pub value: Value,
}

impl Entry {
    /// Whether the sources allow the value.
    #[must_use]
    pub fn is_in_range(&self) -> bool {
        let (low, high) = self.info.range;
        (low..=high).contains(&self.value)
    }

    /// Whether the model can take the value.
    #[must_use]
    pub fn is_within_limits(&self) -> bool {
        let (least, most) = self.info.limits;
        (least..=most).contains(&self.value)
    }
}

/// A table made by [`parameter_table!`](crate::parameter_table); a machine can hold many as `&dyn ParameterTable`.
pub trait ParameterTable {
    /// What is known of each number, in order. Without a table at hand, its type has the same as `INFOS`.
    fn infos(&self) -> &'static [ParameterInfo];

    /// The value of a parameter.
    ///
    /// # Errors
    ///
    /// [`ParameterError::Unknown`] when no parameter has this name.
    fn get(&self, name: &str) -> Result<Value, ParameterError>;

    /// Changes a parameter, whatever its range and limits: see [`ParameterTable::check`].
    ///
    /// # Errors
    ///
    /// [`ParameterError::Unknown`] when no parameter has this name, [`ParameterError::NotWhole`] when the field holds
    /// whole numbers and the value is none.
    fn set(&mut self, name: &str, value: Value) -> Result<(), ParameterError>;

    /// All numbers with their values, in order.
    fn entries(&self) -> Vec<Entry> {
        self.infos().iter().filter_map(|info| Some(Entry { info, value: self.get(info.name).ok()? })).collect()
    }

    /// The numbers whose values no source allows: what an experiment supposes.
    fn out_of_range(&self) -> Vec<Entry> {
        self.entries().into_iter().filter(|entry| !entry.is_in_range()).collect()
    }

    /// Checks every number against the limits of the model.
    ///
    /// # Errors
    ///
    /// [`ParameterError::OutOfLimits`] for the first number that is beyond its own.
    fn check(&self) -> Result<(), ParameterError> {
        for info in self.infos() {
            let value = self.get(info.name)?;
            if !(Entry { info, value }).is_within_limits() {
                return Err(ParameterError::OutOfLimits { name: info.name, limits: info.limits, found: value });
            }
        }
        Ok(())
    }
}
