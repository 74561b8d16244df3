//! How far points are from the truth, as they are and after the best rigid motion.

use super::Sweep;
use geometry::{MeshIndex, rigid_from_wire};
use nalgebra::{Cholesky, Isometry3, Matrix6, Point3, Translation3, UnitQuaternion, Vector3, Vector6};
use rayon::prelude::*;
use std::collections::BTreeMap;
use wire::{ProfilePoint, Scan, ScanPoint};

/// Millimetres.
#[derive(Debug, Clone, Copy)]
pub struct Fit {
    /// Root mean square of all points without any alignment.
    pub raw: f64,
    /// The same after it.
    pub rms: f64,
    pub p95: f64,
    /// Of the points of the thing alone.
    pub thing_rms: f64,
    pub thing_p95: f64,
    /// Signed mean along the normals of the thing.
    pub bias: f64,
    /// To the same true point, after the alignment.
    pub same_point: f64,
}

impl std::fmt::Display for Fit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { raw, rms, p95, thing_rms, thing_p95, same_point, .. } = self;
        write!(f, "raw {raw:.3} aligned {rms:.3}/{p95:.3} thing {thing_rms:.3}/{thing_p95:.3} 3-D {same_point:.2}")
    }
}

const MOST_POINTS: usize = 40_000;

/// The inliers of scans against the truth; scans are found by their stamps.
pub fn fit(sweep: &Sweep, scans: &[Scan]) -> Fit {
    let mut pairs: Vec<(Point3<f64>, Point3<f64>)> = Vec::new();
    for scan in scans {
        let (k, way) = (profile_of(sweep, scan), sweep.world_from_camera(scan.header.stamp_nanos));
        pairs.extend(inliers(sweep, scan).map(|(point, i)| {
            let truth = way * Point3::from(sweep.profiles[k].points[i].position_m).cast::<f64>();
            (Point3::from(point.position_m).cast::<f64>(), truth)
        }));
    }
    let stride = (pairs.len() / MOST_POINTS).max(1);
    let pairs: Vec<_> = pairs.into_iter().step_by(stride).collect();
    let points: Vec<Point3<f64>> = pairs.iter().map(|(p, _)| *p).collect();
    let raw = distances(&sweep.truth, &points, &Isometry3::identity());
    let motion = align(&sweep.truth, &points);
    let aligned = distances(&sweep.truth, &points, &motion);
    let thing: Vec<f64> = aligned.iter().filter(|d| d.1 < sweep.thing_triangles).map(|d| d.0).collect();
    let all: Vec<f64> = aligned.iter().map(|d| d.0).collect();
    let same: f64 = pairs.iter().map(|(p, t)| (motion * p - t).norm_squared()).sum::<f64>() / pairs.len() as f64;
    Fit {
        raw: rms(&raw.iter().map(|d| d.0).collect::<Vec<_>>()) * 1e3,
        rms: rms(&all) * 1e3,
        p95: p95(&all) * 1e3,
        thing_rms: rms(&thing) * 1e3,
        thing_p95: p95(&thing) * 1e3,
        bias: thing.iter().sum::<f64>() / thing.len().max(1) as f64 * 1e3,
        same_point: same.sqrt() * 1e3,
    }
}

fn profile_of(sweep: &Sweep, scan: &Scan) -> usize {
    sweep.profiles.binary_search_by_key(&scan.header.stamp_nanos, |p| p.header.stamp_nanos).unwrap()
}

/// The points of a scan, each with its place in the profile: some were left out, the others keep their order.
fn placed<'a>(sweep: &'a Sweep, scan: &'a Scan) -> impl Iterator<Item = (&'a ScanPoint, usize)> {
    let camera_from_world = rigid_from_wire(&scan.world_from_camera).unwrap().inverse();
    let profile = &sweep.profiles[profile_of(sweep, scan)].points;
    let mut next = 0;
    scan.points.iter().map(move |point| {
        let seen = camera_from_world * Point3::from(point.position_m).cast::<f64>();
        let is_it = |exact: &ProfilePoint| (seen - Point3::from(exact.position_m).cast::<f64>()).norm() < 1e-6;
        let i = next + profile[next..].iter().position(is_it).unwrap();
        next = i + 1;
        (point, i)
    })
}

fn inliers<'a>(sweep: &'a Sweep, scan: &'a Scan) -> impl Iterator<Item = (&'a ScanPoint, usize)> {
    let wild = &sweep.wild[profile_of(sweep, scan)];
    placed(sweep, scan).filter(|(_, i)| !wild[*i])
}

/// Of the inliers and of the outliers of the frames that were kept, the share that was left out.
pub fn left_out(sweep: &Sweep, scans: &[Scan]) -> [f64; 2] {
    let (mut came, mut kept) = ([0usize; 2], [0usize; 2]);
    for scan in scans {
        let wild = &sweep.wild[profile_of(sweep, scan)];
        wild.iter().for_each(|wild| came[usize::from(*wild)] += 1);
        placed(sweep, scan).for_each(|(_, i)| kept[usize::from(wild[i])] += 1);
    }
    [0, 1].map(|kind| 1.0 - kept[kind] as f64 / came[kind].max(1) as f64)
}

fn rms(d: &[f64]) -> f64 {
    (d.iter().map(|d| d * d).sum::<f64>() / d.len().max(1) as f64).sqrt()
}

