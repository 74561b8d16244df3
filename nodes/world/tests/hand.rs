//! The hand keeps off the table, stays at its distance, and leads the sheet over all that the camera can see.
#![allow(clippy::unwrap_used, reason = "a test helper that cannot go on fails the test")]

use geometry::{LaserSheet, Rig, TriangleMesh};
use nalgebra::{Isometry3, Point3, Vector2, Vector3};
use parry3d::math::Pose;
use parry3d::query::{Ray, RayCast};
use parry3d::shape::TriMesh;
use world::{Hand, Scene};

fn rig(name: &str) -> Rig {
    let path = format!("{}/../../config/rigs/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Rig::parse(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn scene(name: &str) -> Scene {
    Scene::load(format!("{}/../../config/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR")).as_ref()).unwrap()
}

/// Where the sheet passes beside the camera.
fn laser_in_camera(sheet: &LaserSheet) -> Point3<f64> {
    let across: Vector2<f64> = sheet.normal.xy();
    let offset = across * (sheet.distance_m / across.norm_squared());
    Point3::new(offset.x, offset.y, 0.0)
}

#[test]
fn keeps_off_the_table_and_at_a_sane_distance() {
    for (name, seconds) in [("cow", 60.0), ("cow", 10.0), ("tabletop", 60.0)] {
        let (scene, rig) = (scene(name), rig("paper"));
        let hand = Hand::new(&scene, &rig, seconds, 7).unwrap();
        let laser = laser_in_camera(&rig.sheet().unwrap());
        let solid = Solid::new(&scene.whole_mesh());
        let mut distances = Vec::new();
        for step in 0..=(seconds * 20.0) as usize {
            let world_from_camera = hand.world_from_camera(step as f64 / 20.0);
            let camera = Point3::from(world_from_camera.translation.vector);
            assert!(camera.z > 0.03 && (world_from_camera * laser).z > 0.02, "{name} at {step}: {camera}");
            let axis = world_from_camera * Vector3::z();
            distances.extend(solid.cast(&camera, &axis));
        }
        distances.sort_by(f64::total_cmp);
        let share = |at: f64| distances[(at * (distances.len() - 1) as f64) as usize];
        let [low, median, high] = [share(0.02), share(0.5), share(0.9)];
        println!(
            "{name} {seconds} s: stand-off 2% {low:.3} median {median:.3} 90% {high:.3} m, {} rays",
            distances.len()
        );
        assert!(low > 0.10 && (0.17..0.27).contains(&median) && high < 0.36, "{name}: {low} {median} {high}");
    }
}

#[test]
fn moves_like_a_hand() {
    let (scene, rig) = (scene("cow"), rig("paper"));
    for (seconds, limit_m_per_s) in [(60.0, 0.45), (10.0, 0.9)] {
        let hand = Hand::new(&scene, &rig, seconds, 7).unwrap();
        let step = 0.002;
        let at = |i: usize| hand.world_from_camera(i as f64 * step).translation.vector;
        let speeds = (0..(seconds / step) as usize).map(|i| (at(i + 1) - at(i)).norm() / step);
        let (sum, top) = speeds.fold((0.0, 0.0f64), |(sum, top), v| (sum + v, top.max(v)));
        println!("{seconds} s: mean {:.3}, top {top:.3} m/s", sum * step / seconds);
        assert!(top < limit_m_per_s, "{top} m/s");
    }
}

#[test]
fn tremor_has_the_stated_size() {
    let (mut calm, rig) = (scene("cow"), rig("paper"));
    let shaky = calm.clone();
    (calm.hand.tremor_mm, calm.hand.tremor_deg) = (0.0, 0.0);
    let [calm, shaky] = [calm, shaky].map(|scene| Hand::new(&scene, &rig, 20.0, 3).unwrap());
    let (mut shift, mut turn) = (0.0, 0.0);
    for i in 0..4000 {
        let t = i as f64 * 0.005;
        let off = calm.world_from_camera(t).inverse() * shaky.world_from_camera(t);
        shift += off.translation.vector.norm_squared() / 4000.0;
        turn += off.rotation.angle().powi(2) / 4000.0;
    }
    assert!((shift.sqrt() - 0.3e-3).abs() < 0.02e-3, "{}", shift.sqrt());
    assert!((turn.sqrt().to_degrees() - 0.2).abs() < 0.02, "{}", turn.sqrt().to_degrees());
}

#[test]
fn same_seed_same_way_and_another_seed_another() {
    let (scene, rig) = (scene("cow"), rig("fine"));
    let at = |seed: u64, t: f64| Hand::new(&scene, &rig, 30.0, seed).unwrap().world_from_body(t);
    assert_eq!(at(1, 12.34), at(1, 12.34));
    assert_ne!(at(1, 12.34), at(2, 12.34));
    assert!(Hand::new(&scene, &rig, f64::NAN, 1).is_err());
    assert!(Hand::new(&scene, &rig, 0.0, 1).is_err());
}

#[test]
fn ten_seconds_still_go_all_around() {
    let (scene, rig) = (scene("cow"), rig("paper"));
    let hand = Hand::new(&scene, &rig, 10.0, 1).unwrap();
    let mut seen = [false; 12];
    for i in 0..1000 {
        let p = hand.world_from_camera(i as f64 * 0.01).translation.vector;
        seen[((p.y.atan2(p.x).to_degrees() + 360.0) / 30.0) as usize % 12] = true;
    }
    assert_eq!(seen, [true; 12]);
}

