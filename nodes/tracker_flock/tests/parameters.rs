//! Every parameter of the flock that is played: what EXAMINE answers after power-up, byte for byte as the manual's defaults
//! have it, that CHANGE is told again, and that a reset forgets it; and the bytes that are asked for one by one.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use nalgebra::{UnitQuaternion, Vector3};
use serial_line::Emulated as _;
use tracker_flock::emulator::{EmulatorConfig, FlockEmulator, Mood, World};
use tracker_flock::protocol::address::Addressing;

const MS: i64 = 1_000_000;

/// A flock, and the moment.
struct Played {
    flock: FlockEmulator,
    nanos: i64,
}

impl Played {
    fn new(config: EmulatorConfig) -> Self {
        let at = (Vector3::new(0.2, 0.1, 0.1), UnitQuaternion::from_euler_angles(0.3, 0.2, 0.1));
        let world: World = Box::new(move |_, _| at);
        let mut played = Self { flock: FlockEmulator::new(EmulatorConfig { baud: 0, ..config }, world), nanos: 0 };
        played.rest(0);
        played.rest(20);
        played
    }

    fn alone() -> Self {
        Self::new(EmulatorConfig::default())
    }

    /// What is said in so many milliseconds.
    fn rest(&mut self, millis: i64) -> Vec<u8> {
        self.nanos += millis * MS;
        std::iter::from_fn(|| self.flock.speak(self.nanos)).flat_map(|(_, bytes)| bytes).collect()
    }

    /// What is said at once to a command.
    fn ask(&mut self, command: &[u8]) -> Vec<u8> {
        self.flock.hear(command, self.nanos);
        std::iter::from_fn(|| self.flock.speak(self.nanos)).flat_map(|(_, bytes)| bytes).collect()
    }

    fn examine(&mut self, parameter: u8) -> Vec<u8> {
        self.ask(&[b'O', parameter])
    }

    fn change(&mut self, parameter: u8, data: &[u8]) {
        let said = self.ask(&[&[b'P', parameter], data].concat());
        assert!(said.is_empty(), "CHANGE {parameter} is answered by nothing");
    }
}

fn words(word: [u8; 2]) -> Vec<u8> {
    word.repeat(7)
}

/// Number, answer after power-up, and what it is changed to.
fn changeable() -> Vec<(u8, Vec<u8>, Vec<u8>)> {
    let motion = |words: [u16; 7]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
    vec![
        (3, vec![0, 0], vec![1, 0]),
        (4, vec![4, 0], vec![2, 0]),
        (5, words([0x8F, 0x02]), words([0x11, 0x01])),
        (8, vec![0], vec![1]),
        (9, vec![0x2C], vec![b';']),
        (11, vec![0], vec![3]),
        (12, motion([2, 4, 8, 32, 64, 256, 512]), motion([2, 2, 2, 10, 10, 40, 200])),
        (13, words([0x33, 0x73]), words([0x00, 0x70])),
        (14, vec![0], vec![1]),
        (17, vec![0], vec![1]),
        (18, vec![0], vec![2]),
        (20, vec![60], vec![50]),
        (22, vec![0, 0], vec![0x0C, 1]),
        (23, vec![0; 6], vec![1, 2, 3, 4, 5, 6]),
        (24, vec![0; 6], vec![6, 5, 4, 3, 2, 1]),
        (28, vec![0, 0, 32, 0, 0, 0, 0, 0, 12, 0], vec![1, 0, 40, 0, 3, 0, 2, 0, 9, 0]),
        (29, vec![1], vec![8]),
        (32, vec![0, 0], vec![5, 0]),
        (35, vec![0], vec![1]),
    ]
}

#[test]
fn what_is_changed_is_told_again_and_a_reset_forgets_it() {
    let mut bird = Played::alone();
    for (parameter, at_power_up, changed) in changeable() {
        assert_eq!(bird.examine(parameter), at_power_up, "{parameter} after power-up");
        bird.change(parameter, &changed);
        assert_eq!(bird.examine(parameter), changed, "{parameter} when it was changed");
    }
    assert_eq!(bird.examine(10), [0], "all of them are known");
    bird.flock.set_rts(true, bird.nanos);
    bird.rest(1000);
    bird.flock.set_rts(false, bird.nanos);
    bird.rest(2000);
    for (parameter, at_power_up, _) in changeable() {
        assert_eq!(bird.examine(parameter), at_power_up, "{parameter} behind a reset");
    }
}

