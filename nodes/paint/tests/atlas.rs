//! The chart texture: density, coverage, no overlap.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod scene;

use geometry::TriangleMesh;
use nalgebra::{Point3, UnitQuaternion, Vector3};
use paint::{Atlas, AtlasError, NO_TEXEL};
use proptest::prelude::*;
use scene::*;
use wire::Mesh;

const CELL_M: f64 = 1e-3;

fn surface(mesh: &Mesh) -> TriangleMesh {
    let mut surface = TriangleMesh::from(mesh);
    surface.normals = surface.vertex_normals();
    surface
}

fn atlas(surface: &TriangleMesh) -> Atlas {
    Atlas::build(surface, CELL_M, 35.0, 8192).unwrap()
}

/// Every place of every triangle reads, between texels, four texels that show the surface right there.
fn check_coverage(surface: &TriangleMesh, atlas: &Atlas) {
    const SHARES: [[f32; 3]; 5] =
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.34, 0.33, 0.33], [0.5, 0.5, 0.0]];
    assert_eq!(atlas.triangles.len(), surface.triangles.len());
    for (t, corners) in atlas.triangles.iter().enumerate() {
        assert_eq!(corners.map(|i| atlas.vertices[i as usize]), surface.triangles[t]);
        for shares in SHARES {
            let mix =
                |values: [[f32; 3]; 3]| (0..3).map(|i| Vector3::from(values[i]) * shares[i]).sum::<Vector3<f32>>();
            let place = Point3::from(mix(surface.corners(t).map(|p| p.into())));
            let uv = mix(corners.map(|i| {
                let [u, v] = atlas.uv[i as usize];
                [u * atlas.width as f32, v * atlas.height as f32, 0.0]
            }));
            for (du, dv) in [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)] {
                let (column, row) = ((uv.x + du * 0.999) as usize, (uv.y + dv * 0.999) as usize);
                let number = atlas.number_at[row * atlas.width as usize + column];
                assert_ne!(number, NO_TEXEL, "triangle {t} reads beside its chart");
                let shown = Point3::from(atlas.texels[number as usize].position_m);
                // Two cells, and as much deeper as a fragment may be steep.
                assert!((shown - place).norm() < 8e-3, "triangle {t} at {place} reads {shown}");
            }
        }
    }
}

/// Shares of length that the texture keeps, over all edges: smallest and largest.
fn stretch(surface: &TriangleMesh, atlas: &Atlas) -> [f32; 2] {
    let mut range = [f32::INFINITY, 0.0f32];
    for (t, corners) in atlas.triangles.iter().enumerate() {
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let [a, b] = [corners[i], corners[j]].map(|v| atlas.uv[v as usize]);
            let flat = ((a[0] - b[0]) * atlas.width as f32).hypot((a[1] - b[1]) * atlas.height as f32);
            let [p, q] = [surface.corners(t)[i], surface.corners(t)[j]];
            let kept = flat * CELL_M as f32 / (p - q).norm();
            range = [range[0].min(kept), range[1].max(kept)];
        }
    }
    range
}

#[test]
fn a_tilted_plate_has_cells_of_exactly_the_size_asked() {
    let mut mesh = surface(&plate_mesh([-0.05; 2], [0.05; 2], 0.0, 7));
    let tilt = UnitQuaternion::from_euler_angles(0.4, -0.9, 1.3).cast::<f32>();
    mesh.vertices.iter_mut().for_each(|p| *p = tilt * *p);
    mesh.normals = mesh.vertex_normals();
    let atlas = atlas(&mesh);
    assert_eq!(atlas.charts, 1);
    let inside = atlas.texels.iter().filter(|t| t.inside).count();
    assert!((9990..=10010).contains(&inside), "{inside} cells on 10000 mm2");
    let [least, most] = stretch(&mesh, &atlas);
    assert!(least > 0.999 && most < 1.001, "{least} {most}");
    // The smallest rectangle is found: hardly a texel is wasted.
    assert!(atlas.number_at.len() < 12_500, "{}x{}", atlas.width, atlas.height);
    check_coverage(&mesh, &atlas);
}

