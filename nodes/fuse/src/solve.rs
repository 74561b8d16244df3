//! One pose for a body of which several receivers tell theirs: least squares on SE(3).
//!
//! With o_i, B_i the place and the axes of receiver i on the body and p_i, M_i what it measured, the pose (R, t) minimises
//!
//!   sum |R o_i + t - p_i|^2 / sigma_p,i^2  +  sum |log(M_i^-1 R B_i)|^2 / sigma_r,i^2
//!
//! So the orientation comes from where the receivers are as well as from how they are turned, each as far as it is known
//! (paper, section 6, first point: "computing orientation from the more accurate translation estimates and/or averaging").

use nalgebra::{Isometry3, Matrix3, Matrix6, UnitQuaternion, Vector3, Vector6};

/// What one receiver tells of the body.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sighting {
    pub body_from_receiver: Isometry3<f64>,
    pub world_from_receiver: Isometry3<f64>,
    /// Along one axis.
    pub position_sigma_m: f64,
    /// About one axis.
    pub rotation_sigma_rad: f64,
}

/// The pose that fits best.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Solution {
    pub world_from_body: Isometry3<f64>,
    /// Of the position along the axes of the world (rows 0 to 2) and of the rotation about the axes of the body (3 to 5).
    pub covariance: Matrix6<f64>,
    /// What the sum above comes to; infinite when numbers overflow.
    pub chi_squared: f64,
}

/// Gauss-Newton gains more than a digit in each step; receivers that contradict each other may need some.
const MOST_STEPS: usize = 50;
/// Metres and radians: far below what any tracker can tell.
const SMALL_STEP: f64 = 1e-12;

impl Sighting {
    /// Where the body is when this receiver alone is asked.
    pub fn world_from_body(&self) -> Isometry3<f64> {
        self.world_from_receiver * self.body_from_receiver.inverse()
    }

    /// How far a pose of the body is from what was measured: metres along the axes of the world, radians about the axes
    /// of the body.
    pub fn residual(&self, world_from_body: &Isometry3<f64>) -> [Vector3<f64>; 2] {
        let expected = world_from_body * self.body_from_receiver;
        let turn = (self.world_from_receiver.rotation.inverse() * expected.rotation).scaled_axis();
        let off = expected.translation.vector - self.world_from_receiver.translation.vector;
        [off, self.body_from_receiver.rotation * turn]
    }

    /// 1/sigma^2 of position and rotation.
    fn weights(&self) -> [f64; 2] {
        [self.position_sigma_m, self.rotation_sigma_rad].map(|sigma| sigma.powi(-2))
    }
}

/// `None` when there is no sighting.
pub(crate) fn solve(sightings: &[Sighting]) -> Option<Solution> {
    let alone = sightings.iter().map(Sighting::world_from_body);
    let mut pose = alone.min_by(|a, b| cost(sightings, a).total_cmp(&cost(sightings, b)))?;
    let mut inverse = Matrix6::zeros();
    for _ in 0..MOST_STEPS {
        let (normal, gradient) = normal_equations(sightings, &pose);
        let Some(factors) = normal.cholesky() else {
            return Some(Solution { world_from_body: pose, covariance: inverse, chi_squared: f64::INFINITY });
        };
        inverse = factors.inverse();
        let step = -factors.solve(&gradient);
        if step.norm() < SMALL_STEP {
            break;
        }
        let [shift, turn] = [0, 3].map(|row| Vector3::from(step.fixed_rows::<3>(row)));
        pose.translation.vector += shift;
        pose.rotation *= UnitQuaternion::new(turn);
    }
    pose.rotation.renormalize();
    let chi_squared = Some(cost(sightings, &pose)).filter(|cost| cost.is_finite()).unwrap_or(f64::INFINITY);
    Some(Solution { world_from_body: pose, covariance: inverse, chi_squared })
}

fn cost(sightings: &[Sighting], pose: &Isometry3<f64>) -> f64 {
    let of = |sighting: &Sighting| {
        let ([off, turn], [place, axes]) = (sighting.residual(pose), sighting.weights());
        off.norm_squared() * place + turn.norm_squared() * axes
    };
    sightings.iter().map(of).sum()
}

/// For the step (dt, dr): t + dt, R exp(dr). To first order d(R o + t) = dt - R [o]x dr, and of the rotation's residual,
/// turned into the axes of the body, dr. The gradient is exact all the same: the inverse right Jacobian of SO(3) leaves
/// the residual that it belongs to as it is (Sola et al. 2018, equation 144). So the minimum is, too.
fn normal_equations(sightings: &[Sighting], pose: &Isometry3<f64>) -> (Matrix6<f64>, Vector6<f64>) {
    let (mut normal, mut gradient) = (Matrix6::zeros(), Vector6::zeros());
    let rotation: Matrix3<f64> = pose.rotation.to_rotation_matrix().into_inner();
    for sighting in sightings {
        let ([off, turn], [place, axes]) = (sighting.residual(pose), sighting.weights());
        let arm = -rotation * sighting.body_from_receiver.translation.vector.cross_matrix();
        let add = |normal: &mut Matrix6<f64>, row: usize, column: usize, block: Matrix3<f64>| {
            let mut sum = normal.fixed_view_mut::<3, 3>(row, column);
            sum += block;
        };
        add(&mut normal, 0, 0, Matrix3::identity() * place);
        add(&mut normal, 0, 3, arm * place);
        add(&mut normal, 3, 0, arm.transpose() * place);
        add(&mut normal, 3, 3, arm.tr_mul(&arm) * place + Matrix3::identity() * axes);
        let mut shift = gradient.fixed_rows_mut::<3>(0);
        shift += off * place;
        let mut turning = gradient.fixed_rows_mut::<3>(3);
        turning += arm.tr_mul(&off) * place + turn * axes;
    }
    (normal, gradient)
}
