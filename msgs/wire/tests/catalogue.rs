//! The words beside the bytes.

use wire::{Frame, Header, Pose, Quality, RigidPose, codec};

#[test]
fn every_message_that_has_a_topic_is_told() {
    let told = wire::catalogue();
    for (key, name, _class) in wire::topic::all() {
        assert!(told.keys().any(|schema| schema.starts_with(&format!("{name}@"))), "{key}: {name} is missing");
    }
}

#[test]
fn a_layout_names_every_field_down_to_the_numbers() {
    let text = &wire::catalogue()[&codec::schema::<Frame>()];
    for words in [
        "struct Frame {\n    header: Header,\n    width: u32,",
        "data: Bulk<u8>",
        "stamp_nanos: i64",
        "enum PixelFormat {\n    Grey8,",
    ] {
        assert!(text.contains(words), "{words:?} is not in {text}");
    }
}

#[test]
fn the_header_can_be_read_alone() {
    let header = Header { scan: 7, seq: 70_000, stamp_nanos: -5, ..Header::default() };
    let pose = Pose {
        header,
        world_from_body: RigidPose::IDENTITY,
        position_sigma_m: [1e-3; 3],
        rotation_sigma_rad: [1e-3; 3],
        rotation_lag_nanos: 0,
        quality: Quality::Good,
        reason: String::new(),
    };
    assert_eq!(codec::header(&codec::encode(&pose)).unwrap(), header);
    assert!(codec::header(&[0xff; 3]).is_err());
}
