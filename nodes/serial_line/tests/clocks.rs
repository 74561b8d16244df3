//! Stamps against the truth, whatever the line does to the arrivals.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use proptest::prelude::*;
use serial_line::{DeviceClock, Faults, FaultsConfig, RateLock, wire_nanos};

const MS: f64 = 1e-6;

fn late(seed: u64, jitter_ms: i64) -> Faults {
    Faults::new(FaultsConfig { seed, jitter_nanos: jitter_ms * 1_000_000, ..Default::default() })
}

/// Root mean square, and the largest, of what follows the first `skip` errors, in milliseconds.
fn rms_ms(errors: &[f64], skip: usize) -> (f64, f64) {
    let errors = &errors[skip..];
    let squares: f64 = errors.iter().map(|e| e * e).sum();
    ((squares / errors.len() as f64).sqrt() * MS, errors.iter().fold(0.0, |most: f64, e| most.max(e.abs())) * MS)
}

fn locked(lock: &mut RateLock, period: f64, count: i64, faults: &mut Faults) -> Vec<f64> {
    let run = |k: i64| {
        let truth = (k as f64 * period) as i64;
        let arrival = faults.deliver(truth, &[0]).due_nanos;
        (lock.undelay(arrival, 0).nanos - truth) as f64
    };
    (0..count).map(run).collect()
}

#[test]
fn a_hundred_a_second_with_ten_milliseconds_of_jitter_is_known_to_a_tenth() {
    for (said, seed) in [(Some(1e7), 1), (None, 2), (Some(1.02e7), 3)] {
        let mut lock = RateLock::new(said);
        let errors = locked(&mut lock, 1e7, 6000, &mut late(seed, 10));
        let (rms, most) = rms_ms(&errors, 200);
        assert!(rms < 0.2 && most < 1.5, "period said to be {said:?}: {rms} ms rms, {most} ms at most");
        let (removed, spread) = lock.jitter_nanos();
        assert!((removed * MS - 10.0 / 12f64.sqrt()).abs() < 0.4 && spread * MS > 9.0, "{removed} {spread}");
        assert!((lock.period_nanos().unwrap() / 1e7 - 1.0).abs() < 1e-4);
    }
}

#[test]
fn lost_records_are_counted_in_whether_the_decoder_saw_them_or_not() {
    let mut lock = RateLock::new(Some(1e7));
    let mut faults = late(4, 10);
    let (mut errors, mut unseen) = (Vec::new(), 0);
    let mut missed = 0;
    for k in 0..6000_i64 {
        let truth = k * 10_000_000;
        let arrival = faults.deliver(truth, &[0]).due_nanos;
        match k % 997 {
            500 => missed += 1,
            // Nothing of it was ever seen; and one that seemed to be two.
            700 if k > 200 => unseen += 1,
            _ => {
                let phantom = u32::from(k % 997 == 900);
                errors.push((lock.undelay(arrival, missed + phantom).nanos - truth) as f64);
                missed = 0;
            }
        }
    }
    assert_eq!(unseen, 6);
    let (rms, _) = rms_ms(&errors, 200);
    assert!(rms < 2.0, "a loss is noticed within a quarter of a second: {rms} ms");
    let wrong = errors[200..].iter().filter(|e| e.abs() * MS > 1.0).count();
    assert!(wrong < 6 * 40, "{wrong} of {} stamps are off by more than 1 ms", errors.len());
}

#[test]
fn a_silence_starts_the_count_anew_and_a_burst_does_not() {
    let mut lock = RateLock::new(Some(1e7));
    let mut faults = late(5, 3);
    locked(&mut lock, 1e7, 500, &mut faults);
    // The host was stopped for 120 ms, and for 400: as many records arrive at once.
    let errors: Vec<f64> = (500..1000)
        .map(|k: i64| {
            let truth = k * 10_000_000;
            let stopped = [5_000..5_125, 7_000..7_400].into_iter().find(|ms| ms.contains(&(k * 10)));
            let arrival = faults.deliver(truth, &[0]).due_nanos.max(stopped.map_or(0, |ms| ms.end * 1_000_000));
            (lock.undelay(arrival, 0).nanos - truth) as f64
        })
        .collect();
    assert!(rms_ms(&errors, 0).1 < 0.5, "{:?}", rms_ms(&errors, 0));
    let truth = 60_000_000_000;
    assert!(!lock.undelay(truth, 0).settled);
    let errors: Vec<f64> =
        (1..500).map(|k| (lock.undelay(truth + k * 10_000_000, 0).nanos - truth - k * 10_000_000) as f64).collect();
    assert!(rms_ms(&errors, 0).1 < 0.01);
}

