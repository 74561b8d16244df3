//! Rigid transforms between the wire and nalgebra, and between two moments.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use wire::RigidPose;

/// From numbers to a transform; `None` unless they are finite and the quaternion has a length.
pub fn rigid_from_wire(pose: &RigidPose) -> Option<Isometry3<f64>> {
    let [w, x, y, z] = pose.rotation_wxyz;
    let rotation = Quaternion::new(w, x, y, z);
    let finite = pose.translation_m.iter().chain(&pose.rotation_wxyz).all(|value| value.is_finite());
    if !finite || (rotation.norm() - 1.0).abs() > 0.1 {
        return None;
    }
    let [x, y, z] = pose.translation_m;
    Some(Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::from_quaternion(rotation)))
}

/// From a transform to numbers.
pub fn rigid_to_wire(transform: &Isometry3<f64>) -> RigidPose {
    let q = transform.rotation.quaternion();
    RigidPose { translation_m: transform.translation.vector.into(), rotation_wxyz: [q.w, q.i, q.j, q.k] }
}

/// Between two poses: straight in position, on the shorter arc at constant rate in rotation; `at` is 0 at `a`, 1 at `b`.
pub fn interpolate(a: &Isometry3<f64>, b: &Isometry3<f64>, at: f64) -> Isometry3<f64> {
    let translation = a.translation.vector.lerp(&b.translation.vector, at);
    let turn = (a.rotation.inverse() * b.rotation).scaled_axis();
    Isometry3::from_parts(Translation3::from(translation), a.rotation * UnitQuaternion::new(turn * at))
}
