//! Rows of the tables, which are part of the program.

/// The rows of a table of comma-separated values: lines that neither begin with `#` nor are empty, split into cells.
pub fn rows(text: &'static str) -> impl Iterator<Item = Vec<&'static str>> {
    let lines = text
        .lines()
        .filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines.map(|line| line.split(',').collect())
}

/// The number in a cell; `None` if the cell is empty or missing.
pub fn number(row: &[&str], cell: usize) -> Option<f64> {
    row.get(cell)
        .filter(|text| !text.is_empty())
        .and_then(|text| text.parse().ok())
}

/// The number in a cell that every row has.
pub fn required(row: &[&str], cell: usize) -> f64 {
    number(row, cell).expect("the tables are part of the program, and a test reads all their cells")
}
