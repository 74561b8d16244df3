//! What a launcher tells a node, from anywhere: it is understood or refused, never a panic.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use bus::BusConfig;
use kit::NodeSpec;
use proptest::prelude::*;
use serde_json::{Value, json};

fn odd() -> impl Strategy<Value = Value> {
    let values = [
        json!(null),
        json!(-1),
        json!(0),
        json!(1e300),
        json!(u64::MAX),
        json!(""),
        json!("../x"),
        json!("fast"),
        json!([]),
        json!([1, "a"]),
        json!({}),
        json!({ "a": null }),
        json!(true),
    ];
    prop::sample::select(values.to_vec())
}

proptest! {
    #[test]
    fn any_text(text in ".{0,200}") {
        drop(serde_json::from_str::<NodeSpec>(&text));
    }

    #[test]
    fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        drop(serde_json::from_slice::<NodeSpec>(&bytes));
    }

    #[test]
    fn with_values_changed(changes in prop::collection::vec((any::<prop::sample::Index>(), odd()), 1..4)) {
        let mut told = serde_json::to_value(NodeSpec::new("stripe", "head", BusConfig::default())).unwrap();
        let keys: Vec<String> = told.as_object().unwrap().keys().cloned().collect();
        for (which, value) in changes {
            told[&keys[which.index(keys.len())]] = value;
        }
        if let Ok(spec) = serde_json::from_value::<NodeSpec>(told) {
            // What was understood is told again in the same words.
            let again = serde_json::to_string(&spec).unwrap();
            prop_assert_eq!(serde_json::from_str::<NodeSpec>(&again).unwrap(), spec);
        }
    }

    #[test]
    fn cut_short(length: prop::sample::Index) {
        let told = serde_json::to_string(&NodeSpec::new("stripe", "head", BusConfig::default())).unwrap();
        prop_assert!(serde_json::from_str::<NodeSpec>(&told[..length.index(told.len())]).is_err());
    }
}

#[test]
fn an_unknown_key_is_named() {
    let error = serde_json::from_str::<NodeSpec>(r#"{"kind":"stripe","instance":"head","isntance":1}"#).unwrap_err();
    assert!(error.to_string().contains("isntance"), "{error}");
}
