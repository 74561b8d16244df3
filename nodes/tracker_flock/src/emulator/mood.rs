//! What is wrong with a flock.

use super::FlockEmulator;
use crate::protocol::records::{MOST_WORDS, Record};

/// What is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mood {
    /// Nothing.
    Well,
    /// It says nothing: standby, or a cable that is half open.
    Silent,
    /// Its switch 8 is on.
    Test(TestMode),
    /// Its baud rate is another: nothing that it says is understood, nor what it hears.
    WrongBaud,
    /// Its sensors are too near the transmitter: they give zeros, and the error that says so whenever it is asked for.
    Saturated,
    /// Its sensors are beyond the scale: positions stick at its end.
    OutOfRange,
}

/// What a bird does with its switch 8 at test, as its other switches have it (manual, pages 19-21).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TestMode {
    /// It says OK, twice a second.
    Output,
    /// It says what it hears.
    Echo,
    /// For each byte that it hears it says the next number.
    Read,
    /// For each byte that it hears it says the numbers from 0 to 255.
    Block,
}

/// The code of a saturated sensor.
pub(super) const SATURATED: u8 = 32;

impl FlockEmulator {
    /// Makes it ill, or well again.
    pub fn set_mood(&mut self, mood: Mood) {
        self.mood = mood;
    }

    /// One cycle.
    pub(super) fn live(&mut self, at_nanos: i64) {
        match self.mood {
            Mood::Well | Mood::Saturated | Mood::OutOfRange => self.measure(),
            Mood::Test(TestMode::Output) if self.cycle.is_multiple_of((self.rate_hz as u64 / 2).max(1)) => {
                self.speech.say(at_nanos, b"OK\r\n".to_vec());
            }
            Mood::WrongBaud => self.speech.say(at_nanos, vec![0x78, 0x00, 0x60, 0x1E, 0x06, 0x18]),
            Mood::Silent | Mood::Test(_) => {}
        }
    }

    /// What of a record is left.
    pub(super) fn bend(&self, record: &mut Record) {
        match self.mood {
            Mood::Saturated => record.words = [0; MOST_WORDS],
            Mood::OutOfRange if record.format.has_position() => record.words[..3].fill(i16::MAX),
            _ => {}
        }
    }

    /// Whether commands are obeyed; else what it does with the bytes instead.
    pub(super) fn understands(&mut self, bytes: &[u8], now_nanos: i64) -> bool {
        match self.mood {
            Mood::Well | Mood::Saturated | Mood::OutOfRange => return true,
            Mood::Test(TestMode::Echo) => self.speech.say(now_nanos, bytes.to_vec()),
            Mood::Test(TestMode::Read) => {
                let numbers = (0..bytes.len()).map(|k| self.counted.wrapping_add(k as u8)).collect();
                self.counted = self.counted.wrapping_add(bytes.len() as u8);
                self.speech.say(now_nanos, numbers);
            }
            Mood::Test(TestMode::Block) => {
                bytes.iter().for_each(|_| self.speech.say(now_nanos, (0..=255).collect()));
            }
            Mood::Silent | Mood::Test(TestMode::Output) | Mood::WrongBaud => {}
        }
        false
    }
}
