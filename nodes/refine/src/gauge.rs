//! Where the whole scan lies: the surface does not tell, the tracker does.

use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};

/// Distances beyond this count little (Cauchy): they are what refinement is for.
const SCALE_M: f64 = 5e-3;
const ROUNDS: usize = 5;

/// The rigid motion that lays points `from` onto the same points in `to` (Kabsch 1976, reweighted).
pub(crate) fn rigid(from: &[Point3<f64>], to: &[Point3<f64>]) -> Isometry3<f64> {
    let mut motion = Isometry3::identity();
    for _ in 0..ROUNDS {
        let weight =
            |(p, q): (&Point3<f64>, &Point3<f64>)| 1.0 / (1.0 + (motion * p - q).norm_squared() / SCALE_M.powi(2));
        let weights: Vec<f64> = from.iter().zip(to).map(weight).collect();
        let total: f64 = weights.iter().sum();
        if total.is_nan() || total <= 0.0 {
            return Isometry3::identity();
        }
        let mean = |points: &[Point3<f64>]| -> Vector3<f64> {
            points.iter().zip(&weights).map(|(p, w)| p.coords * *w).sum::<Vector3<f64>>() / total
        };
        let (mean_from, mean_to) = (mean(from), mean(to));
        let cross = from.iter().zip(to).zip(&weights).fold(Matrix3::zeros(), |sum: Matrix3<f64>, ((p, q), w)| {
            sum + (q.coords - mean_to) * (p.coords - mean_from).transpose() * *w
        });
        let svd = cross.svd(true, true);
        let (Some(u), Some(v_t)) = (svd.u, svd.v_t) else { return motion };
        let sign = (u * v_t).determinant().signum();
        let turn = u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, sign)) * v_t;
        let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn));
        motion = Isometry3::from_parts(Translation3::from(mean_to - rotation * mean_from), rotation);
    }
    motion
}
