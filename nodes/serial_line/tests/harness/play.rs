//! A tracker's emulator and its driver in no time at all, with neither port nor thread: for the tests of every tracker.

use nalgebra::Vector3;
use serial_line::{Emulated, Faults, FaultsConfig, PoseTracker, SensorPose, Step};

const TICK_NANOS: i64 = 100_000;

/// What a driver makes of so many seconds of a device that was told some things first. `decode` takes a byte and gives
/// the record that it completes, with how many came in pieces before.
pub fn play<T: PoseTracker>(
    mut device: impl Emulated,
    told: impl IntoIterator<Item = Step>,
    faults: FaultsConfig,
    seconds: i64,
    mut tracker: T,
    mut decode: impl FnMut(u8) -> Option<(T::Record, u32)>,
) -> Vec<SensorPose> {
    told.into_iter().for_each(|step| device.hear(&step.send, 0));
    let (mut faults, mut poses) = (Faults::new(faults), Vec::new());
    for tick in 1..seconds * 1_000_000_000 / TICK_NANOS {
        while let Some((left_nanos, bytes)) = device.speak(tick * TICK_NANOS) {
            let delivery = faults.deliver(left_nanos, &bytes);
            for (record, missed) in delivery.bytes.iter().filter_map(|&byte| decode(byte)) {
                poses.extend(tracker.process(&record, delivery.due_nanos, missed));
            }
        }
    }
    poses
}

pub fn metres(pose: &SensorPose) -> Vector3<f64> {
    Vector3::from(pose.pose.world_from_body.translation_m)
}

/// Along x at half a metre a second, to and fro: the position tells the time.
pub fn pendulum(nanos: i64) -> Vector3<f64> {
    let t = nanos as f64 * 1e-9 * 0.5;
    Vector3::new(0.2 + 0.4 * ((t / 0.4).rem_euclid(2.0) - 1.0).abs(), 0.05, -0.1)
}

/// How far stamps on the pendulum are from the truth; where it turns round it does not tell.
pub fn stamp_errors_ms<'a>(poses: impl IntoIterator<Item = &'a SensorPose>) -> Vec<f64> {
    let straight = poses.into_iter().filter(|pose| (0.21..0.59).contains(&metres(pose).x));
    straight.map(|pose| (metres(pose) - pendulum(pose.pose.header.stamp_nanos)).x.abs() / 0.5 * 1e3).collect()
}

pub fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}
