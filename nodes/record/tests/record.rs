//! What an independent reader (the crate mcap, by its index) finds in our files.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use record::{Config, METADATA, RecordError, Recorder};
use std::collections::BTreeMap;
use wire::{Header, Phase, RunPhase, codec};

fn run_phase(seq: u64) -> RunPhase {
    RunPhase {
        header: Header { phase: Phase::Both, seq, stamp_nanos: seq as i64 * 1_000, ..Header::default() },
        discard: false,
    }
}

#[test]
fn any_mcap_reader_finds_channels_schemas_layouts_and_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.mcap");
    let metadata: BTreeMap<_, _> = [("configuration".into(), "stripe.threshold = 3".into())].into();
    let mut recorder = Recorder::create(&path, Config::default(), &metadata).unwrap();
    let schema = codec::schema::<RunPhase>();
    for seq in 0..100 {
        let message = run_phase(seq);
        recorder.write("run/phase", &schema, message.header.stamp_nanos, &codec::encode(&message)).unwrap();
        recorder.write("other/thing", "Thing@9:00", -5, b"as it came").unwrap();
    }
    let kept = recorder.finish().unwrap();
    assert_eq!((kept.messages, kept.by_key["run/phase"]), (200, 100));

    let bytes = std::fs::read(&path).unwrap();
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    assert_eq!(summary.stats.unwrap().message_count, 200);
    let noted = mcap::read::metadata(&bytes, &summary.metadata_indexes[0]).unwrap();
    assert_eq!((noted.name.as_str(), noted.metadata), (METADATA, metadata));
    let messages: Vec<_> = mcap::MessageStream::new(&bytes).unwrap().collect::<Result<_, _>>().unwrap();
    let ours = &messages[198];
    let channel_schema = ours.channel.schema.as_ref().unwrap();
    assert_eq!((ours.channel.topic.as_str(), ours.channel.message_encoding.as_str()), ("run/phase", "bincode"));
    assert_eq!(channel_schema.name, schema);
    assert!(String::from_utf8_lossy(&channel_schema.data).contains("struct RunPhase {\n    header: Header,"));
    assert_eq!((ours.log_time, ours.sequence), (99_000, 99));
    assert_eq!(codec::decode::<RunPhase>(&ours.data).unwrap(), run_phase(99));
    assert_eq!((messages[199].log_time, &messages[199].data[..]), (0, &b"as it came"[..]));
}

#[test]
fn a_recording_is_never_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.mcap");
    std::fs::write(&path, "precious").unwrap();
    let refused = Recorder::create(&path, Config::default(), &BTreeMap::new());
    assert!(matches!(refused, Err(RecordError::Create { .. })));
    assert_eq!(std::fs::read(&path).unwrap(), b"precious");
}

#[test]
fn a_recorder_that_lives_again_goes_on_in_the_next_part() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.mcap");
    let go_on = || Recorder::go_on(&path, Config::default(), &BTreeMap::new()).unwrap();
    let names = ["scan.mcap", "scan.2.mcap", "scan.3.mcap"];
    for name in names {
        let recorder = go_on();
        assert_eq!(recorder.path(), folder.path().join(name));
    }
    // A new recording does not take the parts of another for its own.
    std::fs::remove_file(&path).unwrap();
    let refused = Recorder::create(&path, Config::default(), &BTreeMap::new()).err().unwrap().to_string();
    assert!(refused.contains("scan.2.mcap is there already"), "{refused}");
    assert!(!path.exists());
}

#[test]
fn numbers_out_of_range_are_refused() {
    for (config, wanted) in [
        (Config { chunk_mb: 0, ..Config::default() }, "chunk_mb = 0: 1 to 256"),
        (Config { chunk_s: f64::NAN, ..Config::default() }, "chunk_s = NaN: 0.01 to 60"),
        (Config { zstd_level: 20, ..Config::default() }, "zstd_level = 20: 0 to 19"),
    ] {
        assert_eq!(config.check().unwrap_err().to_string(), wanted);
    }
}
