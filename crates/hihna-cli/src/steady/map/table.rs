//! A map as CSV and as Parquet.

use std::fmt::Write;
use std::sync::Arc;

use hihna::record::RecordError;
use hihna::steady::running::map::Map;
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

/// Comma-separated values: `answer`, then the columns; empty where there is no number.
pub fn csv(map: &Map) -> String {
    let mut text = String::from("answer");
    // Writing to a string cannot fail.
    for column in &map.columns {
        let _ = write!(text, ",{column}");
    }
    text.push('\n');
    for row in &map.rows {
        text.push_str(row.answer);
        for value in &row.values {
            text.push(',');
            if value.is_finite() {
                let _ = write!(text, "{value}");
            }
        }
        text.push('\n');
    }
    text
}

/// The same columns as a Parquet file: text, then optional doubles.
pub fn parquet(map: &Map) -> Result<Vec<u8>, RecordError> {
    write(map).map_err(|cause| RecordError::Encode {
        file: "map.parquet",
        cause: cause.into(),
    })
}

fn write(map: &Map) -> Result<Vec<u8>, ParquetError> {
    let mut fields = vec![Arc::new(
        Type::primitive_type_builder("answer", Physical::BYTE_ARRAY)
            .with_logical_type(Some(LogicalType::String))
            .with_repetition(Repetition::REQUIRED)
            .build()?,
    )];
    for column in &map.columns {
        let number = Type::primitive_type_builder(column, Physical::DOUBLE)
            .with_repetition(Repetition::OPTIONAL)
            .build()?;
        fields.push(Arc::new(number));
    }
    let schema = Type::group_type_builder("map")
        .with_fields(fields)
        .build()?;
    let properties = Arc::new(WriterProperties::builder().build());
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, Arc::new(schema), properties)?;
    let mut group = writer.next_row_group()?;
    if let Some(mut column) = group.next_column()? {
        let answers: Vec<_> = map
            .rows
            .iter()
            .map(|row| ByteArray::from(row.answer))
            .collect();
        column
            .typed::<ByteArrayType>()
            .write_batch(&answers, None, None)?;
        column.close()?;
    }
    for i in 0..map.columns.len() {
        if let Some(mut column) = group.next_column()? {
            let all = map.rows.iter().map(|row| row.values[i]);
            let there: Vec<i16> = all
                .clone()
                .map(|value| i16::from(value.is_finite()))
                .collect();
            let values: Vec<f64> = all.filter(|value| value.is_finite()).collect();
            column
                .typed::<DoubleType>()
                .write_batch(&values, Some(&there), None)?;
            column.close()?;
        }
    }
    group.close()?;
    writer.close()?;
    Ok(bytes)
}
