//! A quadric through the neighbourhood of each surfel: the tangent plane corrected for the curvature of the surface.
//!
//! A mean over a curved neighbourhood lies inside the curve by its sagitta; at the radii that noise asks for that is
//! more than the noise that is left. So a height field of second order is fitted over the tangent plane (moving least squares, Levin
//! 1998; Alexa et al. 2003), weighted by distance and by the agreement of the normals (as in Oeztireli et al. 2009, so that the other side of a thin
//! sheet and the far side of an edge take no part).

use crate::plane::{Plane, kernel};
use nalgebra::{Matrix6, Vector3, Vector6};

/// A piece of surface: the zero set of n . d - d' M d around its centre, d being the offset from there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quadric {
    /// On the surface, in the world.
    pub centre: Vector3<f32>,
    /// Unit normal there, outwards.
    pub normal: Vector3<f32>,
    /// M, half the second fundamental form, in 1/metre: xx, yy, zz, xy, xz, yz.
    pub bend: [f32; 6],
    /// Beyond this distance it says nothing, in metres.
    pub reach_m: f32,
    /// Weight of its samples.
    pub weight: f32,
    /// One standard deviation of the centre along the normal, in metres.
    pub sigma_m: f32,
}

/// Normals further apart than 60 degrees belong to different sheets or faces.
const LEAST_AGREEMENT: f32 = 0.5;
const FEWEST_NEIGHBOURS: usize = 8;
/// Holds curvature at zero where samples say nothing of it; a fortieth of what a full neighbourhood weighs.
const RIDGE: f64 = 1e-3;
/// A centre that moves farther, in reaches, does not belong to its samples.
const FARTHEST: f64 = 0.5;
/// A frame steeper than this against its fit is turned and the fit done again.
const STEEP: f64 = 0.1;

impl Quadric {
    /// Signed distance to first order, at an offset from the centre.
    pub fn distance(&self, d: &Vector3<f32>) -> f32 {
        self.normal.dot(d) - d.dot(&self.bent(d))
    }

    /// The gradient of the distance.
    pub fn gradient(&self, d: &Vector3<f32>) -> Vector3<f32> {
        self.normal - self.bent(d) * 2.0
    }

    fn bent(&self, d: &Vector3<f32>) -> Vector3<f32> {
        let [xx, yy, zz, xy, xz, yz] = self.bend;
        Vector3::new(xx * d.x + xy * d.y + xz * d.z, xy * d.x + yy * d.y + yz * d.z, xz * d.x + yz * d.y + zz * d.z)
    }
}

/// One neighbour as the fit sees it: all lengths in reaches.
struct Row {
    basis: [f32; 6],
    height: f32,
    weight: f32,
    variance: f32,
}

/// The quadrics of `planes`, those of one block; `near` are all within reach of the block.
pub fn quadrics(planes: &[Plane], near: &[Plane]) -> Vec<Quadric> {
    let mut rows = Vec::new();
    planes
        .iter()
        .filter_map(|plane| {
            let first = fit(plane, &plane.normal, near, &mut rows)?;
            let steep = f64::from(first.normal.dot(&plane.normal)) < 1.0 / (1.0 + STEEP * STEEP).sqrt();
            if steep { fit(plane, &first.normal, near, &mut rows) } else { Some(first) }
        })
        .collect()
}

fn tangents(normal: &Vector3<f32>) -> [Vector3<f32>; 2] {
    let across = if normal.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
    let first = normal.cross(&across).normalize();
    [first, normal.cross(&first)]
}

