//! The tracker's own filter: first order, quick while the handset moves and slow while it rests (the Flock's adaptive DC
//! filter), so that what it reports lags behind by a time that depends on the motion.

use super::TrackerSection;
use crate::Hand;
use geometry::METRES_PER_MM;
use nalgebra::Isometry3;

/// The filter forgets what is older than so many of its longest time constants.
const MEMORY: f64 = 6.0;
/// Steps in its shortest time constant, within limits.
const STEPS_PER_CONSTANT: f64 = 4.0;
const STEP_LIMITS_S: [f64; 2] = [0.0005, 0.004];

/// What the filter shows at a moment of the truth until then.
pub fn filtered(section: &TrackerSection, hand: &Hand, t_s: f64) -> Isometry3<f64> {
    let longest = section.filter_rest_s.max(section.filter_moving_s);
    if longest <= 0.0 {
        return hand.world_from_body(t_s);
    }
    let shortest = section.filter_rest_s.min(section.filter_moving_s);
    let wanted = (shortest / STEPS_PER_CONSTANT).clamp(STEP_LIMITS_S[0], STEP_LIMITS_S[1]);
    let count = (MEMORY * longest / wanted).ceil();
    let step = MEMORY * longest / count;
    let mut before = hand.world_from_body(t_s - MEMORY * longest);
    let mut shown = before;
    for i in 1..=count as usize {
        let now = hand.world_from_body(t_s - MEMORY * longest + i as f64 * step);
        let speed = (now.translation.vector - before.translation.vector).norm() / step;
        let follow = following(section, speed, step);
        shown = geometry::interpolate(&shown, &geometry::interpolate(&before, &now, 0.5), follow);
        before = now;
    }
    shown
}

/// The share of the way to the truth that the filter goes in one step.
fn following(section: &TrackerSection, speed_m_per_s: f64, step_s: f64) -> f64 {
    let ratio = speed_m_per_s / (section.filter_speed_mm_per_s * METRES_PER_MM);
    let rest = 1.0 / (1.0 + ratio * ratio);
    let constant = section.filter_moving_s + (section.filter_rest_s - section.filter_moving_s) * rest;
    if constant <= 0.0 { 1.0 } else { 1.0 - (-step_s / constant).exp() }
}