#[test]
fn what_can_only_be_read_has_the_manuals_length() {
    let mut bird = Played::alone();
    // Master, configured, running, no synchronisation; position and angles.
    assert_eq!(bird.examine(0), [4 << 1, 0b1101_0001]);
    assert_eq!(bird.examine(1), [3, 67], "revision 3.67");
    assert_eq!(bird.examine(2), [25, 0], "its crystal, in MHz");
    assert_eq!(bird.examine(10), [0]);
    assert_eq!(bird.examine(15), *b"6DFOB     ");
    assert_eq!(bird.examine(16), [0, 0]);
    assert_eq!(bird.examine(19), [0]);
    assert_eq!(bird.examine(21), [0]);
    for serial in [25, 26, 27] {
        assert_eq!(bird.examine(serial).len(), 2);
    }
    for (addressing, name, units, configuration) in
        [(Addressing::Normal, 0, 14, 5), (Addressing::Expanded, 1, 30, 7), (Addressing::SuperExpanded, 3, 126, 19)]
    {
        let mut flock = Played::new(EmulatorConfig { units: 2, addressing, ..EmulatorConfig::default() });
        assert_eq!(flock.examine(19), [name]);
        assert_eq!(flock.examine(36).len(), units);
        assert_eq!(flock.examine(50).len(), configuration);
    }
}

#[test]
fn the_rate_is_told_as_a_count_and_in_hertz() {
    let mut bird = Played::alone();
    assert_eq!(bird.examine(7), (103u16 * 256).to_le_bytes());
    for (hz, told) in [(20, 20), (50, 50), (100, 100), (144, 144), (10, 20), (200, 144)] {
        bird.change(7, &(hz * 256u16).to_le_bytes());
        assert_eq!(bird.examine(7), (told * 256u16).to_le_bytes(), "{hz} Hz");
        let count = f64::from(u16::from_le_bytes(bird.examine(6).try_into().unwrap()));
        // Hz = 1000 / (4 n (8 / MHz) / 1000 + 0.3).
        let hertz = 1000.0 / (4.0 * count * (8.0 / 25.0) / 1000.0 + 0.3);
        assert!((hertz - f64::from(told)).abs() < 0.02, "{count} counts are {hertz} Hz");
        bird.change(7, &(60 * 256u16).to_le_bytes());
        bird.change(6, &(count as u16).to_le_bytes());
        let again = f64::from(u16::from_le_bytes(bird.examine(7).try_into().unwrap())) / 256.0;
        assert!((again - f64::from(told)).abs() < 0.02, "{count} counts are {again} Hz");
        bird.ask(b"@");
        bird.rest(100);
        let records = bird.rest(10_000).len() / 12;
        assert!(records.abs_diff(usize::from(told) * 10) <= 2, "{records} in 10 s at {told} Hz");
        bird.ask(b"?");
    }
}

#[test]
fn a_flock_says_who_is_there_and_is_told_to_begin() {
    let mut flock = Played::new(EmulatorConfig { units: 3, first_sensor: 2, ..EmulatorConfig::default() });
    let [low, high] = flock.examine(0).try_into().unwrap();
    assert_eq!((low, high), (4 << 1, 0b1000_0001), "the master; neither configured nor running");
    assert_eq!(flock.examine(36)[..4], [0x91, 0xA0, 0xA0, 0], "an extended range controller and two sensors");
    assert_eq!(flock.examine(50), [0; 5]);
    assert!(flock.ask(b"B").is_empty(), "it does not measure before it is configured");
    flock.change(50, &[3]);
    assert!(flock.examine(0).is_empty(), "it hears nothing while it configures itself");
    flock.rest(600);
    assert_eq!(flock.examine(36)[..4], [0xD1, 0xE0, 0xE0, 0]);
    assert_eq!(flock.examine(50), [1, 0b1110, 0, 0b1100, 0]);
    assert_eq!(flock.ask(&[0xF2, b'O', 21]), [2], "its own address");
    assert_eq!(flock.ask(&[0xF1, b'O', 15]), *b"6DERC     ");
    flock.change(35, &[1]);
    let records = flock.ask(b"B");
    assert_eq!((records.len(), records[12], records[25]), (26, 2, 3), "both answer, the lower address first");
    flock.ask(b"/");
    flock.rest(600);
    assert!(flock.ask(b"B").is_empty(), "an FBB RESET wants to be configured behind");
}

