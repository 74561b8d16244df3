//! The pictures that a mesh file names or holds.

use crate::{Reason, image_file};
use image::RgbImage;
use std::path::Path;

/// A picture beside the mesh file, by the name that the file gives it.
pub(super) fn beside(folder: &Path, named: &str) -> Result<RgbImage, Reason> {
    // Files from Windows spell folders with a backslash.
    let looked_for = folder.join(named.replace('\\', "/"));
    let companion = |why: String| Reason::Companion { named: named.to_owned(), looked_for: looked_for.clone(), why };
    let bytes = std::fs::read(&looked_for).map_err(|e| companion(e.to_string()))?;
    decode(&bytes).map_err(|e| companion(e.to_string()))
}

/// A picture from its bytes.
pub(super) fn decode(bytes: &[u8]) -> Result<RgbImage, image::ImageError> {
    Ok(image_file::decode(bytes)?.into_rgb8())
}
