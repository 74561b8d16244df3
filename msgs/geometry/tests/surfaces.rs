//! Rays, closest points, and surfaces compared, against what analysis says.

use geometry::{AlignError, CompareError, MeshError, MeshIndex, TriangleMesh, align, compare, sample_surface};
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;

const SEED: u64 = 7;

/// A square of 100 mm in the plane z = `height_m`, normal up, with its middle at the origin.
fn plane(height_m: f32) -> TriangleMesh {
    grid(100, 0.1, |x, y| Point3::new(x, y, height_m))
}

/// `cells` x `cells` squares over `size_m` x `size_m`, bent by `shape`.
fn grid(cells: u32, size_m: f32, shape: impl Fn(f32, f32) -> Point3<f32>) -> TriangleMesh {
    let at = |i: u32| size_m * (i as f32 / cells as f32 - 0.5);
    let mut mesh = TriangleMesh::default();
    for j in 0..=cells {
        for i in 0..=cells {
            mesh.vertices.push(shape(at(i), at(j)));
        }
    }
    for j in 0..cells {
        for i in 0..cells {
            let a = j * (cells + 1) + i;
            let (b, c, d) = (a + 1, a + cells + 2, a + cells + 1);
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

/// A ball: the poles are degenerate triangles on purpose.
fn sphere(radius_m: f32, centre: Vector3<f32>) -> TriangleMesh {
    const PI: f32 = std::f32::consts::PI;
    grid(200, 1.0, move |x, y| {
        let (longitude, latitude) = (2.0 * PI * x, PI * y);
        let ring = latitude.cos();
        Point3::from(centre + radius_m * Vector3::new(ring * longitude.cos(), ring * longitude.sin(), latitude.sin()))
    })
}

/// Something without symmetry.
fn hills(x: f32, y: f32) -> Point3<f32> {
    Point3::new(x, y, 0.01 * (60.0 * x).sin() + 0.006 * (45.0 * y + 80.0 * x * y).cos() + 0.2 * x * x)
}

fn moved(mesh: &TriangleMesh, by: &Isometry3<f64>) -> TriangleMesh {
    let mut mesh = mesh.clone();
    for p in &mut mesh.vertices {
        *p = (by * p.map(f64::from)).map(|c| c as f32);
    }
    mesh
}

#[test]
fn planes_apart_differ_by_their_distance() {
    let comparison = compare(&plane(0.3e-3), &plane(0.0), None, SEED).unwrap();
    let distances = comparison.model_to_truth;
    for value in [distances.rms_mm, distances.median_mm, distances.p95_mm, distances.max_mm, distances.bias_mm] {
        assert!((value - 0.3).abs() < 1e-5, "{distances:?}");
    }
    let shares: Vec<f64> = comparison.truth_to_model.within.iter().map(|w| w.share).collect();
    assert_eq!(shares, [0.0, 1.0, 1.0, 1.0]);
    assert!(comparison.seen_truth_to_model.is_none());
}

#[test]
fn spheres_differ_by_their_radii_and_the_sign_says_inside() {
    let (model, truth) = (sphere(0.0495, Vector3::zeros()), sphere(0.05, Vector3::zeros()));
    let distances = compare(&model, &truth, None, SEED).unwrap().model_to_truth;
    assert!((distances.rms_mm - 0.5).abs() < 0.005, "{distances:?}");
    assert!((distances.bias_mm + 0.5).abs() < 0.005, "{distances:?}");
}

#[test]
fn half_a_truth_is_half_complete_and_all_of_what_could_be_seen() {
    let half = grid(100, 0.1, |x, y| Point3::new(0.5 * (x - 0.05), y, 0.0));
    let truth = plane(0.0);
    let seen: Vec<bool> = geometry::truth_samples(&truth, SEED).unwrap().iter().map(|s| s.point.x < 0.0).collect();
    let comparison = compare(&half, &truth, Some(&seen), SEED).unwrap();
    let within = |c: &geometry::Completeness| c.share_within_mm(1.0).unwrap();
    // Half of 100 mm, and one more that is within reach of the edge.
    assert!((within(&comparison.truth_to_model) - 0.51).abs() < 0.002);
    let of_seen = comparison.seen_truth_to_model.unwrap();
    assert_eq!(within(&of_seen), 1.0);
    assert!((of_seen.samples as f64 / seen.len() as f64 - 0.5).abs() < 0.01);
}

#[test]
fn distances_are_to_triangles_and_not_to_vertices() {
    let coarse = grid(1, 0.1, |x, y| Point3::new(x, y, 0.0));
    assert!(compare(&plane(0.0), &coarse, None, SEED).unwrap().model_to_truth.max_mm < 1e-5);
}

#[test]
fn the_same_seed_gives_the_same_bytes_on_any_number_of_threads() {
    let (model, truth) = (sphere(0.0495, Vector3::x() * 1e-3), sphere(0.05, Vector3::zeros()));
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| compare(&model, &truth, None, SEED).unwrap())
    };
    assert_eq!(on(1), on(4));
    assert_ne!(on(1), compare(&model, &truth, None, SEED + 1).unwrap());
}

#[test]
fn samples_are_uniform_over_the_area() {
    // A fan of triangles of very different sizes.
    let square = TriangleMesh {
        vertices: [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.9, 0.1)]
            .map(|(x, y)| Point3::new(x, y, 0.0))
            .to_vec(),
        triangles: vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
        ..TriangleMesh::default()
    };
    const COUNT: usize = 40_000;
    let samples = sample_surface(&square, COUNT, SEED).unwrap();
    let mut cells = [0usize; 16];
    for s in &samples {
        cells[(s.point.x * 4.0) as usize + 4 * (s.point.y * 4.0) as usize] += 1;
        assert_eq!(s.normal, Vector3::z());
    }
    let expected = COUNT as f64 / 16.0;
    for count in cells {
        assert!((count as f64 - expected).abs() < 5.0 * expected.sqrt(), "{cells:?}");
    }
}

