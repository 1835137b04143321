//! Names of runs as pages show them.

/// Name of a run on a page: that of the foundation in words where its label is only the keyword of one, the label
/// otherwise. Files keep the label, as in `history-rigid.csv`.
pub(crate) fn run_name(label: &str) -> &str {
    foundation_words(label)
}

/// A foundation in words; other text as it is.
pub(crate) fn foundation_words(word: &str) -> &str {
    match word {
        "rigid" => "rigid rails",
        "influence" => "rails on influence functions",
        "modal" => "rails on natural modes",
        "full" => "rails on the full model",
        "parts" => "rails in rigid parts",
        "ties" => "rails on ties",
        "auto" => "foundation chosen by the program",
        own => own,
    }
}

#[cfg(test)]
mod tests {
    use super::run_name;

    #[test]
    fn keywords_are_shown_in_words_and_labels_as_they_are() {
        assert_eq!(run_name("rigid"), "rigid rails");
        assert_eq!(run_name("printed-akispl"), "printed-akispl");
    }
}
