//! What the painter may be told.

use serde::{Deserialize, Serialize};

/// How colour is put onto the surface. All defaults are the paper's rules where it states one (section 2.6).
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// Edge of one texture cell on the plane of its chart. The paper: 1 mm.
    pub cell_mm: f64,
    /// A chart holds triangles whose normals lie within this angle of its axis, so a cell is at most
    /// 1 / cos(angle) longer on the surface than on the texture: 1.22 for 35 degrees.
    pub chart_degrees: f64,
    /// No texture is wider or higher than this many texels.
    pub texture_side_max: u32,
    /// Largest angle between the surface's normal and the line of sight. The paper: 45 degrees.
    pub facing_degrees: f64,
    /// Largest angle between a line of sight and the optical axis. The paper: 15 degrees.
    pub axis_degrees: f64,
    /// A pixel with any channel at or above this value is saturated and colours nothing.
    pub saturated_from: u8,
    /// How far a cell may lie behind what the picture sees in its place and still be what is seen there; the width of
    /// one and a half pixels at that distance is added, for surfaces seen at a slant.
    pub depth_tolerance_mm: f64,
    /// A step in depth from one pixel to the next, beyond what the slant explains, that counts as an edge.
    pub edge_jump_mm: f64,
    /// Pixels this near to an edge in depth colour nothing: a small error of the pose would put the colour of what is
    /// in front onto what is behind it. Raise it for a coarse tracker.
    pub edge_margin_px: u32,
    /// Estimates kept for each cell, 1 to 32. More come in: the kept ones are a fair draw from them all.
    pub samples_per_cell: usize,
    /// Position of the lamp in the frame of the camera (the paper's light centre l).
    pub lamp_from_camera_m: [f64; 3],
    /// Brightness falls as this power of the cosine of the angle off the optical axis (Horn 1986: 4); 0 for a lens
    /// that is corrected for it.
    pub vignetting_exponent: f64,
    /// Light that does not come from the lamp, for red, green and blue, as a share of the lamp's on a surface that
    /// faces it at 0.2 m. Left out, it is estimated: the ambient light under which the views of each cell agree best.
    pub ambient: Option<[f64; 3]>,
    /// Surfaces that mirror the lamp into the lens to within this angle may gleam: their estimates get a tenth of the
    /// weight.
    pub highlight_degrees: f64,
    /// This share of the seen cells is darker than `white_albedo` in the finished texture (one gain for all channels).
    pub white_percentile: f64,
    /// The linear value that `white_percentile` of the cells stays below: 0.8 is 231 of 255 in sRGB.
    pub white_albedo: f64,
    /// Passes of the 1-2-1 / 2-4-2 / 1-2-1 blur. The paper: 1, for cells of 1 mm. Where cells are about as fine as the
    /// pictures' pixels it is most of what colours err, so the demo (cells of 0.25 mm) has 0.
    pub blur_passes: usize,
    /// Whether the pictures are moved a little until they agree, before they are painted. A lamp-lit picture stands
    /// between laser-lit ones, which alone tell the way, and the hand's tremor at its own moment is not known.
    pub settle: bool,
    /// How far a picture's pose errs along each axis (one standard deviation).
    pub settle_shift_mm: f64,
    /// How far it errs about each axis (one standard deviation).
    pub settle_turn_degrees: f64,
    /// Pictures that wait for the final mesh take at most this many MiB of memory.
    pub memory_mib: usize,
    /// Seconds between two coloured live surfaces, at least: coarse ones, for the eye. 0: none.
    pub live_every_s: f64,
    /// So many pictures, spread over the scan so far, colour a live surface.
    pub live_pictures: usize,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            cell_mm: 1.0,
            chart_degrees: 35.0,
            texture_side_max: 8192,
            facing_degrees: 45.0,
            axis_degrees: 15.0,
            saturated_from: 250,
            depth_tolerance_mm: 0.25,
            edge_jump_mm: 1.0,
            edge_margin_px: 2,
            samples_per_cell: 8,
            lamp_from_camera_m: [0.0; 3],
            vignetting_exponent: 4.0,
            ambient: None,
            highlight_degrees: 12.0,
            white_percentile: 0.99,
            white_albedo: 0.8,
            blur_passes: 1,
            settle: true,
            settle_shift_mm: 0.7,
            settle_turn_degrees: 0.4,
            memory_mib: 512,
            live_every_s: 3.0,
            live_pictures: 40,
        }
    }
}