/// Rays against a mesh.
struct Solid(TriMesh);

impl Solid {
    fn new(mesh: &TriangleMesh) -> Self {
        let vertices = mesh.vertices.iter().map(|p| [p.x, p.y, p.z].into()).collect();
        Self(TriMesh::new(vertices, mesh.triangles.clone()).unwrap())
    }

    fn cast(&self, from: &Point3<f64>, towards: &Vector3<f64>) -> Option<f64> {
        let (p, d) = (from.cast::<f32>(), towards.normalize().cast::<f32>());
        let ray = Ray::new([p.x, p.y, p.z].into(), [d.x, d.y, d.z].into());
        self.0.cast_ray(&Pose::IDENTITY, &ray, 2.0, true).map(f64::from)
    }

    fn sees(&self, from: &Point3<f64>, point: &Point3<f64>) -> bool {
        let way = point - from;
        self.cast(from, &way).is_none_or(|hit| hit > way.norm() - 0.4e-3)
    }
}

/// A sample of the surface, and what happened to it.
struct Sample {
    point: Point3<f64>,
    normal: Vector3<f64>,
    area: f64,
    visible: bool,
    crossed: bool,
    side: f64,
}

/// A surface that is steeper than this gives no peak.
const STEEPEST_COS: f64 = 0.2;

fn faces(from: &Point3<f64>, sample: &Sample) -> bool {
    (from - sample.point).normalize().dot(&sample.normal) > STEEPEST_COS
}

/// Shares of the surface that the camera sees, and of that what the sheet crosses while the camera sees it.
fn coverage(scene: &Scene, rig: &Rig, seconds: f64, frames_per_s: f64) -> (f64, f64, Vec<Sample>) {
    let hand = Hand::new(scene, rig, seconds, 7).unwrap();
    let sheet = rig.sheet().unwrap();
    let laser = laser_in_camera(&sheet);
    let solid = Solid::new(&scene.whole_mesh());
    let mesh = &scene.subject().mesh;
    let stride = (mesh.triangles.len() / 8_000).max(1);
    let mut samples: Vec<Sample> = (0..mesh.triangles.len())
        .step_by(stride)
        .map(|t| {
            let [a, b, c] = mesh.corners(t).map(|p| p.coords.cast::<f64>());
            let normal = mesh.area_normal(t).cast::<f64>();
            let point = Point3::from((a + b + c) / 3.0);
            let area = 0.5 * normal.norm();
            Sample { point, normal: normal.normalize(), area, visible: false, crossed: false, side: f64::NAN }
        })
        .collect();
    for frame in 0..(seconds * frames_per_s) as usize {
        let world_from_camera: Isometry3<f64> = hand.world_from_camera(frame as f64 / frames_per_s);
        let camera = Point3::from(world_from_camera.translation.vector);
        let laser = world_from_camera * laser;
        let look_around = frame % 8 == 0;
        for sample in samples.iter_mut().filter(|sample| !sample.crossed) {
            let p_in_camera = world_from_camera.inverse_transform_point(&sample.point);
            let side = sheet.distance_to(&p_in_camera);
            let crosses = side * sample.side < 0.0;
            sample.side = side;
            if !(crosses || look_around && !sample.visible) || !faces(&camera, sample) {
                continue;
            }
            let in_picture = rig.camera.project(&p_in_camera).is_some_and(|pixel| rig.camera.contains(&pixel));
            if !in_picture || p_in_camera.z > 0.35 || !solid.sees(&camera, &sample.point) {
                continue;
            }
            sample.visible = true;
            sample.crossed = crosses && faces(&laser, sample) && solid.sees(&laser, &sample.point);
        }
    }
    let area = |keep: &dyn Fn(&Sample) -> bool| samples.iter().filter(|s| keep(s)).map(|s| s.area).sum::<f64>();
    let visible = area(&|s| s.visible);
    (visible / area(&|_| true), area(&|s| s.crossed) / visible, samples)
}

#[test]
fn the_sheet_crosses_what_the_camera_sees_of_the_cow() {
    for (rig, frames_per_s) in [(rig("paper"), 25.0), (rig("fine"), 60.0)] {
        let (visible, crossed, _) = coverage(&scene("cow"), &rig, 60.0, frames_per_s);
        println!("{}: camera sees {:.1} %, sheet crosses {:.1} % of that", rig.name, 100.0 * visible, 100.0 * crossed);
        assert!(visible > 0.9, "{visible}");
        assert!(crossed > 0.97, "{crossed}");
    }
}

#[test]
fn a_short_sweep_and_a_cluttered_table_are_covered_too() {
    for (name, seconds, least) in [("cow", 10.0, 0.7), ("tabletop", 60.0, 0.72)] {
        let (visible, crossed, _) = coverage(&scene(name), &rig("paper"), seconds, 25.0);
        println!("{name}, {seconds} s: camera sees {:.1} %, sheet crosses {:.1} %", 100.0 * visible, 100.0 * crossed);
        assert!(crossed > least, "{name}: {crossed}");
    }
}
