//! What a user may choose.

use geometry::METRES_PER_MM;
use serde::{Deserialize, Serialize};

/// The settings of the surface. Lengths are millimetres, since people write them.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// Edge of a grid cell, about the edge of a triangle; 0 takes it from the cloud (three eighths of `radius_mm`).
    pub cell_mm: f64,
    /// Radius of the neighbourhood to which a quadric is fitted; 0 takes it from the cloud's spacing and noise. Detail
    /// much smaller than it is smoothed away, noise is averaged over it.
    pub radius_mm: f64,
    /// In the final mesh, holes whose rim is at most pi times this long are filled, by a membrane over the rim, and count as
    /// measured.
    pub fill_holes_mm: f64,
    /// Whether the holes that are left in the final mesh are closed as well, by caps that are told apart from what was
    /// measured ([`wire::Mesh::measured`]). One that would be larger than a third of what was measured is left open, but where
    /// the thing stands on the table with it.
    pub close: bool,
    /// Of a thing that stands on a table: what nobody saw and a cap has nearer to the table than this is taken to stand on it.
    /// The line in the corner between both is lost, or not told from that on the table.
    pub standing_mm: f64,
    /// In the final mesh, loose pieces whose bounding box has a shorter diagonal than this are dropped, and those with less
    /// area than a quarter of its square.
    pub drop_islands_mm: f64,
    /// Seconds between two live surfaces, at least: they are for the eye, and wait until nothing else is to do. 0: none.
    pub live_every_s: f64,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            cell_mm: 0.0,
            radius_mm: 0.0,
            fill_holes_mm: 10.0,
            close: false,
            standing_mm: 3.0,
            drop_islands_mm: 10.0,
            live_every_s: 1.0,
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

impl Config {
    /// Refuses what makes no sense.
    pub fn check(&self) -> Result<(), ConfigError> {
        let automatic_or = |key, value: f64, low: f64, high: f64, wanted| {
            let good = value == 0.0 || (low..=high).contains(&value);
            if good { Ok(()) } else { Err(ConfigError { key, value, wanted }) }
        };
        automatic_or("cell_mm", self.cell_mm, 0.02, 1000.0, "0 (automatic) or 0.02 to 1000 mm")?;
        automatic_or("radius_mm", self.radius_mm, 0.05, 1000.0, "0 (automatic) or 0.05 to 1000 mm")?;
        automatic_or("fill_holes_mm", self.fill_holes_mm, 0.0, 1e6, "0 (none) to 1000000 mm")?;
        automatic_or("standing_mm", self.standing_mm, 0.0, 1e3, "0 to 1000 mm")?;
        automatic_or("drop_islands_mm", self.drop_islands_mm, 0.0, 1e6, "0 (none) to 1000000 mm")?;
        automatic_or("live_every_s", self.live_every_s, 0.05, 1e6, "0 (none) or 0.05 s and more")?;
        let ratio = self.radius_mm / self.cell_mm;
        if ratio.is_finite() && ratio > 0.0 && !(2.0..=24.0).contains(&ratio) {
            let wanted = "between 2 and 24 times cell_mm, or 0 (automatic)";
            return Err(ConfigError { key: "radius_mm", value: self.radius_mm, wanted });
        }
        Ok(())
    }

    pub(crate) fn cell_m(&self) -> Option<f64> {
        (self.cell_mm > 0.0).then_some(self.cell_mm * METRES_PER_MM)
    }

    pub(crate) fn standing_m(&self) -> f32 {
        (self.standing_mm * METRES_PER_MM) as f32
    }

    pub(crate) fn radius_m(&self) -> Option<f64> {
        (self.radius_mm > 0.0).then_some(self.radius_mm * METRES_PER_MM)
    }
}
