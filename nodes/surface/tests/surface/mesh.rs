//! What the mesh promises whatever the shape: holes, islands, determinism, live updates.

use crate::animal::{Random, V, scanned};
use crate::check::{as_it_is, assert_clean, cloud};
use surface::{Config, Surfer, surface_from_points};
use wire::{Cloud, Extent, Header, Mesh, Phase};

type Points = (Vec<[f32; 3]>, Vec<[f32; 3]>);

fn ball(random: &mut Random, centre: V, radius_m: f64) -> (V, V) {
    let n = random.direction();
    (centre + n * radius_m, n)
}

fn some_sphere(count: usize) -> Points {
    let mut random = Random(11);
    let truth: Vec<(V, V)> = (0..count).map(|_| ball(&mut random, V::zeros(), 0.02)).collect();
    scanned(&truth, 0.1e-3, 5.0, 12)
}

fn without(points: &Points, gone: impl Fn(&[f32; 3]) -> bool) -> Points {
    points.0.iter().zip(&points.1).filter(|(p, _)| !gone(p)).map(|(p, n)| (*p, *n)).unzip()
}

#[test]
fn holes_are_filled_up_to_their_size() {
    // A cap of 8 mm radius is missing above, one of 3.5 mm below.
    let points = without(&some_sphere(40_000), |p| {
        let across = p[0].hypot(p[1]);
        (p[2] > 0.0 && across < 8e-3) || (p[2] < 0.0 && across < 3.5e-3)
    });
    let mesh = surface_from_points(&points.0, Some(&points.1), as_it_is()).unwrap().0;
    let both = assert_clean(&mesh);
    let mesh = surface_from_points(&points.0, Some(&points.1), Config::default()).unwrap().0;
    let one = assert_clean(&mesh);
    assert!(one > 20 && one < both, "{one} of {both} edges are left on rims");
    assert!(mesh.vertices_m.iter().all(|p| p[2] < 0.0199), "the large hole stays open");
    let config = Config { fill_holes_mm: 30.0, ..Config::default() };
    let mesh = surface_from_points(&points.0, Some(&points.1), config).unwrap().0;
    assert_eq!(assert_clean(&mesh), 0, "a larger size closes it");
    let lid = |p: &&[f32; 3]| p[2] > 0.0 && p[0].hypot(p[1]) < 5e-3;
    assert!(mesh.vertices_m.iter().filter(lid).count() > 20);
    assert!(mesh.vertices_m.iter().filter(lid).all(|p| p[2] > 0.0175 && p[2] < 0.0195), "flat over its rim");
}

#[test]
fn islands_below_their_size_are_dropped() {
    let (mut points, mut normals) = some_sphere(40_000);
    let mut random = Random(5);
    let crumbs: Vec<(V, V)> = (0..300).map(|_| ball(&mut random, V::x() * 0.06, 2e-3)).collect();
    let (more_points, more_normals) = scanned(&crumbs, 0.0, 0.0, 6);
    points.extend(more_points);
    normals.extend(more_normals);
    let far = |mesh: &Mesh| mesh.vertices_m.iter().filter(|p| p[0] > 0.04).count();
    assert!(far(&surface_from_points(&points, Some(&normals), as_it_is()).unwrap().0) > 20);
    let mesh = surface_from_points(&points, Some(&normals), Config::default()).unwrap().0;
    assert_clean(&mesh);
    assert_eq!(far(&mesh), 0);
}

#[test]
fn no_triangle_is_a_sliver() {
    let (points, normals) = some_sphere(40_000);
    let mesh = surface_from_points(&points, Some(&normals), Config::default()).unwrap().0;
    let at = |v: u32| V::from(mesh.vertices_m[v as usize].map(f64::from));
    let height_over_edge = |&[a, b, c]: &[u32; 3]| {
        let edges = [at(b) - at(a), at(c) - at(b), at(a) - at(c)];
        let longest = edges.iter().map(V::norm).fold(0.0, f64::max);
        edges[0].cross(&edges[1]).norm() / (longest * longest)
    };
    let bad = mesh.triangles.iter().filter(|t| height_over_edge(t) < 0.05).count();
    assert!(bad * 1000 <= mesh.triangles.len(), "{bad} of {}", mesh.triangles.len());
}

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

#[test]
fn threads_do_not_show() {
    let (points, normals) = some_sphere(20_000);
    for normals in [Some(&normals[..]), None] {
        let run = || surface_from_points(&points, normals, Config::default()).unwrap().0;
        assert_eq!(on_threads(1, run), on_threads(2, run));
    }
}

