//! A small renderer: smooth shading, two soft lights, edges averaged over 2 x 2 samples, nothing behind.

use crate::View;
use crate::albedo::encoded_255;
use geometry::{Camera, NO_TRIANGLE, TriangleMesh, VisibilityBuffer};
use image::{Rgba, RgbaImage};
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;
use std::collections::HashMap;

/// Samples of a pixel in each direction.
const SAMPLES: u32 = 2;
/// Light from everywhere, from the lamp at the upper left, and from the camera: about 1 together.
const AMBIENT: f32 = 0.28;
const KEY: f32 = 0.58;
const HEAD: f32 = 0.24;
/// To the right, down and forward, as the camera sees.
const TO_KEY_IN_CAMERA: [f64; 3] = [-0.5, -0.7, -0.5];
/// Where faces meet at a larger angle than this (cosine), the edge is drawn sharp.
const CREASE: f64 = 0.82;
/// The inside of an open surface.
const INSIDE: f32 = 0.45;

/// Draws a mesh; `colour` gives the linear colour at a triangle's barycentric coordinates. Pixels without surface are
/// transparent.
pub fn render(mesh: &TriangleMesh, view: &View, colour: impl Fn(u32, [f64; 3]) -> [f32; 3] + Sync) -> RgbaImage {
    let large = view.enlarged(SAMPLES);
    let Camera { width, height, .. } = large.camera;
    let mut buffer = VisibilityBuffer::new(width as usize, height as usize);
    buffer.draw(&large.camera, &large.camera_from_world, mesh, 0);
    let shader = Shader::new(mesh, &large, colour);
    let row = |v: u32| -> Vec<Rgba<u8>> { (0..view.camera.width).map(|u| shader.pixel(&buffer, u, v)).collect() };
    let rows: Vec<Vec<Rgba<u8>>> = (0..view.camera.height).into_par_iter().map(row).collect();
    RgbaImage::from_fn(view.camera.width, view.camera.height, |u, v| rows[v as usize][u as usize])
}

struct Shader<'a, F> {
    mesh: &'a TriangleMesh,
    camera: Camera,
    centre: Point3<f64>,
    world_from_camera: nalgebra::Isometry3<f64>,
    to_key: Vector3<f64>,
    normals: Vec<Vector3<f64>>,
    colour: F,
}

impl<'a, F: Fn(u32, [f64; 3]) -> [f32; 3]> Shader<'a, F> {
    fn new(mesh: &'a TriangleMesh, view: &View, colour: F) -> Self {
        let world_from_camera = view.camera_from_world.inverse();
        Self {
            mesh,
            camera: view.camera,
            centre: Point3::from(world_from_camera.translation.vector),
            world_from_camera,
            to_key: world_from_camera * Vector3::from(TO_KEY_IN_CAMERA).normalize(),
            normals: welded_normals(mesh),
            colour,
        }
    }

    /// The mean of the samples in linear light, weighted by what they cover.
    fn pixel(&self, buffer: &VisibilityBuffer, u: u32, v: u32) -> Rgba<u8> {
        let mut sum = [0.0f32; 3];
        let mut covered = 0.0f32;
        for (i, j) in (0..SAMPLES).flat_map(|j| (0..SAMPLES).map(move |i| (i, j))) {
            let (column, row) = (u * SAMPLES + i, v * SAMPLES + j);
            let triangle = buffer.triangle[row as usize * buffer.width + column as usize];
            if triangle != NO_TRIANGLE {
                let light = self.sample(triangle, f64::from(column), f64::from(row));
                sum = [0, 1, 2].map(|k| sum[k] + light[k]);
                covered += 1.0;
            }
        }
        let [r, g, b] = sum.map(|c| encoded_255(c / covered.max(1.0)).round() as u8);
        Rgba([r, g, b, (255.0 * covered / (SAMPLES * SAMPLES) as f32).round() as u8])
    }

    fn sample(&self, triangle: u32, u: f64, v: f64) -> [f32; 3] {
        let ray = self.world_from_camera * self.camera.direction(nalgebra::Point2::new(u, v));
        let [a, b, c] = self.mesh.corners(triangle as usize).map(|p| p.map(f64::from));
        let face = (b - a).cross(&(c - a));
        let reach = face.dot(&(a - self.centre)) / face.dot(&ray);
        let point = self.centre + ray * if reach.is_finite() { reach } else { 0.0 };
        let weights = clamped_weights(&[a, b, c], &face, &point);
        let face = face.try_normalize(0.0).unwrap_or(-ray);
        let corners = self.mesh.triangles[triangle as usize].map(|i| self.normals[i as usize]);
        let smooth = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
        let creased = corners.iter().any(|n| n.dot(&face) < CREASE);
        let normal = if creased { face } else { smooth.try_normalize(1e-6).unwrap_or(face) };
        let to_eye = -ray.normalize();
        let from_behind = face.dot(&to_eye) < 0.0;
        let normal = if from_behind { -normal } else { normal };
        let lambert = |to_light: &Vector3<f64>| normal.dot(to_light).max(0.0) as f32;
        let light = AMBIENT + KEY * lambert(&self.to_key) + HEAD * lambert(&to_eye);
        let light = if from_behind { INSIDE * light } else { light };
        (self.colour)(triangle, weights).map(|c| c * light)
    }
}

/// Barycentric coordinates of a point in a triangle's plane, kept inside the triangle.
fn clamped_weights([a, b, c]: &[Point3<f64>; 3], face: &Vector3<f64>, point: &Point3<f64>) -> [f64; 3] {
    let squared = face.norm_squared().max(f64::MIN_POSITIVE);
    let v = (point - a).cross(&(c - a)).dot(face) / squared;
    let w = (b - a).cross(&(point - a)).dot(face) / squared;
    let weights = [1.0 - v - w, v, w].map(|x| if x.is_finite() { x.clamp(0.0, 1.0) } else { 0.0 });
    let sum = weights.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    weights.map(|x| x / sum)
}

/// The mesh's normals, or those of its triangles weighted by area; vertices at one place (the seams of a texture) share.
fn welded_normals(mesh: &TriangleMesh) -> Vec<Vector3<f64>> {
    if mesh.normals.len() == mesh.vertices.len() {
        return mesh.normals.iter().map(|n| n.map(f64::from)).collect();
    }
    let place = |i: u32| mesh.vertices[i as usize].coords.map(f32::to_bits);
    let mut sums: HashMap<Vector3<u32>, Vector3<f64>> = HashMap::new();
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        let normal = mesh.area_normal(t).map(f64::from);
        for &i in triangle {
            *sums.entry(place(i)).or_default() += normal;
        }
    }
    let normal = |i: u32| sums.get(&place(i)).and_then(|n| n.try_normalize(0.0)).unwrap_or_default();
    (0..mesh.vertices.len() as u32).map(normal).collect()
}
