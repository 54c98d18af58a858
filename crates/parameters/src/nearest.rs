//! What a misspelt name was probably meant to be.

/// The candidate with the fewest single-letter changes to `name`; `None` of no candidates.
#[must_use]
pub fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    candidates.min_by_key(|candidate| strsim::levenshtein(name, candidate))
}
