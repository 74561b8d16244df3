//! Scenes and rigs from anywhere: a world or a refusal, never a panic, and nothing is allocated that nobody could want.
#![allow(clippy::unwrap_used, reason = "a test helper that cannot go on fails the test")]

use proptest::prelude::*;
use std::path::Path;
use world::{Scene, Setup};

const SCENE: &str = "subject = \"all\"\nambient = 0.08\n[table]\nsize_mm = [120, 100]\ncolour = [150, 146, 136]\ngrain = 9\n\
    [hand]\nstand_off_mm = 200\nspeed_limit_mm_per_s = 280\n[[object]]\nkind = \"box\"\nsides_mm = [30, 20, 25]\nat_mm = [5, -5]\n\
    yaw_deg = 40\ncolours = [[206, 214, 222], [52, 92, 150]]\npattern = \"stripes\"\npattern_mm = 8\n";
const PAPER: &str = include_str!("../../../config/rigs/paper.toml");
const VALUES: &[&str] = &[
    "0",
    "-1",
    "1",
    "-0.0",
    "1e-300",
    "1e-9",
    "1e9",
    "1e300",
    "1e999",
    "nan",
    "inf",
    "4294967296",
    "9223372036854775807",
    "\"x\"",
    "true",
    "[]",
    "[1.0]",
    "{}",
    "",
];

/// The text with the number that `which` chooses written otherwise.
fn changed(text: &str, which: prop::sample::Index, value: &str) -> String {
    let is_part = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-');
    let starts: Vec<usize> =
        text.char_indices().filter(|&(at, c)| is_part(c) && !text[..at].ends_with(is_part)).map(|(at, _)| at).collect();
    let start = starts[which.index(starts.len())];
    let length = text[start..].find(|c| !is_part(c)).unwrap_or(text.len() - start);
    format!("{}{value}{}", &text[..start], &text[start + length..])
}

fn opens_or_refuses(scene: &str, rig: &str) {
    let folder = tempfile::tempdir().unwrap();
    let [scene_file, rig_file] = ["scene.toml", "rig.toml"].map(|name| folder.path().join(name));
    std::fs::write(&scene_file, scene).unwrap();
    std::fs::write(&rig_file, rig).unwrap();
    let setup = Setup { scene: scene_file, object: "".into(), size_mm: 150.0, rig: rig_file, seed: 1, seconds: 2.0 };
    if let Ok(known) = setup.open() {
        assert!(known.hand.duration_s().is_finite(), "{scene}\n{rig}");
        assert!(known.scene.subject().mesh.check().is_ok(), "{scene}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn any_text(text in ".{0,200}") {
        drop(Scene::parse(&text, Path::new("")));
    }

    #[test]
    fn a_scene_with_a_number_changed(which: prop::sample::Index, value in prop::sample::select(VALUES)) {
        opens_or_refuses(&changed(SCENE, which, value), PAPER);
    }

    #[test]
    fn a_simulated_rig_with_a_number_changed(which: prop::sample::Index, value in prop::sample::select(VALUES)) {
        opens_or_refuses(SCENE, &changed(PAPER, which, value));
    }
}

/// A camera of so long a lens sees nothing of the stripe: the sweep would be of a thousand million lanes.
#[test]
fn a_stripe_that_is_no_stripe_is_refused_with_its_length() {
    let folder = tempfile::tempdir().unwrap();
    let rig = folder.path().join("rig.toml");
    let long: Vec<&str> = PAPER.lines().map(|line| if line.starts_with("fy = ") { "fy = 1e9" } else { line }).collect();
    std::fs::write(&rig, long.join("\n")).unwrap();
    let refused = Setup { rig, ..Setup::default() }.open().unwrap_err().to_string();
    assert!(refused.contains("mm of the stripe") && refused.contains("[camera]"), "{refused}");
}

#[test]
fn as_they_are_they_open() {
    let folder = tempfile::tempdir().unwrap();
    let rig = folder.path().join("rig.toml");
    std::fs::write(&rig, PAPER).unwrap();
    assert!(Scene::parse(SCENE, Path::new("")).is_ok());
}
