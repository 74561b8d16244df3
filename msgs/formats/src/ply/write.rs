//! Writing: always binary, little-endian, the encoding that every reader knows and that loses nothing.

use std::io::{self, Write};

/// Declares elements, then takes their values.
pub(crate) struct PlyWriter<W: Write> {
    out: W,
}

impl<W: Write> PlyWriter<W> {
    pub fn begin(mut out: W, comments: &[&str]) -> io::Result<Self> {
        writeln!(out, "ply\nformat binary_little_endian 1.0")?;
        for comment in comments {
            writeln!(out, "comment {comment}")?;
        }
        Ok(Self { out })
    }

    pub fn element(&mut self, name: &str, rows: usize) -> io::Result<()> {
        writeln!(self.out, "element {name} {rows}")
    }

    /// Properties of the last element; `kind` may be "list uchar uint".
    pub fn properties(&mut self, kind: &str, names: &[&str]) -> io::Result<()> {
        names.iter().try_for_each(|name| writeln!(self.out, "property {kind} {name}"))
    }

    pub fn end_header(&mut self) -> io::Result<()> {
        writeln!(self.out, "end_header")
    }

    /// Plain values as their bytes; this machine is little-endian (the crate `wire` refuses to build elsewhere).
    pub fn values<T: bytemuck::NoUninit>(&mut self, values: &[T]) -> io::Result<()> {
        self.out.write_all(bytemuck::cast_slice(values))
    }
}
