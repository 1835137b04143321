//! The grammar of JSON compared with that of `serde_json`.

use super::*;

/// The tree as `serde_json` has it.
fn plain(node: &TreeNode<'_>) -> serde_json::Value {
    match &node.value {
        Value::Null => serde_json::Value::Null,
        Value::Bool(value) => (*value).into(),
        Value::Unsigned(value) => (*value).into(),
        Value::Signed(value) => (*value).into(),
        Value::Float(value) => (*value).into(),
        Value::Text(text) => text.as_ref().into(),
        Value::List(items) => items.iter().map(plain).collect(),
        Value::Object(members) => members
            .iter()
            .map(|member| (member.key.clone().into_owned(), plain(&member.value)))
            .collect(),
    }
}

/// What `serde_json` makes of a text: the value, or its message and byte offset.
fn peer(text: &str) -> Result<serde_json::Value, (String, usize)> {
    serde_json::from_str(text).map_err(|error| {
        let message = error.to_string();
        let tail = format!(" at line {} column {}", error.line(), error.column());
        let lines = text.split_inclusive('\n').take(error.line() - 1);
        let start = lines.map(str::len).sum::<usize>();
        let offset = (start + error.column().saturating_sub(1)).min(text.len());
        (
            message.strip_suffix(&tail).unwrap_or(&message).to_owned(),
            offset,
        )
    })
}

fn own(text: &str) -> Result<serde_json::Value, (String, usize)> {
    let Reading { root, error } = read(text);
    error.map_or_else(
        || Ok(plain(&root)),
        |error| Err((error.message, error.offset)),
    )
}

fn agree(text: &str) {
    assert_eq!(own(text), peer(text), "{text:?}");
}

const GOOD: &str = "{\"a\": [1, -2.5e-3, true, false, null],\n \"b\\u00e9\\ud83d\\ude00\": {\"c\": \"x\\\\\\n/\"},\n\
                    \"e\": [[], {}, [0.1, 1E+5, 18446744073709551616, -9223372036854775808]], \"u\": \"\u{e4}\"}\n";

#[test]
fn texts_are_taken_or_refused_as_serde_json_does_it_wherever_they_are_damaged() {
    agree(GOOD);
    let pieces = [
        "",
        "\"",
        "\\",
        "\n",
        "\t",
        "{",
        "}",
        "[",
        "]",
        ",",
        ":",
        "0",
        "1",
        "-",
        ".",
        "e",
        "+",
        "tru",
        "x",
        " ",
        "1e999",
        "\\ud800",
        "\\u12",
        "1e99999999999",
    ];
    let ends: Vec<usize> = (0..=GOOD.len())
        .filter(|&at| GOOD.is_char_boundary(at))
        .collect();
    for pair in ends.windows(2) {
        let [at, after] = [pair[0], pair[1]];
        agree(&GOOD[..at]);
        for piece in pieces {
            agree(&format!("{}{piece}{}", &GOOD[..at], &GOOD[at..]));
            agree(&format!("{}{piece}{}", &GOOD[..at], &GOOD[after..]));
        }
    }
}

#[test]
fn numbers_are_those_of_serde_json_to_the_last_bit() {
    let words = [
        "0",
        "-0",
        "-0.0",
        "0e5",
        "0e99999999999",
        "1e-99999999999",
        "1e308",
        "1.7976931348623157e308",
        "1.7976931348623159e308",
        "-1e999",
        "5e-324",
        "2e-324",
        "2.2250738585072011e-308",
        "0.1",
        "0.30000000000000004",
        "9007199254740993",
        "9007199254740993.0",
        "18446744073709551615",
        "18446744073709551616",
        "-9223372036854775808",
        "-9223372036854775809",
        "-18446744073709551615",
        "123456789012345678901234567890",
        "123456789012345678901234567890.5e-7",
        "6.02214076e23",
        "01",
        "1.",
        ".5",
        "+1",
        "1e",
        "1e+",
        "--1",
        "0x10",
    ];
    for word in words {
        agree(word);
        agree(&format!("[{word}]"));
        let bits = |value: Result<serde_json::Value, _>| {
            value.ok().and_then(|value| Some(value.as_f64()?.to_bits()))
        };
        assert_eq!(bits(own(word)), bits(peer(word)), "{word}");
    }
    let mut random = fastrand::Rng::with_seed(1);
    for _ in 0..20_000 {
        let value = f64::from_bits(random.u64(..));
        if value.is_finite() {
            let text = format!("{value:e}");
            assert_eq!(
                own(&text).ok().and_then(|value| value.as_f64()),
                Some(value),
                "{text}"
            );
        }
    }
}

#[test]
fn values_are_nested_127_deep_and_no_deeper() {
    for depth in [126, 127, 128, 200] {
        agree(&format!("{}1{}", "[".repeat(depth), "]".repeat(depth)));
        agree(&format!(
            "{}1{}",
            "{\"a\":".repeat(depth),
            "}".repeat(depth)
        ));
    }
}

#[test]
fn an_error_keeps_the_path_of_the_value_that_breaks_off() {
    for (text, path) in [
        ("{\"a\": {\"b\": [1, 2, x]}}", "a.b[2]"),
        ("{\"a\": {\"b\": [1, 2", "a.b"),
        ("{\"a\": {\"b\" 1}}", "a"),
        ("{\"a\": 1} 2", ""),
    ] {
        let Reading { root, error } = read(text);
        assert_eq!(
            error.map(|error| error.path.to_string()).as_deref(),
            Some(path),
            "{text}"
        );
        assert!(matches!(root.value, Value::Object(_)), "{text}");
    }
}

#[test]
fn a_text_of_too_many_values_is_refused_before_it_is_read() {
    let text = "[1, 2, [3, 4], 5]";
    assert!(read_up_to(text, 4).error.is_none());
    let error = read_up_to(text, 3).error.expect("a fourth comma");
    assert_eq!(
        (error.message.as_str(), error.offset),
        (TOO_MANY_VALUES, 13)
    );
}
