//! CSV files whose first line names the columns.

use crate::Reason;
use csv::{ReaderBuilder, StringRecord, Trim};
use std::path::Path;

/// Lines of known columns.
pub(crate) struct Table {
    /// Where each known column stands.
    places: Vec<(&'static str, usize)>,
    rows: Vec<StringRecord>,
}

/// One line.
pub(crate) struct Row<'a> {
    table: &'a Table,
    record: &'a StringRecord,
    pub line: usize,
}

/// What to do with a column that nobody knows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unknown {
    Refused,
    Skipped,
}

impl Table {
    /// Reads a file that must have the `required` columns and may have the `optional` ones, in any order.
    pub fn read(
        path: &Path,
        required: &[&'static str],
        optional: &[&'static str],
        unknown: Unknown,
    ) -> Result<Self, Reason> {
        let bytes = std::fs::read(path)?;
        let mut reader = ReaderBuilder::new().trim(Trim::All).comment(Some(b'#')).from_reader(bytes.as_slice());
        let header = reader.headers().map_err(malformed)?.clone();
        let mut places = Vec::new();
        for (place, name) in header.iter().enumerate() {
            match required.iter().chain(optional).find(|known| **known == name) {
                Some(known) if places.iter().any(|(other, _)| other == known) => {
                    return Err(Reason::Line { line: 1, what: format!("column {name:?} stands there twice") });
                }
                Some(known) => places.push((*known, place)),
                None if unknown == Unknown::Refused => {
                    let known = [required, optional].concat().join(", ");
                    return Err(Reason::Line { line: 1, what: format!("unknown column {name:?}; known are {known}") });
                }
                None => {}
            }
        }
        if let Some(missing) = required.iter().find(|name| places.iter().all(|(known, _)| known != *name)) {
            return Err(Reason::Line { line: 1, what: format!("column {missing:?} is missing") });
        }
        let rows = reader.records().collect::<Result<_, _>>().map_err(malformed)?;
        Ok(Self { places, rows })
    }

    pub fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|record| {
            let line = record.position().map_or(0, |position| position.line() as usize);
            Row { table: self, record, line }
        })
    }
}

fn malformed(error: csv::Error) -> Reason {
    let line = error.position().map_or(1, |position| position.line() as usize);
    match error.kind() {
        csv::ErrorKind::Utf8 { .. } => Reason::Line { line, what: "is not text".into() },
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            Reason::Line { line, what: format!("has {len} columns where the first line names {expected_len}") }
        }
        _ => Reason::syntax(error),
    }
}

impl Row<'_> {
    /// The text in a column; `None` when the file has no such column or nothing stands in it.
    pub fn text(&self, column: &str) -> Option<&str> {
        let place = self.table.places.iter().find(|(name, _)| *name == column)?.1;
        self.record.get(place).filter(|text| !text.is_empty())
    }

    /// A complaint about a column of this line.
    pub fn cell(&self, column: &'static str, what: impl Into<String>) -> Reason {
        Reason::Cell { line: self.line, column, what: what.into() }
    }

    /// The text in a column that must not be empty.
    pub fn needed(&self, column: &'static str) -> Result<&str, Reason> {
        self.text(column).ok_or_else(|| self.cell(column, "is empty"))
    }

    /// A finite number.
    pub fn number(&self, column: &'static str) -> Result<f64, Reason> {
        let text = self.needed(column)?;
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            Ok(_) => Err(self.cell(column, format!("{text} is not finite"))),
            Err(_) => Err(self.cell(column, format!("{text:?} is no number"))),
        }
    }

    /// A finite number, or what stands for it when there is none.
    pub fn number_or(&self, column: &'static str, default: f64) -> Result<f64, Reason> {
        if self.text(column).is_some() { self.number(column) } else { Ok(default) }
    }
}
