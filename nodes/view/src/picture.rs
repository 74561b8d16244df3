//! A frame, shrunk for showing.

use wire::Frame;

/// Red, green, blue, row by row, with the factor by which it was shrunk.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Pixels of the frame for one of these, along each axis.
    pub shrunk_by: u32,
    /// 3 bytes a pixel.
    pub rgb: Vec<u8>,
}

/// Shrinks a frame to at most `max_width` pixels across, taking the brightest of each block: a thin bright laser line
/// stays visible. `None` when the frame's bytes contradict its size.
pub fn shrink(frame: &Frame, max_width: u32) -> Option<Picture> {
    frame.check().ok()?;
    let by = frame.width.div_ceil(max_width.max(1)).max(1);
    let (width, height) = (frame.width / by, frame.height / by);
    let mut rgb = Vec::with_capacity(3 * (width * height) as usize);
    for y in 0..height {
        for x in 0..width {
            let mut brightest = [0u8; 3];
            for dy in 0..by {
                for dx in 0..by {
                    let row = &frame.data[(y * by + dy) as usize * frame.stride as usize..];
                    let pixel = frame.format.rgb(row, (x * by + dx) as usize);
                    brightest = std::array::from_fn(|c| brightest[c].max(pixel[c]));
                }
            }
            rgb.extend_from_slice(&brightest);
        }
    }
    Some(Picture { width, height, shrunk_by: by, rgb })
}
