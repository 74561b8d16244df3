//! A quadric through the points of a neighbourhood, robustly.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// Coefficients of 1, u, v, u^2, uv, v^2.
pub(crate) const TERMS: usize = 6;
type Normal = SMatrix<f64, TERMS, TERMS>;
type Terms = SVector<f64, TERMS>;

/// A neighbour in the frame of the tangent plane; u and v in units of the radius, h in metres.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Local {
    pub terms: [f32; TERMS],
    pub height: f32,
    /// Of the distance from the centre and of the point itself.
    pub weight: f32,
    /// Set by the fit: height above the quadric, across it.
    pub residual: f32,
    /// Set by the fit: `weight` times that of the robust function.
    pub robust: f32,
}

/// Ridge on slopes and curvatures, as a share of the summed weights.
const RIDGE: [f64; TERMS] = [0.0, 1e-3, 1e-3, 3e-3, 3e-3, 3e-3];

/// What a fit gives.
pub(crate) struct Quadric {
    pub coefficients: [f32; TERMS],
    /// 1 / sqrt(1 + slope^2) at the centre: from heights to distances.
    pub to_distance: f32,
    /// L of the normal matrix L L^T, ridge included, for the weights of the last pass.
    pub factor: SMatrix<f32, TERMS, TERMS>,
}

/// Iteratively reweighted least squares with the function of Geman and McClure, first at `scales[0]`, then at the next.
/// `None` when the points hold no quadric.
pub(crate) fn fit(points: &mut [Local], radius_m: f32, scales: &[f32]) -> Option<Quadric> {
    points.iter_mut().for_each(|point| point.robust = point.weight);
    let mut solution = solve(points)?;
    for &scale in scales {
        reweigh(points, &solution.1, radius_m, scale);
        solution = solve(points)?;
    }
    let (factor, coefficients) = solution;
    let to_distance = residuals(points, &coefficients, radius_m);
    Some(Quadric { coefficients: coefficients.map(|c| c as f32).into(), to_distance, factor: factor.map(|l| l as f32) })
}

fn reweigh(points: &mut [Local], coefficients: &Terms, radius_m: f32, scale: f32) {
    residuals(points, coefficients, radius_m);
    let square = scale * scale;
    for point in points {
        let share = square / (square + point.residual * point.residual);
        point.robust = point.weight * share * share;
    }
}

fn residuals(points: &mut [Local], coefficients: &Terms, radius_m: f32) -> f32 {
    let c: [f32; TERMS] = coefficients.map(|c| c as f32).into();
    let slope = [c[1] / radius_m, c[2] / radius_m];
    let to_distance = 1.0 / (1.0 + slope[0] * slope[0] + slope[1] * slope[1]).sqrt();
    for point in points {
        let quadric: f32 = point.terms.iter().zip(c).map(|(term, c)| term * c).sum();
        point.residual = (point.height - quadric) * to_distance;
    }
    to_distance
}

fn solve(points: &[Local]) -> Option<(Normal, Terms)> {
    let mut normal = [[0f64; TERMS]; TERMS];
    let mut right = [0f64; TERMS];
    for point in points {
        let terms = point.terms.map(f64::from);
        let (weight, height) = (f64::from(point.robust), f64::from(point.height));
        for a in 0..TERMS {
            let weighted = weight * terms[a];
            right[a] += weighted * height;
            for b in 0..=a {
                normal[a][b] += weighted * terms[b];
            }
        }
    }
    let total = normal[0][0];
    if total < 1e-6 {
        return None;
    }
    for a in 0..TERMS {
        normal[a][a] += RIDGE[a] * total;
    }
    let factor = cholesky(normal)?;
    Some((Normal::from_fn(|i, j| factor[i][j]), Terms::from(solve_factored(&factor, right))))
}

fn cholesky(mut a: [[f64; TERMS]; TERMS]) -> Option<[[f64; TERMS]; TERMS]> {
    for i in 0..TERMS {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| a[i][k] * a[j][k]).sum();
            let value = a[i][j] - sum;
            a[i][j] = match i == j {
                true if value <= 1e-12 => return None,
                true => value.sqrt(),
                false => value / a[j][j],
            };
        }
        a[i][i + 1..].fill(0.0);
    }
    Some(a)
}

fn solve_factored(l: &[[f64; TERMS]; TERMS], mut b: [f64; TERMS]) -> [f64; TERMS] {
    for i in 0..TERMS {
        let sum: f64 = (0..i).map(|k| l[i][k] * b[k]).sum();
        b[i] = (b[i] - sum) / l[i][i];
    }
    for i in (0..TERMS).rev() {
        let sum: f64 = (i + 1..TERMS).map(|k| l[k][i] * b[k]).sum();
        b[i] = (b[i] - sum) / l[i][i];
    }
    b
}

/// The tangent plane of weighted points around a centre: normal, and whether the points spread in two directions.
pub(crate) struct Plane {
    pub normal: Vector3<f32>,
    /// Of the middle direction, in square metres.
    pub second: f32,
    /// Thickness against the middle direction.
    pub flatness: f32,
}

/// Principal directions of the points.
pub(crate) fn plane(points: impl Iterator<Item = (Vector3<f32>, f32)> + Clone) -> Plane {
    let total: f32 = points.clone().map(|(_, weight)| weight).sum();
    let mean = points.clone().map(|(p, weight)| p * weight).sum::<Vector3<f32>>() / total;
    let spread = points.fold(Matrix3::zeros(), |sum: Matrix3<f32>, (p, weight)| {
        let off = p - mean;
        sum + off * off.transpose() * weight
    });
    let eigen = (spread / total).symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let [least, middle] = [eigen.eigenvalues[order[0]], eigen.eigenvalues[order[1]]];
    Plane {
        normal: eigen.eigenvectors.column(order[0]).into(),
        second: middle,
        flatness: least / middle.max(f32::MIN_POSITIVE),
    }
}
