//! Which strokes the hand makes: rounds about the thing with the stripe upright, then strokes from each side up and over
//! the top with the stripe across, in as many lanes as the stripe is short.

use super::aim::{Aim, Reach};
use nalgebra::{Point3, Vector3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// One movement without a pause.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Where it begins.
    pub from: Aim,
    /// Where it ends.
    pub to: Aim,
    /// The longer of the ways of camera and laser.
    pub length_m: f64,
}

/// The laser beside the camera, as [`Aim::laser`].
const LEFT: f64 = PI;
const RIGHT: f64 = 0.0;
const ABOVE: f64 = -FRAC_PI_2;
/// The stripe leans by this much in a round, so that it also crosses what stands upright.
const LEAN: f64 = 0.2;
/// Camera and laser stay above this height.
const CLEARANCE_M: f64 = 0.045;
/// Elevations of the camera in the second round, and in the only one of a hurried scan.
const HIGH_ROUND: f64 = 0.70;
const ONLY_ROUND: f64 = 0.45;
/// A stroke over the top begins by looking this share of the thing's height below its middle.
const FOOT: f64 = 0.35;
/// The way over the top ends here at the latest.
const FAR_ELEVATION: f64 = 2.6;
/// Steps of a numerical search or length.
const STEPS: usize = 60;

/// As many strokes as the budget of way allows, the most useful first, at least one; `stripe_m` is the stripe's usable
/// length.
pub fn plan(reach: &Reach, stripe_m: f64, budget_m: f64) -> Vec<Stroke> {
    let overs = overs(reach, stripe_m);
    let all = rounds(reach, stripe_m);
    let first_over = overs.first().map_or(0.0, |&(from, to)| length(reach, &from, &to));
    let needed: f64 = all.iter().map(|(from, to)| length(reach, from, to)).sum::<f64>() + first_over;
    let rounds = if needed <= budget_m { all } else { vec![round(ONLY_ROUND, LEFT, 0.0, 1.0)] };
    let mut strokes: Vec<Stroke> = Vec::new();
    let mut way = 0.0;
    for (from, to) in rounds.into_iter().chain(overs) {
        let move_over = strokes.last().map(|last| (last.to.said_near(&from), from));
        let more: Vec<Stroke> = move_over
            .into_iter()
            .chain([(from, to)])
            .map(|(from, to)| Stroke { from, to, length_m: length(reach, &from, &to) })
            .collect();
        way += more.iter().map(|stroke| stroke.length_m).sum::<f64>();
        if way > budget_m && !strokes.is_empty() {
            break;
        }
        strokes.extend(more);
    }
    strokes
}

/// Low rounds, one above the other when the thing is taller than the stripe, and a high one the other way about.
fn rounds(reach: &Reach, stripe_m: f64) -> Vec<(Aim, Aim)> {
    let height = 2.0 * reach.half.z;
    let count = (height / (1.3 * stripe_m)).ceil().max(1.0);
    let low = (0..count as usize).map(|i| {
        let shift = height * ((i as f64 + 0.5) / count - 0.5);
        let elevation = lowest(|elevation| {
            let azimuths = (0..STEPS).map(|step| TAU * step as f64 / STEPS as f64);
            let aims = azimuths.map(|azimuth| Aim { azimuth, ..round(elevation, LEFT, shift, 1.0).0 });
            aims.map(|aim| reach.height_m(&aim)).fold(f64::INFINITY, f64::min)
        });
        round(elevation, LEFT, shift, 1.0)
    });
    low.chain([round(HIGH_ROUND, RIGHT, 0.0, -1.0)]).collect()
}

fn round(elevation: f64, laser: f64, shift_z: f64, turns: f64) -> (Aim, Aim) {
    let from = Aim { azimuth: 0.0, elevation, laser: laser - LEAN, shift: Vector3::z() * shift_z };
    (from, Aim { azimuth: TAU * turns, laser: laser + LEAN, ..from })
}

/// From each side up and over, there and back, so that the next begins where the last one ended.
fn overs(reach: &Reach, stripe_m: f64) -> Vec<(Aim, Aim)> {
    let quarters = [0.0, FRAC_PI_2];
    let diagonals = [FRAC_PI_2 / 2.0, 3.0 * FRAC_PI_2 / 2.0];
    let mut strokes = Vec::new();
    for azimuth in quarters.into_iter().chain(diagonals) {
        let across = Vector3::new(-azimuth.sin(), azimuth.cos(), 0.0);
        let width = 2.0 * across.component_mul(&reach.half).norm();
        let lanes = (width / stripe_m).ceil().max(1.0);
        for lane in 0..lanes as usize {
            let shift = across * (width * ((lane as f64 + 0.5) / lanes - 0.5));
            strokes.extend([azimuth, azimuth + PI].map(|azimuth| over(reach, azimuth, shift)));
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

/// The longer of the ways of camera and laser, so that a roll of the handset takes its time too.
fn length(reach: &Reach, from: &Aim, to: &Aim) -> f64 {
    let [x, y] = reach.laser_offset_m.into();
    let way = |p_in_camera: Point3<f64>| {
        let at =
            |step: usize| reach.world_from_camera(&from.towards(to, step as f64 / STEPS as f64), 0.0) * p_in_camera;
        (0..STEPS).map(|step| (at(step + 1) - at(step)).norm()).sum::<f64>()
    };
    way(Point3::origin()).max(way(Point3::new(x, y, 0.0)))
}
