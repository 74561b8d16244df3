//! Clocks, stamps and numbers of a driver.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use camera_v4l::{
    ClockMap, ClockReading, DriverStamp, SequenceCount, StampAt, Step, clock_readings, middle_of_exposure,
    monotonic_nanos,
};
use proptest::prelude::*;

const MS: i64 = 1_000_000;

#[test]
fn stamps_follow_a_system_clock_that_is_steered_and_then_set() {
    // Steered by 500 in a million, the most that Linux does; every third reading is interrupted for up to 3 ms.
    let mut clock = ClockMap::default();
    let start = 1_700_000_000_000_000_000_i64;
    let mut worst = 0;
    for k in 0..3600_i64 {
        let now = k * 16_666_667;
        let set = if k >= 1800 { 2_000 * MS } else { 0 };
        let system = |at: i64| start + at + at / 2000 + set;
        let readings: Vec<ClockReading> = (0..3)
            .map(|n| {
                let interrupted = if (k + n) % 3 == 0 { (k * 7919) % (3 * MS) } else { 0 };
                let before = now + n * 200 + 2 * interrupted;
                ClockReading { before, system: system(before + 60), after: before + 120 + interrupted }
            })
            .collect();
        clock.update(&readings);
        let exposed = now - 5 * MS;
        let error = clock.system_nanos(exposed).unwrap() - system(exposed);
        worst = worst.max(error.abs());
    }
    assert!(worst < 10_000, "{worst} ns");
    assert!(clock.uncertainty_nanos().unwrap() <= 60);
}

#[test]
fn a_machine_that_is_always_interrupted_still_has_a_clock() {
    let mut clock = ClockMap::default();
    assert_eq!(clock.system_nanos(0), None);
    clock.update(&[]);
    clock.update(&[ClockReading { before: 10, system: 0, after: 5 }]);
    assert_eq!(clock.system_nanos(0), None, "a clock that runs backwards is not believed");
    clock.update(&[ClockReading { before: 0, system: 50, after: 100 }]);
    // Wide readings are not taken at once, but after a second they are.
    clock.update(&[ClockReading { before: 500 * MS, system: 999, after: 510 * MS }]);
    assert_eq!(clock.system_nanos(0), Some(0));
    clock.update(&[ClockReading { before: 2000 * MS, system: 2105 * MS, after: 2010 * MS }]);
    assert_eq!(clock.system_nanos(2005 * MS), Some(2105 * MS));
}

#[test]
fn the_clocks_of_this_machine_can_be_read() {
    let before = monotonic_nanos();
    let readings = clock_readings();
    assert!(readings.iter().all(|r| before <= r.before && r.before <= r.after && r.after <= monotonic_nanos()));
    let mut clock = ClockMap::default();
    clock.update(&readings);
    let system = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap().as_nanos() as i64;
    assert!((clock.system_nanos(monotonic_nanos()).unwrap() - system).abs() < 1000 * MS);
}

#[test]
fn the_middle_of_an_exposure_is_found_from_either_end() {
    let (start, exposure, delay) = (1000 * MS, 8 * MS, 300_000);
    let middle = start + exposure / 2;
    let stamp = |nanos, flags| DriverStamp { nanos, flags, arrival_nanos: start + exposure + delay };
    let (monotonic, soe) = (0x2000, 0x1_2000);
    for (stamp, at) in [
        (stamp(start + exposure + delay, monotonic), StampAt::Driver),
        (stamp(start + delay, soe), StampAt::Driver),
        // Flags that say the wrong end are overruled.
        (stamp(start + exposure + delay, soe), StampAt::End),
        (stamp(start + delay, monotonic), StampAt::Start),
        (stamp(123, 0), StampAt::Arrival),
    ] {
        assert_eq!(middle_of_exposure(stamp, exposure, at, delay), Ok(middle), "{at:?}");
    }
    for flags in [0, 0x4000, 0x1_0000] {
        let refused = middle_of_exposure(stamp(start, flags), exposure, StampAt::Driver, 0).unwrap_err();
        assert!(refused.to_string().contains("stamp_at = \"arrival\""), "{refused}");
    }
}

#[test]
fn lost_and_repeated_pictures_are_counted_by_the_drivers_numbers() {
    let mut count = SequenceCount::default();
    let steps: Vec<Step> = [7, 8, 8, 11, 12, 3].map(|number| count.note(number)).to_vec();
    let new = |lost| Step::New { lost };
    assert_eq!(steps, [new(0), new(0), Step::Repeated, new(2), new(0), Step::Restarted]);
    count.restart();
    assert_eq!(count.note(900), new(0), "what a new stream begins with follows nothing");
    assert_eq!((count.lost, count.repeated), (2, 1));
}

proptest! {
    #[test]
    fn any_losses_are_counted_over_the_wrap_of_the_numbers(first in any::<u32>(), gaps in proptest::collection::vec(0_u32..1000, 1..200)) {
        let (mut count, mut number) = (SequenceCount::default(), first);
        count.note(number);
        for gap in &gaps {
            number = number.wrapping_add(gap + 1);
            prop_assert_eq!(count.note(number), Step::New { lost: *gap });
        }
        prop_assert_eq!(count.lost, gaps.iter().map(|gap| u64::from(*gap)).sum::<u64>());
    }
}
