//! A world that is known exactly: spheres and plates with a known albedo, seen by a camera with a lamp.
#![allow(dead_code, clippy::unwrap_used, reason = "each test uses its part; helpers of tests")]

use geometry::Camera;
use nalgebra::{Isometry3, Point2, Point3, Vector3};
use rayon::prelude::*;
use wire::{Calibration, Frame, Header, LaserPlane, Light, Mesh, Model, PeaksPer, Phase, PixelFormat, RigidPose};

pub type Albedo = fn(&Point3<f64>) -> [f64; 3];

pub enum Shape {
    Sphere {
        centre: Point3<f64>,
        radius: f64,
    },
    /// Rectangle at height z, facing +z.
    Plate {
        low: [f64; 2],
        high: [f64; 2],
        z: f64,
    },
}

pub struct World {
    pub things: Vec<(Shape, Albedo)>,
    pub ambient: f64,
    pub specular: f64,
    pub exposure: f64,
}

pub const CAMERA: Camera = Camera {
    width: 640,
    height: 512,
    fx: 700.0,
    fy: 700.0,
    cx: 321.3,
    cy: 254.1,
    distortion: [-0.1, 0.05, 1e-3, -5e-4, 0.0],
};

pub fn calibration(camera: &Camera) -> Calibration {
    Calibration {
        header: Header::default(),
        camera: camera.into(),
        laser: LaserPlane {
            normal: [0.0, 0.0, 1.0],
            distance_m: 0.2,
            channel_weights: [1.0; 3],
            peaks_per: PeaksPer::Row,
        },
        body_from_camera: RigidPose::IDENTITY,
        pose_offset_nanos: 0,
        name: "test".into(),
    }
}

/// 10 mm checks of two strong colours.
pub fn checker(p: &Point3<f64>) -> [f64; 3] {
    let odd = p.iter().map(|c| (c / 0.01 + 100.0).floor() as i64).sum::<i64>() % 2 == 0;
    if odd { [0.7, 0.25, 0.1] } else { [0.1, 0.4, 0.6] }
}

/// How far a place is from the nearest border of a check on the axes given.
pub fn from_border(p: &Point3<f64>, axes: &[usize]) -> f64 {
    axes.iter().map(|&i| (p[i] / 0.01 - (p[i] / 0.01).round()).abs() * 0.01).fold(f64::INFINITY, f64::min)
}

pub fn white(_: &Point3<f64>) -> [f64; 3] {
    [0.8; 3]
}

pub fn black(_: &Point3<f64>) -> [f64; 3] {
    [0.02; 3]
}

impl World {
    pub fn of(things: Vec<(Shape, Albedo)>) -> Self {
        Self { things, ambient: 0.0, specular: 0.0, exposure: 0.8 }
    }

    fn nearest(&self, from: &Point3<f64>, way: &Vector3<f64>) -> Option<(Point3<f64>, Vector3<f64>, [f64; 3])> {
        let hits = self.things.iter().filter_map(|(shape, albedo)| {
            let (at, normal) = shape.hit(from, way)?;
            let p = from + way * at;
            Some((at, p, normal, albedo(&p)))
        });
        hits.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, p, n, albedo)| (p, n, albedo))
    }

    /// Light at a pixel: lamp at the camera's centre, Lambert, inverse square, cos^4 off the axis, a gleam (Phong 40).
    fn light(&self, world_from_camera: &Isometry3<f64>, direction: &Vector3<f64>) -> [f64; 3] {
        let eye = Point3::from(world_from_camera.translation.vector);
        let way = world_from_camera * direction.normalize();
        let Some((p, normal, albedo)) = self.nearest(&eye, &way) else { return [0.05; 3] };
        let distance = (p - eye).norm();
        let facing = -normal.dot(&way);
        let lamp = (0.2 / distance).powi(2);
        let gleam = self.specular * lamp * (2.0 * facing * facing - 1.0).max(0.0).powi(40);
        let lens = (direction.z / direction.norm()).powi(4) * self.exposure;
        albedo.map(|a| lens * (a * (lamp * facing.max(0.0) + self.ambient) + gleam))
    }

    /// The picture, as far as the painter may look (20 degrees off the axis).
    pub fn frame(&self, camera: &Camera, world_from_camera: &Isometry3<f64>, seq: u64) -> Frame {
        let rows = (0..camera.height).into_par_iter();
        let pixels =
            rows.flat_map_iter(|v| (0..camera.width).map(move |u| self.pixel(camera, world_from_camera, u, v)));
        frame_of(camera, pixels.collect::<Vec<[u8; 3]>>().concat(), seq)
    }

    fn pixel(&self, camera: &Camera, world_from_camera: &Isometry3<f64>, u: u32, v: u32) -> [u8; 3] {
        let (x, y) = (f64::from(u) - camera.cx, f64::from(v) - camera.cy);
        if x.hypot(y) > camera.fx * 0.36 {
            return [0; 3];
        }
        const PARTS: usize = 2;
        let mut light = [0.0; 3];
        for part in 0..PARTS * PARTS {
            let shift = |i: usize| (i as f64 + 0.5) / PARTS as f64 - 0.5;
            let pixel = Point2::new(f64::from(u) + shift(part % PARTS), f64::from(v) + shift(part / PARTS));
            let one = self.light(world_from_camera, &camera.direction(pixel));
            (0..3).for_each(|c| light[c] += one[c] / (PARTS * PARTS) as f64);
        }
        light.map(|l| (255.0 * l.min(1.0).powf(1.0 / 2.2)).round() as u8)
    }
}

