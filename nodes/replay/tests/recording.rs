//! Recordings: whole, cut at any place, with any bit turned.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use proptest::prelude::*;
use record::{Config, Recorder};
use replay::{Message, Recording, ReplayError, Source};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use tempfile::TempDir;
use wire::codec::{self, DecodeError};
use wire::{Header, Mesh, Phase, RunPhase};

/// Two streams, the large one noisy, so that a small file has many chunks.
fn messages() -> Vec<Message> {
    let mut noise = 1_u32;
    let mut bytes = |count: usize| -> Vec<u8> {
        let next = |_| {
            noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (noise >> 24) as u8
        };
        (0..count).map(next).collect()
    };
    (0..60)
        .map(|i| {
            let (key, schema) = if i % 3 == 0 { ("run/phase", "RunPhase@1:1") } else { ("a/b/c", "Thing@2:2") };
            let (key, schema) = (key.to_owned(), schema.to_owned());
            Message { key, schema, stamp_nanos: i * 20_000_000, bytes: bytes(300 + i as usize) }
        })
        .collect()
}

fn record(path: &Path, messages: &[Message], finish: bool) {
    record_packed(path, messages, finish, 1);
}

fn record_packed(path: &Path, messages: &[Message], finish: bool, zstd_level: u32) {
    let config = Config { chunk_s: 0.1, zstd_level, ..Config::default() };
    let metadata = [("limn_version".to_owned(), "test".to_owned())].into();
    let mut recorder = Recorder::create(path, config, &metadata).unwrap();
    for m in messages {
        recorder.write(&m.key, &m.schema, m.stamp_nanos, &m.bytes).unwrap();
    }
    if finish {
        recorder.finish().unwrap();
    } else {
        // As a kill would leave it: no footer, the last chunk never written.
        std::mem::forget(recorder);
    }
}

fn place() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.mcap");
    (folder, path)
}

/// What can be read, and how many errors stood between.
fn play(path: &Path) -> Result<(Vec<Message>, usize, bool), ReplayError> {
    let recording = Recording::open(path)?;
    let (good, bad): (Vec<_>, Vec<_>) = recording.messages()?.partition(Result::is_ok);
    Ok((good.into_iter().flatten().collect(), bad.len(), !recording.damages().is_empty()))
}

static WHOLE: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let (_folder, path) = place();
    record(&path, &messages(), true);
    std::fs::read(&path).unwrap()
});

static PLAIN: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let (_folder, path) = place();
    record_packed(&path, &messages(), true, 0);
    std::fs::read(&path).unwrap()
});

#[test]
fn a_recording_gives_back_every_byte_in_order() {
    let (_folder, path) = place();
    record(&path, &messages(), true);
    assert_eq!(play(&path).unwrap(), (messages(), 0, false));
    let plain = path.with_file_name("plain.mcap");
    record_packed(&plain, &messages(), true, 0);
    assert_eq!(play(&plain).unwrap(), (messages(), 0, false));
    let recording = Recording::open(&path).unwrap();
    let streams: Vec<_> = recording.streams().into_iter().map(|s| (s.key, s.schema, s.messages)).collect();
    let expected = [("a/b/c", "Thing@2:2", 40), ("run/phase", "RunPhase@1:1", 20)];
    assert_eq!(streams, expected.map(|(key, schema, count)| (key.to_owned(), schema.to_owned(), count)));
    assert_eq!(recording.metadata()["limn_version"], "test");
}

#[test]
fn after_a_kill_all_but_the_last_chunk_is_there() {
    let (_folder, path) = place();
    record(&path, &messages(), false);
    let recording = Recording::open(&path).unwrap();
    let damage = recording.damages()[0].to_string();
    assert!(damage.contains("it ends without a footer"), "{damage}");
    let read: Vec<Message> = recording.messages().unwrap().collect::<Result<_, _>>().unwrap();
    // A chunk spans 0.1 s: six messages.
    assert!(read.len() >= 60 - 6, "{}", read.len());
    assert_eq!(read, messages()[..read.len()]);
    assert_eq!(recording.streams().iter().map(|s| s.messages).sum::<u64>(), read.len() as u64);
}

/// Whole messages: what came twice is known by its header.
fn numbered(numbers: std::ops::Range<u64>) -> Vec<Message> {
    let message = |seq: u64| {
        let header = Header { phase: Phase::Both, seq, stamp_nanos: seq as i64 * 20_000_000, ..Header::default() };
        let bytes = codec::encode(&RunPhase { header, discard: false });
        Message { key: "run/phase".into(), schema: codec::schema::<RunPhase>(), stamp_nanos: header.stamp_nanos, bytes }
    };
    numbers.map(message).collect()
}

/// What a recorder leaves that was killed, and was started again so often.
fn record_in_parts(path: &Path, parts: &[Vec<Message>]) {
    for (number, messages) in parts.iter().enumerate() {
        let config = Config { chunk_s: 0.1, ..Config::default() };
        let metadata = [("limn_version".to_owned(), number.to_string())].into();
        let begin = if number == 0 { Recorder::create } else { Recorder::go_on };
        let mut recorder = begin(path, config, &metadata).unwrap();
        for m in messages {
            recorder.write(&m.key, &m.schema, m.stamp_nanos, &m.bytes).unwrap();
        }
        std::mem::forget(recorder);
    }
}