#[test]
fn batches_do_not_show() {
    let (points, normals) = some_sphere(20_000);
    let whole = cloud(&points, &normals, Extent::Whole);
    let mut at_once = Surfer::new(Config::default()).unwrap();
    at_once.update(&whole);
    let wanted = at_once.final_mesh();
    assert!(wanted.header.phase == Phase::End && wanted.triangles.len() > 1000);

    let mut backwards = Surfer::new(Config::default()).unwrap();
    for (k, batch) in whole.points.chunks(1537).rev().enumerate() {
        let mut points = batch.to_vec();
        // A ball that grows: first somewhere else, then where it belongs.
        let moved: Vec<_> =
            points.iter().map(|p| wire::CloudPoint { position_m: p.position_m.map(|x| x * 1.05), ..*p }).collect();
        let changes = |points: Vec<_>| Cloud { points: points.into(), extent: Extent::Changes, ..whole.clone() };
        backwards.update(&changes(moved));
        points.reverse();
        backwards.update(&changes(points));
        if k % 4 == 0 {
            backwards.live_mesh();
        }
    }
    let live = backwards.live_mesh();
    assert!(live.triangles.len() > 1000 && live.header.phase != Phase::End);
    assert_eq!(backwards.final_mesh(), wanted);
    assert_eq!(backwards.final_mesh(), wanted, "asking twice changes nothing");
}

#[test]
fn live_changes_reach_the_mesh() {
    let (points, normals) = some_sphere(40_000);
    let mut surfer = Surfer::new(Config::default()).unwrap();
    surfer.update(&cloud(&points, &normals, Extent::Whole));
    let before = surfer.live_mesh();
    // The northern cap grows by a millimetre.
    let mut change = cloud(&points, &normals, Extent::Changes);
    change.points.retain(|p| p.position_m[2] > 0.017);
    for point in change.points.iter_mut() {
        point.position_m = point.position_m.map(|x| x * 1.05);
    }
    surfer.update(&change);
    let after = surfer.live_mesh();
    let top = |mesh: &Mesh| mesh.vertices_m.iter().map(|p| p[2]).fold(0.0, f32::max);
    assert!((top(&before) - 0.020).abs() < 2e-4 && (top(&after) - 0.021).abs() < 2e-4);
    let below = |mesh: &Mesh| -> Vec<[f32; 3]> { mesh.vertices_m.iter().copied().filter(|p| p[2] < 0.0).collect() };
    assert_eq!(below(&before), below(&after), "what nothing touched stays to the last bit");
}

#[test]
fn points_that_are_gone_leave_no_trace() {
    let (points, normals) = some_sphere(20_000);
    let mut surfer = Surfer::new(Config::default()).unwrap();
    let whole = cloud(&points, &normals, Extent::Whole);
    surfer.update(&whole);
    surfer.live_mesh();
    // A second sheet that was seen by mistake, and is taken back in the next revision.
    let next = Header { revision: 1, ..whole.header };
    let mut wrong = Cloud { header: next, extent: Extent::Changes, ..whole.clone() };
    wrong.points.retain(|p| p.position_m[2] > 0.01);
    for point in wrong.points.iter_mut() {
        (point.position_m, point.id) = (point.position_m.map(|x| x * 1.3), point.id + 100_000);
    }
    surfer.update(&wrong);
    let held = surfer.samples();
    assert_eq!(held, points.len() + wrong.points.len(), "what changed is beside what there was");
    assert!(surfer.live_mesh().vertices_m.iter().any(|p| p[2] > 0.024));
    wrong.points.iter_mut().for_each(|point| point.count = 0);
    surfer.update(&wrong);
    surfer.update(&wrong);
    assert_eq!(surfer.samples(), points.len());
    assert!(surfer.live_mesh().vertices_m.iter().all(|p| p[2] < 0.021));
    let mut clean = Surfer::new(Config::default()).unwrap();
    clean.update(&whole);
    assert_eq!(surfer.final_mesh().triangles, clean.final_mesh().triangles);
}

#[test]
fn a_new_revision_starts_afresh_and_an_old_one_is_refused() {
    let (points, normals) = some_sphere(10_000);
    let of = |points: &Points, scan, revision| Cloud {
        header: Header { scan, revision, ..Header::default() },
        ..cloud(&points.0, &points.1, Extent::Whole)
    };
    let southern = without(&(points.clone(), normals.clone()), |p| p[2] > 0.0);
    let mut surfer = Surfer::new(Config::default()).unwrap();
    surfer.update(&of(&(points.clone(), normals.clone()), 1, 0));
    surfer.update(&of(&southern, 1, 1));
    assert_eq!(surfer.samples(), southern.0.len());
    surfer.update(&of(&(points, normals), 1, 0));
    assert_eq!(surfer.samples(), southern.0.len());
    assert_eq!(
        (surfer.refused()[0].reason.as_str(), surfer.refused()[0].count),
        ("of an older scan or revision", 10_000)
    );
    let mesh = surfer.final_mesh();
    assert_eq!((mesh.header.scan, mesh.header.revision), (1, 1));
    assert!(mesh.vertices_m.iter().all(|p| p[2] < 3e-3));
}
