//! A serial line to a device that measures, and when what came over it was measured.
//!
//! In: arrivals of records on the host's clock ([`HostClock`]). Out: the same moments without what delayed them, in
//! nanoseconds of the host's clock. A node takes off [`wire_nanos`] and the device's own latency, and has the stamp.
//!
//! - [`RateLock`]: for devices without a clock that measure at an even rate. 100 Hz with 0-10 ms of jitter comes out
//!   within 0.1 ms rms (`tests/clocks.rs`).
//! - [`DeviceClock`]: for devices that send the time of their own clock.
//! - [`Envelope`]: the line under all arrivals, which both stand on: delays only add.
//!
//! What trackers on such lines have in common is here as well, since nodes never depend on nodes: [`PoseTracker`], what
//! turns records into poses; [`HalfSpace`], which side of the transmitter they are on; [`Rounds`], whose record it is; [`Tally`], what a decoder has seen; [`Noise`], whether a line is half dead; [`Step`], what a device
//! is told; [`ConfigError`], a setting that cannot be; [`Emulated`], [`Speech`] and [`Faults`], a device that is played, and what goes wrong on real lines.
//!
//! With the feature `serial`:
//!
//! - `Line`: a port, raw and without flow control, with its modem lines as the device wants them; each failure is a
//!   sentence that says what to do.
//! - `Session`: a thread that opens, sets up, listens, names what is wrong within a second, and starts again, for ever.
//! - `Pty`: the other end of a line, for emulators: a pseudo-terminal.
//!
//! With the feature `node`, which brings the bus: `node::run`, the life of a node that sends what a tracker says. This is
//! the only crate that names serialport.

mod config_error;
#[cfg(feature = "serial")]
mod device;
mod device_clock;
mod emulated;
mod envelope;
mod faults;
mod half_space;
mod host_clock;
#[cfg(feature = "serial")]
mod line;
#[cfg(feature = "serial")]
mod line_error;
#[cfg(feature = "node")]
pub mod node;
mod noise;
mod pose_tracker;
#[cfg(feature = "serial")]
mod pty;
mod rate_lock;
#[cfg(feature = "serial")]
mod ring;
mod rounds;
#[cfg(feature = "serial")]
mod session;
mod step;
mod tally;
mod wire_time;

pub use config_error::ConfigError;
#[cfg(feature = "serial")]
pub use device::{Arrived, Counts, Device, Heard, News, Trouble};
pub use device_clock::DeviceClock;
pub use emulated::{Emulated, Speech};
pub use envelope::{Envelope, FittedLine};
pub use faults::{Delivery, Faults, FaultsConfig};
pub use half_space::HalfSpace;
pub use host_clock::HostClock;
#[cfg(feature = "serial")]
pub use line::{Chunk, Line, LineSettings, RaiseRts};
#[cfg(feature = "serial")]
pub use line_error::LineError;
pub use noise::Noise;
pub use pose_tracker::{PoseTracker, SensorPose};
#[cfg(feature = "serial")]
pub use pty::{Pty, PtyError};
pub use rate_lock::RateLock;
pub use rounds::{Rounds, Turn};
#[cfg(feature = "serial")]
pub use session::Session;
pub use step::Step;
pub use tally::Tally;
pub use wire_time::wire_nanos;

/// Why the pose of a record that was [`held_up`](Undelayed::held_up) is lost.
pub const HELD_UP: &str = "it came in a burst behind a silence: when it was measured is not known";

/// A moment of arrival without what delayed it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Undelayed {
    /// On the clock of the arrivals.
    pub nanos: i64,
    /// How much later it arrived.
    pub removed_nanos: i64,
    /// True once enough was heard to be sure.
    pub settled: bool,
    /// It waited somewhere, nobody knows for how long: it came right behind another, or behind a silence, while the clock
    /// was not settled.
    pub held_up: bool,
}
