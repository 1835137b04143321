//! Two columns of a file, as rows of numbers.

use super::cells::{Cell, Sheet};
use crate::tables::defect::disorder;
use crate::text::diagnostic::Diagnostic;
use crate::text::source::Source;

/// Rows of a file, with the names of its columns if the first row is a header.
pub struct CsvColumns<'s> {
    sheet: Sheet<'s>,
    names: Vec<String>,
    first: usize,
}

impl<'s> CsvColumns<'s> {
    /// Reads a file whose cells are separated by semicolons, tabs, commas or blanks. Rows that begin with `#`, `%` or
    /// `!` are comments.
    ///
    /// # Errors
    /// A file without rows, or with a quotation mark that is not closed.
    pub fn of(source: &'s Source) -> Result<CsvColumns<'s>, Box<Diagnostic>> {
        let sheet = Sheet::of(source)?;
        let head = &sheet.rows[0];
        let named = head.iter().any(|cell| sheet.maybe_number(cell).is_none());
        let names = if named {
            head.iter().map(|cell| cell.text.clone()).collect()
        } else {
            Vec::new()
        };
        Ok(CsvColumns {
            sheet,
            names,
            first: usize::from(named),
        })
    }

    /// Names of the columns; empty if the file has no header.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The numbers of two columns, by their indices.
    ///
    /// # Errors
    /// Every cell that is missing or not a finite number; no row below the header; an x smaller than the previous
    /// one; a third row with the same x.
    pub fn rows(&self, columns: [usize; 2]) -> Result<Vec<[f64; 2]>, Vec<Diagnostic>> {
        let (mut rows, mut faults) = (Vec::new(), Vec::new());
        for row in &self.sheet.rows[self.first..] {
            match columns.map(|column| self.number(row, column)) {
                [Ok(x), Ok(value)] => {
                    rows.push([x, value]);
                    if let Some(why) = disorder(&rows) {
                        faults.push(self.sheet.fault(&row[columns[0]], why));
                        rows.pop();
                    }
                }
                both => faults.extend(both.into_iter().filter_map(Result::err).map(|error| *error)),
            }
        }
        if self.sheet.rows.len() == self.first {
            faults.push(Diagnostic::of_file(
                self.sheet.name,
                "the file has no rows below its header",
            ));
        }
        if faults.is_empty() {
            Ok(rows)
        } else {
            Err(faults)
        }
    }

    /// The number in one column of a row.
    fn number(&self, row: &[Cell], column: usize) -> Result<f64, Box<Diagnostic>> {
        match row.get(column) {
            Some(cell) => self.sheet.number(cell),
            None => {
                let expected = format!("the row must have at least {} cells", column + 1);
                let mut fault = self.sheet.fault(&row[0], expected);
                fault.found = Some(row.len().to_string());
                Err(Box::new(fault))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::CsvColumns;
    use crate::text::source::Source;

    fn rows(text: &str, columns: [usize; 2]) -> Result<Vec<[f64; 2]>, String> {
        let source = Source::from_bytes("t.csv".to_owned(), text.as_bytes().to_vec())
            .map_err(|e| e.to_string())?;
        let table = CsvColumns::of(&source).map_err(|e| e.to_string())?;
        table.rows(columns).map_err(|all| {
            all.iter()
                .map(ToString::to_string)
                .collect::<Vec<_>>()
                .join("\n")
        })
    }

    #[test]
    fn header_is_optional_and_comments_are_skipped() {
        let plain = rows("0, 1\n2, 3\n", [0, 1]);
        assert_eq!(plain, Ok(vec![[0.0, 1.0], [2.0, 3.0]]));
        assert_eq!(
            rows("# level survey\nx;y0;z0\n0;1;5\n2;3,5;6\n", [0, 1]),
            Ok(vec![[0.0, 1.0], [2.0, 3.5]])
        );
    }

    #[test]
    fn faults_stand_at_their_cells() {
        let faults = rows("x,y\n0,1\n0,two\n-1,2\n4\n", [0, 1]).expect_err("three faults");
        assert_eq!(
            faults,
            "t.csv:3:3: must be a finite number, got \"two\"\nt.csv:4:1: x must not decrease: the previous row is at 0\nt.csv:5:1: the row must have at least 2 cells, got 1"
        );
        assert_eq!(
            rows("x,y\n", [0, 1]),
            Err("t.csv: the file has no rows below its header".to_owned())
        );
        assert!(rows("0 0\n0 1\n0 2\n", [0, 1]).is_err());
    }
}
