//! The painted surface of the wire as a mesh with a picture.

use super::LoadedMesh;
use crate::Reason;
use geometry::TriangleMesh;
use image::{Rgb, RgbImage};
use wire::Model;

/// Takes mesh, texture coordinates and texture; refuses a texture whose size contradicts its bytes.
impl TryFrom<&Model> for LoadedMesh {
    type Error = Reason;

    fn try_from(model: &Model) -> Result<Self, Reason> {
        let mesh = TriangleMesh { uv: model.uv.to_vec(), ..TriangleMesh::from(&model.mesh) };
        let (width, height) = (model.texture_width, model.texture_height);
        if model.texture.len() as u64 != u64::from(width) * u64::from(height) {
            let texels = model.texture.len();
            return Err(Reason::syntax(format!("its texture of {width}x{height} has {texels} texels")));
        }
        mesh.check()?;
        let at = |x: u32, y: u32| (y as usize) * (width as usize) + x as usize;
        let texture = (width > 0 && height > 0).then(|| {
            RgbImage::from_fn(width, height, |x, y| {
                let [r, g, b, _how] = model.texture[at(x, y)];
                Rgb([r, g, b])
            })
        });
        Ok(Self { mesh, texture })
    }
}
