//! Rust source as words and marks, without comments, strings and unit-test modules.

/// A word (identifier, keyword, number) or one mark; `::` is one mark.
pub type Token = String;

/// Tokens of a source file. Strings and characters become the token `""`, comments vanish, and so do modules
/// under `#[cfg(test)]`.
pub fn tokens(text: &str) -> Vec<Token> {
    without_tests(&words(text))
}

fn words(text: &str) -> Vec<Token> {
    let bytes = text.as_bytes();
    let mut tokens = Vec::new();
    let mut i = 0;
    while i < bytes.len() {
        let rest = &text[i..];
        let byte = bytes[i];
        if byte.is_ascii_whitespace() || !byte.is_ascii() {
            i += 1;
            while !text.is_char_boundary(i) {
                i += 1;
            }
        } else if rest.starts_with("//") {
            i += rest.find('\n').unwrap_or(rest.len());
        } else if rest.starts_with("/*") {
            i += block_comment(rest);
        } else if let Some(length) = string(rest) {
            tokens.push("\"\"".to_owned());
            i += length;
        } else if byte == b'_' || byte.is_ascii_alphanumeric() {
            let length = rest
                .find(|c: char| c != '_' && !c.is_alphanumeric())
                .unwrap_or(rest.len());
            tokens.push(rest[..length].to_owned());
            i += length;
        } else {
            let length = if rest.starts_with("::") { 2 } else { 1 };
            tokens.push(rest[..length].to_owned());
            i += length;
        }
    }
    tokens
}

/// Bytes of a block comment, nested ones included.
fn block_comment(text: &str) -> usize {
    let mut depth = 0;
    let mut i = 0;
    while i < text.len() {
        match &text.as_bytes()[i..(i + 2).min(text.len())] {
            b"/*" => (depth, i) = (depth + 1, i + 2),
            b"*/" => (depth, i) = (depth - 1, i + 2),
            _ => i += 1,
        }
        if depth == 0 {
            return i;
        }
    }
    text.len()
}

/// Bytes of the string or character that a text begins with; lifetimes are none.
fn string(text: &str) -> Option<usize> {
    let prefix = text
        .find(|c| !matches!(c, 'b' | 'c' | 'r' | '#'))
        .unwrap_or(text.len());
    let (marks, rest) = text.split_at(prefix);
    if let Some(after) = rest.strip_prefix('"') {
        if marks.contains('r') {
            let end = format!("\"{}", "#".repeat(marks.matches('#').count()));
            return Some(prefix + 1 + after.find(&end).map_or(after.len(), |at| at + end.len()));
        }
        return marks
            .chars()
            .all(|c| c != '#')
            .then(|| prefix + 1 + closing(after, '"'));
    }
    let after = text
        .strip_prefix("b'")
        .or_else(|| text.strip_prefix('\''))?;
    let start = text.len() - after.len();
    let mut characters = after.chars();
    let first = characters.next()?;
    (first == '\\' || characters.next() == Some('\'')).then(|| start + closing(after, '\''))
}

/// Bytes up to and with the closing mark; a backslash takes the next character along.
fn closing(text: &str, mark: char) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices() {
        if !escaped && c == mark {
            return at + 1;
        }
        escaped = !escaped && c == '\\';
    }
    text.len()
}

/// Leaves out `#[cfg(test)] mod name { ... }` and `#[cfg(test)] mod name;`.
fn without_tests(tokens: &[Token]) -> Vec<Token> {
    const MARK: [&str; 7] = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut kept = Vec::new();
    let mut i = 0;
    while i < tokens.len() {
        let marked = tokens[i..]
            .iter()
            .zip(MARK)
            .filter(|(token, mark)| token == mark)
            .count()
            == MARK.len();
        if marked
            && tokens
                .get(i + MARK.len())
                .is_some_and(|token| token == "mod")
        {
            i += MARK.len();
            while i < tokens.len() && tokens[i] != "{" && tokens[i] != ";" {
                i += 1;
            }
            i = if tokens.get(i).is_some_and(|token| token == "{") {
                after_braces(tokens, i)
            } else {
                i + 1
            };
        } else {
            kept.push(tokens[i].clone());
            i += 1;
        }
    }
    kept
}

/// Place after the brace that closes the one at `open`.
pub fn after_braces(tokens: &[Token], open: usize) -> usize {
    let mut depth = 0;
    for (i, token) in tokens.iter().enumerate().skip(open) {
        match token.as_str() {
            "{" => depth += 1,
            "}" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return i + 1;
        }
    }
    tokens.len()
}

#[test]
fn strings_comments_and_unit_tests_are_left_out() {
    let text = r##"
        //! use crate::a;
        /* use crate::b; /* nested */ */
        fn f<'a>(x: &'a str) { g('{', b'\'', "use crate::c; \"", r#"" crate::d"#) }
        #[cfg(test)]
        mod tests { use crate::e; fn h() {} }
        use crate::f;
    "##;
    let words = tokens(text).join(" ");
    assert_eq!(
        words,
        "fn f < ' a > ( x : & ' a str ) { g ( \"\" , \"\" , \"\" , \"\" ) } use crate :: f ;"
    );
}
