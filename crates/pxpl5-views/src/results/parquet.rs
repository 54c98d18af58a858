use super::origin::origin;
use super::pictures::{Column, SCHEMA, columns, rows};
use parquet::basic::{Compression, Repetition, Type as PhysicalType};
use parquet::data_type::Int64Type;
use parquet::errors::Result;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use pxpl5_measure::Report;
use pxpl5_run::Outcome;
use std::io::Write;
use std::sync::Arc;

/// Writes the pictures as Parquet, with uncompressed INT64 columns in one row group.
///
/// # Errors
///
/// Returns [`parquet::errors::ParquetError`] if the writer fails.
pub fn parquet(outcome: &Outcome, out: impl Write + Send) -> Result<()> {
    let columns = columns();
    let fields = columns.iter().map(field).collect::<Result<_>>()?;
    let schema = Type::group_type_builder("pictures").with_fields(fields).build()?;
    let mut writer = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties(outcome)))?;
    let mut group = writer.next_row_group()?;
    let rows = rows(outcome);
    for (i, column) in columns.iter().enumerate() {
        let Some(mut writer) = group.next_column()? else { break };
        // Times are below 2^63 ps, which is about 106 days.
        let values: Vec<i64> = rows.iter().filter_map(|row| row[i]).map(u64::cast_signed).collect();
        // The definition level is 0 for a missing value and 1 for a present one.
        let levels: Vec<i16> = rows.iter().map(|row| row[i].is_some().into()).collect();
        let levels = column.optional.then_some(&levels[..]);
        writer.typed::<Int64Type>().write_batch(&values, levels, None)?;
        writer.close()?;
    }
    group.close()?;
    writer.close()?;
    Ok(())
}

fn field(column: &Column) -> Result<Arc<Type>> {
    let repetition = if column.optional { Repetition::OPTIONAL } else { Repetition::REQUIRED };
    let builder = Type::primitive_type_builder(&column.name, PhysicalType::INT64).with_repetition(repetition);
    Ok(Arc::new(builder.build()?))
}

fn properties(outcome: &Outcome) -> WriterProperties {
    let mut metadata = vec![entry("schema", SCHEMA.to_owned())];
    metadata.extend(origin(&Report::of(outcome)).into_iter().map(|(key, value)| entry(key, value)));
    WriterProperties::builder()
        .set_compression(Compression::UNCOMPRESSED)
        .set_key_value_metadata(Some(metadata))
        .set_created_by(format!("pxpl5 {}", env!("CARGO_PKG_VERSION")))
        .build()
}

fn entry(key: &str, value: String) -> KeyValue {
    KeyValue::new(format!("pxpl5.{key}"), value)
}