#[test]
fn a_turned_copy_is_laid_back() {
    let truth = grid(100, 0.1, hills);
    let off = Isometry3::from_parts(
        Translation3::new(2e-3, -1.5e-3, 1e-3),
        UnitQuaternion::from_scaled_axis(Vector3::new(0.05, -0.04, 0.06)),
    );
    let model = moved(&truth, &off);
    let alignment = align(&model, &truth, &Isometry3::identity(), SEED).unwrap();
    assert!(alignment.converged, "{alignment:?}");
    assert_eq!(alignment.observed_directions, 6);
    let left = alignment.truth_from_model * off;
    assert!(left.translation.vector.norm() < 5e-6 && left.rotation.angle() < 5e-5, "{left:?}");
    let after = compare(&moved(&model, &alignment.truth_from_model), &truth, None, SEED).unwrap();
    assert!(after.model_to_truth.rms_mm < 2e-3, "{after:?}");
}

#[test]
fn what_the_truth_lacks_pulls_nothing() {
    let truth = grid(100, 0.1, hills);
    let off = Isometry3::translation(1e-3, 0.5e-3, -1e-3);
    let mut with_blob = truth.clone();
    with_blob.append(&sphere(0.01, Vector3::new(0.0, 0.0, 0.05)));
    let alignment = align(&moved(&with_blob, &off), &truth, &Isometry3::identity(), SEED).unwrap();
    assert!((alignment.truth_from_model * off).translation.vector.norm() < 2e-5, "{alignment:?}");
    assert!(alignment.kept_share < 0.95);
}

#[test]
fn what_a_plane_does_not_hold_stays_as_it_was() {
    let alignment = align(&plane(1e-3), &plane(0.0), &Isometry3::identity(), SEED).unwrap();
    assert_eq!(alignment.observed_directions, 3);
    assert!((alignment.truth_from_model.translation.vector - Vector3::new(0.0, 0.0, -1e-3)).norm() < 1e-8);
}

#[test]
fn bad_surfaces_are_named() {
    let (empty, good) = (TriangleMesh::default(), plane(0.0));
    assert_eq!(compare(&empty, &good, None, 0), Err(CompareError::Model(MeshError::NoFaces { vertices: 0 })));
    assert_eq!(compare(&good, &empty, None, 0), Err(CompareError::Truth(MeshError::NoFaces { vertices: 0 })));
    let needle = TriangleMesh { vertices: vec![Point3::origin(); 3], triangles: vec![[0, 1, 2]], ..empty.clone() };
    assert_eq!(compare(&needle, &good, None, 0), Err(CompareError::NoArea("model")));
    let samples = geometry::COMPARE_SAMPLES;
    assert_eq!(compare(&good, &good, Some(&[true]), 0), Err(CompareError::Mask { mask: 1, samples }));
    let nan = Isometry3::translation(f64::NAN, 0.0, 0.0);
    assert_eq!(align(&good, &good, &nan, 0), Err(AlignError::Start));
    let mut hole = good;
    hole.vertices[3].y = f32::NAN;
    assert_eq!(MeshIndex::new(&hole).err(), Some(MeshError::NotFinite { index: 3 }));
}

