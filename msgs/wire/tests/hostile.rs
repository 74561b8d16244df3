//! Whatever bytes come: an error, never a panic, never a large allocation.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

mod samples;

use proptest::prelude::*;
use samples::Sample as _;
use std::io::Read as _;
use wire::*;

fn reads_or_refuses<M: Message>(bytes: &[u8]) {
    let whole = codec::decode::<M>(bytes);
    let (first, second) = bytes.split_at(bytes.len() / 2);
    let pieces = codec::decode_pieces::<M>(first.chain(second), bytes.len());
    let again = |read: &Result<M, codec::DecodeError>| read.as_ref().ok().map(codec::encode);
    assert_eq!(again(&pieces), again(&whole), "in pieces it is the same");
    if let Ok(message) = whole {
        // What was read is what was written, to the last byte.
        assert!(codec::decode::<M>(&codec::encode(&message)).is_ok());
    }
}

fn all(bytes: &[u8]) {
    macro_rules! read {
        ($($message:ty),*) => { $(reads_or_refuses::<$message>(bytes);)* };
    }
    for_all_messages!(read);
}

/// The bytes of a sample of each message.
fn samples() -> Vec<Vec<u8>> {
    macro_rules! bytes {
        ($($message:ty),*) => { vec![$(codec::encode(&<$message>::sample())),*] };
    }
    for_all_messages!(bytes)
}

fn scan(points: usize) -> Scan {
    Scan { points: Bulk(vec![ScanPoint::default(); points]), ..Scan::none(Header::default()) }
}

/// Schemas: anything, and what looks like one.
fn schemas() -> impl Strategy<Value = String> {
    let near =
        ("[A-Z][a-z]{1,9}", any::<u64>(), "[0-9a-f]{0,20}").prop_map(|(name, v, hash)| format!("{name}@{v}:{hash}"));
    let ours = (any::<u64>(), ".{0,20}").prop_map(|(version, rest)| format!("Pose@{version}{rest}"));
    prop_oneof![".{0,60}", near, ours, Just(codec::schema::<Pose>())]
}

proptest! {
    #[test]
    fn a_header_is_the_same_alone_as_in_its_message(bytes in proptest::collection::vec(any::<u8>(), 0..60)) {
        let alone = codec::header(&bytes);
        if let Ok(message) = codec::decode::<RunPhase>(&bytes) {
            prop_assert_eq!(alone.ok(), Some(message.header));
        }
    }

    #[test]
    fn any_header_is_read_whatever_follows(
        (scan, revision, seq, stamp_nanos) in any::<(u64, u32, u64, i64)>(),
        behind in proptest::collection::vec(any::<u8>(), 0..30),
    ) {
        let header = Header { scan, revision, seq, stamp_nanos, ..Header::default() };
        let mut bytes = codec::encode(&RunPhase { header, discard: false });
        bytes.pop();
        bytes.extend(behind);
        prop_assert_eq!(codec::header(&bytes).ok(), Some(header));
    }

    #[test]
    fn any_schema_but_our_own_is_refused_by_its_name(got in schemas()) {
        match codec::check_schema::<Pose>(&got) {
            Ok(()) => prop_assert_eq!(got, codec::schema::<Pose>()),
            Err(error) => prop_assert!(error.to_string().contains(&got)),
        }
    }

    #[test]
    fn garbage(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        all(&bytes);
    }

    #[test]
    fn any_message_with_one_byte_changed(which: prop::sample::Index, place: prop::sample::Index, value: u8) {
        let samples = samples();
        let mut bytes = samples[which.index(samples.len())].clone();
        let place = place.index(bytes.len());
        bytes[place] = value;
        all(&bytes);
    }

    #[test]
    fn any_message_cut_short(which: prop::sample::Index, place: prop::sample::Index) {
        let samples = samples();
        let bytes = &samples[which.index(samples.len())];
        all(&bytes[..place.index(bytes.len())]);
    }

    #[test]
    fn a_message_cut_short_or_with_something_behind_it_is_refused(points in 0usize..50, cut in 1usize..100, more in 1usize..9) {
        let bytes = codec::encode(&scan(points));
        prop_assert!(codec::decode::<Scan>(&bytes[..bytes.len().saturating_sub(cut)]).is_err());
        let longer = [bytes, vec![0; more]].concat();
        let is_trailing = matches!(codec::decode::<Scan>(&longer), Err(codec::DecodeError::Trailing { left, .. }) if left == more);
        prop_assert!(is_trailing);
    }

    #[test]
    fn a_frame_whose_size_contradicts_its_header_is_refused(width in 0u32..9, height in 0u32..9, stride in 0u32..40, bytes in 0usize..400) {
        let frame = Frame {
            header: Header::default(), width, height, stride, format: PixelFormat::Rgb8, light: Light { laser: true, lamp: false },
            exposure_nanos: 0, gain: 1.0, gamma: 1.0, data: Bulk(vec![0; bytes]),
        };
        let fits = width > 0 && height > 0 && stride >= 3 * width
            && bytes >= (stride * (height.max(1) - 1) + 3 * width) as usize && bytes <= (stride * height) as usize;
        prop_assert_eq!(frame.check().is_ok(), fits);
    }
}

#[test]
fn a_hostile_length_is_refused_before_it_allocates() {
    // A scan's bytes up to its points, then a length of 2^60.
    let mut bytes = codec::encode(&scan(0));
    bytes.truncate(bytes.len() - 2);
    bytes.extend([253, 0, 0, 0, 0, 0, 0, 0, 16]);
    assert!(codec::decode::<Scan>(&bytes).is_err());
}

#[test]
fn names_of_instances_cannot_be_wildcards() {
    for bad in ["", "*", "a/b", "**", "@x", "Head", "a b", &"x".repeat(41)] {
        assert!(topic::check_name(bad).is_err(), "{bad:?}");
    }
    assert!(topic::check_name("head_2").is_ok());
}

#[test]
fn no_latched_or_kept_topic_lives_under_an_at() {
    for (key, _, class) in topic::all() {
        let kept = matches!(class, topic::Class::Latched | topic::Class::Stream);
        assert!(!(kept && key.contains('@')), "{key}: history cannot find it there");
    }
}
