//! PLY: named elements, each a table of named columns (Turk, "The PLY Polygon File Format", 1994).
//!
//! Our own reader, because a surface, a cloud of balls and a stranger's points are then all one table; the crates that were
//! looked at build a hash map for every vertex.

mod body;
mod header;
mod write;

use header::Header;
pub(crate) use write::PlyWriter;

use crate::Reason;
use crate::bytes::Cursor;

/// All that a file holds.
pub(crate) struct Ply {
    pub comments: Vec<String>,
    pub tables: Vec<Table>,
}

/// One element.
pub(crate) struct Table {
    pub name: String,
    pub rows: usize,
    pub columns: Vec<Column>,
}

/// One property of all rows. Every PLY number fits an f64 exactly.
pub(crate) struct Column {
    pub name: String,
    pub kind: Scalar,
    pub values: Vec<f64>,
    /// Where in `values` each row ends; `None` when every row has one value.
    pub list_ends: Option<Vec<usize>>,
}

/// The number types of PLY.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Ply {
    pub fn parse(bytes: &[u8]) -> Result<Self, Reason> {
        let mut cursor = Cursor::new(bytes);
        let header = Header::parse(&mut cursor)?;
        let tables = header.elements.iter().map(|e| body::read_table(&mut cursor, header.encoding, e));
        Ok(Self { tables: tables.collect::<Result<_, _>>()?, comments: header.comments })
    }

    pub fn table(&self, name: &str) -> Option<&Table> {
        self.tables.iter().find(|t| t.name == name)
    }
}

impl Table {
    /// The scalar column of this name.
    pub fn scalar(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|c| c.name == name && c.list_ends.is_none())
    }

    /// The scalar columns of these names, when all are there.
    pub fn scalars<const N: usize>(&self, names: [&str; N]) -> Option<[&Column; N]> {
        let found: Vec<&Column> = names.iter().map_while(|name| self.scalar(name)).collect();
        found.try_into().ok()
    }

    /// The list column that has one of these names.
    pub fn list(&self, names: &[&str]) -> Option<&Column> {
        self.columns.iter().find(|c| names.contains(&c.name.as_str()) && c.list_ends.is_some())
    }
}

impl Column {
    /// The values of each row.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        let ends = self.list_ends.as_deref().unwrap_or_default();
        let starts = std::iter::once(&0).chain(ends);
        starts.zip(ends).map(|(&start, &end)| &self.values[start..end])
    }

    /// A colour channel as a byte: integers are taken as they are, fractions as 0..1.
    pub fn byte(&self, row: usize) -> u8 {
        match self.kind {
            Scalar::F32 | Scalar::F64 => (self.values[row] * 255.0).round() as u8,
            Scalar::U16 => (self.values[row] / 257.0).round() as u8,
            _ => self.values[row] as u8,
        }
    }
}