#[test]
fn nothing_is_found_for_what_is_not_finite() {
    let index = MeshIndex::new(&plane(0.0)).unwrap();
    assert!(index.closest(&Point3::new(f64::NAN, 0.0, 0.0)).is_none());
    assert!(index.cast(&Point3::new(0.0, 0.0, 1.0), &Vector3::zeros(), 9.0).is_none());
    assert!(index.cast(&Point3::new(0.0, 0.0, 1.0), &Vector3::new(0.0, f64::NAN, -1.0), 9.0).is_none());
    assert!(index.closest_within(&Point3::new(0.0, 0.0, 1.0), 0.5).is_none());
}

#[test]
fn no_ray_slips_between_neighbours_and_none_reaches_too_far() {
    let index = MeshIndex::new(&grid(100, 0.1, hills)).unwrap();
    for (i, j) in (0..=200).flat_map(|i| (0..=200).map(move |j| (i, j))) {
        // Every other one of these runs exactly into an edge or a corner.
        let at = |i: i32| f64::from(0.0999_f32) * (f64::from(i) / 200.0 - 0.5);
        let (x, y) = (at(i), at(j));
        let hit = index.cast(&Point3::new(x, y, 0.2), &Vector3::new(0.0, 0.0, -2.0), 1.0).unwrap();
        assert!((hit.point.z - f64::from(hills(x as f32, y as f32).z)).abs() < 5e-5);
        assert!((hit.distance - (0.2 - hit.point.z) / 2.0).abs() < 1e-12, "in lengths of the direction");
    }
    assert!(index.cast(&Point3::new(0.0, 0.0, 0.2), &Vector3::new(0.0, 0.0, -1.0), 0.1).is_none());
    assert!(index.cast(&Point3::new(0.0, 0.0, 0.2), &Vector3::new(0.0, 0.0, 1.0), 1.0).is_none());
    // From behind counts too.
    assert!(index.cast(&Point3::new(0.0, 0.0, -0.2), &Vector3::new(0.0, 0.0, 1.0), 1.0).is_some());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]
    #[test]
    fn the_tree_agrees_with_looking_at_every_triangle(
        corners in prop::collection::vec(prop::array::uniform3(prop::array::uniform3(-0.1f32..0.1)), 1..40),
        at in prop::array::uniform3(-0.2f64..0.2),
        towards in prop::array::uniform3(-1.0f64..1.0),
    ) {
        let mesh = TriangleMesh {
            vertices: corners.iter().flatten().map(|&p| Point3::from(p)).collect(),
            triangles: (0..corners.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
            ..TriangleMesh::default()
        };
        let alone = |t: usize| {
            MeshIndex::new(&TriangleMesh { triangles: vec![mesh.triangles[t]], ..mesh.clone() }).unwrap()
        };
        let (point, direction) = (Point3::from(at), Vector3::from(towards));
        let index = MeshIndex::new(&mesh).unwrap();
        let closest = index.closest(&point).unwrap();
        let nearest = (0..corners.len()).map(|t| alone(t).closest(&point).unwrap().distance).fold(f64::MAX, f64::min);
        prop_assert!((closest.distance - nearest).abs() < 1e-7);
        let first = (0..corners.len()).filter_map(|t| alone(t).cast(&point, &direction, 1e3)).map(|h| h.distance);
        let first = first.fold(f64::INFINITY, f64::min);
        let hit = index.cast(&point, &direction, 1e3).map_or(f64::INFINITY, |h| h.distance);
        prop_assert!(hit == first || (hit - first).abs() < 1e-6 * first);
        // No point of the triangle is closer than the one that was found.
        let [a, b, c] = mesh.corners(closest.triangle as usize).map(|p| p.map(f64::from));
        for (i, j) in (0..=8).flat_map(|i| (0..=8 - i).map(move |j| (f64::from(i) / 8.0, f64::from(j) / 8.0))) {
            let other = a + (b - a) * i + (c - a) * j;
            prop_assert!((other - point).norm() >= closest.distance - 1e-12);
        }
        let [wa, wb, wc] = index.barycentric(closest.triangle, &closest.point);
        let back = a.coords * wa + b.coords * wb + c.coords * wc;
        prop_assert!((back - closest.point.coords).norm() < 1e-6);
    }
}
