//! Access to tables by name, without their types.

use crate::{ParameterError, ParameterInfo, Value};

/// A number of a table with its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Name, unit, provenance, range, limits and source.
    pub info: &'static ParameterInfo,
    /// Current value in the table.
    pub value: Value,
}

impl Entry {
    /// Returns true if the sources allow the value.
    #[must_use]
    pub fn is_in_range(&self) -> bool {
        let (low, high) = self.info.range;
        (low..=high).contains(&self.value)
    }

    /// Returns true if the model can use the value.
    #[must_use]
    pub fn is_within_limits(&self) -> bool {
        let (least, most) = self.info.limits;
        (least..=most).contains(&self.value)
    }
}

/// A table made by [`parameter_table!`](crate::parameter_table). A machine can hold many as `&dyn ParameterTable`.
pub trait ParameterTable {
    /// Returns unit, provenance, range and source of each number, in order. The constant `INFOS` of the table's type
    /// has the same contents.
    fn infos(&self) -> &'static [ParameterInfo];

    /// Returns the value of a parameter.
    ///
    /// # Errors
    ///
    /// [`ParameterError::Unknown`] if no parameter has this name.
    fn get(&self, name: &str) -> Result<Value, ParameterError>;

    /// Changes a parameter without a check of range and limits: see [`ParameterTable::check`].
    ///
    /// # Errors
    ///
    /// [`ParameterError::Unknown`] if no parameter has this name. [`ParameterError::NotWhole`] if the field holds whole
    /// numbers and the value is not whole.
    fn set(&mut self, name: &str, value: Value) -> Result<(), ParameterError>;

    /// Returns all numbers with their values, in order.
    fn entries(&self) -> Vec<Entry> {
        self.infos().iter().filter_map(|info| Some(Entry { info, value: self.get(info.name).ok()? })).collect()
    }

    /// Returns the numbers whose values no source allows, for example those that an experiment has changed.
    fn out_of_range(&self) -> Vec<Entry> {
        self.entries().into_iter().filter(|entry| !entry.is_in_range()).collect()
    }

    /// Checks every number against the limits of the model.
    ///
    /// # Errors
    ///
    /// [`ParameterError::OutOfLimits`] for the first number outside its limits.
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