#[test]
fn a_sphere_is_covered_with_bounded_stretch() {
    for (cells, radius) in [(10, 0.03), (60, 0.03), (40, 0.002)] {
        let mesh = surface(&sphere_mesh([0.3, -0.2, 0.1], radius, cells));
        let atlas = atlas(&mesh);
        check_coverage(&mesh, &atlas);
        let [least, most] = stretch(&mesh, &atlas);
        assert!(most < 1.002, "{most}");
        // 35 degrees, and 75 for fragments of less than 16 cells.
        assert!(least > 0.25, "{least}");
        assert!(atlas.charts < 60, "{}", atlas.charts);
    }
}

#[test]
fn sheets_over_each_other_get_charts_of_their_own() {
    // A ramp that winds up three times: connected, nowhere steep, and three deep seen from above.
    const STEPS: u32 = 180;
    let at = |step: u32, radius: f32| {
        let turn = std::f32::consts::TAU * step as f32 / 60.0;
        [radius * turn.cos(), radius * turn.sin(), 0.02 * step as f32 / 60.0]
    };
    let vertices = (0..=STEPS).flat_map(|s| [at(s, 0.02), at(s, 0.04)]).collect();
    let triangles =
        (0..STEPS).flat_map(|s| [[2 * s, 2 * s + 1, 2 * s + 2], [2 * s + 1, 2 * s + 3, 2 * s + 2]]).collect();
    let mesh = surface(&mesh_of(vertices, triangles));
    let atlas = atlas(&mesh);
    assert!(atlas.charts >= 3, "{}", atlas.charts);
    check_coverage(&mesh, &atlas);
}

#[test]
fn seams_pair_texels_of_one_place() {
    let mesh = surface(&sphere_mesh([0.0; 3], 0.03, 40));
    let atlas = atlas(&mesh);
    assert!(atlas.seams.len() > 500);
    for &[a, b] in &atlas.seams {
        let [p, q] = [a, b].map(|number| Point3::from(atlas.texels[number as usize].position_m));
        assert!((p - q).norm() < 1.5e-3, "{p} {q}");
        assert!(atlas.seams.binary_search(&[b, a]).is_ok());
    }
}

#[test]
fn a_texture_too_large_says_which_cells_would_fit() {
    let mesh = surface(&sphere_mesh([0.0; 3], 0.03, 10));
    let Err(AtlasError::TooLarge { enough_mm, .. }) = Atlas::build(&mesh, CELL_M, 35.0, 64) else {
        panic!("12,000 mm2 do not fit on 64 x 64 cells")
    };
    assert!(enough_mm > 1.0);
    Atlas::build(&mesh, 1.5e-3 * enough_mm, 35.0, 64).unwrap();
}

#[test]
fn loose_triangles_hang_together_where_they_touch() {
    let plate = plate_mesh([-0.05; 2], [0.05; 2], 0.0, 20);
    let vertices = plate.triangles.iter().flatten().map(|&i| plate.vertices_m[i as usize]).collect::<Vec<_>>();
    let triangles = (0..plate.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    assert_eq!(atlas(&surface(&mesh_of(vertices, triangles))).charts, 1);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// Triangles through each other, without area, with edges of many neighbours.
    #[test]
    fn any_triangles_get_a_texture(
        places in prop::collection::vec([-8i8..8, -8i8..8, -8i8..8], 3..24),
        picks in prop::collection::vec([0usize..64, 0usize..64, 0usize..64], 1..60),
    ) {
        let vertices: Vec<[f32; 3]> = places.iter().map(|p| p.map(|c| f32::from(c) * 1e-3)).collect();
        let triangles: Vec<[u32; 3]> = picks.iter().map(|t| t.map(|i| (i % places.len()) as u32)).collect();
        let mesh = surface(&mesh_of(vertices, triangles));
        let atlas = atlas(&mesh);
        for corners in &atlas.triangles {
            let [u, v] = corners.iter().fold([0.0; 2], |s, &i| {
                [s[0] + atlas.uv[i as usize][0] / 3.0, s[1] + atlas.uv[i as usize][1] / 3.0]
            });
            let place = (v * atlas.height as f32) as usize * atlas.width as usize + (u * atlas.width as f32) as usize;
            prop_assert_ne!(atlas.number_at[place], NO_TEXEL);
        }
    }
}
