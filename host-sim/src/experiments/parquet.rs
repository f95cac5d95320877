//! Rows as a Parquet file.

use std::io::Write;
use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::Result;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use super::row::Row;

/// The values of one column; those that may be missing as options.
enum Column {
    Text(Vec<ByteArray>),
    Flag(Vec<bool>),
    Integer(Vec<i64>),
    Real(Vec<f64>),
    MaybeInteger(Vec<Option<i64>>),
    MaybeReal(Vec<Option<f64>>),
}

/// Writes rows as Parquet, with the columns of [`Row`].
///
/// # Errors
/// Those of `to`.
pub fn write_parquet(rows: &[Row], to: impl Write + Send) -> Result<()> {
    let columns = columns(rows);
    let fields = columns.iter().map(|(name, column)| column.field(name));
    let fields = fields.collect::<Result<Vec<_>>>()?;
    let schema = Type::group_type_builder("run")
        .with_fields(fields)
        .build()?;
    let properties = Arc::new(WriterProperties::default());
    let mut file = SerializedFileWriter::new(to, Arc::new(schema), properties)?;
    let mut group = file.next_row_group()?;
    for (_, column) in &columns {
        if let Some(mut writer) = group.next_column()? {
            column.write(writer.untyped())?;
            writer.close()?;
        }
    }
    group.close()?;
    file.close()?;
    Ok(())
}

impl Column {
    fn field(&self, name: &str) -> Result<Arc<Type>> {
        let (physical, is_text) = match self {
            Self::Text(_) => (Physical::BYTE_ARRAY, true),
            Self::Flag(_) => (Physical::BOOLEAN, false),
            Self::Integer(_) | Self::MaybeInteger(_) => (Physical::INT64, false),
            Self::Real(_) | Self::MaybeReal(_) => (Physical::DOUBLE, false),
        };
        let repetition = match self {
            Self::MaybeInteger(_) | Self::MaybeReal(_) => Repetition::OPTIONAL,
            _ => Repetition::REQUIRED,
        };
        Type::primitive_type_builder(name, physical)
            .with_repetition(repetition)
            .with_logical_type(is_text.then_some(LogicalType::String))
            .build()
            .map(Arc::new)
    }

    fn write(&self, writer: &mut ColumnWriter<'_>) -> Result<()> {
        match (self, writer) {
            (Self::Text(values), ColumnWriter::ByteArrayColumnWriter(writer)) => {
                writer.write_batch(values, None, None)?;
            }
            (Self::Flag(values), ColumnWriter::BoolColumnWriter(writer)) => {
                writer.write_batch(values, None, None)?;
            }
            (Self::Integer(values), ColumnWriter::Int64ColumnWriter(writer)) => {
                writer.write_batch(values, None, None)?;
            }
            (Self::Real(values), ColumnWriter::DoubleColumnWriter(writer)) => {
                writer.write_batch(values, None, None)?;
            }
            (Self::MaybeInteger(values), ColumnWriter::Int64ColumnWriter(writer)) => {
                let (present, levels) = split(values);
                writer.write_batch(&present, Some(&levels), None)?;
            }
            (Self::MaybeReal(values), ColumnWriter::DoubleColumnWriter(writer)) => {
                let (present, levels) = split(values);
                writer.write_batch(&present, Some(&levels), None)?;
            }
            _ => unreachable!("the schema was made from these columns"),
        }
        Ok(())
    }
}

/// The values that are there, and for each value whether it is (1) or not (0).
fn split<T: Copy>(values: &[Option<T>]) -> (Vec<T>, Vec<i16>) {
    let present = values.iter().flatten().copied().collect();
    let levels = values.iter().map(|value| i16::from(value.is_some()));
    (present, levels.collect())
}

fn columns(rows: &[Row]) -> Vec<(&'static str, Column)> {
    let text = |value: fn(&Row) -> String| {
        let bytes = |row| ByteArray::from(value(row).into_bytes());
        Column::Text(rows.iter().map(bytes).collect())
    };
    let integer = |value: fn(&Row) -> i64| Column::Integer(rows.iter().map(value).collect());
    let real = |value: fn(&Row) -> f64| Column::Real(rows.iter().map(value).collect());
    let ticks = |value: fn(&Row) -> Option<u32>| {
        let maybe = |row| value(row).map(i64::from);
        Column::MaybeInteger(rows.iter().map(maybe).collect())
    };
    let cost = |value: fn(&Row) -> Option<f64>| Column::MaybeReal(rows.iter().map(value).collect());
    vec![
        ("family", text(|row| row.family.clone())),
        ("world", text(|row| row.world.clone())),
        ("width", integer(|row| row.width.into())),
        ("height", integer(|row| row.height.into())),
        ("planner", text(|row| row.planner.to_string())),
        ("robots", integer(|row| row.robots.into())),
        ("place", text(|row| row.place.to_string())),
        ("start", integer(|row| row.start.into())),
        ("medium", text(|row| row.medium.to_string())),
        ("sync", integer(|row| row.sync.into())),
        ("loss", real(|row| row.loss)),
        ("range", integer(|row| row.range.into())),
        ("trouble", text(|row| row.trouble.clone())),
        ("preset", text(|row| row.preset.to_string())),
        ("seed", integer(|row| row.seed as i64)),
        (
            "complete",
            Column::Flag(rows.iter().map(|row| row.complete).collect()),
        ),
        ("false_claims", integer(|row| row.false_claims.into())),
        ("closed_share", real(|row| row.closed_share)),
        ("opened_cells", real(|row| row.opened_cells)),
        ("bumps", integer(|row| row.bumps.into())),
        ("ticks_to_90", ticks(|row| row.ticks_to_90)),
        ("ticks_to_99", ticks(|row| row.ticks_to_99)),
        ("ticks_to_seen", ticks(|row| row.ticks_to_seen)),
        ("ticks_to_stopped", ticks(|row| row.ticks_to_stopped)),
        ("ticks", integer(|row| row.ticks.into())),
        ("reachable_cells", integer(|row| row.reachable_cells.into())),
        ("seen_cells", integer(|row| row.seen_cells.into())),
        ("stopped_robots", integer(|row| row.stopped_robots.into())),
        ("robot_ticks", integer(|row| row.robot_ticks as i64)),
        ("waited_ticks", integer(|row| row.waited_ticks as i64)),
        ("steps_mean", real(|row| row.steps_mean)),
        ("steps_sd", real(|row| row.steps_sd)),
        ("steps_max", integer(|row| row.steps_max.into())),
        ("overlap", real(|row| row.overlap)),
        ("work_max", integer(|row| row.work_max.into())),
        ("work_mean", real(|row| row.work_mean)),
        ("bytes", integer(|row| row.bytes as i64)),
        ("assignment_sum", cost(|row| row.assignment_sum)),
        ("assignment_max", cost(|row| row.assignment_max)),
    ]
}