pub fn frame_of(camera: &Camera, data: Vec<u8>, seq: u64) -> Frame {
    Frame {
        header: Header { phase: Phase::Colour, seq, stamp_nanos: seq as i64 * 40_000_000, ..Header::default() },
        width: camera.width,
        height: camera.height,
        stride: 3 * camera.width,
        format: PixelFormat::Rgb8,
        light: Light { laser: false, lamp: true },
        exposure_nanos: 10_000_000,
        gain: 1.0,
        gamma: 2.2,
        data: data.into(),
    }
}

impl Shape {
    fn hit(&self, from: &Point3<f64>, way: &Vector3<f64>) -> Option<(f64, Vector3<f64>)> {
        match self {
            Self::Sphere { centre, radius } => {
                let to = centre - from;
                let along = to.dot(way);
                let under = radius * radius - (to.norm_squared() - along * along);
                let at = along - under.max(0.0).sqrt();
                (under > 0.0 && at > 0.0).then(|| (at, (from + way * at - centre) / *radius))
            }
            Self::Plate { low, high, z } => {
                let at = (z - from.z) / way.z;
                let p = from + way * at;
                let on = at > 0.0 && (low[0]..high[0]).contains(&p.x) && (low[1]..high[1]).contains(&p.y);
                on.then(|| (at, Vector3::z()))
            }
        }
    }
}

/// A camera at `eye` that looks at `target`: world_from_camera.
pub fn look_at(eye: [f64; 3], target: [f64; 3]) -> Isometry3<f64> {
    let (eye, target) = (Point3::from(eye), Point3::from(target));
    let forward = target - eye;
    let up = if forward.x.abs() + forward.y.abs() < 1e-9 { Vector3::y() } else { Vector3::z() };
    Isometry3::face_towards(&eye, &target, &-up)
}

pub fn mesh_of(vertices: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh {
        header: Header { phase: Phase::End, ..Header::default() },
        vertices_m: vertices.into(),
        normals: Vec::new().into(),
        sigma_m: Vec::new().into(),
        measured: triangles.len() as u32,
        triangles: triangles.into(),
    }
}

