//! The header of an `.npy` array: a Python dictionary.

/// Type, order and shape of an array.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Header {
    /// Type of the items, such as `<f8`.
    pub descr: String,
    /// Whether the items are in Fortran order.
    pub fortran: bool,
    pub shape: Vec<usize>,
}

/// Splits the bytes of an array into header and data; `None` if they are not an array.
///
/// # Source
/// NumPy, `numpy.lib.format`, versions 1 to 3.
pub(super) fn split(bytes: &[u8]) -> Option<(Header, &[u8])> {
    let rest = bytes.strip_prefix(b"\x93NUMPY")?;
    let (&major, rest) = rest.split_first()?;
    let (_, rest) = rest.split_first()?;
    let (length, rest) = if major == 1 {
        let (size, rest) = rest.split_first_chunk::<2>()?;
        (usize::from(u16::from_le_bytes(*size)), rest)
    } else {
        let (size, rest) = rest.split_first_chunk::<4>()?;
        (usize::try_from(u32::from_le_bytes(*size)).ok()?, rest)
    };
    let (text, data) = rest.split_at_checked(length)?;
    Some((parse(std::str::from_utf8(text).ok()?)?, data))
}

/// Reads a dictionary such as `{'descr': '<f8', 'fortran_order': False, 'shape': (7, 7), }`.
fn parse(text: &str) -> Option<Header> {
    let mut rest = text.trim().strip_prefix('{')?.strip_suffix('}')?.trim();
    let (mut descr, mut fortran, mut shape) = (None, None, None);
    while !rest.is_empty() {
        let (key, after) = quoted(rest)?;
        let value = after.trim_start().strip_prefix(':')?.trim_start();
        let after = match key {
            "descr" => {
                let (text, after) = quoted(value)?;
                descr = Some(text.to_owned());
                after
            }
            "fortran_order" => {
                let (word, is) = if value.starts_with("True") {
                    ("True", true)
                } else {
                    ("False", false)
                };
                fortran = Some(is);
                value.strip_prefix(word)?
            }
            "shape" => {
                let (inside, after) = value.strip_prefix('(')?.split_once(')')?;
                let items = inside
                    .split(',')
                    .map(str::trim)
                    .filter(|item| !item.is_empty());
                let sizes = items.map(|item| item.trim_end_matches('L').parse().ok());
                shape = Some(sizes.collect::<Option<Vec<usize>>>()?);
                after
            }
            _ => return None,
        };
        rest = after.trim_start();
        rest = rest.strip_prefix(',').unwrap_or(rest).trim_start();
    }
    Some(Header {
        descr: descr?,
        fortran: fortran?,
        shape: shape?,
    })
}

/// A string in quotation marks at the beginning of the text, and the remaining text.
fn quoted(text: &str) -> Option<(&str, &str)> {
    let mark = text.chars().next().filter(|c| matches!(c, '\'' | '"'))?;
    text[1..].split_once(mark)
}

/// Magic string, version 1.0 and dictionary of an array in C order, padded so that the data begin at a multiple of 64
/// bytes.
pub(super) fn bytes(descr: &str, shape: &[usize]) -> Vec<u8> {
    let sizes: Vec<String> = shape.iter().map(usize::to_string).collect();
    let comma = if sizes.len() == 1 { "," } else { "" };
    let mut text = format!(
        "{{'descr': '{descr}', 'fortran_order': False, 'shape': ({}{comma}), }}",
        sizes.join(", ")
    );
    let fixed = 10;
    while (fixed + text.len() + 1) % 64 != 0 {
        text.push(' ');
    }
    text.push('\n');
    let length = u16::try_from(text.len()).unwrap_or(u16::MAX);
    let mut out = b"\x93NUMPY\x01\x00".to_vec();
    out.extend(length.to_le_bytes());
    out.extend(text.bytes());
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_are_read_as_every_numpy_writes_them() {
        for (text, shape) in [
            (
                "{'descr': '<f8', 'fortran_order': False, 'shape': (7, 7), }",
                vec![7, 7],
            ),
            (
                "{'descr': '<f8', 'fortran_order': False, 'shape': (7,), }  \n",
                vec![7],
            ),
            (
                "{\"shape\": (), 'fortran_order': False, 'descr': '<f8'}",
                vec![],
            ),
            (
                "{'descr': '<f8', 'fortran_order': False, 'shape': (7L, 7L)}",
                vec![7, 7],
            ),
        ] {
            let expected = Header {
                descr: "<f8".to_owned(),
                fortran: false,
                shape,
            };
            assert_eq!(parse(text), Some(expected), "{text}");
        }
        for text in [
            "",
            "{",
            "{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': ()}",
            "{'shape': (-1,)}",
        ] {
            assert_eq!(parse(text), None, "{text}");
        }
    }

    #[test]
    fn data_begin_at_a_multiple_of_64() {
        for shape in [&[] as &[usize], &[1], &[123_456_789, 12], &[1; 30]] {
            let bytes = bytes("<f8", shape);
            assert_eq!(bytes.len() % 64, 0);
            assert_eq!(
                split(&bytes).map(|(header, data)| (header.shape, data.len())),
                Some((shape.to_vec(), 0))
            );
        }
    }
}
