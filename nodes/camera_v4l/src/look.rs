//! What a picture looks like: how much of a line it shows, and how bright it is.

use serde::{Deserialize, Serialize};
use wire::{Frame, FrameError, LaserPlane, PeaksPer, PixelFormat};

/// How a line and a lamp are told.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LightConfig {
    /// Height of a line above what lies beside it, in grey levels of the laser channel.
    pub stripe_height: f32,
    /// At least this share of the rows (or columns) shows the line when the laser alone is on.
    pub stripe_share: f32,
    /// The lamp makes a picture brighter by at least so many stops: 1 is twice the light.
    pub lamp_stops: f32,
}

impl Default for LightConfig {
    fn default() -> Self {
        Self { stripe_height: 25.0, stripe_share: 0.05, lamp_stops: 1.0 }
    }
}

/// A picture is looked at in parts from top to bottom, since a rolling shutter sees a switch in the middle of it.
pub const BANDS: usize = 8;

/// What a picture looks like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// Share of the rows (or columns) that show a line which goes on in the next.
    pub stripe_share: f32,
    /// Light of each band, from top to bottom, in stops: the binary logarithm of its mean, in full scales of the sensor at
    /// gain 1 and an exposure of 1 ms. So it says what is lit, however the camera is set.
    pub brightness: [f32; BANDS],
}

/// Of the rows or columns one in so many is looked at, and for the brightness one pixel in so many.
const STEP: usize = 8;
/// A line is over so far from its middle.
const REACH_PX: usize = 16;
/// From one row that is looked at to the next, a line goes aside by this much at most; bright spots of a texture jump.
const LINK_PX: usize = 2 * STEP;

/// Looks at a sample of the pixels.
///
/// # Errors
/// A frame whose bytes contradict its header.
pub fn look(frame: &Frame, laser: &LaserPlane, config: &LightConfig) -> Result<Look, FrameError> {
    frame.check()?;
    let (width, height) = (frame.width as usize, frame.height as usize);
    let weights = laser.channel_weights.map(|w| w as f32);
    let (lines, length) = match laser.peaks_per {
        PeaksPer::Row => (height, width),
        PeaksPer::Column => (width, height),
    };
    let mut levels = vec![0.0; length];
    let (mut linked, mut looked_at) = (0_u32, 0_u32);
    let mut before: Option<usize> = None;
    for line in (STEP / 2..lines).step_by(STEP) {
        for (at, level) in levels.iter_mut().enumerate() {
            let (u, v) = if laser.peaks_per == PeaksPer::Row { (at, line) } else { (line, at) };
            let [r, g, b] = rgb(frame, u, v);
            let is_grey = frame.format == PixelFormat::Grey8;
            *level = if is_grey { r } else { weights[0] * r + weights[1] * g + weights[2] * b };
        }
        let now = line_at(&levels, config.stripe_height);
        looked_at += 1;
        linked += u32::from(now.zip(before).is_some_and(|(now, before)| now.abs_diff(before) <= LINK_PX));
        before = now;
    }
    let light = light_of_level(frame.gamma);
    let brightness = std::array::from_fn(|band| {
        let (first, last) = (band * height / BANDS, (band + 1) * height / BANDS);
        (mean_light(frame, &light, first..last.max(first + 1).min(height)) + DARKEST).log2() - sensitivity_stops(frame)
    });
    Ok(Look { stripe_share: linked as f32 / looked_at.max(1) as f32, brightness })
}

/// The highest place, if it stands out from what lies on either side of it.
fn line_at(levels: &[f32], height: f32) -> Option<usize> {
    let (at, &top) = levels.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    let lower =
        |beside: Option<usize>| beside.and_then(|beside| levels.get(beside)).is_none_or(|level| top - level >= height);
    let stands_out = levels.len() > REACH_PX && lower(at.checked_sub(REACH_PX)) && lower(at.checked_add(REACH_PX));
    stands_out.then_some(at)
}

/// Less light, as a share of full scale, is noise.
const DARKEST: f32 = 1.0 / 1024.0;

/// By how many stops gain and exposure make a picture brighter; an exposure that nobody knows is always the same.
fn sensitivity_stops(frame: &Frame) -> f32 {
    let millis = if frame.exposure_nanos > 0 { frame.exposure_nanos as f32 * 1e-6 } else { 1.0 };
    (frame.gain.max(f32::MIN_POSITIVE) * millis).log2()
}

/// The light behind each grey level, 0 to 1.
fn light_of_level(gamma: f32) -> [f32; 256] {
    std::array::from_fn(|level| (level as f32 / 255.0).powf(gamma))
}

/// The line itself is too narrow to matter.
fn mean_light(frame: &Frame, light: &[f32; 256], rows: std::ops::Range<usize>) -> f32 {
    let (mut sum, mut count) = (0.0, 0_u32);
    for v in rows.step_by(STEP / 2) {
        for u in (0..frame.width as usize).step_by(STEP) {
            let [r, g, b] = rgb(frame, u, v);
            sum += light[usize::from((0.299 * r + 0.587 * g + 0.114 * b) as u8)];
            count += 1;
        }
    }
    sum / count.max(1) as f32
}

/// A pixel of a checked frame.
fn rgb(frame: &Frame, u: usize, v: usize) -> [f32; 3] {
    frame.format.rgb(&frame.data[v * frame.stride as usize..], u).map(f32::from)
}
