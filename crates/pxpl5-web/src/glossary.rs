//! The terms that the page explains, taken from docs/glossary.md.

use serde_json::{Map, Value};

const TEXT: &str = include_str!("../../../docs/glossary.md");

/// Returns all terms with their explanations as JSON. In docs/glossary.md, each term is on a line `- **term**:
/// sentence`.
pub(crate) fn glossary() -> Value {
    let terms = TEXT.lines().filter_map(|line| line.strip_prefix("- **")?.split_once("**: "));
    Value::Object(terms.map(|(term, sentence)| (term.to_owned(), plain(sentence).into())).collect::<Map<_, _>>())
}

/// Returns a sentence without Markdown formatting.
fn plain(sentence: &str) -> String {
    sentence.replace(['`', '*'], "")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    const PAGE: [&str; 2] = [include_str!("../page/index.html"), include_str!("../page/page.js")];

    fn used() -> BTreeSet<&'static str> {
        let marked = PAGE.iter().flat_map(|text| text.split("data-term=\"").skip(1));
        marked.filter_map(|rest| rest.split('"').next()).filter(|term| !term.contains('$')).collect()
    }

    #[test]
    fn every_marked_term_of_the_page_has_one_sentence() {
        let glossary = glossary();
        assert!(used().len() > 15, "the page marks its terms");
        for term in used() {
            let sentence =
                glossary[term].as_str().unwrap_or_else(|| panic!("docs/glossary.md does not explain {term}"));
            assert!(sentence.ends_with('.') && sentence.len() < 260, "{term}: {sentence}");
        }
    }

    #[test]
    fn terms_are_sorted_and_unique() {
        let terms: Vec<&str> =
            TEXT.lines().filter_map(|line| Some(line.strip_prefix("- **")?.split_once("**")?.0)).collect();
        assert!(terms.windows(2).all(|two| two[0].to_lowercase() < two[1].to_lowercase()), "{terms:?}");
    }
}
