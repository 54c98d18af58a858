//! Checks of the settings of head motion, trackers and predictors.

use pxpl5_sim::parameters::SettingError;

/// Returns an error unless `found` lies within `low..=high`. NaN is always an error.
pub(crate) fn check(what: &str, found: f64, low: f64, high: f64) -> Result<(), SettingError> {
    SettingError::require((low..=high).contains(&found), what, format_args!("{low} to {high}"), found)
}

pub(crate) fn contradiction(what: &str) -> SettingError {
    SettingError::combination(format_args!("settings contradict each other: {what}"))
}

#[cfg(test)]
mod tests {
    use super::check;

    #[test]
    fn the_message_states_the_expected_and_found_values() {
        let error = check("line rate", f64::NAN, 300.0, 115_200.0).unwrap_err();
        assert_eq!(error.to_string(), "line rate: expected 300 to 115200, found NaN");
    }
}
