//! A prescribed motion as an expression of TIME.

use sim::Profile;

use crate::words::expression::number;

/// Position along the rail: a polynomial for each stretch of the profile, exact, chosen by nested IFs.
///
/// Position is continuous, so it does not matter which side a break belongs to. Nested as a tree: a table of n rows
/// takes log2 n comparisons.
pub(crate) fn expression(profile: &Profile) -> String {
    let mut starts = vec![0.0];
    starts.extend_from_slice(profile.breaks());
    let pieces: Vec<(f64, String)> = (0..starts.len())
        .map(|k| (starts[k], piece(profile, starts[k], starts.get(k + 1).copied())))
        .collect();
    tree(&pieces)
}

fn tree(pieces: &[(f64, String)]) -> String {
    match pieces {
        [] => "0.0".to_owned(),
        [(_, only)] => only.clone(),
        _ => {
            let (before, after) = pieces.split_at(pieces.len() / 2);
            let (start, first) = &after[0];
            let time = format!("TIME-{}", number(*start));
            format!("IF({time}:{},{first},{})", tree(before), tree(after))
        }
    }
}

/// x + v s + a s^2/2 + j s^3/6 with s the time since the start of the stretch.
fn piece(profile: &Profile, start: f64, end: Option<f64>) -> String {
    let at = profile.at(start);
    // inside the stretch acceleration is linear in time
    let middle = end.map_or(start + 1.0, |end| f64::midpoint(start, end));
    let jerk = (profile.at(middle).a - at.a) / (middle - start);
    let s = if start == 0.0 { "TIME".to_owned() } else { format!("(TIME-{})", number(start)) };
    let mut text = adams::number::write(at.x);
    for (power, factor) in [(1, at.v), (2, at.a / 2.0), (3, jerk / 6.0)] {
        if factor != 0.0 {
            text.push_str(&format!("+{}*{s}", number(factor)));
            if power > 1 {
                text.push_str(&format!("**{power}"));
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::expression;
    use sim::{Given, Profile};

    #[test]
    fn a_speed_table_is_a_polynomial_a_stretch() {
        let table = [[0.0, 0.0], [4.0, 6.0], [8.0, 6.0]];
        let profile = Profile::new(Given::Speed, &table, 20.0, 0.0).expect("a valid table");
        assert_eq!(
            expression(&profile),
            "IF(TIME-4.0:20.0+0.75*TIME**2,32.0+6.0*(TIME-4.0),IF(TIME-8.0:32.0+6.0*(TIME-4.0),\
             56.0+6.0*(TIME-8.0),56.0+6.0*(TIME-8.0)))"
        );
    }
}