/// A plate of n x n squares.
pub fn plate_mesh(low: [f32; 2], high: [f32; 2], z: f32, n: u32) -> Mesh {
    let at = |i: u32, axis: usize| low[axis] + (high[axis] - low[axis]) * i as f32 / n as f32;
    let vertices = (0..=n).flat_map(|j| (0..=n).map(move |i| [at(i, 0), at(j, 1), z])).collect();
    let corner = |i: u32, j: u32| j * (n + 1) + i;
    let square = |i, j| {
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    mesh_of(vertices, (0..n).flat_map(|j| (0..n).flat_map(move |i| square(i, j))).collect())
}

/// A sphere from a cube of n x n squares a side.
pub fn sphere_mesh(centre: [f32; 3], radius: f32, n: u32) -> Mesh {
    let side = plate_mesh([-1.0; 2], [1.0; 2], 1.0, n);
    let turns: [fn([f32; 3]) -> [f32; 3]; 6] = [
        |[x, y, z]| [x, y, z],
        |[x, y, z]| [z, x, y],
        |[x, y, z]| [y, z, x],
        |[x, y, z]| [-x, y, -z],
        |[x, y, z]| [-z, -x, y],
        |[x, y, z]| [x, -z, y],
    ];
    let mut all = mesh_of(vec![], vec![]);
    for turn in turns {
        let first = all.vertices_m.len() as u32;
        let round = |&p: &[f32; 3]| {
            // Tangents even the squares out.
            let [x, y, z] = p.map(|c| (c * std::f32::consts::FRAC_PI_4).tan());
            let p = Vector3::from(turn([x, y, z])).normalize() * radius;
            [p.x + centre[0], p.y + centre[1], p.z + centre[2]]
        };
        all.vertices_m.extend(side.vertices_m.iter().map(round));
        all.triangles.extend(side.triangles.iter().map(|t| t.map(|i| i + first)));
    }
    // Turned inside out where a turn mirrors.
    for t in all.triangles.iter_mut() {
        let [a, b, c] = t.map(|i| Vector3::from(all.vertices_m[i as usize]) - Vector3::from(centre));
        if (b - a).cross(&(c - a)).dot(&a) < 0.0 {
            t.swap(1, 2);
        }
    }
    all.measured = all.triangles.len() as u32;
    all
}

pub fn join(a: &Mesh, b: &Mesh) -> Mesh {
    let first = a.vertices_m.len() as u32;
    let mut all = a.clone();
    all.vertices_m.extend(b.vertices_m.iter());
    all.triangles.extend(b.triangles.iter().map(|t| t.map(|i| i + first)));
    all.measured = all.triangles.len() as u32;
    all
}

/// The texture at texture coordinates, between texels, as a viewer shows it.
pub fn sample(model: &Model, uv: [f64; 2]) -> [f64; 4] {
    let x = uv[0] * f64::from(model.texture_width) - 0.5;
    let y = uv[1] * f64::from(model.texture_height) - 0.5;
    let mut sum = [0.0; 4];
    for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let weight = |at: f64, d: i32| if d == 1 { at - at.floor() } else { 1.0 - (at - at.floor()) };
        let column = (x.floor() as i64 + i64::from(dx)).clamp(0, i64::from(model.texture_width) - 1);
        let row = (y.floor() as i64 + i64::from(dy)).clamp(0, i64::from(model.texture_height) - 1);
        let texel = model.texture[(row * i64::from(model.texture_width) + column) as usize];
        (0..4).for_each(|c| sum[c] += weight(x, dx) * weight(y, dy) * f64::from(texel[c]));
    }
    sum
}

/// Places all over the model: where, and the colour that a viewer shows there.
pub fn places(model: &Model) -> Vec<(Point3<f64>, [f64; 4])> {
    let middle = |t: &[u32; 3]| {
        let p =
            t.iter().map(|&i| Vector3::from(model.mesh.vertices_m[i as usize].map(f64::from))).sum::<Vector3<f64>>()
                / 3.0;
        let uv = t.iter().fold([0.0; 2], |s, &i| {
            let uv = model.uv[i as usize];
            [s[0] + f64::from(uv[0]) / 3.0, s[1] + f64::from(uv[1]) / 3.0]
        });
        (Point3::from(p), sample(model, uv))
    };
    model.mesh.triangles.iter().map(middle).collect()
}

pub fn linear(byte: f64) -> f64 {
    let v = byte / 255.0;
    if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

pub fn srgb(linear: f64) -> f64 {
    255.0 * if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Root mean square difference to the albedo, in sRGB steps, after one gain per channel.
pub fn rms(seen: &[(Point3<f64>, [f64; 4])], albedo: Albedo) -> f64 {
    let mut sum = 0.0;
    for c in 0..3 {
        let pairs: Vec<(f64, f64)> = seen.iter().map(|(p, colour)| (linear(colour[c]), albedo(p)[c])).collect();
        let gain = pairs.iter().map(|(x, y)| x * y).sum::<f64>() / pairs.iter().map(|(x, _)| x * x).sum::<f64>();
        sum += pairs.iter().map(|(x, y)| (srgb(gain * x) - srgb(*y)).powi(2)).sum::<f64>();
    }
    (sum / (3.0 * seen.len() as f64)).sqrt()
}
