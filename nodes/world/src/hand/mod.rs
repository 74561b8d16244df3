//! The operator's hand.

use serde::Deserialize;

/// `[hand]` of a scene file: how a person would sweep over this scene.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HandSection {
    /// Distance of the camera from the surface, on average.
    pub stand_off_mm: f64,
}

impl Default for HandSection {
    fn default() -> Self {
        Self { stand_off_mm: 200.0 }
    }
}
