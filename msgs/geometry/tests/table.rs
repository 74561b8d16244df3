//! The table is found, and only the table.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use geometry::{Facing, Table, TableSearch};
use nalgebra::{Isometry3, Point3, Vector3};

const SEARCH: TableSearch = TableSearch {
    near_m: 2e-3,
    least_facing: 0.9,
    least_share: 0.05,
    most_behind: 0.02,
    trials: 1500,
    looked_at: 4000,
};

fn find(points: &[Facing]) -> Option<Table> {
    Table::find(points, &SEARCH)
}

fn ball(position: Point3<f64>, towards: Vector3<f64>) -> Facing {
    Facing { position, towards }
}

fn noise(i: usize) -> f64 {
    1e-4 * ((i * 7919 % 1000) as f64 / 500.0 - 1.0)
}

/// A dome of 40 mm on a table of 300 mm, anywhere in the world.
fn scene(place: &Isometry3<f64>) -> Vec<Facing> {
    let mut balls = Vec::new();
    for i in 0..3600 {
        let (x, y) = (0.005 * ((i % 60) as f64 - 30.0), 0.005 * ((i / 60) as f64 - 30.0));
        if f64::hypot(x, y) > 0.04 {
            balls.push(ball(place * Point3::new(x, y, noise(i)), place * Vector3::z()));
        }
    }
    for i in 0..3000 {
        let z = (f64::from(i) + 0.5) / 3000.0;
        let (turn, ring) = (2.4 * f64::from(i), (1.0 - z * z).sqrt());
        let normal = Vector3::new(ring * turn.cos(), ring * turn.sin(), z);
        balls.push(ball(place * Point3::from(normal * 0.04), place * normal));
    }
    balls
}

#[test]
fn the_table_is_found_wherever_it_stands_and_the_thing_is_left() {
    for place in [Isometry3::identity(), Isometry3::new(Vector3::new(0.4, -0.2, 1.0), Vector3::new(2.0, 0.3, -0.4))] {
        let balls = scene(&place);
        let plane = find(&balls).unwrap();
        assert!((place * Vector3::z()).angle(&plane.normal) < 1e-3);
        assert!((plane.rms_m - 1e-4 / 3f64.sqrt()).abs() < 2e-5, "{plane:?}");
        let left = balls.iter().filter(|ball| plane.height_m(&ball.position) > 5.0 * plane.rms_m).count();
        assert!((2950..=3000).contains(&left), "{left} balls of the thing");
        assert_eq!(find(&balls), Some(plane), "the same in every run");
    }
}

#[test]
fn without_a_table_nothing_is_taken_away() {
    let dome: Vec<Facing> = scene(&Isometry3::identity()).into_iter().filter(|ball| ball.position.z > 1e-3).collect();
    assert_eq!(find(&dome), None);
    assert_eq!(find(&[]), None);
    assert_eq!(find(&dome[..2]), None);
}

#[test]
fn a_plane_with_things_on_both_sides_is_no_table() {
    let mut balls = scene(&Isometry3::identity());
    let below = balls.iter().map(|b| ball(Point3::new(b.position.x, b.position.y, -b.position.z), b.towards));
    let below: Vec<Facing> = below.filter(|ball| ball.position.z < -1e-3).collect();
    balls.extend(below);
    assert_eq!(find(&balls), None);
}
