//! Search for the name that is most similar to an unknown name, for error messages.

/// Returns the candidate that begins with `name`, for example a parameter of the table `name`. Otherwise it is one of the
/// same table, or with the same name in another table, if there is one. Of these, it is the one that shares the most words
/// with `name`, and among equals the one with the fewest single-letter changes. Returns `None` if there are no candidates.
///
/// Capital and small letters are the same. Words end at punctuation, and similar words count as the same word.
pub fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let name = &name.to_lowercase();
    let (table, last) = name.split_at(name.rfind('.').map_or(0, |point| point + 1));
    candidates.min_by_key(|candidate| {
        let foreign = words(name).filter(|word| !words(candidate).any(|other| are_similar(word, other)));
        let is_other = !candidate.starts_with(table) && !candidate.ends_with(last);
        (!candidate.starts_with(name), is_other, foreign.count(), strsim::levenshtein(name, candidate))
    })
}

fn words(name: &str) -> impl Iterator<Item = &str> {
    name.split(|letter: char| !letter.is_alphanumeric()).filter(|word| !word.is_empty())
}

/// Returns true if at most half of the letters of two words differ.
fn are_similar(word: &str, other: &str) -> bool {
    let longer = word.chars().count().max(other.chars().count());
    2 * strsim::levenshtein(word, other) <= longer
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn the_first_part_of_a_path_is_nearer_to_the_path_than_another_word_of_equal_length() {
        let keys = ["fit", "on", "n_gps", "gp.triangle_ns", "gp.pass_ns", "arp.across_deg", "hmd.view"];
        for (name, expected) in [("gp", "gp.pass_ns"), ("hmd.pass_ns", "gp.pass_ns"), ("hmd.across_v_deg", "hmd.view")]
        {
            assert_eq!(nearest(name, keys.into_iter()), Some(expected), "{name}");
        }
    }

    #[test]
    fn a_name_of_the_same_family_is_nearer_than_a_shorter_word() {
        let names =
            ["euc", "mig", "slats", "jitp-beam", "jitp-dual-view", "renderer.swap_ns", "n_renderers", "machine.n_gps"];
        for (name, expected) in [
            ("jitp-bean", "jitp-beam"),
            ("jitp-duel", "jitp-dual-view"),
            ("slast", "slats"),
            ("renderers", "n_renderers"),
            ("machine.n_gpus", "machine.n_gps"),
        ] {
            assert_eq!(nearest(name, names.into_iter()), Some(expected), "{name}");
        }
    }
}