/// A setting that cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{key} = {value}: {wanted}")]
pub struct ConfigError {
    /// The key.
    pub key: &'static str,
    /// What it holds.
    pub value: f64,
    /// What it should hold.
    pub wanted: &'static str,
}

/// Most estimates that a cell can keep.
pub(crate) const SAMPLES_MAX: usize = 32;

impl Config {
    /// Refuses settings that cannot be.
    pub fn check(&self) -> Result<(), ConfigError> {
        let within = |key, value: f64, low: f64, high: f64, wanted| {
            if (low..=high).contains(&value) { Ok(()) } else { Err(ConfigError { key, value, wanted }) }
        };
        within("cell_mm", self.cell_mm, 0.01, 100.0, "0.01 to 100 mm")?;
        within("chart_degrees", self.chart_degrees, 5.0, 60.0, "5 to 60 degrees")?;
        within("texture_side_max", self.texture_side_max.into(), 16.0, 16384.0, "16 to 16384 texels")?;
        within("facing_degrees", self.facing_degrees, 1.0, 85.0, "1 to 85 degrees")?;
        within("axis_degrees", self.axis_degrees, 1.0, 60.0, "1 to 60 degrees")?;
        within("saturated_from", self.saturated_from.into(), 1.0, 255.0, "1 to 255")?;
        within("depth_tolerance_mm", self.depth_tolerance_mm, 0.0, 100.0, "0 to 100 mm")?;
        within("edge_jump_mm", self.edge_jump_mm, 0.01, 1000.0, "0.01 to 1000 mm")?;
        within("edge_margin_px", self.edge_margin_px.into(), 0.0, 64.0, "0 to 64 pixels")?;
        within("samples_per_cell", self.samples_per_cell as f64, 1.0, SAMPLES_MAX as f64, "1 to 32 estimates")?;
        for value in self.lamp_from_camera_m {
            within("lamp_from_camera_m", value, -10.0, 10.0, "each within 10 m")?;
        }
        within("vignetting_exponent", self.vignetting_exponent, 0.0, 16.0, "0 to 16")?;
        for value in self.ambient.into_iter().flatten() {
            within("ambient", value, 0.0, 1e3, "0 to 1000 times the lamp")?;
        }
        within("highlight_degrees", self.highlight_degrees, 0.0, 90.0, "0 to 90 degrees")?;
        within("white_percentile", self.white_percentile, 0.5, 1.0, "0.5 to 1")?;
        within("white_albedo", self.white_albedo, 0.01, 1.0, "0.01 to 1")?;
        within("blur_passes", self.blur_passes as f64, 0.0, 8.0, "0 to 8 passes")?;
        within("settle_shift_mm", self.settle_shift_mm, 1e-3, 100.0, "0.001 to 100 mm")?;
        within("settle_turn_degrees", self.settle_turn_degrees, 1e-3, 10.0, "0.001 to 10 degrees")?;
        within("memory_mib", self.memory_mib as f64, 1.0, 1e6, "1 to 1000000 MiB")?;
        within("live_every_s", self.live_every_s, 0.0, 3600.0, "0 to 3600 s")?;
        within("live_pictures", self.live_pictures as f64, 1.0, 1e4, "1 to 10000 pictures")
    }

    /// Edge of one cell, in metres.
    pub fn cell_m(&self) -> f64 {
        self.cell_mm * geometry::METRES_PER_MM
    }
}
