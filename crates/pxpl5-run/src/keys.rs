use pxpl5_sim::parameters::KeyValue;
use std::collections::BTreeMap;
use std::str::FromStr;

/// Values of the pipeline settings (keys) that the user has set.
///
/// Each value must have been checked against its [`Key`](pxpl5_sim::parameters::Key).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PipelineSettings {
    values: BTreeMap<&'static str, KeyValue>,
}

impl PipelineSettings {
    /// Sets the value of a key.
    pub fn set(&mut self, key: &'static str, value: KeyValue) {
        self.values.insert(key, value);
    }

    /// Returns the value of a true-or-false key, or `None` if the user did not set the key.
    pub fn flag(&self, key: &str) -> Option<bool> {
        if let Some(KeyValue::Flag(flag)) = self.values.get(key) { Some(*flag) } else { None }
    }

    /// Returns the value of a whole-number key, or `None` if the user did not set the key.
    pub fn whole(&self, key: &str) -> Option<u64> {
        if let Some(KeyValue::Whole(number)) = self.values.get(key) { Some(*number) } else { None }
    }

    /// Returns the text of a key, or `None` if the user did not set the key.
    pub fn text(&self, key: &str) -> Option<&str> {
        if let Some(KeyValue::Text(text)) = self.values.get(key) { Some(text) } else { None }
    }

    /// Returns the choice that a key with named values names, or `None` if the user did not set the key.
    pub fn chosen<T: FromStr>(&self, key: &str) -> Option<T> {
        self.name(key)?.parse().ok()
    }

    /// Returns the value of a key with named values, or `None` if the user did not set the key.
    pub fn name(&self, key: &str) -> Option<&'static str> {
        if let Some(KeyValue::Name(name)) = self.values.get(key) { Some(name) } else { None }
    }
}
