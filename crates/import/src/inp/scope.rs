//! Names of sets in files with parts.
//!
//! A name within a part differs from the same name outside, where the part's own is written with the name of the
//! instance before it, as `Part-1-1.feet`. Names within the part are replaced by that form, so that every name means
//! one set.

use super::keyword::{InpField, KeywordBlock};
use super::values::number_of;

/// Parameters whose values are names of sets, or nodes.
const NAMES: [&str; 5] = ["ELSET", "NSET", "TIENSET", "PINNSET", "REFNODE"];

/// Replaces names within parts by names with their instance. Files have one part with one instance; others are refused
/// when their keywords are read.
pub fn with_instances(blocks: &mut [KeywordBlock]) {
    let name_of = |keyword: &str| {
        let block = blocks.iter().find(|block| block.name == keyword)?;
        block.parameter("NAME").map(|name| name.text.clone())
    };
    let Some(instance) = name_of("INSTANCE").or_else(|| name_of("PART")) else {
        return;
    };
    let rename = |field: &mut InpField| {
        if !field.text.is_empty() && number_of(&field.text).is_none() {
            field.text = format!("{instance}.{}", field.text);
        }
    };
    let mut inside = false;
    for block in blocks {
        match block.name.as_str() {
            "PART" => inside = true,
            "END PART" => inside = false,
            _ => {}
        }
        if !inside {
            continue;
        }
        let named = block
            .parameters
            .iter_mut()
            .filter(|parameter| NAMES.contains(&parameter.name.as_str()));
        named.for_each(|parameter| rename(&mut parameter.value));
        let places = match block.name.as_str() {
            "NSET" | "ELSET" => 0..usize::MAX,
            "BOUNDARY" | "RELEASE" => 0..1,
            "MPC" => 1..usize::MAX,
            _ => continue,
        };
        for line in &mut block.data {
            let fields = line
                .iter_mut()
                .enumerate()
                .filter(|(index, _)| places.contains(index));
            fields.for_each(|(_, field)| rename(field));
        }
    }
}
