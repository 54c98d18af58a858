use crate::parameters::{ParameterInfo, SettingError, Value};

/// A parameter of a table together with its current value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Name, unit, provenance, range, limits and source of the parameter.
    pub info: &'static ParameterInfo,
    pub value: Value,
}

impl Entry {
    /// Returns true if the current value lies within the range that the sources allow.
    pub fn is_in_range(&self) -> bool {
        let (low, high) = self.info.range;
        (low..=high).contains(&self.value)
    }

    /// Returns true if the current value lies within the limits in which the model works.
    pub fn is_within_limits(&self) -> bool {
        let (least, most) = self.info.limits;
        (least..=most).contains(&self.value)
    }
}

/// A table of parameters that was declared with [`parameter_table!`](crate::parameters::parameter_table). A machine can
/// hold tables of different types as `&dyn ParameterTable`.
pub trait ParameterTable {
    /// Returns unit, provenance, range and source of each parameter, in the order of the declaration. The table's
    /// constant `INFOS` has the same content.
    fn infos(&self) -> &'static [ParameterInfo];

    /// Returns the value of a parameter.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if no parameter has this name.
    fn get(&self, name: &str) -> Result<Value, SettingError>;

    /// Changes the value of a parameter. This function does not check the range and the limits. To check them, call
    /// [`ParameterTable::check`].
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if no parameter has this name, or if the parameter holds whole numbers and the value
    /// is not whole.
    fn set(&mut self, name: &str, value: Value) -> Result<(), SettingError>;

    /// Returns all parameters with their current values, in the order of the declaration.
    fn entries(&self) -> Vec<Entry> {
        self.infos().iter().filter_map(|info| Some(Entry { info, value: self.get(info.name).ok()? })).collect()
    }

    /// Returns the parameters whose current values lie outside the ranges that the sources allow.
    fn out_of_range(&self) -> Vec<Entry> {
        self.entries().into_iter().filter(|entry| !entry.is_in_range()).collect()
    }

    /// Checks the value of every parameter against the limits of the model.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] for the first parameter whose value is outside its limits.
    fn check(&self) -> Result<(), SettingError> {
        for info in self.infos() {
            let value = self.get(info.name)?;
            if !(Entry { info, value }).is_within_limits() {
                return Err(SettingError::limits(info.name, info.limits, value));
            }
        }
        Ok(())
    }
}
