//! The painted surface (paper, section 2.6: texture cells).

use crate::layout::{layout, message};
use crate::{Bulk, Header, Mesh};

layout! {
    /// The surface with its texture.
    pub struct Model {
        /// The stamp is the latest frame's that went in; phase `End` marks the final one.
        pub header: Header,
        /// The surface; a vertex on a seam of the texture stands in it once for each chart.
        pub mesh: Mesh,
        /// Texture coordinates of each vertex: u right, v down, 0..1 over the whole texture.
        pub uv: Bulk<[f32; 2]>,
        /// Texture columns.
        pub texture_width: u32,
        /// Texture rows.
        pub texture_height: u32,
        /// Red, green, blue and how it was coloured (0 no cell, 85 filled in from its neighbours, 255 seen), row by row.
        pub texture: Bulk<[u8; 4]>,
        /// Edge of one texture cell on the surface.
        pub cell_m: f32,
    }
}
message!(Model @ 1);
