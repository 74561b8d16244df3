//! How near the surface comes to the truth, and how long it takes: `cargo run --release -p surface --no-default-features
//! --example accuracy`. With a folder as argument it leaves the meshes there as PLY.

#[path = "../tests/surface/animal.rs"]
#[allow(dead_code, reason = "the tests need more of it")]
mod animal;

use animal::{V, distance, on_animal, scanned};
use std::io::Write as _;
use std::time::Instant;
use surface::{Config, surface_from_points};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1);
    println!(
        "cloud                    | s     | triangles | mesh to truth, mm: mean  95%    max    | truth seen within 0.5 mm"
    );
    for (name, count, noise_m) in [
        ("50000 points, 0.05 mm", 50_000, 0.05e-3),
        ("200000 points, 0.1 mm", 200_000, 0.1e-3),
        ("1000000 points, 0.2 mm", 1_000_000, 0.2e-3),
    ] {
        let truth = on_animal(count, 1);
        let (points, normals) = scanned(&truth, noise_m, 5.0, 2);
        let start = Instant::now();
        let (mesh, _) = surface_from_points(&points, Some(&normals), Config::default())?;
        let seconds = start.elapsed().as_secs_f64();
        let (mean, p95, max) = errors_mm(&mesh);
        let seen = 100.0 * seen(&mesh, &truth[..20_000]);
        let triangles = mesh.triangles.len();
        println!("{name:24} | {seconds:5.2} | {triangles:9} | {mean:25.4} {p95:6.4} {max:6.3} | {seen:8.2} %");
        if let Some(folder) = &folder {
            write_ply(&mesh, &format!("{folder}/animal_{count}.ply"))?;
        }
    }
    Ok(())
}

/// Over vertices and middles of triangles.
fn errors_mm(mesh: &wire::Mesh) -> (f64, f64, f64) {
    let at = |v: u32| V::from(mesh.vertices_m[v as usize].map(f64::from));
    let middles = mesh.triangles.iter().map(|&[a, b, c]| (at(a) + at(b) + at(c)) / 3.0);
    let places = mesh.vertices_m.iter().map(|p| V::from(p.map(f64::from))).chain(middles);
    let mut errors: Vec<f64> = places.map(|p| 1e3 * distance(animal::animal, &p).abs()).collect();
    errors.sort_by(f64::total_cmp);
    let mean = errors.iter().sum::<f64>() / errors.len().max(1) as f64;
    let at = |share: f64| errors.get((share * (errors.len() as f64 - 1.0)) as usize).copied().unwrap_or(f64::NAN);
    (mean, at(0.95), at(1.0))
}

/// Share of the true points with a vertex of the mesh within reach.
fn seen(mesh: &wire::Mesh, truth: &[(V, V)]) -> f64 {
    let mut voxels = std::collections::HashMap::<[i64; 3], Vec<V>>::new();
    let voxel = |p: &V| [p.x, p.y, p.z].map(|x| (x / 1e-3).floor() as i64);
    let at = |v: u32| V::from(mesh.vertices_m[v as usize].map(f64::from));
    for &[a, b, c] in mesh.triangles.iter() {
        for p in [at(a), at(b), at(c), (at(a) + at(b) + at(c)) / 3.0] {
            voxels.entry(voxel(&p)).or_default().push(p);
        }
    }
    let near = |p: &V| {
        let [x, y, z] = voxel(p);
        let around = (0..27).map(move |n| [x + n / 9 - 1, y + n / 3 % 3 - 1, z + n % 3 - 1]);
        around.filter_map(|v| voxels.get(&v)).flatten().any(|q| (p - q).norm() < 0.5e-3)
    };
    truth.iter().filter(|(p, _)| near(p)).count() as f64 / truth.len() as f64
}

fn write_ply(mesh: &wire::Mesh, path: &str) -> std::io::Result<()> {
    let mut file = std::io::BufWriter::new(std::fs::File::create(path)?);
    writeln!(file, "ply\nformat binary_little_endian 1.0\nelement vertex {}", mesh.vertices_m.len())?;
    for name in ["x", "y", "z", "nx", "ny", "nz"] {
        writeln!(file, "property float {name}")?;
    }
    writeln!(file, "element face {}\nproperty list uchar int vertex_indices\nend_header", mesh.triangles.len())?;
    for (p, n) in mesh.vertices_m.iter().zip(mesh.normals.iter()) {
        for x in p.iter().chain(n) {
            file.write_all(&x.to_le_bytes())?;
        }
    }
    for triangle in mesh.triangles.iter() {
        file.write_all(&[3])?;
        for v in triangle {
            file.write_all(&v.to_le_bytes())?;
        }
    }
    Ok(())
}
