//! Released layouts never change: the bytes of one sample of every message are kept in tests/golden, with its schema.
//!
//! A message that is new, or has a new version, gets its file by `BLESS=1 cargo test -p wire --test golden`.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

mod samples;

use samples::Sample;
use std::fmt::Write as _;
use std::path::PathBuf;
use wire::{Message, codec};

fn check<M: Message + PartialEq + std::fmt::Debug>(message: M) {
    let bytes = codec::encode(&message);
    assert_eq!(codec::decode::<M>(&bytes).unwrap(), message);
    let (head, tail) = codec::encode_apart(message.clone());
    assert!([head, tail].concat() == bytes, "in two parts it is the same");
    let mut hex = format!("{}\n", codec::schema::<M>());
    for (i, byte) in bytes.iter().enumerate() {
        write!(hex, "{byte:02x}{}", if i % 32 == 31 { "\n" } else { "" }).unwrap();
    }
    hex.push('\n');
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(format!("{}.hex", M::NAME));
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, &hex).unwrap();
    }
    let golden =
        std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}; BLESS=1 writes it", path.display()));
    assert_eq!(hex, golden, "the layout of {} has changed: give it a new version instead", M::NAME);
}

macro_rules! check_all {
    ($($message:ty),*) => { $(check(<$message>::sample());)* };
}

#[test]
fn the_bytes_of_every_message_are_what_they_were() {
    wire::for_all_messages!(check_all);
}

#[test]
fn no_golden_file_is_left_of_a_message_that_is_gone() {
    macro_rules! names {
        ($($message:ty),*) => { [$(<$message as Message>::NAME),*] };
    }
    let known = wire::for_all_messages!(names);
    for file in std::fs::read_dir(PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden")).unwrap() {
        let path = file.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        assert!(known.contains(&name), "{}", path.display());
    }
}
