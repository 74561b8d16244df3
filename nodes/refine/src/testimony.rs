//! What the unknowns that all frames share came to, and how well they are known.

use crate::Config;
use crate::evidence::{ClockEvidence, HandEyeEvidence, Observed, RefusedInput, TrackerEvidence};
use crate::gather::Gathered;
use crate::guard::strokes::{Hold, Strokes};
use crate::prior::Prior;
use crate::scene::Problem;
use crate::solver::Noise;
use crate::step::Seen;
use crate::system::System;
use crate::tracker::Smoothed;
use crate::unknowns::Free;
use rayon::prelude::*;

const CG_STEPS: usize = 40;

const SHARED: usize = 8;

/// The marginal standard deviations of hand-eye (six), clock and lag: the roots of the diagonal of H^-1, a column each.
fn sigmas(problem: &Problem, prior: &Prior, seen: &Seen, free: &Free, x: &[f64]) -> [f64; SHARED] {
    let poses = problem.poses(x);
    let system = System::new(problem, prior, seen, free, &poses);
    let sigma = |i: usize| {
        if i + 1 == SHARED && !free.lag {
            return f64::NAN;
        }
        let at = problem.unknowns.hand_eye().start + i;
        let mut unit = vec![0.0; x.len()];
        unit[at] = 1.0;
        system.solve(&unit, CG_STEPS).map_or(f64::NAN, |column| column[at].max(0.0).sqrt())
    };
    let all: Vec<f64> = (0..SHARED).into_par_iter().map(sigma).collect();
    std::array::from_fn(|i| all[i])
}

/// Clock and hand-eye, with their sigma; where they were held fast that is what was believed.
pub(crate) fn globals(
    problem: &Problem,
    prior: &Prior,
    seen: &Seen,
    free: Free,
    x: &[f64],
) -> (ClockEvidence, HandEyeEvidence) {
    let sigma = sigmas(problem, prior, seen, &Free { hand_eye: true, clock: true, ..free }, x);
    let eta = &x[problem.unknowns.hand_eye()];
    let clock = clock(problem, x, [sigma[6], sigma[7]]);
    let hand_eye = HandEyeEvidence {
        freed: free.hand_eye,
        shift_mm: [0, 1, 2].map(|i| eta[i] * 1e3),
        turn_deg: [3, 4, 5].map(|i| eta[i].to_degrees()),
        shift_sigma_mm: [0, 1, 2].map(|i| sigma[i] * 1e3),
        turn_sigma_deg: [3, 4, 5].map(|i| sigma[i].to_degrees()),
    };
    (clock, hand_eye)
}

/// The clock's offset and the lag of the orientations as they were found.
pub(crate) fn clock(problem: &Problem, x: &[f64], sigmas_s: [f64; 2]) -> ClockEvidence {
    let [sigma_ms, rotation_lag_sigma_ms] = sigmas_s.map(|sigma| Some(sigma * 1e3).filter(|sigma| sigma.is_finite()));
    let [tau_ms, rotation_lag_ms] = problem.unknowns.offsets_s(x).map(|offset| offset * 1e3);
    ClockEvidence { tau_ms, sigma_ms, rotation_lag_ms, rotation_lag_sigma_ms }
}

/// The hand-eye transform where nothing was asked about it.
pub(crate) fn hand_eye_held(config: &Config) -> HandEyeEvidence {
    HandEyeEvidence {
        freed: false,
        shift_mm: [0.0; 3],
        turn_deg: [0.0; 3],
        shift_sigma_mm: [config.hand_eye_mm; 3],
        turn_sigma_deg: [config.hand_eye_deg; 3],
    }
}

/// What the tracker's readings are like.
pub(crate) fn tracker(smoothed: &Smoothed, excess: Option<f64>, noise: Noise) -> TrackerEvidence {
    let [position, rotation] = smoothed.white();
    TrackerEvidence {
        white_position_mm: position * 1e3,
        white_rotation_deg: rotation.to_degrees(),
        excess,
        inflation: noise.inflation,
    }
}

/// What the scan determines.
pub(crate) fn observed(strokes: &Strokes, hold: Hold) -> Observed {
    Observed { crossing: strokes.crossing, stripes_along: strokes.along.into(), held_directions: hold.directions }
}

/// What was refused on the way in.
pub(crate) fn refused(gathered: &Gathered) -> Vec<RefusedInput> {
    let told = |refusal: wire::Refusal| RefusedInput { reason: refusal.reason, count: refusal.count };
    gathered.refused().into_iter().map(told).collect()
}
