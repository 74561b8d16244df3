//! What `limn emulate` is told to be wrong, before the real drivers.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use serial_line::{Device, HostClock, LineSettings, News, Session};
use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;
use std::time::Duration;
use system_tests::rig::{Rig, wait_until};
use system_tests::{limn, repository};

const LONG: Duration = Duration::from_secs(60);

/// What is heard of a driver's device until it has said these words.
fn says<D: Device>(device: D, line: LineSettings, words: &str) {
    let (say, news) = channel();
    let _session = Session::start(device, line, HostClock::start(), move |piece| drop(say.send(piece)));
    let mut heard = Vec::new();
    while !heard.iter().any(|sentence: &String| sentence.contains(words)) {
        let piece = news.recv_timeout(LONG);
        heard.push(match piece.unwrap_or_else(|_| panic!("{words:?} was not said: {heard:?}")) {
            News::Streaming(found) | News::Noisy(found) => found,
            News::Trouble(trouble) => trouble.to_string(),
        });
    }
}

/// A device that `limn emulate` plays, and its port.
fn played(words: &[&str], folder: &Path) -> (Rig, PathBuf) {
    let port = folder.join(words.join("_").replace(' ', ""));
    let mut play = limn();
    play.arg("emulate").args(words).arg("--rig").arg(repository("config/rigs/paper.toml"));
    play.arg("--scene").arg(repository("config/scenes/cow.toml")).arg("--link").arg(&port);
    let played = Rig::start(&mut play);
    wait_until("no port", || played.said().contains("which") && port.exists());
    (played, port)
}

#[test]
fn each_illness_of_a_bird_is_its_own_sentence() {
    let folder = tempfile::tempdir().unwrap();
    for (told, words) in [
        (["--mood", "silent"], "says nothing"),
        (["--mood", "test-echo"], "test mode"),
        (["--mood", "wrong-baud"], "no record of a bird"),
        (["--mood", "saturated"], "saturated"),
        (["--error", "5"], "no sensor"),
    ] {
        let (_played, port) = played(&[&["flock"], &told[..]].concat(), folder.path());
        let bird = tracker_flock::port::Flock::new(tracker_flock::Config { port, ..Default::default() });
        let line = bird.line_settings();
        says(bird, line, words);
    }
}

#[test]
fn a_silent_polhemus_says_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (_played, port) = played(&["polhemus", "--mood", "silent"], folder.path());
    let config = tracker_polhemus::Config { port, ..Default::default() };
    let device = tracker_polhemus::port::Polhemus::new(config);
    let line = device.line_settings();
    says(device, line, "says nothing");
}
