//! The lines before `end_header`.

use super::Scalar;
use crate::Reason;
use crate::bytes::Cursor;

/// How the numbers behind the header are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

pub(crate) struct Header {
    pub encoding: Encoding,
    pub comments: Vec<String>,
    pub elements: Vec<Element>,
}

pub(crate) struct Element {
    pub name: String,
    pub rows: usize,
    pub properties: Vec<Property>,
}

pub(crate) struct Property {
    pub name: String,
    pub kind: Scalar,
    /// The type of a list's length.
    pub length_kind: Option<Scalar>,
}

impl Header {
    pub fn parse(cursor: &mut Cursor<'_>) -> Result<Self, Reason> {
        if cursor.next_line().is_none_or(|line| line.trim_ascii() != b"ply") {
            return Err(Reason::syntax("does not begin with the line \"ply\""));
        }
        let mut header = Self { encoding: Encoding::Ascii, comments: Vec::new(), elements: Vec::new() };
        let mut format_seen = false;
        for line_number in 2.. {
            let bytes = cursor.next_line().ok_or_else(|| Reason::truncated("the header"))?;
            let bad = |what: String| Reason::Line { line: line_number, what };
            let line = std::str::from_utf8(bytes).map_err(|_| bad("the header is not text".into()))?.trim();
            if line == "end_header" {
                break;
            }
            if line.starts_with("format ") {
                format_seen = true;
            }
            header.take_line(line).map_err(bad)?;
        }
        if format_seen { Ok(header) } else { Err(Reason::syntax("the header has no \"format\" line")) }
    }

    fn take_line(&mut self, line: &str) -> Result<(), String> {
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match words.as_slice() {
            ["comment" | "obj_info", ..] => {
                self.comments.push(line.split_once(' ').map_or("", |(_, text)| text.trim()).to_owned());
            }
            [] => {}
            ["format", name, _version] => self.encoding = encoding(name)?,
            ["element", name, rows] => {
                let rows = rows.parse().map_err(|_| format!("{rows:?} is no count of {name}"))?;
                self.elements.push(Element { name: (*name).to_owned(), rows, properties: Vec::new() });
            }
            ["property", rest @ ..] => {
                let element = self.elements.last_mut().ok_or("a property before any element")?;
                element.properties.push(property(rest).ok_or_else(|| format!("{line:?} is no property"))?);
            }
            _ => return Err(format!("{line:?} is not understood")),
        }
        Ok(())
    }
}

fn encoding(name: &str) -> Result<Encoding, String> {
    match name {
        "ascii" => Ok(Encoding::Ascii),
        "binary_little_endian" => Ok(Encoding::LittleEndian),
        "binary_big_endian" => Ok(Encoding::BigEndian),
        _ => {
            Err(format!("format {name:?} is not understood; known are ascii, binary_little_endian, binary_big_endian"))
        }
    }
}

fn property(words: &[&str]) -> Option<Property> {
    let (kind, length_kind, name) = match words {
        ["list", length, kind, name] => (kind, Some(scalar(length)?), name),
        [kind, name] => (kind, None, name),
        _ => return None,
    };
    Some(Property { name: (*name).to_owned(), kind: scalar(kind)?, length_kind })
}

fn scalar(name: &str) -> Option<Scalar> {
    Some(match name {
        "char" | "int8" => Scalar::I8,
        "uchar" | "uint8" => Scalar::U8,
        "short" | "int16" => Scalar::I16,
        "ushort" | "uint16" => Scalar::U16,
        "int" | "int32" => Scalar::I32,
        "uint" | "uint32" => Scalar::U32,
        "float" | "float32" => Scalar::F32,
        "double" | "float64" => Scalar::F64,
        _ => return None,
    })
}
