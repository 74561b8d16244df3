//! What comes in, and what of it is refused.

use nalgebra::Vector3;

/// One usable point of the cloud.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Its number; sums are taken in the order of these.
    pub id: u32,
    /// In the world, in metres.
    pub position: Vector3<f32>,
    /// Unit vector to the side from which it was seen, or zero when nobody knows.
    pub seen: Vector3<f32>,
    /// One standard deviation along the normal; 0 when nobody knows.
    pub sigma_m: f32,
}

/// Why a point is not used, or a hole not closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, thiserror::Error)]
pub enum Refused {
    /// NaN or infinite.
    #[error("position is not finite")]
    Position,
    /// Farther out than any tracker reaches; the grid's numbers would overflow.
    #[error("more than 1000 m from the origin")]
    Far,
    /// NaN or infinite.
    #[error("normal is not finite")]
    Normal,
    /// From a scan or a revision that is over.
    #[error("of an older scan or revision")]
    Old,
    /// Of the surface, not a point: see [`crate::Config::close`].
    #[error("hole left open: a cap over it would be larger than a third of what was measured")]
    Hole,
}

const FARTHEST_M: f32 = 1000.0;
/// Averaged directions shorter than this point nowhere.
const SHORTEST: f32 = 1e-3;
/// A sigma beyond these is taken as the nearer one: its square would vanish or overflow.
const SIGMAS_M: [f32; 2] = [1e-7, 1.0];

impl Sample {
    /// Checks a point. A normal of zero length means that the side is not known; so does a sigma of zero or nonsense.
    pub fn new(id: u32, position: [f32; 3], normal: [f32; 3], sigma_m: f32) -> Result<Self, Refused> {
        let position = Vector3::from(position);
        if !position.iter().all(|x| x.is_finite()) {
            return Err(Refused::Position);
        }
        if position.amax() > FARTHEST_M {
            return Err(Refused::Far);
        }
        let normal = Vector3::from(normal);
        if !normal.iter().all(|x| x.is_finite()) {
            return Err(Refused::Normal);
        }
        let seen = normal.try_normalize(SHORTEST).unwrap_or_else(Vector3::zeros);
        let known = sigma_m.is_finite() && sigma_m > 0.0;
        let sigma_m = if known { sigma_m.clamp(SIGMAS_M[0], SIGMAS_M[1]) } else { 0.0 };
        Ok(Self { id, position, seen, sigma_m })
    }
}
