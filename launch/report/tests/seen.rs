//! What a camera can see, where geometry says it.

use geometry::{Camera, MeshIndex, SurfaceSample, TriangleMesh, sample_surface};
use nalgebra::{Isometry3, Point3, Vector3};
use report::{Gate, seen_mask};

const CAMERA: Camera = Camera {
    width: 640,
    height: 480,
    fx: 800.0,
    fy: 800.0,
    cx: 319.5,
    cy: 239.5,
    distortion: [-0.2, 0.1, 0.0, 0.0, 0.0],
};

/// A square in the plane z = `height_m`, normal up.
fn square(side_m: f32, height_m: f32) -> TriangleMesh {
    let h = 0.5 * side_m;
    TriangleMesh {
        vertices: [[-h, -h], [h, -h], [h, h], [-h, h]].map(|[x, y]| Point3::new(x, y, height_m)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..TriangleMesh::default()
    }
}

fn looking(eye: [f64; 3], at: [f64; 3]) -> Isometry3<f64> {
    Isometry3::face_towards(&Point3::from(eye), &Point3::from(at), &Vector3::new(0.3, 1.0, 0.2))
}

fn share(scene: &TriangleMesh, samples: &[SurfaceSample], way: &[Isometry3<f64>]) -> f64 {
    let mask = seen_mask(samples, &MeshIndex::new(scene).expect("a surface"), way, &CAMERA, &Gate::default());
    assert_eq!(mask.len(), samples.len());
    mask.iter().filter(|seen| **seen).count() as f64 / mask.len() as f64
}

#[test]
fn the_picture_the_gate_and_the_slant_bound_what_is_seen() {
    let wall = square(0.1, 0.0);
    let samples = sample_surface(&wall, 5000, 1).unwrap();
    let whole = [looking([0.0, 0.0, 0.25], [0.0, 0.0, 0.0])];
    assert_eq!(share(&wall, &samples, &whole), 1.0);
    for (why, eye, at) in [
        ("from behind", [0.0, 0.0, -0.25], [0.0, 0.0, 0.0]),
        ("too near", [0.0, 0.0, 0.09], [0.0, 0.0, 0.0]),
        ("too far", [0.0, 0.0, 0.36], [0.0, 0.0, 0.0]),
        ("too slanted", [0.25, 0.0, 0.04], [0.0, 0.0, 0.0]),
        ("looking away", [0.0, 0.0, 0.25], [0.0, 0.0, 1.0]),
    ] {
        assert_eq!(share(&wall, &samples, &[looking(eye, at)]), 0.0, "{why}");
    }
    assert_eq!(share(&wall, &samples, &[]), 0.0);
}

#[test]
fn what_stands_before_it_hides_it_until_the_camera_has_moved() {
    let wall = square(0.1, 0.0);
    let samples = sample_surface(&wall, 20_000, 1).unwrap();
    let mut scene = wall;
    scene.append(&square(0.02, 0.05));
    // A plate of 20 mm at 200 mm throws a shadow of 25 mm at 250 mm.
    let above = looking([0.0, 0.0, 0.25], [0.0, 0.0, 0.0]);
    let hidden = 1.0 - share(&scene, &samples, &[above]);
    assert!((hidden - 0.0625).abs() < 0.002, "{hidden}");
    let way = [above, looking([0.15, 0.0, 0.2], [0.0, 0.0, 0.0])];
    assert_eq!(share(&scene, &samples, &way), 1.0);
}
