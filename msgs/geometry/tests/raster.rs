//! The visibility buffer against rays cast in closed form.

use geometry::{Camera, NO_TRIANGLE, TriangleMesh, VisibilityBuffer};
use nalgebra::{Isometry3, Point2, Point3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;

fn camera() -> Camera {
    let distortion = [-0.21, 0.12, 4e-4, -3e-4, 0.01];
    Camera { width: 320, height: 240, fx: 400.0, fy: 402.0, cx: 161.3, cy: 118.7, distortion }
}

/// A square in the plane z = 0 of the world.
fn square(half_m: f32) -> TriangleMesh {
    let corner = |x: f32, y: f32| Point3::new(x * half_m, y * half_m, 0.0);
    TriangleMesh {
        vertices: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..TriangleMesh::default()
    }
}

fn sphere(rings: u32, radius_m: f32) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let around = 2 * rings;
    for i in 0..=rings {
        let (sin, cos) = (std::f32::consts::PI * i as f32 / rings as f32).sin_cos();
        for j in 0..around {
            let (y, x) = (std::f32::consts::TAU * j as f32 / around as f32).sin_cos();
            mesh.vertices.push(Point3::new(radius_m * sin * x, radius_m * sin * y, radius_m * cos));
        }
    }
    for i in 0..rings {
        for j in 0..around {
            let next = (j + 1) % around;
            let [a, b, c, d] = [i * around + j, (i + 1) * around + j, (i + 1) * around + next, i * around + next];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

/// From above, tilted, so that world z = 0 lies about `distance_m` ahead.
fn looking_down(distance_m: f64, tilt_rad: f64) -> Isometry3<f64> {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI - tilt_rad);
    Isometry3::from_parts(Translation3::new(0.004, -0.003, distance_m), turn)
}

#[test]
fn two_huge_triangles_are_the_plane_at_every_pixel_of_a_bent_lens() {
    let camera = camera();
    let camera_from_world = looking_down(0.2, 0.4);
    let mut seen = VisibilityBuffer::new(320, 240);
    seen.draw(&camera, &camera_from_world, &square(0.5), 7);
    let normal = camera_from_world.rotation * Vector3::z();
    let distance = normal.dot(&camera_from_world.translation.vector);
    let mut worst = 0.0_f64;
    for row in 0..240 {
        for column in 0..320 {
            let direction = camera.direction(Point2::new(column as f64, row as f64));
            let truth = distance / normal.dot(&direction);
            let depth = seen.depth_m(column, row).unwrap_or_else(|| panic!("a gap at {column} {row}"));
            worst = worst.max((f64::from(depth) - truth).abs());
            assert!([7, 8].contains(&seen.triangle[row * 320 + column]));
        }
    }
    // 0.05 px of a bent edge drawn straight, on a slope of 0.5 mm a pixel.
    assert!(worst < 3e-5, "depth is off by {worst} m");
}

#[test]
fn a_sphere_is_seen_where_its_rays_meet_it_and_hides_what_is_behind() {
    let camera = camera();
    let camera_from_world =
        Isometry3::from_parts(Translation3::new(0.01, 0.005, 0.25), UnitQuaternion::from_euler_angles(0.7, -0.3, 2.0));
    let radius = 0.05;
    let (ball, wall) = (sphere(200, radius as f32), square(0.02));
    let mut seen = VisibilityBuffer::new(320, 240);
    seen.cull_back_faces = true;
    seen.draw(&camera, &camera_from_world, &ball, 0);
    let first_of_wall = ball.triangles.len() as u32;
    seen.draw(&camera, &camera_from_world, &wall, first_of_wall);
    let centre = camera_from_world.translation.vector;
    let mut wrong_outline = 0;
    for row in 0..240 {
        for column in 0..320 {
            let direction = camera.direction(Point2::new(column as f64, row as f64));
            // |mu d - c|² = r²
            let (dd, dc) = (direction.norm_squared(), direction.dot(&centre));
            let root = dc * dc - dd * (centre.norm_squared() - radius * radius);
            let triangle = seen.triangle[row * 320 + column];
            match seen.depth_m(column, row) {
                Some(depth) if root > 0.0 => {
                    let truth = (dc - root.sqrt()) / dd;
                    // The chord of a facet lies inside the sphere; towards the outline the ray runs along it.
                    let grazing = (root.sqrt() / (dd.sqrt() * radius)).max(0.05);
                    assert!((f64::from(depth) - truth).abs() < 2e-5 / grazing, "{column} {row}");
                    assert!(triangle < first_of_wall, "the wall inside the ball shows through");
                }
                None => {
                    assert_eq!(triangle, NO_TRIANGLE);
                    wrong_outline += usize::from(root > 0.0);
                }
                Some(_) => wrong_outline += 1,
            }
        }
    }
    assert!(wrong_outline < 20, "{wrong_outline} pixels of the outline");
}

#[test]
fn culling_leaves_out_the_back_and_nothing_else() {
    let camera = camera();
    let mut seen = VisibilityBuffer::new(320, 240);
    seen.cull_back_faces = true;
    seen.draw(&camera, &looking_down(0.2, 0.0), &square(0.02), 0);
    assert!(seen.depth_m(160, 120).is_some(), "its normal is world z, towards the camera");
    seen.clear();
    let from_below = Isometry3::from_parts(Translation3::new(0.0, 0.0, 0.2), UnitQuaternion::identity());
    seen.draw(&camera, &from_below, &square(0.02), 0);
    assert!(seen.triangle.iter().all(|t| *t == NO_TRIANGLE));
    seen.cull_back_faces = false;
    seen.draw(&camera, &from_below, &square(0.02), 0);
    assert!(seen.depth_m(160, 120).is_some());
}

#[test]
fn a_floor_that_runs_under_the_camera_is_drawn_as_far_as_it_is_ahead() {
    let camera = Camera { distortion: [0.0; 5], ..camera() };
    // y down: the floor (world z = 0, z up) lies 0.1 m below a camera that looks along world x.
    let rotation = nalgebra::Matrix3::new(0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0);
    let turn = UnitQuaternion::from_matrix(&rotation);
    let camera_from_world = Isometry3::from_parts(Translation3::new(0.0, 0.1, 0.0), turn);
    let mut seen = VisibilityBuffer::new(320, 240);
    seen.draw(&camera, &camera_from_world, &square(3.0), 0);
    for row in 0..240 {
        let truth = 0.1 * camera.fy / (row as f64 - camera.cy);
        let depth = seen.depth_m(161, row);
        if truth > 0.0 && truth < 2.9 {
            let depth = f64::from(depth.unwrap_or_else(|| panic!("row {row}")));
            assert!((depth / truth - 1.0).abs() < 2e-3, "row {row}: {depth} for {truth}");
        } else if truth < 0.0 {
            assert!(depth.is_none(), "the sky has no depth");
        }
    }
}

proptest! {
    #[test]
    fn no_mesh_breaks_it(
        coordinates in prop::collection::vec(prop::num::f32::ANY, 9..60),
        triangles in prop::collection::vec(prop::array::uniform3(0u32..22), 1..20),
    ) {
        let vertices = coordinates.chunks_exact(3).map(|c| Point3::new(c[0], c[1], c[2])).collect();
        let mesh = TriangleMesh { vertices, triangles, ..TriangleMesh::default() };
        let mut seen = VisibilityBuffer::new(320, 240);
        seen.draw(&camera(), &Isometry3::identity(), &mesh, 0);
        for (inverse, triangle) in seen.inverse_depth.iter().zip(&seen.triangle) {
            prop_assert_eq!(*inverse > 0.0, *triangle != NO_TRIANGLE);
        }
    }
}
