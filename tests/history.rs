//! Histories as users read them: columns of a file by name.

use std::path::Path;

/// Columns of a history file by name.
pub struct History(pub Vec<(String, Vec<f64>)>);

impl History {
    pub fn read(path: &Path) -> History {
        let mut reader = csv::Reader::from_path(path).expect("the history is there");
        let mut columns: Vec<(String, Vec<f64>)> = reader
            .headers()
            .expect("a header")
            .iter()
            .map(|name| (name.to_owned(), Vec::new()))
            .collect();
        for row in reader.records() {
            for (column, value) in columns.iter_mut().zip(row.expect("a row").iter()) {
                column.1.push(value.parse().expect("a number"));
            }
        }
        History(columns)
    }

    pub fn column(&self, name: &str) -> &[f64] {
        let found = self.0.iter().find(|(known, _)| known == name);
        &found.unwrap_or_else(|| panic!("no column {name}")).1
    }
}
