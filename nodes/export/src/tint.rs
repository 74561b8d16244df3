//! Colours for the cloud: those of the painted surface beside each ball.

use geometry::{MeshError, MeshIndex, TriangleMesh};
use nalgebra::Point3;
use rayon::prelude::*;
use wire::{CloudPoint, Model};

/// A ball that is farther from the surface is no part of it.
const BESIDE_M: f64 = 2e-3;

/// Gives each ball without a colour that of the texture cell beside it; where no cell was coloured it has none. The model's
/// arrays must fit each other, as [`formats::mesh::LoadedMesh`] checks.
pub(crate) fn tint(balls: &mut [CloudPoint], model: &Model) -> Result<(), MeshError> {
    let index = MeshIndex::new(&TriangleMesh::from(&model.mesh))?;
    balls.par_iter_mut().filter(|ball| ball.colour[3] == 0).for_each(|ball| {
        let place = Point3::from(ball.position_m).cast::<f64>();
        let Some(beside) = index.closest_within(&place, BESIDE_M) else { return };
        let weights = index.barycentric(beside.triangle, &beside.point);
        if let Some([red, green, blue, how]) = texel(model, beside.triangle, weights)
            && how > 0
        {
            ball.colour = [red, green, blue, 255];
        }
    });
    Ok(())
}

/// The cell in which a point of a triangle lies; `None` without a texture.
fn texel(model: &Model, triangle: u32, weights: [f64; 3]) -> Option<[u8; 4]> {
    let corners = model.mesh.triangles.get(triangle as usize)?;
    let mut at = [0.0; 2];
    for (&corner, weight) in corners.iter().zip(weights) {
        let uv = model.uv.get(corner as usize)?;
        at = [0, 1].map(|axis| at[axis] + weight * f64::from(uv[axis]));
    }
    let [width, height] = [model.texture_width, model.texture_height].map(|size| size as usize);
    let cell = |at: f64, size: usize| ((at * size as f64).max(0.0) as usize).min(size.saturating_sub(1));
    model.texture.get(cell(at[1], height) * width + cell(at[0], width)).copied()
}
