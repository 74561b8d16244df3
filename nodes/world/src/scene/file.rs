//! A scene as a file: config/scenes/*.toml.

use crate::HandSection;
use crate::shape::{Pattern, Primitive};
use serde::Deserialize;
use std::path::PathBuf;

/// What a scene file holds.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SceneFile {
    /// What is scanned: the name of one object, or `all` for everything on the table, merged.
    pub subject: String,
    /// Irradiance of the room's even light, in units of the lamp's at 0.2 m.
    pub ambient: f32,
    /// The table; without this section there is none.
    pub table: Option<TableSection>,
    /// The sweep.
    pub hand: HandSection,
    /// What stands on the table: `[[object]]`.
    #[serde(rename = "object")]
    pub objects: Vec<ObjectSection>,
}

impl Default for SceneFile {
    fn default() -> Self {
        Self { subject: ALL.to_owned(), ambient: 0.08, table: None, hand: HandSection::default(), objects: Vec::new() }
    }
}

/// The subject that is everything on the table.
pub const ALL: &str = "all";

/// `[table]`: its top is z = 0, its centre the world's origin.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TableSection {
    /// Along x and y.
    pub size_mm: [f64; 2],
    /// Its colour (sRGB).
    pub colour: [u8; 3],
    /// How far the grain of the wood goes from that colour, in grey levels.
    pub grain: u8,
}

impl Default for TableSection {
    fn default() -> Self {
        Self { size_mm: [360.0, 280.0], colour: [150, 146, 136], grain: 9 }
    }
}

/// What an object is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// The toy cow.
    Cow,
    /// A mesh of the user's: OBJ, PLY, STL or GLB.
    Mesh,
    /// See [`Primitive`].
    #[serde(untagged)]
    Primitive(Primitive),
}

/// Which way is up in a mesh's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Up {
    /// As glTF prescribes.
    Y,
    /// As here.
    Z,
}

/// `[[object]]`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectSection {
    /// "cow", "mesh", "box", "sphere", "cylinder", "cone", "mug", "skittle".
    pub kind: Kind,
    /// What messages and `subject` call it; its kind when it does not say.
    #[serde(default)]
    pub name: Option<String>,
    /// The mesh, beside the scene file unless absolute; for kind "mesh" alone.
    #[serde(default)]
    pub file: Option<PathBuf>,
    /// Which way is up in that file; y in a glTF and z in all others when it does not say.
    #[serde(default)]
    pub up: Option<Up>,
    /// Its largest side; all sides are scaled alike. 0 keeps `sides_mm`.
    #[serde(default)]
    pub size_mm: f64,
    /// The proportions of a primitive, and without `size_mm` its size.
    #[serde(default = "default_sides")]
    pub sides_mm: [f64; 3],
    /// Where its middle stands on the table.
    #[serde(default)]
    pub at_mm: [f64; 2],
    /// How far its foot is above the table.
    #[serde(default)]
    pub lift_mm: f64,
    /// Turned to the left, seen from above.
    #[serde(default)]
    pub yaw_deg: f64,
    /// A primitive's colours (sRGB).
    #[serde(default = "default_colours")]
    pub colours: [[u8; 3]; 2],
    /// Where a primitive's second colour goes.
    #[serde(default)]
    pub pattern: Pattern,
    /// Half a period of the pattern.
    #[serde(default = "default_pattern_mm")]
    pub pattern_mm: f64,
    /// Weight of the Phong lobe beside an albedo of 1.
    #[serde(default = "default_specular")]
    pub specular: f32,
    /// Exponent of the Phong lobe.
    #[serde(default = "default_shininess")]
    pub shininess: f32,
}

impl ObjectSection {
    /// An object of this kind with the defaults for all else.
    pub fn new(kind: Kind) -> Self {
        Self {
            kind,
            name: None,
            file: None,
            up: None,
            size_mm: 0.0,
            sides_mm: default_sides(),
            at_mm: [0.0; 2],
            lift_mm: 0.0,
            yaw_deg: 0.0,
            colours: default_colours(),
            pattern: Pattern::default(),
            pattern_mm: default_pattern_mm(),
            specular: default_specular(),
            shininess: default_shininess(),
        }
    }
}

fn default_sides() -> [f64; 3] {
    [60.0; 3]
}
fn default_colours() -> [[u8; 3]; 2] {
    [[200, 190, 170], [90, 110, 150]]
}
fn default_pattern_mm() -> f64 {
    12.0
}
fn default_specular() -> f32 {
    0.08
}
fn default_shininess() -> f32 {
    20.0
}
