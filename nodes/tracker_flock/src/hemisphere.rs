//! Which half of space a sensor is in.

use crate::config::Hemisphere;
use nalgebra::Vector3;

/// A bird cannot tell a position from its mirror image through the transmitter, and always gives the one in the half
/// that it was told. A hand does not jump through the transmitter: of the two the one nearer to the last is taken.
#[derive(Debug, Clone, Default)]
pub(crate) struct HalfSpace {
    last: Option<(i64, Vector3<f64>)>,
}

/// After a longer pause the hand may have been anywhere: the half that the bird was told is believed again.
const PAUSE_NANOS: i64 = 500_000_000;

impl HalfSpace {
    /// The position as it is; true when it is in the other half.
    pub fn follow(&mut self, nanos: i64, reported_m: Vector3<f64>) -> (Vector3<f64>, bool) {
        let known = self.last.filter(|(at, _)| nanos.saturating_sub(*at) < PAUSE_NANOS);
        let mirrored = known.is_some_and(|(_, last)| (last + reported_m).norm() < (last - reported_m).norm());
        let position = if mirrored { -reported_m } else { reported_m };
        self.last = Some((nanos, position));
        (position, mirrored)
    }
}

/// The position as a bird gives it that was told this half.
pub fn reported(half: Hemisphere, position_m: Vector3<f64>) -> Vector3<f64> {
    let (axis, sign) = half.axis();
    if position_m[axis] * sign < 0.0 { -position_m } else { position_m }
}
