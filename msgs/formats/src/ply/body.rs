//! The numbers behind the header.

use super::header::{Element, Encoding};
use super::{Column, Scalar, Table};
use crate::Reason;
use crate::bytes::Cursor;

/// Reads one element. Nothing is reserved on the header's word: columns grow with the bytes that are really there.
pub(crate) fn read_table(cursor: &mut Cursor<'_>, encoding: Encoding, element: &Element) -> Result<Table, Reason> {
    let mut columns: Vec<Column> = element.properties.iter().map(empty_column).collect();
    // A row without properties takes no bytes, so a count of such rows could not be held against the file.
    let rows = if columns.is_empty() { 0 } else { element.rows };
    for row in 0..rows {
        for (column, property) in columns.iter_mut().zip(&element.properties) {
            let mut next = |kind| {
                number(cursor, encoding, kind)
                    .map_err(|reason| at_row(reason, &element.name, row, rows, &property.name))
            };
            let count = match property.length_kind {
                Some(kind) => list_length(next(kind)?)?,
                None => 1,
            };
            for _ in 0..count {
                column.values.push(next(property.kind)?);
            }
            if let Some(ends) = &mut column.list_ends {
                ends.push(column.values.len());
            }
        }
    }
    Ok(Table { name: element.name.clone(), rows, columns })
}

fn empty_column(property: &super::header::Property) -> Column {
    let list_ends = property.length_kind.map(|_| Vec::new());
    Column { name: property.name.clone(), kind: property.kind, values: Vec::new(), list_ends }
}

fn at_row(reason: Reason, element: &str, row: usize, rows: usize, property: &str) -> Reason {
    match reason {
        Reason::Truncated { .. } => Reason::truncated(format!("{element} {row} of {rows} ({property})")),
        other => other,
    }
}

fn list_length(length: f64) -> Result<usize, Reason> {
    if length >= 0.0 && length.fract() == 0.0 {
        Ok(length as usize)
    } else {
        Err(Reason::syntax(format!("a list cannot have {length} entries")))
    }
}

fn number(cursor: &mut Cursor<'_>, encoding: Encoding, kind: Scalar) -> Result<f64, Reason> {
    match encoding {
        Encoding::Ascii => {
            let word = cursor.word().ok_or_else(|| Reason::truncated(""))?;
            word.parse().map_err(|_| Reason::Line { line: cursor.line(), what: format!("{word:?} is no number") })
        }
        Encoding::LittleEndian => binary(cursor, kind, true),
        Encoding::BigEndian => binary(cursor, kind, false),
    }
}

fn binary(cursor: &mut Cursor<'_>, kind: Scalar, little: bool) -> Result<f64, Reason> {
    macro_rules! take {
        ($t:ty) => {{
            let bytes = cursor.array("")?;
            f64::from(if little { <$t>::from_le_bytes(bytes) } else { <$t>::from_be_bytes(bytes) })
        }};
    }
    Ok(match kind {
        Scalar::I8 => take!(i8),
        Scalar::U8 => take!(u8),
        Scalar::I16 => take!(i16),
        Scalar::U16 => take!(u16),
        Scalar::I32 => take!(i32),
        Scalar::U32 => take!(u32),
        Scalar::F32 => take!(f32),
        Scalar::F64 => take!(f64),
    })
}