fn p95(d: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = d.iter().map(|d| d.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.get(sizes.len() * 95 / 100).copied().unwrap_or(0.0)
}

fn distances(truth: &MeshIndex, points: &[Point3<f64>], motion: &Isometry3<f64>) -> Vec<(f64, u32)> {
    points
        .par_iter()
        .map(|p| {
            let p = motion * p;
            let closest = truth.closest(&p).unwrap();
            let side = truth.normal(closest.triangle).dot(&(p - closest.point)).signum();
            (side * closest.distance, closest.triangle)
        })
        .collect()
}

/// Point-to-plane with a Cauchy weight.
fn align(truth: &MeshIndex, points: &[Point3<f64>]) -> Isometry3<f64> {
    let few: Vec<Point3<f64>> = points.iter().copied().step_by((points.len() / 10_000).max(1)).collect();
    let middle = few.iter().map(|p| p.coords).sum::<Vector3<f64>>() / few.len().max(1) as f64;
    let mut motion = Isometry3::identity();
    for _ in 0..15 {
        let rows: Vec<(Vector6<f64>, f64)> = few
            .par_iter()
            .map(|p| {
                let p = motion * p;
                let closest = truth.closest(&p).unwrap();
                let n = truth.normal(closest.triangle);
                let turn = (p - middle).coords.cross(&n);
                (Vector6::new(n.x, n.y, n.z, turn.x, turn.y, turn.z), n.dot(&(p - closest.point)))
            })
            .collect();
        let scale = 2.0 * p95(&rows.iter().map(|r| r.1).collect::<Vec<_>>()) / 2.0 + 1e-6;
        let (mut normal, mut right) = (Matrix6::<f64>::identity() * 1e-6, Vector6::zeros());
        for (row, e) in &rows {
            let weight = 1.0 / (1.0 + (e / scale).powi(2));
            normal += row * row.transpose() * weight;
            right -= row * (weight * e);
        }
        let step = Cholesky::new(normal).unwrap().solve(&right);
        let turn = UnitQuaternion::new(step.fixed_rows::<3>(3).into_owned());
        let shift: Vector3<f64> = step.fixed_rows::<3>(0).into();
        motion = Isometry3::from_parts(Translation3::from(middle + shift - turn * middle), turn) * motion;
    }
    motion
}

/// Of each scan: its stamp, how many inliers, their root mean square distance and mean after the alignment of all.
pub fn frames(sweep: &Sweep, scans: &[Scan]) -> Vec<(i64, usize, f64, f64)> {
    let all: Vec<Point3<f64>> =
        scans.iter().flat_map(|s| s.points.iter()).map(|p| Point3::from(p.position_m).cast()).collect();
    let motion = align(&sweep.truth, &all);
    let one = |scan: &Scan| {
        let points: Vec<Point3<f64>> = inliers(sweep, scan).map(|(p, _)| Point3::from(p.position_m).cast()).collect();
        let d: Vec<f64> = distances(&sweep.truth, &points, &motion).iter().map(|d| d.0 * 1e3).collect();
        (scan.header.stamp_nanos, points.len(), rms(&d), d.iter().sum::<f64>() / d.len().max(1) as f64)
    };
    scans.iter().map(one).collect()
}

/// Pieces of the thing this large stand off as wholes.
const REGION_M: f64 = 20e-3;
const FEWEST_IN_REGION: f64 = 100.0;

/// The mean distance of each piece of the thing from the truth after the alignment of all, and the sigma that is stated of
/// such: root mean square over its points. In metres.
pub fn regions(sweep: &Sweep, scans: &[Scan]) -> Vec<[f64; 2]> {
    let (mut points, mut variances) = (Vec::new(), Vec::new());
    for scan in scans {
        for (point, _) in inliers(sweep, scan) {
            points.push(Point3::from(point.position_m).cast::<f64>());
            variances.push(scan.region_sigma_m.powi(2));
        }
    }
    let motion = align(&sweep.truth, &points);
    let off = distances(&sweep.truth, &points, &motion);
    let mut regions: BTreeMap<_, [f64; 3]> = BTreeMap::new();
    for ((point, (distance, triangle)), variance) in points.iter().zip(off).zip(variances) {
        if triangle < sweep.thing_triangles {
            let normal = sweep.truth.normal(triangle);
            let side = (normal.iamax(), normal[normal.iamax()] > 0.0);
            let cell = point.coords.map(|x| (x / REGION_M).floor() as i32);
            let sums = regions.entry((side, [cell.x, cell.y, cell.z])).or_default();
            *sums = [sums[0] + 1.0, sums[1] + distance, sums[2] + variance];
        }
    }
    let large = regions.into_values().filter(|sums| sums[0] >= FEWEST_IN_REGION);
    large.map(|[count, distance, variance]| [distance / count, (variance / count).sqrt()]).collect()
}

/// The shares of inliers that are at most one and two stated sigmas from the truth, after the alignment of all.
pub fn coverage(sweep: &Sweep, scans: &[Scan]) -> [f64; 2] {
    let (mut points, mut sigmas) = (Vec::new(), Vec::new());
    for scan in scans {
        for (point, _) in inliers(sweep, scan).step_by(5) {
            points.push(Point3::from(point.position_m).cast::<f64>());
            sigmas.push(f64::from(point.sigma_m));
        }
    }
    let motion = align(&sweep.truth, &points);
    let off = distances(&sweep.truth, &points, &motion);
    [1.0, 2.0].map(|k| {
        let within = off.iter().zip(&sigmas).filter(|(d, sigma)| d.0.abs() <= k * **sigma).count();
        within as f64 / points.len() as f64
    })
}
