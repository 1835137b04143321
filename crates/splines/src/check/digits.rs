//! How many digits a table was written with.

use crate::Table;

/// What the digits of a table's entries say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Digits {
    /// Significant digits, 1 to 17, that give back every entry bit for bit.
    pub count: usize,
    /// Largest change, in the Frobenius norm, of a table whose entries are off by one unit of the last digit:
    /// no eigenvalue and no entry moves by more. Length/force.
    pub slack: f64,
}

/// Digits of the entries of a table.
///
/// # Source
/// The eigenvalues of a symmetric matrix move by no more than the norm of its change (Weyl).
#[must_use]
pub fn digits(table: &Table) -> Digits {
    let all = table.values();
    let given =
        |count: usize| all.iter().all(|value| format!("{:.*e}", count - 1, value).parse() == Ok(*value));
    let count = (1..17).find(|&count| given(count)).unwrap_or(17);
    let unit = |value: f64| {
        let power = || value.abs().log10().floor() as i32 + 1 - count as i32;
        if value == 0.0 { 0.0 } else { 10_f64.powi(power()) }
    };
    Digits { count, slack: all.iter().map(|v| unit(*v).powi(2)).sum::<f64>().sqrt() }
}
