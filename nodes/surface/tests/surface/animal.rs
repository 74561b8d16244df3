//! A known world for the tests: a toy animal of smoothly joined blobs, 150 x 80 x 109 mm, on a plinth with rounded edges, as a signed distance.

use nalgebra::Vector3;
use rayon::prelude::*;

/// A vector of metres, or a direction.
pub type V = Vector3<f64>;

/// Random numbers with a seed (Steele, Lea and Flood's splitmix64).
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    /// Even in 0..1.
    pub fn even(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }
    /// Normal with variance 1 (Box and Muller).
    pub fn gauss(&mut self) -> f64 {
        let (u, v) = (1.0 - self.even(), self.even());
        (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    }
    pub fn direction(&mut self) -> V {
        V::new(self.gauss(), self.gauss(), self.gauss()).normalize()
    }
}

fn capsule(p: &V, a: [f64; 3], b: [f64; 3], radius: f64) -> f64 {
    let (a, b) = (V::from(a) * 1e-3, V::from(b) * 1e-3);
    let along = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
    (p - a - (b - a) * along).norm() - radius * 1e-3
}

fn ellipsoid(p: &V, centre: [f64; 3], radii: [f64; 3]) -> f64 {
    let (d, r) = (p - V::from(centre) * 1e-3, V::from(radii) * 1e-3);
    let (near, slope) = (d.component_div(&r).norm(), d.component_div(&r.component_mul(&r)).norm());
    if slope > 0.0 { near * (near - 1.0) / slope } else { -r.min() }
}

fn rounded_box(p: &V, centre: [f64; 3], half: [f64; 3], radius: f64) -> f64 {
    let q = (p - V::from(centre) * 1e-3).abs() - (V::from(half) - V::repeat(radius)) * 1e-3;
    q.map(|x| x.max(0.0)).norm() + q.max().min(0.0) - radius * 1e-3
}

fn join(a: f64, b: f64, width_mm: f64) -> f64 {
    let k = width_mm * 1e-3;
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k * 0.25
}

/// Distance from the animal, positive outside (near the surface; farther off it is only a bound).
pub fn animal(p: &V) -> f64 {
    let mut d = ellipsoid(p, [0.0, 0.0, 60.0], [44.0, 26.0, 24.0]);
    d = join(d, ellipsoid(p, [50.0, 0.0, 82.0], [20.0, 16.0, 16.0]), 14.0);
    d = join(d, capsule(p, [60.0, 0.0, 78.0], [66.0, 0.0, 75.0], 9.0), 8.0);
    d = join(d, capsule(p, [38.0, 0.0, 72.0], [46.0, 0.0, 78.0], 15.0), 10.0);
    for side in [-1.0, 1.0] {
        d = join(d, capsule(p, [28.0, 15.0 * side, 50.0], [30.0, 17.0 * side, 10.0], 8.0), 8.0);
        d = join(d, capsule(p, [-28.0, 15.0 * side, 50.0], [-30.0, 17.0 * side, 10.0], 8.0), 8.0);
        // Ears of 4 mm that thin out to a sharp rim: two sheets, seen from opposite sides.
        d = join(d, ellipsoid(p, [46.0, 21.0 * side, 96.0], [6.0, 13.0, 2.0]), 3.0);
        d = join(d, capsule(p, [50.0, 8.0 * side, 96.0], [48.0, 13.0 * side, 106.0], 3.0), 3.0);
    }
    d = join(d, capsule(p, [-44.0, 0.0, 66.0], [-60.0, 0.0, 40.0], 4.0), 8.0);
    d.min(rounded_box(p, [0.0, 0.0, 5.0], [75.0, 40.0, 5.0], 1.5))
}

/// The gradient, by central differences.
pub fn gradient(f: impl Fn(&V) -> f64, p: &V) -> V {
    const STEP_M: f64 = 1e-6;
    V::from_fn(|axis, _| {
        let step = V::ith(axis, STEP_M);
        (f(&(p + step)) - f(&(p - step))) / (2.0 * STEP_M)
    })
}

/// Distance to first order: right near the surface even where the function is only a bound.
pub fn distance(f: impl Fn(&V) -> f64, p: &V) -> f64 {
    let slope = gradient(&f, p).norm();
    f(p) / slope.max(0.1)
}

/// Points spread evenly over the animal's surface, with their true normals.
pub fn on_animal(count: usize, seed: u64) -> Vec<(V, V)> {
    const SHELL_M: f64 = 5e-4;
    const CHUNK: usize = 1 << 12;
    let (low, size) = (V::new(-77e-3, -42e-3, -2e-3), V::new(154e-3, 84e-3, 113e-3));
    let mut points = Vec::with_capacity(count);
    let mut batch = seed << 32;
    while points.len() < count {
        let found: Vec<Vec<(V, V)>> = (batch..batch + 512)
            .into_par_iter()
            .map(|chunk| {
                let mut random = Random(chunk.wrapping_mul(0x2545_f491_4f6c_dd1d));
                let mut found = Vec::new();
                for _ in 0..CHUNK {
                    let mut p = low + V::new(random.even(), random.even(), random.even()).component_mul(&size);
                    // A shell of even thickness holds points in proportion to the area.
                    if animal(&p).abs() > 1.2 * SHELL_M || distance(animal, &p).abs() > SHELL_M {
                        continue;
                    }
                    for _ in 0..3 {
                        let slope = gradient(animal, &p);
                        p -= slope * (animal(&p) / slope.norm_squared());
                    }
                    if animal(&p).abs() < 1e-6 {
                        found.push((p, gradient(animal, &p).normalize()));
                    }
                }
                found
            })
            .collect();
        points.extend(found.into_iter().flatten());
        batch += 512;
    }
    points.truncate(count);
    points
}

/// A scan of them: noise along the normal, normals off by some degrees.
pub fn scanned(points: &[(V, V)], noise_m: f64, normal_noise_deg: f64, seed: u64) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let mut random = Random(seed);
    let turn = normal_noise_deg.to_radians();
    let bulk = |v: V| [v.x as f32, v.y as f32, v.z as f32];
    points
        .iter()
        .map(|(p, n)| {
            let p = p + n * (noise_m * random.gauss());
            let n = (n + V::new(random.gauss(), random.gauss(), random.gauss()) * turn).normalize();
            (bulk(p), bulk(n))
        })
        .unzip()
}
