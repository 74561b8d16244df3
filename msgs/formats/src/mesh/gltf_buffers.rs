//! The binary part of glTF. The crate's own readers trust offsets and counts; here each is held against the bytes.

use super::picture;
use crate::Reason;
use ::gltf::accessor::{DataType, Dimensions};
use ::gltf::image::Source;
use ::gltf::mesh::Mode;
use ::gltf::{Accessor, Document, buffer};
use ::image::RgbImage;
use std::path::Path;

/// The buffers of one file.
pub(super) struct Buffers(Vec<Vec<u8>>);

/// Rows of numbers.
pub(super) struct Floats {
    values: Vec<f32>,
    width: usize,
}

impl Floats {
    /// The first `width` numbers of each row; no rows at all when there are fewer.
    pub fn rows(&self, width: usize) -> impl Iterator<Item = &[f32]> {
        let rows = if self.width < width { &[] } else { self.values.as_slice() };
        rows.chunks_exact(self.width).map(move |row| &row[..width])
    }
}

impl Buffers {
    pub fn load(document: &Document, folder: &Path, mut blob: Option<Vec<u8>>) -> Result<Self, Reason> {
        let load = |buffer: buffer::Buffer<'_>| {
            let bytes = match buffer.source() {
                buffer::Source::Bin => blob.take().ok_or_else(|| Reason::syntax("has no binary chunk"))?,
                buffer::Source::Uri(uri) if uri.starts_with("data:") => {
                    buffer::Data::from_source(buffer.source(), Some(folder)).map_err(Reason::syntax)?.0
                }
                buffer::Source::Uri(uri) => {
                    let looked_for = folder.join(decoded(uri)?);
                    std::fs::read(&looked_for).map_err(|e| Reason::Companion {
                        named: uri.to_owned(),
                        looked_for,
                        why: e.to_string(),
                    })?
                }
            };
            let (there, promised) = (bytes.len(), buffer.length());
            if there < promised {
                let inside = format!("buffer {} ({there} of {promised} bytes)", buffer.index());
                return Err(Reason::truncated(inside));
            }
            Ok(bytes)
        };
        document.buffers().map(load).collect::<Result<_, _>>().map(Self)
    }

    fn view(&self, view: &buffer::View<'_>) -> Result<&[u8], Reason> {
        let buffer = self.0.get(view.buffer().index()).map_or(&[][..], Vec::as_slice);
        let end = view.offset().checked_add(view.length());
        let bytes = end.and_then(|end| buffer.get(view.offset()..end));
        bytes.ok_or_else(|| Reason::syntax(format!("buffer view {} lies outside its buffer", view.index())))
    }

    /// The bytes of each element of an accessor.
    fn elements(&self, accessor: &Accessor<'_>) -> Result<Vec<&[u8]>, Reason> {
        let bad = |what: &str| Reason::syntax(format!("accessor {} {what}", accessor.index()));
        if accessor.sparse().is_some() {
            return Err(bad("is sparse, which is not understood"));
        }
        let view = accessor.view().ok_or_else(|| bad("has no buffer view"))?;
        let bytes = self.view(&view)?;
        let (size, stride) = (accessor.size(), view.stride().unwrap_or(accessor.size()));
        let element = |i: usize| {
            let start = stride.checked_mul(i)?.checked_add(accessor.offset())?;
            bytes.get(start..start.checked_add(size)?)
        };
        let count = accessor.count();
        if stride < size || (count > 0 && element(count - 1).is_none()) {
            return Err(bad("lies outside its buffer view"));
        }
        Ok((0..count).filter_map(element).collect())
    }

    /// Numbers; integers are the fractions of their largest value that glTF means by them.
    pub fn floats(&self, accessor: &Accessor<'_>) -> Result<Floats, Reason> {
        let (kind, width) = (accessor.data_type(), accessor.dimensions().multiplicity());
        let size = kind.size();
        let elements = self.elements(accessor)?;
        let values =
            elements.iter().flat_map(|e| e[..size * width].chunks_exact(size)).map(|bytes| fraction(kind, bytes));
        Ok(Floats { values: values.collect(), width })
    }

    /// Whole numbers.
    pub fn integers(&self, accessor: &Accessor<'_>) -> Result<Vec<u32>, Reason> {
        let wanted = matches!(accessor.data_type(), DataType::U8 | DataType::U16 | DataType::U32);
        if !wanted || accessor.dimensions() != Dimensions::Scalar {
            return Err(Reason::syntax(format!("accessor {} holds no indices", accessor.index())));
        }
        let whole = |bytes: &&[u8]| bytes.iter().rev().fold(0, |value, &byte| value << 8 | u32::from(byte));
        Ok(self.elements(accessor)?.iter().map(whole).collect())
    }

    pub fn picture(&self, image: &::gltf::Image<'_>, folder: &Path) -> Result<RgbImage, Reason> {
        match image.source() {
            Source::View { view, .. } => Ok(picture::decode(self.view(&view)?)?),
            Source::Uri { uri, .. } if uri.starts_with("data:") => {
                // A picture in a data URI is spelled like a buffer in one.
                let bytes = buffer::Data::from_source(buffer::Source::Uri(uri), Some(folder));
                Ok(picture::decode(&bytes.map_err(Reason::syntax)?.0)?)
            }
            Source::Uri { uri, .. } => picture::beside(folder, &decoded(uri)?),
        }
    }
}

fn fraction(kind: DataType, bytes: &[u8]) -> f32 {
    match (kind, bytes) {
        (DataType::F32, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]),
        (DataType::U8, &[a]) => f32::from(a) / 255.0,
        (DataType::I8, &[a]) => (f32::from(a as i8) / 127.0).max(-1.0),
        (DataType::U16, &[a, b]) => f32::from(u16::from_le_bytes([a, b])) / 65535.0,
        (DataType::I16, &[a, b]) => (f32::from(i16::from_le_bytes([a, b])) / 32767.0).max(-1.0),
        // Not allowed for attributes; refused later, as a vertex that is not finite.
        _ => f32::NAN,
    }
}

/// `my%20skin.png` to `my skin.png`.
fn decoded(uri: &str) -> Result<String, Reason> {
    if uri.contains("://") {
        return Err(Reason::syntax(format!("{uri:?} is not a file beside this one")));
    }
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, behind)) = rest.split_first() {
        let hex = behind.get(..2).and_then(|h| u8::from_str_radix(std::str::from_utf8(h).ok()?, 16).ok());
        match hex {
            Some(byte) if first == b'%' => {
                bytes.push(byte);
                rest = &behind[2..];
            }
            _ => {
                bytes.push(first);
                rest = behind;
            }
        }
    }
    String::from_utf8(bytes).map_err(|_| Reason::syntax(format!("{uri:?} is no file name")))
}

/// Triangles in the order of a primitive's corners; none for points and lines.
pub(super) fn indices(mode: Mode, order: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::Triangles => order.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        Mode::TriangleFan => order.windows(2).skip(1).map(|pair| [order[0], pair[0], pair[1]]).collect(),
        Mode::TriangleStrip => order
            .windows(3)
            .enumerate()
            .map(|(i, c)| if i % 2 == 0 { [c[0], c[1], c[2]] } else { [c[0], c[2], c[1]] })
            .collect(),
        _ => Vec::new(),
    }
}