fn collect(plane: &Plane, normal: &Vector3<f32>, [t, b]: &[Vector3<f32>; 2], near: &[Plane], rows: &mut Vec<Row>) {
    rows.clear();
    let per_reach = 1.0 / plane.reach_m;
    let reach_squared = plane.reach_m * plane.reach_m;
    for other in near {
        let offset = other.position - plane.position;
        let squared = offset.norm_squared();
        if squared >= reach_squared {
            continue;
        }
        let agreement = normal.dot(&other.normal);
        if agreement < LEAST_AGREEMENT {
            continue;
        }
        let d = offset * per_reach;
        let (u, v) = (t.dot(&d), b.dot(&d));
        rows.push(Row {
            basis: [1.0, u, v, u * u, u * v, v * v],
            height: normal.dot(&d),
            weight: other.weight * agreement * agreement * kernel(squared / reach_squared),
            variance: other.variance * per_reach * per_reach * other.weight,
        });
    }
}

/// Weighted least squares in the frame of `normal`.
fn fit(plane: &Plane, normal: &Vector3<f32>, near: &[Plane], rows: &mut Vec<Row>) -> Option<Quadric> {
    let frame = tangents(normal);
    collect(plane, normal, &frame, near, rows);
    if rows.len() < FEWEST_NEIGHBOURS {
        return None;
    }
    let (inverse, solution) = solve(rows)?;
    if solution[0].abs() > FARTHEST {
        return None;
    }
    let c = solution.map(|x| x as f32);
    let [t, b] = frame;
    let reach_m = plane.reach_m;
    let matrix =
        (t * t.transpose() * c[3] + (t * b.transpose() + b * t.transpose()) * (0.5 * c[4]) + b * b.transpose() * c[5])
            / reach_m;
    Some(Quadric {
        centre: plane.position + normal * (c[0] * reach_m),
        normal: (normal - t * c[1] - b * c[2]).normalize(),
        bend: [matrix[(0, 0)], matrix[(1, 1)], matrix[(2, 2)], matrix[(0, 1)], matrix[(0, 2)], matrix[(1, 2)]],
        reach_m,
        weight: plane.weight,
        sigma_m: sigma(rows, &inverse, &solution) * reach_m,
    })
}

fn solve(rows: &[Row]) -> Option<(Vector6<f64>, Vector6<f64>)> {
    let mut gram = [[0f32; 6]; 6];
    let mut right = [0f32; 6];
    for row in rows {
        for i in 0..6 {
            let weighted = row.weight * row.basis[i];
            right[i] += weighted * row.height;
            for (sum, basis) in gram[i].iter_mut().zip(&row.basis) {
                *sum += weighted * basis;
            }
        }
    }
    let mut normal = Matrix6::from_fn(|i, j| f64::from(gram[i][j]));
    let ridge = RIDGE * normal[(0, 0)];
    for k in 1..6 {
        normal[(k, k)] += ridge;
    }
    let cholesky = normal.cholesky()?;
    // The first row of the inverse: how each sample moves the centre.
    let inverse = cholesky.solve(&Vector6::ith(0, 1.0));
    Some((inverse, cholesky.solve(&Vector6::from(right.map(f64::from)))))
}

/// So many neighbours err alike: speckle, the borders of colours and the edges of the lit line reach over several points.
const ALIKE: f64 = 4.0;

/// Of the centre, in reaches: from the residuals, and from what the samples state. The errors that samples state are taken to
/// move neighbours together, as those of a pose do: neighbours come from the same pictures, and what they have in common
/// shows in no residual.
fn sigma(rows: &[Row], inverse: &Vector6<f64>, solution: &Vector6<f64>) -> f32 {
    let inner = |basis: &[f32; 6], c: &Vector6<f64>| (0..6).map(|k| f64::from(basis[k]) * c[k]).sum::<f64>();
    let (mut influence, mut stated, mut residual, mut weight) = (0.0, 0.0, 0.0, 0.0);
    for row in rows {
        let (w, difference) = (f64::from(row.weight), f64::from(row.height) - inner(&row.basis, solution));
        let moves = w * inner(&row.basis, inverse);
        influence += moves * moves;
        stated += moves * f64::from(row.variance.max(0.0)).sqrt();
        residual += w * difference * difference;
        weight += w;
    }
    let free = rows.len() as f64 / (rows.len() as f64 - 6.0);
    (ALIKE * influence * free * residual / weight + stated * stated).sqrt() as f32
}
