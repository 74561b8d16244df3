//! Which half of space a sensor is in, for trackers that cannot tell.

/// A magnetic tracker cannot tell a position from its mirror image through the transmitter, and gives the one in the half
/// of space that it was told. A hand does not jump through the transmitter: of the two, the one on the side of the last
/// is taken.
///
/// ```
/// let mut half = serial_line::HalfSpace::default();
/// let told = [[0.1, 0.2, 0.0], [0.01, 0.2, 0.0], [0.08, -0.2, 0.0]];
/// let followed = [0, 10, 20].map(|ms| half.follow(ms * 1_000_000, told[ms as usize / 10]));
/// assert_eq!(followed[2], [-0.08, 0.2, 0.0], "it went on into the other half");
/// ```
#[derive(Debug, Clone, Default)]
pub struct HalfSpace {
    last: Option<(i64, [f64; 3])>,
}

/// After a longer pause the hand may have been anywhere: the half that the tracker was told is believed again.
const PAUSE_NANOS: i64 = 500_000_000;

impl HalfSpace {
    /// The position as it is, from the one that the tracker reports for a moment.
    pub fn follow(&mut self, nanos: i64, reported_m: [f64; 3]) -> [f64; 3] {
        let known = self.last.filter(|(at, _)| nanos.saturating_sub(*at) < PAUSE_NANOS);
        let beyond = known.is_some_and(|(_, last)| last.iter().zip(reported_m).map(|(a, b)| a * b).sum::<f64>() < 0.0);
        let position = if beyond { reported_m.map(|part| -part) } else { reported_m };
        self.last = Some((nanos, position));
        position
    }
}
