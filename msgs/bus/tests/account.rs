//! The account of a topic: every gap is counted once, whoever else sends on it.

use bus::SequenceAccount;
use proptest::prelude::*;
use wire::Header;

const KEY: &str = "tracker/head/pose";

/// What an account makes of these numbers: missing before each, and in all.
fn lost(numbers: &[u64]) -> (Vec<u64>, u64) {
    let mut account = SequenceAccount::default();
    let missing = numbers.iter().map(|&seq| account.note(KEY, &Header { seq, ..Header::default() })).collect();
    (missing, account.lost)
}

#[test]
fn the_last_number_there_is_neither_overflows_nor_counts_as_a_loss() {
    assert_eq!(lost(&[5, u64::MAX, 6, 7]).1, 0);
    assert_eq!(lost(&[u64::MAX, u64::MAX, 0, 1]).1, 0);
    assert_eq!(lost(&[0, u64::MAX, u64::MAX, u64::MAX - 1]).1, 0);
}

#[test]
fn a_stranger_who_begins_at_0_makes_no_loss_of_what_follows() {
    assert_eq!(lost(&[500, 0, 501, 0, 502, 504]), (vec![0, 0, 0, 0, 0, 1], 1));
}

#[test]
fn two_publishers_on_one_key_lose_nothing() {
    assert_eq!(lost(&[100, 5, 101, 6, 102, 7]).1, 0);
}

#[test]
fn what_a_publisher_that_was_born_again_loses_is_counted() {
    assert_eq!(lost(&[70, 71, 0, 1, 2, 6]), (vec![0, 0, 0, 0, 0, 3], 3));
    assert_eq!(lost(&[70, 71, 0, 4, 5]), (vec![0, 0, 0, 3, 0], 3));
}

#[test]
fn a_publisher_that_is_far_ahead_is_followed_from_there() {
    let far = 1 << 40;
    assert_eq!(lost(&[7, far, far + 1, far + 4]), (vec![0, 0, 0, 2], 2));
}

#[test]
fn who_is_started_again_knows_what_to_expect() {
    let mut account = SequenceAccount::default();
    account.expect(KEY, 40);
    assert_eq!(account.note(KEY, &Header { seq: 43, ..Header::default() }), 3);
}

/// One life of a publisher: which of its messages arrive. The first two do, or nobody could know that it lives again.
fn life() -> impl Strategy<Value = Vec<bool>> {
    prop::collection::vec(any::<bool>(), 0..40).prop_map(|arrive| [vec![true; 2], arrive, vec![true]].concat())
}

proptest! {
    #[test]
    fn no_number_is_too_odd(numbers in prop::collection::vec(any::<u64>(), 0..50)) {
        let (missing, all) = lost(&numbers);
        prop_assert_eq!(missing.iter().sum::<u64>(), all);
        // Numbers from anywhere follow on nothing.
        prop_assert!(missing.iter().all(|missing| *missing <= 1 << 20));
    }

    #[test]
    fn each_gap_counts_through_all_lives_and_a_stranger_changes_nothing(
        lives in prop::collection::vec(life(), 1..4),
        stranger in prop_oneof![Just(0), Just(u64::MAX), (1u64 << 30)..],
        at: prop::sample::Index,
    ) {
        let numbers = |life: &Vec<bool>| -> Vec<u64> {
            life.iter().enumerate().filter(|(_, arrives)| **arrives).map(|(seq, _)| seq as u64).collect()
        };
        let never_came: u64 = lives.iter().flatten().map(|arrives| u64::from(!arrives)).sum();
        let mut came: Vec<u64> = lives.iter().flat_map(numbers).collect();
        prop_assert_eq!(lost(&came).1, never_came);
        // Behind the last life's beginning: two who are unknown at once could be taken for each other.
        let begun = came.len() - numbers(&lives[lives.len() - 1]).len() + 2;
        came.insert(begun + at.index(came.len() - begun + 1), stranger);
        prop_assert_eq!(lost(&came).1, never_came);
    }
}
