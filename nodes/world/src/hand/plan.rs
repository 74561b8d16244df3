//! Which strokes the hand makes: to and fro while it goes around the thing, the stripe upright, once with the laser on
//! each side; and from each side up and over the top with the stripe across, in as many lanes as the stripe is short.

use super::aim::{Aim, Reach};
use super::stroke::Stroke;
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

/// The laser beside the camera, as [`Aim::laser`].
const LEFT: f64 = PI;
const RIGHT: f64 = 0.0;
const ABOVE: f64 = -FRAC_PI_2;
/// The stripe leans by this much in a round, so that it also crosses what stands upright.
const LEAN: f64 = 0.2;
/// Camera and laser stay above this height.
const CLEARANCE_M: f64 = 0.035;
/// Strokes in a round, and how far they reach beyond the thing, to look behind legs.
const CAREFUL: Round = Round { strokes: 12, beyond_m: 0.03 };
/// The only round of a hurried scan, and its elevation.
const HURRIED: Round = Round { strokes: 6, beyond_m: -0.005 };
const HURRIED_ELEVATION: f64 = 0.45;
/// The round with the laser on the other side is this much higher.
const HIGHER: f64 = 0.05;
/// A low round for each stripe's length, and half of one more, of the thing's height.
const ROUND_HEIGHT: f64 = 1.5;
/// A stroke over the top begins by looking this share of the thing's height below its middle.
const FOOT: f64 = 0.35;
/// The way over the top ends here at the latest.
const FAR_ELEVATION: f64 = 2.6;
/// Steps of the search for an elevation.
const STEPS: usize = 60;

struct Round {
    strokes: usize,
    beyond_m: f64,
}

/// As many strokes as the budget of way allows, the most useful first, but at least all around; `stripe_m` is the stripe's
/// usable length. Without `crossing` there are rounds only.
pub fn plan(reach: &Reach, stripe_m: f64, budget_m: f64, crossing: bool) -> Vec<Stroke> {
    let [first, other_side] =
        [(LEFT, 0.0), (RIGHT, HIGHER)].map(|(laser, higher)| rounds(reach, stripe_m, laser, higher));
    let over = |azimuths| if crossing { overs(reach, stripe_m, azimuths) } else { Vec::new() };
    let quarters = over([0.0, FRAC_PI_2]);
    let diagonals = over([FRAC_PI_4, 3.0 * FRAC_PI_4]);
    let mut strokes = Vec::new();
    first.into_iter().for_each(|to| go_on(reach, &mut strokes, to));
    if way_m(&strokes) + quarters.first().map_or(0.0, |(from, to)| Stroke::new(reach, *from, *to).length_m) > budget_m {
        strokes.clear();
        let round = round(reach, HURRIED_ELEVATION, LEFT, 0.0, &HURRIED);
        round.into_iter().for_each(|to| go_on(reach, &mut strokes, to));
    }
    for more in quarters.into_iter().chain(other_side).chain(diagonals) {
        let before = strokes.len();
        go_on(reach, &mut strokes, more);
        if way_m(&strokes) > budget_m {
            strokes.truncate(before);
            break;
        }
    }
    strokes
}

fn way_m(strokes: &[Stroke]) -> f64 {
    strokes.iter().map(|stroke| stroke.length_m).sum()
}

/// Moves over to where the next stroke begins, and makes it.
fn go_on(reach: &Reach, strokes: &mut Vec<Stroke>, (from, to): (Aim, Aim)) {
    if let Some(last) = strokes.last().map(|last| last.to.said_near(&from)).filter(|last| *last != from) {
        strokes.push(Stroke::new(reach, last, from));
    }
    strokes.push(Stroke::new(reach, from, to));
}

/// Low rounds, one above the other when the thing is taller than the stripe.
fn rounds(reach: &Reach, stripe_m: f64, laser: f64, higher: f64) -> Vec<(Aim, Aim)> {
    let height = 2.0 * reach.half.z;
    let count = (height / (ROUND_HEIGHT * stripe_m)).ceil().max(1.0);
    let heights = (0..count as usize).map(|i| height * ((i as f64 + 0.5) / count - 0.5));
    let each = heights.flat_map(|shift| {
        let low = lowest(|elevation| {
            let aims = round(reach, elevation, laser, shift, &CAREFUL).into_iter().map(|(from, _)| from);
            aims.map(|aim| reach.height_m(&aim)).fold(f64::INFINITY, f64::min)
        });
        round(reach, low + higher, laser, shift, &CAREFUL)
    });
    each.collect()
}

/// Once around, each stroke from beyond one edge of the thing, as seen from there, to beyond the other.
fn round(reach: &Reach, elevation: f64, laser: f64, shift_z: f64, size: &Round) -> Vec<(Aim, Aim)> {
    let aim = |i: usize| {
        let azimuth = TAU * i as f64 / size.strokes as f64;
        let across = Vector3::new(-azimuth.sin(), azimuth.cos(), 0.0);
        let side = if i.is_multiple_of(2) { -1.0 } else { 1.0 };
        let sideways = side * (across.component_mul(&reach.half).norm() + size.beyond_m);
        Aim { azimuth, elevation, laser: laser + side * LEAN, shift: across * sideways + Vector3::z() * shift_z }
    };
    (0..size.strokes).map(|i| (aim(i), aim(i + 1))).collect()
}

/// Up and over along each azimuth: first every lane once, there and back in turn, then every lane the other way.
fn overs(reach: &Reach, stripe_m: f64, azimuths: [f64; 2]) -> Vec<(Aim, Aim)> {
    let mut strokes = Vec::new();
    for pass in 0..2 {
        for azimuth in azimuths {
            let across = Vector3::new(-azimuth.sin(), azimuth.cos(), 0.0);
            let width = 2.0 * across.component_mul(&reach.half).norm();
            let lanes = (width / stripe_m).ceil().max(1.0);
            strokes.extend((0..lanes as usize).map(|lane| {
                let shift = across * (width * ((lane as f64 + 0.5) / lanes - 0.5));
                let back = if (lane + pass).is_multiple_of(2) { 0.0 } else { PI };
                over(reach, azimuth + back, shift)
            }));
        }
    }
    strokes
}

fn over(reach: &Reach, azimuth: f64, shift: Vector3<f64>) -> (Aim, Aim) {
    let foot = shift - Vector3::z() * (2.0 * FOOT * reach.half.z);
    let near = |elevation| Aim { azimuth, elevation, laser: ABOVE, shift: foot };
    let far = |elevation| Aim { azimuth, elevation, laser: ABOVE, shift };
    let end = PI - lowest(|elevation| reach.height_m(&far(PI - elevation)));
    (near(lowest(|elevation| reach.height_m(&near(elevation)))), far(end.min(FAR_ELEVATION)))
}

/// The lowest elevation, from a little below level, that keeps the clearance.
fn lowest(height_m: impl Fn(f64) -> f64) -> f64 {
    const FROM: f64 = -0.08;
    let elevations = (0..STEPS).map(|step| FROM + (FRAC_PI_2 - FROM) * step as f64 / STEPS as f64);
    elevations.into_iter().find(|&elevation| height_m(elevation) >= CLEARANCE_M).unwrap_or(FRAC_PI_2)
}
