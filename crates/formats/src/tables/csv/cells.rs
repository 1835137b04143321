//! Splits the text of a file into rows of cells with their positions.

use crate::text::diagnostic::Diagnostic;
use crate::text::source::Source;

/// The rows of a file that are neither blank nor comments.
pub(super) struct Sheet<'s> {
    pub name: &'s str,
    pub rows: Vec<Vec<Cell>>,
    /// Text of the comment lines.
    pub comments: String,
    /// Whether a comma may be the decimal mark.
    decimal_comma: bool,
}

/// A cell with its line and column, counted from 1.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    pub line: usize,
    pub column: usize,
    pub text: String,
}

impl<'s> Sheet<'s> {
    /// Splits a file into rows and cells. The separator is the first of semicolon, tab and comma that occurs in the
    /// first row; if none occurs, cells are separated by blanks. A row that begins with `#`, `%` or `!` is a comment.
    /// Cells may be enclosed in double quotes.
    pub fn of(source: &'s Source) -> Result<Sheet<'s>, Box<Diagnostic>> {
        let text = source.text.replace("\r\n", "\n").replace('\r', "\n");
        let mut separator = None;
        let mut sheet = Sheet {
            name: &source.name,
            rows: Vec::new(),
            comments: String::new(),
            decimal_comma: false,
        };
        for (k, line) in text.lines().enumerate() {
            let trimmed = line.trim();
            if let Some(comment) = trimmed.strip_prefix(['#', '%', '!']) {
                sheet.comments.push_str(comment);
                sheet.comments.push('\n');
                continue;
            }
            if trimmed.is_empty() || trimmed.chars().all(|c| ",;\t".contains(c)) {
                continue;
            }
            let mark = *separator.get_or_insert_with(|| {
                [';', '\t', ',']
                    .into_iter()
                    .find(|&mark| line.contains(mark))
            });
            sheet.rows.push(cells(line, mark, k + 1).map_err(|cell| {
                let fault = sheet.fault(&cell, "a quotation mark is not closed");
                Box::new(fault.hint("a cell cannot extend over several lines"))
            })?);
        }
        sheet.decimal_comma = matches!(separator.flatten(), Some(';' | '\t'));
        if sheet.rows.is_empty() {
            return Err(Box::new(Diagnostic::of_file(
                &source.name,
                "the file has no rows",
            )));
        }
        Ok(sheet)
    }

    /// A diagnostic at a cell.
    pub fn fault(&self, cell: &Cell, expected: impl Into<String>) -> Diagnostic {
        Diagnostic {
            line: Some(cell.line),
            column: Some(cell.column),
            ..Diagnostic::of_file(self.name, expected)
        }
    }

    /// The finite number of a cell.
    pub fn number(&self, cell: &Cell) -> Result<f64, Box<Diagnostic>> {
        self.maybe_number(cell).ok_or_else(|| {
            let mut fault = self.fault(cell, "must be a finite number");
            fault.found = Some(if cell.text.is_empty() {
                "nothing".to_owned()
            } else {
                format!("\"{}\"", cell.text)
            });
            Box::new(fault)
        })
    }

    /// The finite number of a cell; `None` if the cell is not a finite number.
    pub fn maybe_number(&self, cell: &Cell) -> Option<f64> {
        let comma =
            self.decimal_comma && cell.text.matches(',').count() == 1 && !cell.text.contains('.');
        if comma {
            adams::number::read(&cell.text.replace(',', "."))
        } else {
            adams::number::read(&cell.text)
        }
    }
}

/// The cells of a line; the error is the first cell whose quotation mark is not closed.
fn cells(line: &str, separator: Option<char>, number: usize) -> Result<Vec<Cell>, Cell> {
    let mut out = Vec::new();
    let mut chars = line.chars().zip(1..).peekable();
    loop {
        while chars
            .peek()
            .is_some_and(|(c, _)| c.is_whitespace() && Some(*c) != separator)
        {
            chars.next();
        }
        let Some(&(first, column)) = chars.peek() else {
            break;
        };
        let mut cell = Cell {
            line: number,
            column,
            text: String::new(),
        };
        if first == '"' {
            chars.next();
            loop {
                match chars.next() {
                    None => return Err(cell),
                    Some(('"', _)) if chars.peek().is_some_and(|(c, _)| *c == '"') => {
                        chars.next();
                        cell.text.push('"');
                    }
                    Some(('"', _)) => break,
                    Some((c, _)) => cell.text.push(c),
                }
            }
        }
        let ends = |c: char| separator.map_or(c.is_whitespace(), |mark| c == mark);
        while let Some((c, _)) = chars.next_if(|(c, _)| !ends(*c)) {
            cell.text.push(c);
        }
        cell.text.truncate(cell.text.trim_end().len());
        let marked = separator.is_some() && chars.next().is_some();
        let after = column + 1;
        out.push(cell);
        if marked && chars.peek().is_none() {
            out.push(Cell {
                line: number,
                column: after,
                text: String::new(),
            });
        }
    }
    while out.len() > 1 && out.last().is_some_and(|cell| cell.text.is_empty()) {
        out.pop();
    }
    Ok(out)
}
