//! The table of results as a Parquet file.

use std::io::Write;
use std::sync::Arc;

use formats::sweep::AxisValue;
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;

use crate::axis_column::AxisColumn;
use crate::table::ResultTable;

/// Rows of a group, which readers take at once.
const GROUP: usize = 1 << 17;

/// Writes the results as a Parquet file with the columns of [`ResultTable::write_csv`]: `run` as an integer, axes as
/// numbers, strings or true and false, results as numbers that may be missing.
///
/// # Errors
/// Those of the writer.
pub fn write_parquet(table: &ResultTable, to: impl Write + Send) -> Result<(), ParquetError> {
    let kinds: Vec<Physical> = table.axis_values.iter().map(kind).collect();
    let mut fields = vec![field("run", Physical::INT64, Repetition::REQUIRED)?];
    for (name, kind) in table.axes.iter().zip(&kinds) {
        fields.push(field(name, *kind, Repetition::REQUIRED)?);
    }
    for name in &table.columns {
        fields.push(field(name, Physical::DOUBLE, Repetition::OPTIONAL)?);
    }
    let schema = Type::group_type_builder("results")
        .with_fields(fields)
        .build()?;
    let properties = WriterProperties::builder()
        .set_created_by("girderway".to_owned())
        .build();
    let mut writer = SerializedFileWriter::new(to, Arc::new(schema), Arc::new(properties))?;
    for from in (0..table.runs.len()).step_by(GROUP) {
        let rows = from..table.runs.len().min(from + GROUP);
        let mut group = writer.next_row_group()?;
        let mut next =
            |write: &mut dyn FnMut(&mut SerializedColumnWriter<'_>) -> Result<(), ParquetError>| {
                let Some(mut column) = group.next_column()? else {
                    return Ok(());
                };
                write(&mut column)?;
                column.close()
            };
        let runs: Vec<i64> = table.runs[rows.clone()]
            .iter()
            .map(|&run| run as i64)
            .collect();
        next(&mut |column| {
            column
                .typed::<Int64Type>()
                .write_batch(&runs, None, None)
                .map(drop)
        })?;
        for (axis, kind) in table.axis_values.iter().zip(&kinds) {
            let values = rows.clone().map(|row| axis.value(row));
            match kind {
                Physical::DOUBLE => {
                    let numbers: Vec<f64> = values.filter_map(|value| value.number()).collect();
                    next(&mut |column| {
                        column
                            .typed::<DoubleType>()
                            .write_batch(&numbers, None, None)
                            .map(drop)
                    })?;
                }
                Physical::BOOLEAN => {
                    let flags: Vec<bool> =
                        values.map(|value| value == AxisValue::Flag(true)).collect();
                    next(&mut |column| {
                        column
                            .typed::<BoolType>()
                            .write_batch(&flags, None, None)
                            .map(drop)
                    })?;
                }
                _ => {
                    let texts: Vec<ByteArray> = values
                        .map(|value| ByteArray::from(value.to_string().into_bytes()))
                        .collect();
                    next(&mut |column| {
                        column
                            .typed::<ByteArrayType>()
                            .write_batch(&texts, None, None)
                            .map(drop)
                    })?;
                }
            }
        }
        for result in 0..table.columns.len() {
            let values = || rows.clone().map(|row| table.result(result, row));
            let there: Vec<i16> = values().map(|value| i16::from(value.is_some())).collect();
            let numbers: Vec<f64> = values().flatten().collect();
            next(&mut |column| match column.untyped() {
                ColumnWriter::DoubleColumnWriter(writer) => {
                    writer.write_batch(&numbers, Some(&there), None).map(drop)
                }
                _ => Ok(()),
            })?;
        }
        group.close()?;
    }
    writer.close().map(drop)
}

/// The type of an axis: that of its values in the first run.
fn kind(axis: &AxisColumn) -> Physical {
    match (!axis.is_empty()).then(|| axis.value(0)) {
        Some(AxisValue::Text(_)) => Physical::BYTE_ARRAY,
        Some(AxisValue::Flag(_)) => Physical::BOOLEAN,
        Some(AxisValue::Number(_)) | None => Physical::DOUBLE,
    }
}

fn field(name: &str, kind: Physical, repetition: Repetition) -> Result<Arc<Type>, ParquetError> {
    let text = (kind == Physical::BYTE_ARRAY).then_some(LogicalType::String);
    let builder = Type::primitive_type_builder(name, kind).with_repetition(repetition);
    builder.with_logical_type(text).build().map(Arc::new)
}

#[cfg(test)]
mod tests {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    use super::*;
    use crate::outcome::RunRow;
    use crate::records::RunRecord;

    #[test]
    fn a_parquet_file_has_the_values_of_the_table() {
        let record = |run: usize, word: &str, results: &[(&str, f64)]| RunRecord {
            run,
            axes: vec![
                AxisValue::Number(0.1 * run as f64),
                AxisValue::Text(word.to_owned()),
                AxisValue::Flag(run == 1),
            ],
            outcome: Ok(RunRow {
                names: Arc::new(results.iter().map(|(name, _)| (*name).to_owned()).collect()),
                values: results.iter().map(|(_, value)| *value).collect(),
                dimensions: Vec::new(),
            }),
        };
        let records = [
            record(1, "influence", &[("x.max", 0.1), ("x.min", -1.5)]),
            record(3, "rigid", &[("x.min", -1.5)]),
        ];
        let table = ResultTable::new(["/a", "/b", "/c"].map(str::to_owned).to_vec(), records);
        let written = || {
            let mut bytes = Vec::new();
            write_parquet(&table, &mut bytes).expect("memory");
            bytes
        };
        let bytes = written();
        assert_eq!(bytes, written(), "equal tables give equal bytes");
        let reader = SerializedFileReader::new(bytes::Bytes::from(bytes)).expect("a Parquet file");
        let rows: Vec<_> = reader
            .get_row_iter(None)
            .expect("rows")
            .map(|row| row.expect("a row"))
            .collect();
        assert_eq!(rows.len(), 2);
        assert_eq!(rows[1].get_long(0).expect("a number"), 3);
        assert_eq!(rows[1].get_double(1).expect("a number"), 0.1 * 3.0);
        assert_eq!(rows[1].get_string(2).expect("a string"), "rigid");
        assert!(rows[0].get_bool(3).expect("a flag"));
        assert_eq!(rows[0].get_double(4).expect("a number"), 0.1);
        assert!(rows[1].get_double(4).is_err(), "a missing result");
        assert_eq!(rows[1].get_double(5).expect("a number"), -1.5);
    }
}
