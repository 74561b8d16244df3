//! A scan at the pace of a hand, refined while it goes on: revision after revision brings what changed, and no picture that
//! is put together from them has a hole where frames came while it was computed.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use bus::Subscriber;
use std::collections::{BTreeMap, BTreeSet};
use system_tests::rig::{Rig, wait_on};
use system_tests::{limn, lost, report};
use wire::{Extent, Message, Refinement, Scan, Trajectory, topic};

/// The frames that a reader has after each revision, as `cluster` puts them together.
fn pictures(scans: &[Scan]) -> BTreeMap<u32, BTreeSet<i64>> {
    let (mut revision, mut frames, mut pictures) = (0, BTreeSet::new(), BTreeMap::new());
    for Scan { header, extent, points, .. } in scans {
        assert!(header.revision >= revision, "revisions come in their order");
        if header.revision > revision {
            pictures.insert(revision, frames.clone());
            revision = header.revision;
            if *extent == Extent::Whole {
                frames.clear();
            }
        }
        if points.is_empty() {
            frames.remove(&header.stamp_nanos)
        } else {
            frames.insert(header.stamp_nanos)
        };
    }
    pictures.insert(revision, frames);
    pictures
}

fn all<M: Message>(input: &mut Subscriber<M>) -> Vec<M> {
    std::iter::from_fn(|| input.next()).collect()
}

#[test]
fn no_frame_is_missing_from_a_picture_that_is_refined_while_it_grows() {
    let folder = tempfile::tempdir().unwrap();
    let mut demo = limn();
    demo.args(["demo", "--headless", "--pace", "real", "--seconds", "15", "--out"]).arg(folder.path());
    demo.args(["--set", "refine.live_every_s=1", "--set", "surface.live_every_s=1"]);
    let mut rig = Rig::start(&mut demo);
    let bus = rig.bus();
    let mut placed = bus.subscribe(&topic::scan("head"), 1 << 14).unwrap();
    let mut refined = bus.subscribe(&topic::scan("refined"), 1 << 17).unwrap();
    let mut ways = bus.subscribe(&topic::trajectory("refined"), 1 << 17).unwrap();
    let mut accounts = bus.subscribe(&topic::refinement("refined"), 1 << 10).unwrap();
    let mut scans: Vec<Scan> = Vec::new();
    wait_on(&bus, "the refined scan does not end", || {
        scans.extend(all(&mut refined));
        scans.last().filter(|scan| scan.header.is_end()).map(|_| ())
    });
    let placed: BTreeSet<i64> = stamps(all(&mut placed).iter());
    let accounts: Vec<Refinement> = all(&mut accounts);
    let ways: Vec<Trajectory> = all(&mut ways);
    drop(bus);
    let (status, said) = rig.end();
    assert!(status.success(), "{said}");
    assert_eq!(lost(&report(folder.path())), 0, "{said}");

    let pictures = pictures(&scans);
    assert!(accounts.len() > 3, "{} revisions, and the last is no live one", accounts.len());
    for account in &accounts {
        let revision = account.header.revision;
        let known = pictures.get(&revision).unwrap_or_else(|| panic!("revision {revision} has no frames"));
        let left_out: BTreeSet<i64> = account.left_out().map(|fit| fit.stamp_nanos).collect();
        let missing: Vec<_> = placed.range(..=known.last().unwrap()).filter(|s| !known.contains(s)).collect();
        let missing: Vec<_> = missing.into_iter().filter(|stamp| !left_out.contains(stamp)).collect();
        assert!(missing.is_empty(), "revision {revision} of {} frames lacks {missing:?}", known.len());
        let told = account.frames.iter().map(|fit| fit.stamp_nanos).max();
        assert!(told <= known.last().copied(), "it has at least the frames that it tells of");
    }
    // The second one, and those behind it, bring what changed.
    let live = |scan: &&Scan| {
        (accounts[1].header.revision..accounts.last().unwrap().header.revision).contains(&scan.header.revision)
    };
    assert!(scans.iter().filter(live).all(|scan| scan.extent == Extent::Changes));

    // The way goes on from where refinement knew it, without going back.
    let mut way: BTreeMap<u32, Vec<i64>> = BTreeMap::new();
    for piece in &ways {
        way.entry(piece.header.revision).or_default().extend(piece.samples.iter().map(|sample| sample.stamp_nanos));
    }
    assert_eq!(way.keys().filter(|revision| **revision > 0).count(), accounts.len());
    for (revision, stamps) in way {
        assert!(stamps.windows(2).all(|pair| pair[0] < pair[1]), "the way of revision {revision} goes back");
    }
}

/// Of the frames that have points: one without says nothing.
fn stamps<'a>(scans: impl Iterator<Item = &'a Scan>) -> BTreeSet<i64> {
    scans.filter(|scan| !scan.points.is_empty()).map(|scan| scan.header.stamp_nanos).collect()
}
