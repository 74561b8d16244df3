//! The colour of a point of a surface, in linear light.

use formats::mesh::LoadedMesh;
use image::RgbImage;

/// Linear light, 0..1, from an sRGB byte (IEC 61966-2-1).
pub fn linear(byte: u8) -> f32 {
    linear_from_encoded(f32::from(byte) / 255.0)
}

/// Linear light from an sRGB value in 0..1.
fn linear_from_encoded(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// The sRGB value, 0..255 and not rounded, of linear light; what is brighter than white is cut.
pub fn encoded_255(linear: f32) -> f32 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    255.0 * encoded
}

/// The albedo at a point of a triangle, in linear light: from the texture when there is one, else from the colours of the
/// corners; `None` for a surface that has neither.
pub fn albedo(surface: &LoadedMesh, triangle: u32, barycentric: [f64; 3]) -> Option<[f32; 3]> {
    let corners = surface.mesh.triangles[triangle as usize].map(|i| i as usize);
    let weights = barycentric.map(|w| w as f32);
    if let (Some(texture), false) = (&surface.texture, surface.mesh.uv.is_empty()) {
        let at = |axis: usize| corners.iter().zip(weights).map(|(&i, w)| surface.mesh.uv[i][axis] * w).sum::<f32>();
        return Some(bilinear(texture, at(0), at(1)));
    }
    if surface.mesh.colours.is_empty() {
        return None;
    }
    let channel = |c: usize| corners.iter().zip(weights).map(|(&i, w)| linear(surface.mesh.colours[i][c]) * w).sum();
    Some([channel(0), channel(1), channel(2)])
}

/// Between the four pixels around a place; (0, 0) is the outer corner of the first pixel, and the picture repeats.
fn bilinear(texture: &RgbImage, u: f32, v: f32) -> [f32; 3] {
    let (width, height) = texture.dimensions();
    if width == 0 || height == 0 {
        return [0.0; 3];
    }
    let place = |t: f32, size: u32| {
        let at = (t - t.floor()) * size as f32 - 0.5;
        let first = at.floor();
        let wrapped = |i: f32| (i as i64).rem_euclid(i64::from(size)) as u32;
        (wrapped(first), wrapped(first + 1.0), at - first)
    };
    let (x0, x1, fx) = place(u, width);
    let (y0, y1, fy) = place(v, height);
    let pixel = |x, y| texture.get_pixel(x, y).0.map(linear);
    let [a, b, c, d] = [pixel(x0, y0), pixel(x1, y0), pixel(x0, y1), pixel(x1, y1)];
    [0, 1, 2].map(|k| (a[k] * (1.0 - fx) + b[k] * fx) * (1.0 - fy) + (c[k] * (1.0 - fx) + d[k] * fx) * fy)
}

/// A model that came over the wire as a mesh with a picture. Cells without colour are grey.
pub fn painted(model: &wire::Model) -> LoadedMesh {
    let mut mesh = geometry::TriangleMesh::from(&model.mesh);
    mesh.uv = model.uv.to_vec();
    let rgb = model.texture.iter().flat_map(|&[r, g, b, how]| if how == 0 { [128; 3] } else { [r, g, b] }).collect();
    LoadedMesh { mesh, texture: RgbImage::from_raw(model.texture_width, model.texture_height, rgb) }
}
