//! The values of one axis in many runs.

use formats::sweep::AxisValue;

/// The values of one axis in the rows of a table, in little memory: eight bytes for a number, four for a string or for
/// true and false, each of which is kept once.
#[derive(Clone, Debug, PartialEq)]
pub enum AxisColumn {
    /// Numbers.
    Numbers(Vec<f64>),
    /// Values of any kind: the different ones, and the place of that of each row among them.
    Levels(Vec<AxisValue>, Vec<u32>),
}

impl AxisColumn {
    /// A column without rows that has room for some.
    pub(crate) fn with_room(rows: usize) -> AxisColumn {
        AxisColumn::Numbers(Vec::with_capacity(rows))
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            AxisColumn::Numbers(numbers) => numbers.len(),
            AxisColumn::Levels(_, rows) => rows.len(),
        }
    }

    /// Whether there are no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The value in a row.
    #[must_use]
    pub fn value(&self, row: usize) -> AxisValue {
        match self {
            AxisColumn::Numbers(numbers) => AxisValue::Number(numbers[row]),
            AxisColumn::Levels(levels, rows) => levels[rows[row] as usize].clone(),
        }
    }

    /// Adds a row.
    pub(crate) fn push(&mut self, value: AxisValue) {
        match (&mut *self, value) {
            (AxisColumn::Numbers(numbers), AxisValue::Number(number)) => numbers.push(number),
            (AxisColumn::Levels(levels, rows), value) => {
                let found = levels.iter().position(|known| *known == value);
                rows.push(found.unwrap_or(levels.len()) as u32);
                if found.is_none() {
                    levels.push(value);
                }
            }
            (AxisColumn::Numbers(numbers), value) => {
                let mut column =
                    AxisColumn::Levels(Vec::new(), Vec::with_capacity(numbers.capacity()));
                numbers
                    .drain(..)
                    .map(AxisValue::Number)
                    .chain([value])
                    .for_each(|value| column.push(value));
                *self = column;
            }
        }
    }

    /// Puts the rows in an order: that of their former places.
    pub(crate) fn arrange(&mut self, order: &[usize]) {
        match self {
            AxisColumn::Numbers(numbers) => {
                *numbers = order.iter().map(|&row| numbers[row]).collect()
            }
            AxisColumn::Levels(_, rows) => *rows = order.iter().map(|&row| rows[row]).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_has_the_values_that_were_added_of_one_kind_or_several() {
        let number = AxisValue::Number;
        let word = |text: &str| AxisValue::Text(text.to_owned());
        let lists = [
            vec![number(0.5), number(-1.0), number(0.5)],
            vec![word("rigid"), word("influence"), word("rigid")],
            vec![
                number(2.0),
                word("rigid"),
                AxisValue::Flag(true),
                number(2.0),
            ],
        ];
        for values in lists {
            let mut column = AxisColumn::with_room(0);
            values.iter().for_each(|value| column.push(value.clone()));
            let found = |column: &AxisColumn| -> Vec<AxisValue> {
                (0..column.len()).map(|row| column.value(row)).collect()
            };
            assert_eq!(found(&column), values);
            let order: Vec<usize> = (0..values.len()).rev().collect();
            column.arrange(&order);
            assert_eq!(
                found(&column),
                values.iter().rev().cloned().collect::<Vec<_>>()
            );
        }
    }
}
