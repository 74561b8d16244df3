//! The scene as the renderer wants it: one mesh, light at its corners, colours in linear light.

use super::OpticsError;
use super::tessellate::tessellate;
use super::texture::LinearTexture;
use crate::{Scene, Surface, Texture};
use geometry::TriangleMesh;
use nalgebra::Vector3;
use std::collections::HashSet;

/// Everything that can be lit and seen, in the world.
#[derive(Debug, Clone)]
pub(super) struct Stage {
    /// All surfaces; with normals, without colours.
    pub mesh: TriangleMesh,
    /// Linear albedo of each vertex; 1 where a texture colours it.
    pub albedo: Vec<[f32; 3]>,
    /// The room's light on each vertex, in signal of a white surface.
    pub ambient: Vec<f32>,
    /// Whose each triangle is.
    pub owner: Vec<u16>,
    /// What its owner is like.
    pub finish: Vec<Finish>,
    /// All surfaces are closed, so that no back can be seen.
    pub closed: bool,
}

/// How a surface throws light back.
#[derive(Debug, Clone)]
pub(super) struct Finish {
    pub texture: Option<LinearTexture>,
    /// Weight of the Phong lobe.
    pub specular: f32,
    /// Its exponent.
    pub shininess: f32,
}

/// Even light comes from above by half, the rest from all sides: what faces down gets this share of what faces up.
const FROM_BELOW: f32 = 0.4;
/// What has neither colour nor texture (sRGB).
const GREY: [u8; 3] = [180; 3];

impl Stage {
    pub fn new(scene: &Scene, lamp_level: f64) -> Result<Self, OpticsError> {
        let mut stage = Self {
            mesh: TriangleMesh::default(),
            albedo: Vec::new(),
            ambient: Vec::new(),
            owner: Vec::new(),
            finish: Vec::new(),
            closed: true,
        };
        for (index, surface) in scene.surfaces.iter().enumerate() {
            check(surface)?;
            stage.closed &= scene.table == Some(index) || is_closed(&surface.mesh);
            stage.add(surface);
        }
        let light = scene.ambient * lamp_level as f32;
        let share = |normal: &Vector3<f32>| FROM_BELOW + (1.0 - FROM_BELOW) * (0.5 + 0.5 * normal.z);
        stage.ambient = stage.mesh.normals.iter().map(|normal| light * share(normal)).collect();
        Ok(stage)
    }

    fn add(&mut self, surface: &Surface) {
        let mut fine = tessellate(&surface.mesh);
        if fine.normals.is_empty() {
            fine.normals = fine.vertex_normals();
        }
        let textured = surface.texture.is_some();
        let count = fine.vertices.len();
        if textured {
            self.albedo.resize(self.albedo.len() + count, [1.0; 3]);
        } else if fine.colours.is_empty() {
            self.albedo.resize(self.albedo.len() + count, GREY.map(linear));
        } else {
            self.albedo.extend(fine.colours.iter().map(|colour| colour.map(linear)));
        }
        fine.colours.clear();
        if !textured {
            fine.uv = vec![[0.0; 2]; count];
        }
        self.owner.resize(self.owner.len() + fine.triangles.len(), self.finish.len() as u16);
        self.mesh.append(&fine);
        self.finish.push(Finish {
            texture: surface.texture.as_ref().map(LinearTexture::new),
            specular: surface.specular,
            shininess: surface.shininess,
        });
    }

    /// The finish of a triangle.
    pub fn finish_of(&self, triangle: usize) -> &Finish {
        &self.finish[usize::from(self.owner[triangle])]
    }
}

impl Finish {
    /// The Phong lobe's light beside that of a white surface: `normal`, `to_light` and `to_eye` of unit length.
    pub fn gloss(&self, normal: &Vector3<f32>, to_light: &Vector3<f32>, to_eye: &Vector3<f32>) -> f32 {
        if self.specular <= 0.0 {
            return 0.0;
        }
        let mirrored = normal * (2.0 * normal.dot(to_light)) - to_light;
        self.specular * mirrored.dot(to_eye).max(0.0).powf(self.shininess)
    }
}

/// Linear light of an sRGB value (IEC 61966-2-1).
pub(super) fn linear(value: u8) -> f32 {
    let s = f32::from(value) / 255.0;
    if s <= 0.04045 { s / 12.92 } else { ((s + 0.055) / 1.055).powf(2.4) }
}

fn check(surface: &Surface) -> Result<(), OpticsError> {
    let name = || surface.name.clone();
    surface.mesh.check().map_err(|source| OpticsError::Mesh { name: name(), source })?;
    if let Some(Texture { width, height, rgb }) = &surface.texture {
        let (width, height, pixels, coordinates) = (*width, *height, rgb.len(), surface.mesh.uv.len());
        if pixels == 0 || width.checked_mul(height) != Some(pixels) || coordinates == 0 {
            return Err(OpticsError::Texture { name: name(), width, height, pixels, coordinates });
        }
    }
    Ok(())
}

/// Every edge is used once in each direction. A mesh with seams in its texture coordinates has vertices twice, so places
/// are compared, not indices.
fn is_closed(mesh: &TriangleMesh) -> bool {
    let place = |i: u32| mesh.vertices[i as usize].coords.map(|x| (x + 0.0).to_bits());
    let mut open = HashSet::new();
    let mut volume = 0.0;
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| mesh.vertices[i as usize].coords.cast::<f64>());
        volume += a.dot(&b.cross(&c));
        let [a, b, c] = triangle.map(place);
        for (from, to) in [(a, b), (b, c), (c, a)] {
            if !open.remove(&(to, from)) && !open.insert((from, to)) {
                return false;
            }
        }
    }
    open.is_empty() && volume > 0.0
}
