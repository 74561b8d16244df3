//! What is wrong with a device, by its name on the command line.

use tracker_flock::emulator::{Mood as Flock, TestMode};
use tracker_polhemus::emulator::Mood as Polhemus;

/// What can be wrong with a Flock of Birds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum FlockMood {
    /// Nothing.
    Well,
    /// It says nothing: standby, or a cable that is half open.
    Silent,
    /// Its baud rate is another.
    WrongBaud,
    /// Its switch 8 is on: it says OK, twice a second.
    TestOutput,
    /// The same: it says what it hears.
    TestEcho,
    /// The same: for each byte that it hears it says the next number.
    TestRead,
    /// The same: for each byte that it hears it says the numbers from 0 to 255.
    TestBlock,
    /// Its sensors are too near the transmitter.
    Saturated,
    /// Its sensors are beyond its scale.
    OutOfRange,
}

impl From<FlockMood> for Flock {
    fn from(mood: FlockMood) -> Self {
        match mood {
            FlockMood::Well => Self::Well,
            FlockMood::Silent => Self::Silent,
            FlockMood::WrongBaud => Self::WrongBaud,
            FlockMood::TestOutput => Self::Test(TestMode::Output),
            FlockMood::TestEcho => Self::Test(TestMode::Echo),
            FlockMood::TestRead => Self::Test(TestMode::Read),
            FlockMood::TestBlock => Self::Test(TestMode::Block),
            FlockMood::Saturated => Self::Saturated,
            FlockMood::OutOfRange => Self::OutOfRange,
        }
    }
}

/// What can be wrong with a Polhemus.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum PolhemusMood {
    /// Nothing.
    Well,
    /// It says nothing.
    Silent,
    /// Its baud rate is another.
    WrongBaud,
}

impl From<PolhemusMood> for Polhemus {
    fn from(mood: PolhemusMood) -> Self {
        match mood {
            PolhemusMood::Well => Self::Well,
            PolhemusMood::Silent => Self::Silent,
            PolhemusMood::WrongBaud => Self::WrongBaud,
        }
    }
}
