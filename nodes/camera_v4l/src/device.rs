//! What the thread that takes pictures needs of a camera.

use crate::exposure::Setting;
use crate::pixels::Layout;
use crate::stamp::DriverStamp;
use crate::trouble::Trouble;
use std::time::Duration;

/// A picture as the driver gave it: in its own memory (`&[u8]`), which is the driver's again as soon as the next one is
/// asked for, or out of it (`Vec<u8>`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exposed<B = Vec<u8>> {
    /// As many as the driver has filled.
    pub bytes: B,
    /// How they are laid out.
    pub layout: Layout,
    /// When it was.
    pub stamp: DriverStamp,
    /// The driver's number.
    pub sequence: u32,
    /// The driver says that it is damaged.
    pub damaged: bool,
    /// What the camera was set to.
    pub setting: Setting,
}

impl Exposed<&[u8]> {
    /// Out of the driver's memory: the one copy of a picture on its way to the bus.
    pub fn copied(self) -> Exposed {
        let Self { bytes, layout, stamp, sequence, damaged, setting } = self;
        Exposed { bytes: bytes.to_vec(), layout, stamp, sequence, damaged, setting }
    }
}

/// An open camera.
pub trait Device {
    /// What was found and set, in a sentence.
    fn found(&self) -> String;
    /// The next picture, where the driver has put it; none when none came in this time.
    fn expose(&mut self, wait: Duration) -> Result<Option<Exposed<&[u8]>>, Trouble>;
    /// Sets exposure and gain; what they are then.
    fn set(&mut self, setting: Setting) -> Result<Setting, Trouble>;
}

/// Opens the camera and sets it, again and again.
pub trait Opener: Send + 'static {
    /// An open camera that is set as configured.
    fn open(&mut self) -> Result<Box<dyn Device>, Trouble>;
    /// What to say when nothing comes, and after how long.
    fn silence(&self) -> (Duration, Trouble);
}