#[test]
fn errors_are_told_once() {
    let mut flock = Played::new(EmulatorConfig { units: 2, ..EmulatorConfig::default() });
    let error_bit = |flock: &mut Played| flock.examine(0)[1] & 0x20 != 0;
    flock.ask(b"!");
    assert!(error_bit(&mut flock) && !error_bit(&mut flock), "reading the status puts its bit out");
    assert_eq!(flock.examine(16), [6, 0], "an unknown command");
    assert_eq!(flock.examine(16), [0, 0]);
    flock.change(1, &[0]);
    assert_eq!(flock.examine(10), [6], "the revision cannot be changed");
    flock.ask(&[0xF5, b'F']);
    assert_eq!(flock.examine(16), [13, 5], "unit 5 does not answer");
    flock.change(50, &[4]);
    flock.rest(600);
    assert_eq!(flock.examine(16), [13, 3], "the first that is missing of four");
    flock.flock.set_mood(Mood::Saturated);
    assert_eq!([flock.examine(10), flock.examine(10)], [[32], [32]], "as long as it is");
}

#[test]
fn button_and_metal_are_bytes_behind_the_words_and_answers_of_their_own() {
    for button in [0x00, 0x10, 0x30, 0x70] {
        let mut bird = Played::new(EmulatorConfig { button, metal: 17, ..EmulatorConfig::default() });
        assert_eq!(bird.ask(b"N"), [button]);
        assert_eq!(bird.ask(b"t"), [17]);
        assert_eq!(bird.ask(b"B").len(), 12);
        bird.ask(&[b'M', 1]);
        assert_eq!(bird.ask(b"B")[12..], [button]);
        bird.ask(&[b's', 1, 0]);
        assert_eq!(bird.ask(b"B")[12..], [button, 17]);
        bird.ask(&[b'M', 0]);
        assert_eq!(bird.ask(b"B")[12..], [17]);
        for (flag, data) in [(2, 40), (3, 1), (4, 2), (5, 3)] {
            bird.ask(&[b's', flag, data]);
        }
        assert_eq!(bird.examine(28), [1, 0, 40, 0, 1, 0, 2, 0, 3, 0]);
        bird.ask(&[b's', 0, 0]);
        assert_eq!(bird.ask(b"B").len(), 12);
    }
}

#[test]
fn synchronisation_stands_in_the_status() {
    let mut bird = Played::alone();
    for (sync, bits) in [(0, 0b001), (1, 0b010), (3, 0b010), (8, 0b1000)] {
        bird.ask(&[b'A', sync]);
        assert_eq!(bird.examine(0)[1] & 0b1011, bits, "SYNC {sync}");
    }
    assert_eq!(bird.ask(&[b'A', 255]).len(), 4, "two words");
}

/// The words of a record, without their lowest two bits.
fn words_of(record: &[u8]) -> Vec<i16> {
    record.chunks(2).map(|two| tracker_flock::protocol::records::decode_word(two[0] & 0x7F, two[1])).collect()
}

#[test]
fn an_offset_is_added_in_the_sensors_frame_and_a_boresighted_sensor_does_not_turn() {
    let mut bird = Played::alone();
    let before = words_of(&bird.ask(b"B"));
    // The manual's example: 5.4 inches are 4915.
    bird.ask(&[&b"K"[..], &4915i16.to_le_bytes()[..], &[0; 4]].concat());
    let after = words_of(&bird.ask(b"B"));
    let along = UnitQuaternion::from_euler_angles(0.3, 0.2, 0.1) * Vector3::x() * 4915.0;
    for axis in 0..3 {
        let moved = f64::from(after[axis]) - f64::from(before[axis]);
        assert!((moved - along[axis]).abs() < 6.0, "axis {axis}: {moved}, not {}", along[axis]);
    }
    assert_eq!(before[3..], after[3..]);
    bird.ask(b"u");
    assert!(words_of(&bird.ask(b"B"))[3..].iter().all(|angle| angle.abs() <= 4));
    bird.ask(b"v");
    assert_eq!(words_of(&bird.ask(b"B"))[3..], before[3..]);
}

#[test]
fn xoff_holds_the_stream_and_sleep_freezes_it() {
    let mut bird = Played::alone();
    bird.ask(b"@");
    assert!(!bird.rest(50).is_empty());
    bird.ask(&[0x13]);
    assert_eq!(bird.examine(0)[0] & 0x40, 0x40);
    assert!(bird.rest(50).is_empty());
    bird.ask(&[0x11]);
    assert!(!bird.rest(50).is_empty());
    bird.ask(b"G");
    assert_eq!(bird.examine(0)[0] & 0x21, 0x21, "asleep, and it streams on");
    bird.ask(b"F");
    assert_eq!(bird.examine(0)[0] & 0x20, 0);
}
