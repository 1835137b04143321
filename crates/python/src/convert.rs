//! Conversion of values to those of Python.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde_json::Value;

/// A JSON value as Python objects: dictionaries, lists, strings, numbers, `True`, `False` and `None`.
pub(crate) fn python<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Null => py.None().into_bound(py),
        Value::Bool(value) => value.into_pyobject(py)?.to_owned().into_any(),
        Value::Number(number) => match (number.as_u64(), number.as_i64()) {
            (Some(value), _) => value.into_pyobject(py)?.into_any(),
            (None, Some(value)) => value.into_pyobject(py)?.into_any(),
            (None, None) => number.as_f64().into_pyobject(py)?,
        },
        Value::String(text) => text.into_pyobject(py)?.into_any(),
        Value::Array(items) => {
            let list = PyList::empty(py);
            for item in items {
                list.append(python(py, item)?)?;
            }
            list.into_any()
        }
        Value::Object(members) => {
            let dict = PyDict::new(py);
            for (key, value) in members {
                dict.set_item(key, python(py, value)?)?;
            }
            dict.into_any()
        }
    })
}

/// Moves values into a numpy array that cannot be written. Negative zeros become zeros, as in the files.
pub(crate) fn array(py: Python<'_>, mut values: Vec<f64>) -> Bound<'_, PyArray1<f64>> {
    values.iter_mut().for_each(|value| *value += 0.0);
    let array = PyArray1::from_vec(py, values);
    array.readwrite().make_nonwriteable();
    array
}

/// Moves the rows of a matrix into a numpy array of shape (rows, columns).
pub(crate) fn matrix<'py>(
    py: Python<'py>,
    rows: usize,
    columns: usize,
    values: Vec<f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    PyArray1::from_vec(py, values).reshape([rows, columns])
}

/// A table of comma-separated values as a dictionary of its columns: arrays of numbers where every cell is a number
/// (an empty one is not a number), lists of strings elsewhere.
pub(crate) fn table<'py>(py: Python<'py>, text: &[u8]) -> PyResult<Bound<'py, PyDict>> {
    let unreadable =
        |error: csv::Error| pyo3::exceptions::PyRuntimeError::new_err(error.to_string());
    let mut reader = csv::Reader::from_reader(text);
    let names: Vec<String> = reader
        .headers()
        .map_err(unreadable)?
        .iter()
        .map(str::to_owned)
        .collect();
    let mut columns: Vec<Vec<String>> = vec![Vec::new(); names.len()];
    for record in reader.records() {
        for (column, cell) in columns.iter_mut().zip(record.map_err(unreadable)?.iter()) {
            column.push(cell.to_owned());
        }
    }
    let dict = PyDict::new(py);
    for (name, cells) in names.into_iter().zip(columns) {
        let number = |cell: &String| {
            if cell.is_empty() {
                Some(f64::NAN)
            } else {
                cell.parse().ok()
            }
        };
        match cells.iter().map(number).collect::<Option<Vec<f64>>>() {
            Some(numbers) => dict.set_item(name, PyArray1::from_vec(py, numbers))?,
            None => dict.set_item(name, cells)?,
        }
    }
    Ok(dict)
}
