//! The chart texture: which texel shows which place of the surface (paper, section 2.6: texture mapping cells).
//!
//! The surface is cut into nearly flat charts ([`chart`]), each projected along its axis onto cells of exactly the
//! wanted size ([`plane`]), and the charts are laid onto shelves ([`pack`]).

mod adjacency;
mod build;
mod chart;
mod pack;
mod plane;
mod seam;

pub use build::AtlasError;

/// No texel.
pub const NO_TEXEL: u32 = u32::MAX;

/// The texture of one surface, without colour. A texel that belongs to a chart has a number; numbers run chart by chart
/// and row by row.
#[derive(Debug, Clone, Default)]
pub struct Atlas {
    /// Texture columns, a multiple of 4.
    pub width: u32,
    /// Texture rows, a multiple of 4.
    pub height: u32,
    /// How many charts there are.
    pub charts: usize,
    /// The texels of all charts.
    pub texels: Vec<Texel>,
    /// The number of the texel at each place of the texture, row by row, or [`NO_TEXEL`].
    pub number_at: Vec<u32>,
    /// Pairs of texels of two charts that show the same place on both sides of a seam, in both orders, sorted.
    pub seams: Vec<[u32; 2]>,
    /// For each vertex of the textured mesh, the vertex of the surface that it repeats.
    pub vertices: Vec<u32>,
    /// For each vertex of the textured mesh, its texture coordinates: u right, v down, 0..1.
    pub uv: Vec<[f32; 2]>,
    /// The triangles of the surface, in their order, over the vertices of the textured mesh.
    pub triangles: Vec<[u32; 3]>,
}

/// What one texel shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Texel {
    /// Row times width plus column on the texture.
    pub place: u32,
    /// The triangle.
    pub triangle: u32,
    /// In the world, in metres.
    pub position_m: [f32; 3],
    /// Unit normal there.
    pub normal: [f32; 3],
    /// False for a texel beside its chart: it shows the chart's nearest place, for bilinear sampling.
    pub inside: bool,
}
