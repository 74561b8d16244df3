//! How well the receivers agreed.

use crate::agree::Agreement;
use wire::{Pose, Quality};

/// Sigmas that are so many times too small or too large are told.
const FAR: f64 = 3.0;

/// The account of one scan.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Evidence {
    /// Moments with a pose.
    pub fused: u64,
    /// Of these, moments with all receivers, none of which had anything to say against itself.
    pub good: u64,
    /// Moments without a pose.
    pub lost: u64,
    chi_squared: f64,
    freedom: usize,
}

impl Evidence {
    /// How many times as far apart the receivers stood, in the mean of squares, as they state (and
    /// [`crate::Config::apart_mm`] allows): 1 when the sigmas are right. `None` when there was never more than one.
    pub fn times_apart(&self) -> Option<f64> {
        (self.freedom > 0).then(|| (self.chi_squared / self.freedom as f64).sqrt())
    }

    /// What to do when the sigmas are far from right: the rest of the scan is made with them. `None` when they are not.
    pub fn advice(&self) -> Option<&'static str> {
        match self.times_apart()? {
            times if times < 1.0 / FAR => Some(
                "they are surer than they state: with smaller `apart_mm` and `apart_deg` the surface is smoothed less",
            ),
            times if times > FAR => Some(
                "they are less sure than they state: measure anew where they sit, or raise `apart_mm` and `apart_deg`",
            ),
            _ => None,
        }
    }

    pub(crate) fn note(&mut self, pose: &Pose) {
        match pose.quality {
            Quality::Lost => self.lost += 1,
            Quality::Good => (self.fused, self.good) = (self.fused + 1, self.good + 1),
            Quality::Degraded => self.fused += 1,
        }
    }

    pub(crate) fn agree(&mut self, agreement: &Agreement) {
        self.chi_squared += agreement.solution.chi_squared;
        self.freedom += agreement.freedom;
    }
}
