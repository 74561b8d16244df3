//! The cow's colours: crisp patches of brown and black on white, a pink muzzle and udder, a red collar with a bell.

use super::coat::{Coat, Zone};
use super::cow::{BELL, in_head, in_trunk};
use super::solid::{Point, ellipsoid, limb, sphere, union};

const WHITE: [u8; 3] = [233, 228, 216];
const BROWN: [u8; 3] = [133, 82, 48];
const BLACK: [u8; 3] = [62, 58, 56];
const PINK: [u8; 3] = [226, 158, 148];
const HOOF: [u8; 3] = [88, 76, 66];
const HORN: [u8; 3] = [214, 196, 150];
const RED: [u8; 3] = [188, 44, 40];
const GOLD: [u8; 3] = [214, 164, 52];
const EYE: [u8; 3] = [38, 34, 36];

/// The zones, the finest first.
pub fn coat() -> Coat {
    let zones: Vec<(Zone, [u8; 3])> = vec![
        (on_head(|q| sphere(q, [72.3, 12.2, 95.4], 1.2)), WHITE),
        (on_head(|q| sphere(q, [70.2, 10.4, 94.0], 3.3)), EYE),
        (on_head(|q| sphere(q, [88.5, 5.2, 80.5], 2.6)), EYE),
        (on_head(|q| limb(q, [88.0, 0.0, 72.6], [84.0, 9.5, 73.2], 0.8, 0.8)), RED),
        (on_head(|q| ellipsoid(q, [84.0, 0.0, 76.5], [9.5, 14.0, 10.5])), PINK),
        (on_head(|q| limb(q, [58.2, 9.5, 104.5], [61.5, 15.0, 117.0], 6.6, 5.0)), HORN),
        (on_head(|q| ellipsoid(q, [62.5, 22.0, 94.5], [5.2, 8.5, 4.6])), PINK),
        (on_trunk(|q| sphere(q, BELL, 6.0)), GOLD),
        (on_trunk(collar), RED),
        (Box::new(|p| p.z - 7.5), HOOF),
        (on_trunk(|q| ellipsoid(q, [-18.0, 0.0, 32.0], [14.0, 13.0, 10.5])), PINK),
        (on_trunk(|q| ellipsoid(q, [-66.0, 3.5, 34.0], [9.0, 9.0, 11.5])), BLACK),
        (on_head(|q| ellipsoid(q, [78.0, 0.0, 96.0], [18.0, 4.6, 14.0])), WHITE),
        (on_trunk(brown), BROWN),
        (on_trunk(black), BLACK),
    ];
    Coat { zones, ground: WHITE }
}

fn on_trunk(zone: impl Fn(&Point) -> f64 + Sync + 'static) -> Zone {
    Box::new(move |p| zone(&in_trunk(p)))
}

/// The same on both sides of the head.
fn on_head(zone: impl Fn(&Point) -> f64 + Sync + 'static) -> Zone {
    Box::new(move |p| {
        let q = in_head(&in_trunk(p));
        zone(&Point::new(q.x, q.y.abs(), q.z))
    })
}

/// A band around the neck, across its axis.
fn collar(p: &Point) -> f64 {
    let along = ((p.x - 50.0) * 20.0 + (p.z - 78.0) * 18.0) / 26.9;
    (along.abs() - 2.6).max(sphere(p, [50.0, 0.0, 76.0], 26.0))
}

/// Makes the edge of a patch wander.
fn wander(p: &Point) -> f64 {
    1.8 * (0.21 * p.x + 0.9).sin() * (0.17 * p.y + 0.27 * p.z).cos() + 1.1 * (0.43 * p.z - 0.31 * p.x + 0.2 * p.y).sin()
}

fn brown(p: &Point) -> f64 {
    let q = in_head(p);
    let head = ellipsoid(&q, [62.0, 0.0, 95.0], [24.0, 44.0, 22.0]).max(46.0 - q.x);
    let saddle = union(sphere(p, [-6.0, 24.0, 70.0], 20.0), sphere(p, [10.0, 16.0, 84.0], 15.0), 8.0);
    let shoulder = sphere(p, [34.0, -26.0, 60.0], 18.0);
    let thigh = sphere(p, [-46.0, 24.0, 44.0], 14.0);
    head.min(saddle).min(shoulder).min(thigh) + wander(p)
}

fn black(p: &Point) -> f64 {
    let flank = union(sphere(p, [-16.0, -24.0, 66.0], 17.0), sphere(p, [-30.0, -18.0, 80.0], 13.0), 8.0);
    let rump = sphere(p, [-50.0, 12.0, 76.0], 15.0);
    let shoulder = sphere(p, [36.0, 26.0, 54.0], 14.0);
    let knee = sphere(p, [34.0, -22.0, 26.0], 10.0);
    flank.min(rump).min(shoulder).min(knee) + wander(p)
}
