//! One movement of the hand: from rest to rest, at an even pace between.

use super::aim::{Aim, Reach};
use nalgebra::Point3;

/// From one aim to another.
#[derive(Debug, Clone, PartialEq)]
pub struct Stroke {
    /// Where it begins.
    pub from: Aim,
    /// Where it ends.
    pub to: Aim,
    /// Its way: at each moment that of camera or laser, whichever moves faster, so that a roll takes its time too.
    pub length_m: f64,
    /// How far the aim has gone when this many parts of the way are done.
    even: Vec<f64>,
}

/// Steps in which the way is measured.
const STEPS: usize = 120;
/// Parts of the way between which the pace is interpolated.
const PARTS: usize = 16;
/// The stroke speeds up and slows down in this share of its time each.
const RAMP: f64 = 0.15;

impl Stroke {
    /// The stroke between two aims.
    pub fn new(reach: &Reach, from: Aim, to: Aim) -> Self {
        let [x, y] = reach.laser_offset_m.into();
        let handset = [Point3::origin(), Point3::new(x, y, 0.0)];
        let place = |step: usize| {
            let world_from_camera = reach.world_from_camera(&from.towards(&to, step as f64 / STEPS as f64), 0.0);
            handset.map(|p| world_from_camera * p)
        };
        let mut ways = vec![0.0];
        for step in 0..STEPS {
            let (before, after) = (place(step), place(step + 1));
            ways.push(ways[step] + (after[0] - before[0]).norm().max((after[1] - before[1]).norm()));
        }
        let length_m = ways[STEPS];
        Self { from, to, length_m, even: (0..=PARTS).map(|part| inverse(&ways, part as f64 / PARTS as f64)).collect() }
    }

    /// The aim after a share of its time.
    pub fn at(&self, time: f64) -> Aim {
        let part = eased(time.clamp(0.0, 1.0)) * PARTS as f64;
        let knot = (part as usize).min(PARTS - 1);
        let value = |i: usize| self.even[i];
        let slope = |i: usize| match i {
            0 => value(1) - value(0),
            PARTS => value(PARTS) - value(PARTS - 1),
            _ => 0.5 * (value(i + 1) - value(i - 1)),
        };
        // Cubic Hermite, so that the speed has no jumps.
        let t = part - knot as f64;
        let (rise, fall) = (t * t * (3.0 - 2.0 * t), t * (1.0 - t));
        let gone = value(knot) * (1.0 - rise)
            + value(knot + 1) * rise
            + fall * ((1.0 - t) * slope(knot) - t * slope(knot + 1));
        self.from.towards(&self.to, gone)
    }
}

/// Where, as a share of the steps, a share of the whole way is done.
fn inverse(ways: &[f64], share: f64) -> f64 {
    let wanted = share * ways[STEPS];
    let step = ways.partition_point(|way| *way <= wanted).clamp(1, STEPS) - 1;
    let way = ways[step + 1] - ways[step];
    let rest = if way > 0.0 { ((wanted - ways[step]) / way).clamp(0.0, 1.0) } else { 1.0 };
    (step as f64 + rest) / STEPS as f64
}

/// 0 to 1 with rest at both ends: even speed between two ramps that are smoothsteps.
fn eased(at: f64) -> f64 {
    if at > 0.5 {
        return 1.0 - eased(1.0 - at);
    }
    let y = at / RAMP;
    let way = if y < 1.0 { RAMP * y * y * y * (1.0 - 0.5 * y) } else { at - 0.5 * RAMP };
    way / (1.0 - RAMP)
}
