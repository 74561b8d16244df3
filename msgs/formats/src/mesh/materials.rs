//! Many materials made one: files paint each part of a mesh on its own, we keep one mesh with at most one picture.

use super::{LoadedMesh, srgb};
use crate::Reason;
use geometry::TriangleMesh;
use image::{Rgb, RgbImage, imageops};

/// A piece of a mesh with its own material.
#[derive(Debug, Clone, Default)]
pub(super) struct Part {
    pub mesh: TriangleMesh,
    /// The colour that tints the whole part; `None` is white.
    pub base: Option<[u8; 3]>,
    /// Which of the pictures it wears.
    pub texture: Option<usize>,
}

const WHITE: [u8; 3] = [255; 3];
/// A part of one colour gets a patch of the picture so large that filtering at its middle sees nothing else.
const PATCH_PX: u32 = 4;
/// Larger stacks of pictures are refused: they would take gigabytes.
const MAX_STACK_PX: u64 = 1 << 28;

/// One mesh of all parts. Without pictures, colours go to the vertices; one picture that all parts wear plainly is kept as
/// it is; else the pictures are tinted and stacked. Beside a picture, vertex colours are dropped.
pub(super) fn join(mut parts: Vec<Part>, textures: &[RgbImage]) -> Result<LoadedMesh, Reason> {
    parts.retain(|p| !p.mesh.triangles.is_empty());
    for part in &mut parts {
        part.mesh.check()?;
        part.base = part.base.filter(|&base| base != WHITE);
        part.texture = part.texture.filter(|_| !part.mesh.uv.is_empty());
    }
    let first = parts.iter().find_map(|p| p.texture);
    let Some(first) = first else {
        return Ok(LoadedMesh { mesh: with_vertex_colours(parts), texture: None });
    };
    if parts.iter().all(|p| p.texture == Some(first) && p.base.is_none()) {
        let mesh = append_all(parts.into_iter().map(|p| TriangleMesh { colours: Vec::new(), ..p.mesh }));
        return Ok(LoadedMesh { mesh, texture: Some(textures[first].clone()) });
    }
    let stack = Stack::of(&parts, textures)?;
    let mesh = append_all(parts.iter().map(|part| stack.place(part, textures)));
    Ok(LoadedMesh { mesh, texture: Some(stack.picture) })
}

fn append_all(meshes: impl Iterator<Item = TriangleMesh>) -> TriangleMesh {
    let mut whole = TriangleMesh::default();
    meshes.filter(|m| !m.vertices.is_empty()).for_each(|m| whole.append(&m));
    whole
}

fn with_vertex_colours(parts: Vec<Part>) -> TriangleMesh {
    let coloured = parts.iter().any(|p| p.base.is_some() || !p.mesh.colours.is_empty());
    append_all(parts.into_iter().map(|Part { mut mesh, base, .. }| {
        let base = base.unwrap_or(WHITE);
        if mesh.colours.is_empty() && coloured {
            mesh.colours = vec![base; mesh.vertices.len()];
        } else if base != WHITE {
            mesh.colours.iter_mut().for_each(|c| *c = srgb::product(*c, base));
        }
        mesh
    }))
}

/// What a part wears: which picture and which tint.
type Coat = (Option<usize>, [u8; 3]);

/// All coats, one below the other.
struct Stack {
    picture: RgbImage,
    /// Each with the row in which it begins.
    coats: Vec<(Coat, u32)>,
}

fn coat(part: &Part) -> Coat {
    (part.texture, part.base.unwrap_or(WHITE))
}

fn coat_size(coat: Coat, textures: &[RgbImage]) -> (u32, u32) {
    coat.0.map_or((PATCH_PX, PATCH_PX), |number| textures[number].dimensions())
}

impl Stack {
    fn of(parts: &[Part], textures: &[RgbImage]) -> Result<Self, Reason> {
        let mut coats: Vec<(Coat, u32)> = Vec::new();
        let (mut width, mut height) = (0, 0_u32);
        for coat in parts.iter().map(coat) {
            if coats.iter().all(|(other, _)| *other != coat) {
                coats.push((coat, height));
                let size = coat_size(coat, textures);
                width = width.max(size.0);
                height = height.saturating_add(size.1);
            }
        }
        if u64::from(width) * u64::from(height) > MAX_STACK_PX {
            return Err(Reason::syntax(format!(
                "its pictures stacked take {width}x{height} pixels, which is too many"
            )));
        }
        let mut picture = RgbImage::new(width, height);
        for &((number, tint), row) in &coats {
            let mut block = match number {
                Some(number) => textures[number].clone(),
                None => RgbImage::from_pixel(PATCH_PX, PATCH_PX, Rgb(WHITE)),
            };
            if tint != WHITE {
                block.pixels_mut().for_each(|p| p.0 = srgb::product(p.0, tint));
            }
            imageops::replace(&mut picture, &block, 0, i64::from(row));
        }
        Ok(Self { picture, coats })
    }

    /// The part with texture coordinates in the stack.
    fn place(&self, part: &Part, textures: &[RgbImage]) -> TriangleMesh {
        let coat = coat(part);
        let row = self.coats.iter().find(|(other, _)| *other == coat).map_or(0, |&(_, row)| row);
        let (width, height) = coat_size(coat, textures);
        let mut mesh = if part.texture.is_some() { unwrapped(&part.mesh) } else { part.mesh.clone() };
        if part.texture.is_none() {
            mesh.uv = vec![[0.5; 2]; mesh.vertices.len()];
        }
        mesh.colours.clear();
        let place = |at: f32, size: u32| (at * size as f32).clamp(0.5, size as f32 - 0.5);
        for [u, v] in &mut mesh.uv {
            *u = place(*u, width) / self.picture.width() as f32;
            *v = (row as f32 + place(*v, height)) / self.picture.height() as f32;
        }
        mesh
    }
}

/// Stacked pictures cannot repeat, so triangles outside 0..1 are moved into it, each with vertices of its own. (One that
/// spans more than a whole repeat is clipped at its border.)
fn unwrapped(mesh: &TriangleMesh) -> TriangleMesh {
    if mesh.uv.iter().flatten().all(|at| (0.0..=1.0).contains(at)) {
        return mesh.clone();
    }
    let mut apart = TriangleMesh::default();
    for triangle in &mesh.triangles {
        let corners = triangle.map(|i| i as usize).into_iter().filter(|&i| i < mesh.vertices.len());
        let corners: Vec<usize> = corners.collect();
        let shift = |axis: usize| corners.iter().map(|&i| mesh.uv[i][axis]).fold(f32::INFINITY, f32::min).floor();
        let [du, dv] = [shift(0), shift(1)];
        let first = apart.vertices.len() as u32;
        for &i in &corners {
            apart.vertices.push(mesh.vertices[i]);
            apart.normals.extend(mesh.normals.get(i));
            apart.uv.push([mesh.uv[i][0] - du, mesh.uv[i][1] - dv]);
        }
        apart.triangles.push([first, first + 1, first + 2]);
    }
    apart
}
