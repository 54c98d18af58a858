//! Search for the name that is most similar to an unknown name, for error messages.

/// Returns the candidate that begins with `name`, for example a parameter of the table `name`. Otherwise returns the
/// candidate that differs from `name` by the fewest single-letter changes. Returns `None` if there are no candidates.
#[must_use]
pub fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    candidates.min_by_key(|candidate| (!candidate.starts_with(name), strsim::levenshtein(name, candidate)))
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn a_table_is_nearer_than_a_word_of_its_length() {
        let keys = ["fit", "on", "n_gps", "gp.triangle_ns", "gp.pass_ns", "title"];
        for (name, expected) in [("gp", "gp.pass_ns"), ("gp.tri", "gp.triangle_ns"), ("fi", "fit"), ("tilte", "title")]
        {
            assert_eq!(nearest(name, keys.into_iter()), Some(expected), "{name}");
        }
    }
}
