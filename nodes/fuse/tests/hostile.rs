//! Whatever comes is fused or refused: no panic, stamps that rise, poses that are rigid, sigmas that are numbers.

mod handset;

use fuse::{Config, Fuse};
use geometry::rigid_from_wire;
use handset::{MS, triangle};
use proptest::prelude::*;
use wire::{Clock, Header, Phase, Pose, Quality, RigidPose};

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![8 => -1.0..1.0, 1 => any::<f64>(), 1 => Just(0.0)]
}

fn stamp() -> impl Strategy<Value = i64> {
    prop_oneof![20 => 0..2_000_000_000i64, 1 => any::<i64>()]
}

fn header() -> impl Strategy<Value = Header> {
    let phase = prop_oneof![60 => Just(Phase::Both), 1 => Just(Phase::End)];
    let clock = prop_oneof![30 => Just(Clock::Scan), 1 => Just(Clock::System)];
    let scan = prop_oneof![60 => Just(1u64), 1 => 0..4u64];
    (scan, phase, stamp(), clock).prop_map(|(scan, phase, stamp_nanos, clock)| Header {
        scan,
        phase,
        stamp_nanos,
        clock,
        ..Header::default()
    })
}

fn pose() -> impl Strategy<Value = Pose> {
    let unit = Just(RigidPose::IDENTITY.rotation_wxyz);
    let rotation = prop_oneof![4 => unit, 1 => [number(), number(), number(), number()]];
    let quality = prop_oneof![6 => Just(Quality::Good), 1 => Just(Quality::Degraded), 1 => Just(Quality::Lost)];
    let lag = prop_oneof![6 => Just(0i64), 2 => 0..20_000_000i64, 1 => any::<i64>()];
    let sigma = || [number(), number(), number()];
    let sigmas = prop_oneof![3 => Just(([1e-3; 3], [0.03; 3])), 1 => (sigma(), sigma())];
    (header(), [number(), number(), number()], rotation, sigmas, lag, quality).prop_map(
        |(
            header,
            translation_m,
            rotation_wxyz,
            (position_sigma_m, rotation_sigma_rad),
            rotation_lag_nanos,
            quality,
        )| {
            let world_from_body = RigidPose { translation_m, rotation_wxyz };
            let reason = "why not".to_owned();
            Pose { header, world_from_body, position_sigma_m, rotation_sigma_rad, rotation_lag_nanos, quality, reason }
        },
    )
}

fn check(fused: &[Pose]) -> Result<(), TestCaseError> {
    for pair in fused.windows(2) {
        let [a, b] = [&pair[0].header, &pair[1].header];
        prop_assert!(b.scan > a.scan || b.scan == a.scan && b.stamp_nanos > a.stamp_nanos);
    }
    for pose in fused {
        prop_assert!(pose.quality == Quality::Good || !pose.reason.is_empty());
        prop_assert!(rigid_from_wire(&pose.world_from_body).is_some(), "{pose:?}");
        let sigmas = pose.position_sigma_m.iter().chain(&pose.rotation_sigma_rad);
        let known = |sigma: &f64| sigma.is_finite() && (*sigma > 0.0 || pose.quality == Quality::Lost);
        prop_assert!(sigmas.clone().all(known), "{pose:?}");
    }
    Ok(())
}

/// Who says nothing of a moment is given up now and then; at the end nothing waits any more.
fn run(config: Config, said: &[(usize, Pose)]) -> Result<(), TestCaseError> {
    let Ok(mut fuse) = Fuse::new(config) else { return Err(TestCaseError::fail("the configuration")) };
    let mut fused = Vec::new();
    for (step, (receiver, pose)) in said.iter().enumerate() {
        fuse.pose(*receiver, pose);
        if step % 7 == 0 {
            fuse.overdue().into_iter().for_each(|receiver| fuse.go_on_without(receiver));
        }
        fused.extend(fuse.drain());
    }
    let scan = said.iter().map(|(_, pose)| pose.header.scan).max().unwrap_or(0);
    let end = Header { scan, phase: Phase::End, stamp_nanos: i64::MAX, ..Header::default() };
    (0..3).for_each(|receiver| fuse.pose(receiver, &Pose::none(end, "the end")));
    fused.extend(fuse.drain());
    prop_assert!(fuse.end().is_some_and(|(header, _)| header.is_end()), "nothing waits for ever");
    prop_assert!(fuse.overdue().is_empty());
    check(&fused)
}

/// All that came of what was said, in this order: each receiver's readings keep theirs.
fn in_order(said: &[Vec<Pose>], order: impl Iterator<Item = usize>) -> (Vec<Pose>, Vec<wire::Refusal>) {
    let mut fuse = handset::fuse(triangle());
    let mut left: Vec<_> = said.iter().map(|poses| poses.iter()).collect();
    for receiver in order.chain((0..3).flat_map(|receiver| std::iter::repeat_n(receiver, said[receiver].len()))) {
        left[receiver].next().into_iter().for_each(|pose| fuse.pose(receiver, pose));
    }
    (0..3).for_each(|receiver| fuse.pose(receiver, &handset::end(i64::MAX)));
    (fuse.drain().collect(), fuse.take_refused())
}

/// Readings of one receiver some milliseconds apart, some of them lost, some rotations old.
fn stream() -> impl Strategy<Value = Vec<Pose>> {
    let quality = prop_oneof![6 => Just(Quality::Good), 1 => Just(Quality::Degraded), 1 => Just(Quality::Lost)];
    let reading = (1..30i64, quality, 0..25i64);
    prop::collection::vec(reading, 0..60).prop_map(|readings| {
        let mut stamp = 0;
        let mut read = |(step, quality, lag)| {
            stamp += step * MS;
            let pose = handset::reading(stamp, &handset::world_from_body(stamp));
            Pose { quality, rotation_lag_nanos: lag * MS, reason: "why not".to_owned(), ..pose }
        };
        readings.into_iter().map(&mut read).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn whatever_comes_is_fused_or_refused(said in prop::collection::vec((0..3usize, pose()), 0..120)) {
        run(triangle(), &said)?;
    }

    #[test]
    fn in_the_order_of_time_too(mut said in prop::collection::vec((0..3usize, pose()), 0..120)) {
        said.sort_by_key(|(_, pose)| pose.header.stamp_nanos);
        run(triangle(), &said)?;
    }

    #[test]
    fn the_stamps_decide_and_not_the_order_of_the_messages(
        said in [stream(), stream(), stream()],
        order in prop::collection::vec(0..3usize, 0..180),
    ) {
        prop_assert_eq!(in_order(&said, std::iter::empty()), in_order(&said, order.into_iter()));
    }
}
