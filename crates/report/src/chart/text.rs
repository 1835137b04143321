//! Width of text.

/// Upper estimate of the width of a text in pixels, because no font is available to measure it.
pub(crate) fn text_width(text: &str, size: f64) -> f64 {
    let em: f64 = text
        .chars()
        .map(|c| match c {
            'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | '!' | ' ' => 0.31,
            'f' | 't' | 'r' | 'I' | '(' | ')' | '[' | ']' | '-' => 0.39,
            'm' | 'w' | 'M' | 'W' | '%' | '@' => 0.92,
            'A'..='Z' | '\u{2212}' | '+' | '=' | '<' | '>' => 0.70,
            _ => 0.59,
        })
        .sum();
    em * size
}

/// Breaks a text into lines no wider than `width` pixels.
pub(super) fn wrap(text: &str, width: f64, size: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line)
                if text_width(line, size) + text_width(word, size) + 0.31 * size <= width =>
            {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
