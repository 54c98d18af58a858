//! Parsers and formatters of whole numbers. An error message states the range that was expected.

pub(crate) fn whole<T: TryFrom<u64>>(low: u64, high: u64) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| {
        let number = text.parse().ok().filter(|number: &u64| (low..=high).contains(number));
        let number = number.and_then(|number| T::try_from(number).ok());
        number.ok_or_else(|| format!("expected a whole number from {low} to {high}, found {text}"))
    }
}

/// Formats a count with its noun in singular or plural: `1 triangle`, `2 triangles`.
pub(crate) fn count_of(count: impl TryInto<u64>, name: &str) -> String {
    let count = count.try_into().unwrap_or(u64::MAX);
    format!("{count} {name}{}", if count == 1 { "" } else { "s" })
}

/// Formats a count with its noun and verb in the present: `1 point is`, `2 points are`.
pub(crate) fn are(count: u64, name: &str) -> String {
    format!("{} {}", count_of(count, name), if count == 1 { "is" } else { "are" })
}

/// Formats a count with its noun and verb in the past: `1 size was`, `2 sizes were`.
pub(crate) fn were(count: u64, name: &str) -> String {
    format!("{} {}", count_of(count, name), if count == 1 { "was" } else { "were" })
}

/// Text for a missing value.
pub(crate) fn dash() -> String {
    "-".to_owned()
}

/// Formats a number, or [`dash`] if it is not finite.
pub(crate) fn number(value: f64, digits: usize) -> String {
    if value.is_finite() { format!("{value:.digits$}") } else { dash() }
}

pub(crate) fn confidence(text: &str) -> Result<f64, String> {
    let found = text.parse().ok().filter(|share: &f64| *share > 0.0 && *share < 1.0);
    found.ok_or_else(|| format!("expected a number between 0 and 1, such as 0.95, found {text}"))
}

pub(crate) fn plain(value: &toml::Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}
