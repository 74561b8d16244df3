//! Draws a scene from four sides into a PNG: `cargo run -p world --example portrait -- OUT.png [SCENE.toml]`.

use image::{Rgb, RgbImage};
use nalgebra::{Point3, Rotation3, Vector3};
use std::path::Path;
use world::Scene;

const TILE: u32 = 520;
const VIEWS_DEG: [[f64; 2]; 6] =
    [[0.0, 10.0], [90.0, 10.0], [-90.0, 10.0], [180.0, 10.0], [40.0, 30.0], [-130.0, -15.0]];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let out = arguments.get(1).ok_or("which PNG?")?;
    let start = std::time::Instant::now();
    let scene = match arguments.get(2) {
        Some(path) => Scene::load(Path::new(path))?,
        None => Scene::cow()?,
    };
    println!("{} triangles in {:?}", scene.subject().mesh.triangles.len(), start.elapsed());
    let mut picture = RgbImage::from_pixel(3 * TILE, 2 * TILE, Rgb([70, 80, 95]));
    let [low, high] = scene.subject().mesh.bounds().ok_or("empty")?;
    let centre = nalgebra::center(&low, &high).cast::<f64>();
    let scale = f64::from(TILE) / (1.15 * f64::from((high - low).norm()));
    for (view, [azimuth, elevation]) in VIEWS_DEG.iter().enumerate() {
        let turn = Rotation3::from_axis_angle(&Vector3::x_axis(), elevation.to_radians())
            * Rotation3::from_axis_angle(&Vector3::z_axis(), -(azimuth + 90.0).to_radians());
        let corner = [(view as u32 % 3) * TILE, (view as u32 / 3) * TILE];
        draw(&scene, &mut picture, corner, &|p| Point3::from(turn * (p.cast::<f64>() - centre) * scale));
    }
    picture.save(out)?;
    Ok(())
}

/// Orthographic, seen along y, z up.
fn draw(scene: &Scene, picture: &mut RgbImage, [left, top]: [u32; 2], place: &dyn Fn(Point3<f32>) -> Point3<f64>) {
    let mut depth = vec![f64::INFINITY; (TILE * TILE) as usize];
    let half = f64::from(TILE) / 2.0;
    for surface in &scene.surfaces {
        let mesh = &surface.mesh;
        let normals = if mesh.normals.is_empty() { mesh.vertex_normals() } else { mesh.normals.clone() };
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            let world = mesh.corners(t);
            let [a, b, c] = world.map(place);
            let area = (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x);
            if area <= 0.0 {
                continue;
            }
            let range = |axis: usize| {
                let all = [a[axis], b[axis], c[axis]];
                let low = all.iter().copied().fold(f64::INFINITY, f64::min).max(-half).ceil() as i64;
                low..=all.iter().copied().fold(f64::NEG_INFINITY, f64::max).min(half - 1.0).floor() as i64
            };
            for z in range(2) {
                for x in range(0) {
                    let (px, pz) = (x as f64, z as f64);
                    let wb = ((px - a.x) * (c.z - a.z) - (pz - a.z) * (c.x - a.x)) / area;
                    let wc = ((b.x - a.x) * (pz - a.z) - (b.z - a.z) * (px - a.x)) / area;
                    let weights = [1.0 - wb - wc, wb, wc];
                    if weights.iter().any(|w| *w < 0.0) {
                        continue;
                    }
                    let (column, row) = ((px + half) as u32, (half - 1.0 - pz) as u32);
                    let y = a.y * weights[0] + b.y * wb + c.y * wc;
                    let cell = &mut depth[(row * TILE + column) as usize];
                    if row >= TILE || y >= *cell {
                        continue;
                    }
                    *cell = y;
                    let normal: Vector3<f64> =
                        (0..3).map(|i| normals[triangle[i] as usize].cast::<f64>() * weights[i]).sum();
                    let origin = place(Point3::origin());
                    let facing = place(normal.cast::<f32>().into()) - origin;
                    let light = facing.normalize().dot(&Vector3::new(-0.35, -0.75, 0.55)).max(0.0);
                    let uv = [0, 1].map(|k| {
                        mesh.uv.first().map_or(0.0, |_| {
                            (0..3).map(|i| f64::from(mesh.uv[triangle[i] as usize][k]) * weights[i]).sum::<f64>()
                        })
                    });
                    let colour = match &surface.texture {
                        Some(texture) => {
                            let at = |x: f64, n: usize| ((x.rem_euclid(1.0) * n as f64) as usize).min(n - 1);
                            texture.rgb[at(uv[1], texture.height) * texture.width + at(uv[0], texture.width)]
                        }
                        None => mesh.colours.get(triangle[0] as usize).copied().unwrap_or([188; 3]),
                    };
                    let shaded = colour.map(|c| (f64::from(c) * (0.35 + 0.65 * light)) as u8);
                    picture.put_pixel(left + column, top + row, Rgb(shaded));
                }
            }
        }
    }
}