#[test]
fn the_parts_of_a_recording_are_read_as_one() {
    let (_folder, path) = place();
    // Of each part the last chunk, six messages at most, is missing; the next one has got them from their sender.
    record_in_parts(&path, &[numbered(0..60), numbered(0..120), numbered(100..180)]);
    let recording = Recording::open(&path).unwrap();
    let read: Vec<Message> = recording.messages().unwrap().collect::<Result<_, _>>().unwrap();
    assert!(read.len() >= 180 - 6, "{}", read.len());
    assert_eq!(read, numbered(0..read.len() as u64));
    let damages: Vec<String> = recording.damages().iter().map(ToString::to_string).collect();
    let named = ["scan.mcap: ", "scan.2.mcap: ", "scan.3.mcap: "];
    assert!(damages.len() == 3 && damages.iter().zip(named).all(|(told, name)| told.contains(name)), "{damages:?}");
    assert_eq!(recording.metadata()["limn_version"], "0");
    // A part that holds nothing costs nothing, and another recording is no part.
    std::fs::write(path.with_file_name("scan.2.mcap"), b"").unwrap();
    let recording = Recording::open(&path).unwrap();
    assert!(recording.damages().iter().any(|damage| damage.to_string().contains("does not begin")));
    let first = recording.messages().unwrap().flatten().take(50).collect::<Vec<_>>();
    assert_eq!(first, numbered(0..50));
    let second = path.with_file_name("scan.2.mcap");
    std::fs::remove_file(&second).unwrap();
    record(&second, &[], true);
    let alone = Recording::open(&path).unwrap().messages().unwrap().flatten().count();
    assert!(alone <= 60, "{alone}");
}

#[test]
fn a_damaged_chunk_is_named_and_the_rest_follows() {
    let (_folder, path) = place();
    let mut bytes = WHOLE.clone();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    std::fs::write(&path, &bytes).unwrap();
    let recording = Recording::open(&path).unwrap();
    let errors: Vec<String> = recording.messages().unwrap().filter_map(|m| m.err()).map(|e| e.to_string()).collect();
    assert_eq!(errors.len(), 1);
    assert!(errors[0].contains("is damaged (6 messages lost): Chunk CRC failed"), "{}", errors[0]);
    assert_eq!(play(&path).unwrap().0.len(), 54);
}

#[test]
fn a_damaged_length_costs_no_more_than_its_chunk() {
    let (_folder, path) = place();
    let recorded = WHOLE.clone();
    // The second chunk: opcode 6 behind the first one's message indexes.
    let summary = mcap::Summary::read(&recorded).unwrap().unwrap();
    let second = summary.chunk_indexes[1].chunk_start_offset as usize;
    let mut bytes = recorded;
    bytes[second + 6] ^= 0x40;
    std::fs::write(&path, &bytes).unwrap();
    let (read, _errors, damaged) = play(&path).unwrap();
    assert!(damaged);
    assert_eq!(read.len(), 60 - 6);
}

#[test]
fn what_is_no_recording_is_told() {
    let (_folder, path) = place();
    assert!(Recording::open(&path).unwrap_err().to_string().contains("scan.mcap: No such file"));
    std::fs::write(&path, b"").unwrap();
    assert!(Recording::open(&path).unwrap_err().to_string().ends_with("it does not begin as an MCAP file does"));
}

#[test]
fn another_version_is_named() {
    let message = RunPhase { header: Header { phase: Phase::End, ..Header::default() }, discard: true };
    let (key, schema, bytes) = ("run/phase".into(), codec::schema::<RunPhase>(), codec::encode(&message));
    let recorded = Message { key, schema, stamp_nanos: 0, bytes };
    assert_eq!(recorded.decode::<RunPhase>().unwrap(), message);
    let older = Message { schema: "RunPhase@0:0".into(), ..recorded.clone() };
    assert!(older.decode::<RunPhase>().unwrap_err().to_string().contains("got RunPhase@0:0"));
    assert!(matches!(recorded.decode::<Mesh>(), Err(DecodeError::Schema { .. })));
}

#[test]
fn a_source_is_a_recording_or_a_folder() {
    let (folder, path) = place();
    record(&path, &messages(), true);
    assert_eq!(Source::open(&path).unwrap().messages().unwrap().count(), 60);
    assert!(matches!(Source::open(folder.path()), Err(ReplayError::Folder(_))));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn cut_anywhere_gives_the_beginning(at in any::<prop::sample::Index>()) {
        let (_folder, path) = place();
        std::fs::write(&path, &WHOLE[..at.index(WHOLE.len())]).unwrap();
        if let Ok((read, errors, damaged)) = play(&path) {
            // Only the last bytes of the magic at the end can go without a loss.
            prop_assert!(damaged || read.len() == 60);
            prop_assert_eq!(errors, 0);
            prop_assert_eq!(&read, &messages()[..read.len()]);
        }
    }

    #[test]
    fn turned_bits_never_give_wrong_messages(
        packed in any::<bool>(),
        flips in prop::collection::vec((any::<prop::sample::Index>(), 0..8_u8), 1..6),
    ) {
        let (_folder, path) = place();
        let mut bytes = if packed { WHOLE.clone() } else { PLAIN.clone() };
        for (at, bit) in flips {
            let at = at.index(bytes.len());
            bytes[at] ^= 1 << bit;
        }
        std::fs::write(&path, &bytes).unwrap();
        if let Ok((read, _errors, _damaged)) = play(&path) {
            let known = messages();
            prop_assert!(read.iter().all(|m| known.iter().any(|k| k.bytes == m.bytes && k.stamp_nanos == m.stamp_nanos)));
        }
    }

    #[test]
    fn garbage_behind_the_magic(garbage in prop::collection::vec(any::<u8>(), 0..500)) {
        let (_folder, path) = place();
        std::fs::write(&path, [mcap::MAGIC, &garbage].concat()).unwrap();
        drop(play(&path));
    }
}