#[test]
fn behind_a_stop_that_looks_like_a_silence_a_stamp_is_true_or_known_not_to_be() {
    let mut lock = RateLock::new(Some(1e7));
    let mut faults = late(9, 3);
    locked(&mut lock, 1e7, 500, &mut faults);
    let (mut held_up, mut worst) = (0, 0.0_f64);
    for k in 500..1000_i64 {
        let truth = k * 10_000_000;
        // The host was stopped for 900 ms.
        let stopped = if k < 590 { 5_900_000_000 } else { 0 };
        let undelayed = lock.undelay(faults.deliver(truth, &[0]).due_nanos.max(stopped), 0);
        match undelayed.held_up {
            true => held_up += 1,
            false => worst = worst.max((undelayed.nanos - truth).abs() as f64 * MS),
        }
    }
    assert!((90..110).contains(&held_up), "{held_up}");
    assert!(worst < 4.0, "{worst} ms: no more than the line's own jitter");
}

#[test]
fn a_devices_own_clock_is_told_in_ours_to_its_own_coarseness() {
    for (drift, zero) in [(0.0, 0u32), (80e-6, u32::MAX - 5000), (-60e-6, 77)] {
        let mut clock = DeviceClock::new(1e6, None);
        let mut faults = late(6, 10);
        let mut errors = Vec::new();
        for k in 0..6000_i64 {
            let truth = k * 4_166_667 + 321_000;
            let ticks = zero.wrapping_add((truth as f64 * (1.0 + drift) / 1e6) as u32);
            let arrival = faults.deliver(truth, &[0]).due_nanos;
            errors.push((clock.undelay(ticks, arrival).unwrap().nanos - truth) as f64);
        }
        let (rms, most) = rms_ms(&errors, 500);
        assert!(rms < 0.45 && most < 1.2, "drift {drift}: {rms} ms rms, {most} ms at most");
    }
}

#[test]
fn even_frames_are_known_better_than_the_ticks_that_tell_them() {
    // 240 a second as said; twice as slow as said, so that each step is two frames; 100 a second, which is neither.
    for (period, said, best) in [(4_166_667, 240.0, 0.15), (8_333_333, 240.0, 0.15), (10_000_000, 240.0, 0.75)] {
        let mut clock = DeviceClock::new(1e6, Some(1e9 / said));
        let mut faults = late(7, 10);
        let mut errors = Vec::new();
        for k in (0..6000_i64).filter(|k| k % 100 != 7) {
            let truth = k * period + 321_000;
            let ticks = (truth as f64 * 1.00005 / 1e6) as u32;
            let arrival = faults.deliver(truth, &[0]).due_nanos;
            errors.push((clock.undelay(ticks, arrival).unwrap().nanos - truth) as f64);
        }
        let (rms, most) = rms_ms(&errors, 500);
        assert!(rms < best, "{period} ns, said to be {said} a second: {rms} ms rms, {most} ms at most");
    }
}

#[test]
fn a_time_stamp_with_a_bit_error_is_refused_and_a_clock_that_was_set_is_followed() {
    let mut clock = DeviceClock::new(1e6, None);
    for k in 0..500_i64 {
        assert!(clock.undelay(4 * k as u32, k * 4_000_000).is_some());
    }
    assert_eq!(clock.undelay(1 << 30, 2_000_000_000), None);
    assert_eq!(clock.undelay(2004, 2_004_000_000).map(|stamp| stamp.nanos / 1_000_000), Some(2004));
    let after: Vec<bool> =
        (0..5).map(|k| clock.undelay(4 * k, 2_008_000_000 + i64::from(k) * 4_000_000).is_some()).collect();
    assert_eq!(after, [false, false, true, true, true]);
}

#[test]
fn bytes_take_their_time() {
    // A bird's records: angles, the same in group mode, quaternion, matrix.
    for (bytes, slow_ms, fast_ms) in [(12, 3.12, 1.04), (13, 3.39, 1.13), (14, 3.65, 1.22), (24, 6.25, 2.08)] {
        let ms = [38_400, 115_200].map(|baud| wire_nanos(bytes, baud) as f64 * 1e-6);
        assert!((ms[0] - slow_ms).abs() < 0.0051 && (ms[1] - fast_ms).abs() < 0.0051, "{bytes} bytes: {ms:?} ms");
    }
    assert_eq!(wire_nanos(12, 0), 0);
}

proptest! {
    #[test]
    fn any_arrivals_give_rising_stamps_that_are_not_late(
        steps in prop::collection::vec((0i64..2_000_000_000, any::<u32>()), 1..200),
        said in prop::option::of(-1e9..1e12f64),
    ) {
        let mut lock = RateLock::new(said);
        let (mut now, mut last) = (0, i64::MIN);
        for (step, missed) in steps {
            now += step;
            let stamp = lock.undelay(now, missed);
            prop_assert!(stamp.nanos > last && stamp.nanos <= now.max(last + 1));
            last = stamp.nanos;
        }
    }

    #[test]
    fn any_ticks_give_no_falling_stamps(steps in prop::collection::vec((0i64..2_000_000_000, any::<u32>()), 1..200)) {
        let mut clock = DeviceClock::new(1e6, None);
        let (mut now, mut last) = (0, i64::MIN);
        for (step, ticks) in steps {
            now += step;
            if let Some(stamp) = clock.undelay(ticks, now) {
                prop_assert!(stamp.nanos >= last);
                last = stamp.nanos;
            }
        }
    }
}
